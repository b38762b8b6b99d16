#include <algorithm>
#include <set>

#include "exactff/matrix.h"
#include "kernel/float_environment.h"
#include "scene/scene_copy.h"
#include "text/refuse.h"
#include "text/text_lines.h"

namespace exactff::matrix {
namespace {

std::string name_of_back(const Scene& scene, const Selection& selection) {
  std::string name = scene.name_of(selection) + ' ' + std::string(kBack);
  if (std::ranges::any_of(scene.patches(), [&](const Patch& patch) { return patch.name == name; })) {
    text::refuse("the back of " + scene.name_of(selection) + " cannot be a patch of its own",
                 "there is a patch named " + text::in_quotes(name) + " already", "rename that patch");
  }
  return name;
}

}  // namespace

Scene with_two_sided(const Scene& scene, std::span<const Selection> selections) {
  const kernel::StandardArithmetic arithmetic;
  SceneCopy copy(scene);
  std::set<FaceId> doubled;
  for (const Selection& selection : selections) {
    std::vector<FaceId> faces = scene.faces_of(selection);
    std::erase_if(faces, [&](FaceId face) { return !doubled.insert(face).second; });
    if (faces.empty()) continue;
    const Selection back = copy.add_patch(name_of_back(scene, selection));
    for (const FaceId face : faces) copy.add_twin(back, scene.face(face));
  }
  return copy.take();
}

}  // namespace exactff::matrix
