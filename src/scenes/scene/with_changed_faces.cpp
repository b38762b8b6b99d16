// Copies of a scene in which some faces are turned round or transparent.
#include <algorithm>
#include <iterator>
#include <memory>
#include <set>
#include <utility>

#include "kernel/float_environment.h"
#include "scene/glass.h"
#include "scene/scene_data.h"
#include "scene/selections.h"

namespace exactff {

namespace {

void flip(Face& face) {
  for (std::vector<std::uint32_t>& ring : face.rings) std::reverse(ring.begin(), ring.end());
  face.newell = {0.0 - face.newell.x, 0.0 - face.newell.y, 0.0 - face.newell.z};  // never -0
  face.flipped = !face.flipped;
  if (face.file_normals != FileNormals::kNone) {
    face.file_normals = face.file_normals == FileNormals::kAgree ? FileNormals::kContradict : FileNormals::kAgree;
  }
}

void flip(Piece& piece, std::vector<std::uint32_t>& corners) {
  const auto first = corners.begin() + piece.first_corner;
  std::reverse(first, first + piece.corner_count);
  std::swap(piece.frame[1], piece.frame[2]);
}

std::unique_ptr<SceneInside::Data> copy_of(const SceneInside::Data& data) {
  auto copy = std::make_unique<SceneInside::Data>();
  copy->file = data.file;
  copy->files = data.files;
  copy->vertices = data.vertices;
  copy->materials = data.materials;
  copy->patches = data.patches;
  copy->patch_by_name = data.patch_by_name;
  copy->faces = data.faces;
  copy->pieces = data.pieces;
  copy->corners = data.corners;
  copy->warnings = data.warnings;
  copy->warnings_of_glass = data.warnings_of_glass;
  return copy;
}

std::set<FaceId> all_faces_of(const Scene& scene, std::span<const Selection> selections) {
  std::set<FaceId> all;
  for (const Selection& selection : selections) {
    const std::vector<FaceId> faces = scene.faces_of(selection);
    all.insert(faces.begin(), faces.end());
  }
  return all;
}

}  // namespace

Scene Scene::with_flipped(std::span<const Selection> selections) const {
  const kernel::StandardArithmetic arithmetic;
  auto copy = copy_of(data());
  for (const FaceId id : all_faces_of(*this, selections)) {
    Face& face = copy->faces[index_of(id)];
    flip(face);
    for (std::uint32_t p = 0; p < face.piece_count; ++p) flip(copy->pieces[face.first_piece + p], copy->corners);
  }
  return Scene(std::move(copy));
}

Scene Scene::with_transparent(std::span<const Selection> selections) const {
  auto copy = copy_of(data());
  for (const FaceId id : all_faces_of(*this, selections)) {
    Face& face = copy->faces[index_of(id)];
    face.transparent = true;
    for (std::uint32_t p = 0; p < face.piece_count; ++p) copy->pieces[face.first_piece + p].transparent = true;
  }
  Scene changed(std::move(copy));
  changed.set_warnings_of_glass();
  return changed;
}

void Scene::set_warnings_of_glass() {
  std::vector<Problem>& warnings = data_->warnings;
  warnings.erase(warnings.begin(), warnings.begin() + static_cast<std::ptrdiff_t>(data_->warnings_of_glass));
  std::vector<Problem> glass = warnings_of_opaque_glass(*this);
  data_->warnings_of_glass = glass.size();
  warnings.insert(warnings.begin(), std::move_iterator(glass.begin()), std::move_iterator(glass.end()));
}

namespace {

template <class Changed>
std::vector<Selection> changed_faces(const Scene& scene, const Changed& changed) {
  std::vector<FaceId> faces;
  for (std::size_t i = 0; i < scene.faces().size(); ++i) {
    if (changed(scene.faces()[i])) faces.push_back(static_cast<FaceId>(i));
  }
  return selections_of(scene, faces);
}

}  // namespace

std::vector<Selection> Scene::flipped() const {
  return changed_faces(*this, [](const Face& face) { return face.flipped; });
}

std::vector<Selection> Scene::transparent() const {
  return changed_faces(*this, [](const Face& face) { return face.transparent; });
}

}  // namespace exactff
