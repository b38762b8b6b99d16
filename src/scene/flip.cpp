#include <algorithm>
#include <memory>
#include <utility>

#include "scene/scene_data.h"

namespace exactff {

namespace {

void flip(Face& face) {
  for (std::vector<std::uint32_t>& ring : face.rings) std::reverse(ring.begin(), ring.end());
  face.newell = {0.0 - face.newell.x, 0.0 - face.newell.y, 0.0 - face.newell.z};  // never -0
}

void flip(Piece& piece, std::vector<std::uint32_t>& corners) {
  const auto first = corners.begin() + piece.first_corner;
  std::reverse(first, first + piece.corner_count);
  std::swap(piece.frame[1], piece.frame[2]);
}

}  // namespace

Scene Scene::with_flipped(const Selection& selection) const {
  auto copy = std::make_unique<Data>();
  copy->file = data_->file;
  copy->vertices = data_->vertices;
  copy->materials = data_->materials;
  copy->patches = data_->patches;
  copy->patch_by_name = data_->patch_by_name;
  copy->faces = data_->faces;
  copy->pieces = data_->pieces;
  copy->corners = data_->corners;
  copy->warnings = data_->warnings;
  for (const FaceId id : faces_of(selection)) {
    Face& face = copy->faces[index_of(id)];
    flip(face);
    for (std::uint32_t p = 0; p < face.piece_count; ++p) flip(copy->pieces[face.first_piece + p], copy->corners);
  }
  return Scene(std::move(copy));
}

}  // namespace exactff
