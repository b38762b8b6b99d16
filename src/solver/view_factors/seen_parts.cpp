#include "view_factors/seen_parts.h"

#include <algorithm>

#include "visibility/seen_pieces.h"

namespace exactff::view_factors {

SeenParts::SeenParts(const ExactScene& scene) : scene_(scene), walls_(visibility::walls_of(scene.scene)) {}

const SeenParts::Lists& SeenParts::OfPatch::lists(const SeenParts& scene, std::span<const Part> parts) const {
  std::call_once(state_->once, [&] {
    Lists lists;
    for (const Part& part : parts) lists.push_back(scene.seen_from(part));
    state_->lists = std::move(lists);
  });
  return state_->lists;
}

// Corners of a part may be rounded; those of its face, or of its joined panel, are not.
SeenPieces SeenParts::seen_from(const Part& part) const {
  const Scene& scene = scene_.scene;
  const Panels& panels = exactff::panels(scene);
  const std::span<const std::uint32_t> ring =
      panels.is_joined(part.panel) ? panels.corners(part.panel) : scene.face(part.face).rings.front();
  exactff::Box box{scene.vertices()[ring.front()], scene.vertices()[ring.front()]};
  for (const std::uint32_t corner : ring) box.include(scene.vertices()[corner]);
  SeenPieces result{visibility::pieces_seen_from(scene, walls_, box), {}};
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

bool sees(const Scene& scene, const SeenPieces& from, const Part& part) {
  if (const Panels& all = panels(scene); all.is_joined(part.panel)) {
    const Sheet& sheet = all.sheets()[all.sheet_of_joined(part.panel)];
    return std::ranges::any_of(sheet.pieces, [&](auto piece) { return std::ranges::binary_search(from.seen, piece); });
  }
  const Face& face = scene.face(part.face);
  const auto first = std::ranges::lower_bound(from.seen, face.first_piece);
  return first != from.seen.end() && *first < face.first_piece + face.piece_count;
}

}  // namespace exactff::view_factors
