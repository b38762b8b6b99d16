#include "scene/misuse.h"

namespace exactff {

void refuse_argument(const std::string& what, const std::string& why) {
  throw std::invalid_argument(what + " (" + why + ")");
}

namespace {

void require_index(std::size_t index, std::size_t count, const std::string& kind, const std::string& kinds) {
  if (index < count) return;
  refuse_argument("there is no " + kind + " " + std::to_string(index),
                  "the scene has " + std::to_string(count) + " " + kinds + ", counted from 0");
}

}  // namespace

void require_face(const Scene& scene, FaceId face) {
  require_index(index_of(face), scene.faces().size(), "face", "faces");
}

void require_of_scene(const Scene& scene, SceneId made_by, const char* what) {
  if (made_by == scene.id()) return;
  refuse_argument("the " + std::string(what) + " belongs to another scene", "its ids have another meaning there");
}

void require_scene(const Scene* scene) {
  if (scene == nullptr)
    refuse_argument("the request has no scene", "set the pointer to a scene that lives as long as the request");
}

void require_of_scene(const Scene& scene, const Selection& selection) {
  if (selection.scene != kAnyScene) require_of_scene(scene, selection.scene, "selection");
  require_index(index_of(selection.patch), scene.patches().size(), "patch", "patches");
  if (!selection.face) return;
  require_face(scene, *selection.face);
  if (scene.face(*selection.face).patch == selection.patch) return;
  refuse_argument("face " + std::to_string(index_of(*selection.face)) + " does not belong to patch '" +
                      scene.patch(selection.patch).name + "'",
                  "a selection is a patch or one of its own faces");
}

}  // namespace exactff
