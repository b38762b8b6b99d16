// What a Scene holds. Immutable once SceneBuilder::build has returned.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <span>
#include <stdexcept>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "exactff/scene.h"
#include "scene/closed_surfaces.h"
#include "scene/contacts.h"
#include "scene/edges.h"
#include "scene/panels.h"
#include "scene/shaft_tree.h"

namespace exactff {

// Of all faces, one after the other. Takes no memory in a scene without.
struct Texture {
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;
  std::vector<std::uint32_t> first;  // of each face, or of those up to the last one that has some; kNone for none
  std::vector<TexturePoint> points;
};

// A part of a scene that is made at its first use, by whichever thread is first.
template <class Part>
class Lazy {
 public:
  template <class Make>
  const Part& made_by(const Make& make) const {
    std::call_once(once_, [&] { part_ = make(); });
    return part_;
  }

 private:
  mutable std::once_flag once_;
  mutable Part part_{};
};

struct Scene::Data {
  const SceneId id = next_id();
  std::string file;                          // its name in messages
  std::vector<std::filesystem::path> files;  // that it was read from
  Unit unit = Unit::kNone;
  std::vector<Vec3> vertices;  // finite, no negative zero
  std::vector<Material> materials;
  std::vector<Patch> patches;
  std::unordered_map<std::string, PatchId> patch_by_name;
  std::vector<Face> faces;             // in file order
  std::vector<Piece> pieces;           // in the order of their faces
  std::vector<std::uint32_t> corners;  // vertex indices of all pieces
  std::array<Texture, kTextureSets> textures;
  std::vector<Problem> warnings;
  std::size_t warnings_of_glass = 0;  // that many come first

  // Parts that follow from the others. The functions beside them make them at the first use.
  Lazy<std::vector<std::uint32_t>> places;  // places(), scene.cpp: vertices at one position
  Lazy<Planes> planes;                      // planes(), panels.cpp: which pieces lie in one plane
  Lazy<ShaftTree> tree;                     // shaft_tree(): the boxes of pieces
  Lazy<Panels> panels;                      // panels(): neighbours in one plane, joined
  Lazy<ShaftTree> panel_tree;               // panel_tree(), panels.cpp: the boxes of panels
  Lazy<ClosedSurfaces> surfaces;            // closed_surfaces(): what edges join without a gap
  Lazy<Contacts> contacts;                  // contacts(): overlaps in one plane
  Lazy<SceneEdges> edges;                   // scene_edges(): the tree of edges
  Lazy<double> edges_per_silhouette;        // edges_per_silhouette(), edges.cpp: an estimate
  Lazy<Extent> extent;                      // extent(), shaft_tree.cpp: lengths of the order of the scene's

 private:
  static SceneId next_id();
};

struct SceneInside {
  using Data = Scene::Data;
  [[nodiscard]] static const Data& data(const Scene& scene) { return scene.data(); }
  // For a scene that nothing else uses yet.
  static Scene read_from(const std::filesystem::path& file, Scene scene) {
    scene.data_->files.insert(scene.data_->files.begin(), file);
    return scene;
  }
  static Scene of(std::unique_ptr<Data> data) {
    Scene scene(std::move(data));
    scene.set_warnings_of_glass();
    return scene;
  }
};

// --- Misuse ---

// Checks for misuse of the library that the compiler cannot find: exceptions with a message.

// For objects that own their data by a pointer, which is null after a move. Throws std::logic_error if it is null.
template <class Owner>
auto& owned_by(const Owner& owner, const char* what) {
  if (!owner)
    throw std::logic_error(std::string("this ") + what + " was moved from; it can only be assigned to or destroyed");
  return *owner;
}

// The following throw std::invalid_argument.
[[noreturn]] void refuse_argument(const std::string& what, const std::string& why);
void require_face(const Scene& scene, FaceId face);
// Also checks the ids of the selection.
void require_of_scene(const Scene& scene, const Selection& selection);
// `what`: "source"
void require_of_scene(const Scene& scene, SceneId made_by, const char* what);
void require_scene(const Scene* scene);  // of a request

// --- Texture coordinates ---

// Those of one face by the places of its corners.
class FaceTexture {
 public:
  FaceTexture(const Scene& scene, FaceId face, int set);

  [[nodiscard]] int set() const { return set_; }
  // Null if no corner lies there.
  [[nodiscard]] const TexturePoint* find(std::uint32_t place) const;

 private:
  int set_;
  std::vector<std::pair<std::uint32_t, TexturePoint>> at_;  // ascending places
};

[[nodiscard]] inline TexturePoint between(const TexturePoint& a, const TexturePoint& b, double share) {
  return {a.u + (b.u - a.u) * share, a.v + (b.v - a.v) * share};
}

// For the face added last, with these rings. `at` gives a corner's from the FaceTexture of the scene's face.
template <class At>
void copy_texture(const Scene& scene, FaceId face, const std::vector<std::vector<std::uint32_t>>& rings,
                  SceneBuilder& builder, const At& at) {
  for (int set = 0; set < kTextureSets; ++set) {
    const std::span<const TexturePoint> same = scene.texture(face, set);
    if (same.empty()) continue;
    std::vector<TexturePoint> points(same.begin(), same.end());
    if (rings != scene.face(face).rings) {
      const FaceTexture texture(scene, face, set);
      points.clear();
      for (const auto& ring : rings) {
        for (const std::uint32_t corner : ring) points.push_back(at(texture, corner));
      }
    }
    builder.state_texture(set, std::move(points));
  }
}
// The corners are vertices of the scene, at corners of its face.
void copy_texture(const Scene& scene, FaceId face, const std::vector<std::vector<std::uint32_t>>& rings,
                  SceneBuilder& builder);

// Throws std::invalid_argument for another set than 0 and 1.
[[nodiscard]] std::size_t texture_set(int set);
[[nodiscard]] std::size_t corner_count(const std::vector<std::vector<std::uint32_t>>& rings);

// --- Places ---

// Finds the vertices that lie at one position. A vertex index that identifies a position is called a place.

// For every vertex the lowest index of a vertex at its position. Computed at the first
// call; safe to call from several threads.
[[nodiscard]] std::span<const std::uint32_t> places(const Scene& scene);

}  // namespace exactff
