#include "view_factors/seen_parts.h"

#include <algorithm>

#include "visibility/seen_pieces.h"

namespace exactff::view_factors {
namespace {

constexpr std::size_t kFewQuestions = 4;  // of a part: more cost as much as its list

}  // namespace

SeenParts::SeenParts(const ExactScene& scene) : scene_(scene), walls_(visibility::walls_of(scene.scene)) {}

const SeenParts::Lists& SeenParts::OfPatch::lists(const SeenParts& scene, std::span<const Part> parts) const {
  std::call_once(state_->once, [&] {
    Lists lists;
    for (const Part& part : parts) lists.push_back(scene.seen_from(part));
    state_->lists = std::move(lists);
  });
  return state_->lists;
}

bool SeenParts::OfPatch::sees(const SeenParts& scene, std::span<const Part> parts, std::size_t i,
                              const Part& other) const {
  const Face& face = scene.scene_.scene.face(other.face);
  if (state_->questions++ < kFewQuestions * parts.size()) {
    return visibility::sees_any_of(scene.scene_.scene, scene.walls_, scene.region_of(parts[i]), face.first_piece,
                                   face.piece_count);
  }
  const std::vector<std::uint32_t>& seen = lists(scene, parts)[i].seen;
  const auto first = std::ranges::lower_bound(seen, face.first_piece);
  return first != seen.end() && *first < face.first_piece + face.piece_count;
}

// Corners of a part may be rounded; those of its face are not.
exactff::Box SeenParts::region_of(const Part& part) const {
  const Scene& scene = scene_.scene;
  const std::vector<std::uint32_t>& ring = scene.face(part.face).rings.front();
  exactff::Box box{scene.vertices()[ring.front()], scene.vertices()[ring.front()]};
  for (const std::uint32_t corner : ring) box.include(scene.vertices()[corner]);
  return box;
}

SeenPieces SeenParts::seen_from(const Part& part) const {
  const Scene& scene = scene_.scene;
  SeenPieces result{visibility::pieces_seen_from(scene, walls_, region_of(part)), {}};
  std::ranges::sort(result.seen);
  std::vector<bool> occludes(scene.pieces().size());
  for (const std::uint32_t piece : result.seen) {
    occludes[piece] = true;
    const std::uint32_t surface = scene_.pieces[piece].surface;
    if (surface == kNoSurface) continue;
    for (const std::uint32_t other : scene_.surfaces[surface].pieces) occludes[other] = true;
  }
  for (std::uint32_t piece = 0; piece < occludes.size(); ++piece) {
    if (occludes[piece]) result.occluders.push_back(piece);
  }
  return result;
}

}  // namespace exactff::view_factors
