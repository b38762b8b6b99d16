#include "view_factors/seen_parts.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "visibility/seen_pieces.h"

namespace exactff::view_factors {
namespace {

constexpr std::size_t kFewQuestions = 4;  // of a part: more cost as much as its list

// Of the part's face, or sheet, ascending.
std::vector<std::uint32_t> pieces_of(const Scene& scene, const Part& part) {
  if (const Panels& all = panels(scene); all.is_joined(part.panel)) {
    return all.sheet_of(part.panel).pieces;
  }
  const Face& face = scene.face(part.face);
  std::vector<std::uint32_t> pieces(face.piece_count);
  std::iota(pieces.begin(), pieces.end(), face.first_piece);
  return pieces;
}

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
  const std::vector<std::uint32_t> pieces = pieces_of(scene.scene_.scene, other);
  if (state_->questions++ < kFewQuestions * parts.size()) {
    return visibility::sees_any_of(scene.scene_.scene, scene.walls_, scene.region_of(parts[i]), pieces);
  }
  const std::vector<std::uint32_t>& seen = lists(scene, parts)[i].seen;
  return std::ranges::any_of(pieces, [&](std::uint32_t piece) { return std::ranges::binary_search(seen, piece); });
}

const std::vector<Windings>& SeenParts::OfPatch::windings(const SeenParts& scene, std::span<const Part> parts) const {
  std::call_once(state_->windings_once, [&] {
    std::vector<Windings> windings;
    for (const Part& part : parts) windings.push_back(scene.enclosures().above(part));
    state_->windings = std::move(windings);
  });
  return state_->windings;
}

const Enclosures& SeenParts::enclosures() const {
  std::call_once(enclosures_once_, [&] { enclosures_.emplace(scene_); });
  return *enclosures_;
}

// Corners of a part may be rounded; those of its face, or of its joined panel, are not.
exactff::Box SeenParts::region_of(const Part& part) const {
  const Scene& scene = scene_.scene;
  const Panels& panels = exactff::panels(scene);
  const std::span<const std::uint32_t> ring =
      panels.is_joined(part.panel) ? panels.corners(part.panel) : scene.face(part.face).rings.front();
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
