#include "visibility/candidates.h"

#include "kernel/poll.h"

namespace exactff::visibility {

namespace {

constexpr std::uint64_t kCandidatesPerPoll = 1'024;
constexpr Sides kInside{.certain = true, .some_above_each = true, .all_above_each = true};

}  // namespace

void Candidates::start() {
  search_.outline_pieces.clear();
  search_.seen.clear(query_.view.scene.pieces().size());
  backs_.start();
  too_many_ = false;
}

std::optional<FaceId> Candidates::gather(std::uint64_t most) {
  const BoundaryRequest& request = query_.request;
  start();
  outlines_.watch_for_shared_corners();
  std::optional<FaceId> alone;
  const OutlineId shafts = request.culls() ? static_cast<OutlineId>(source_count_) : 1;
  for (OutlineId source = 0; source < shafts && !alone && !too_many_; ++source) {
    shaft_.set(source);
    for_each_candidate(query_.view, shaft_.half_spaces(), request.culling, [&](std::uint32_t piece, bool inside) {
      if (visit(piece, inside)) alone = query_.view.scene.pieces()[piece].face;
      if (record_.tree_candidates % kCandidatesPerPoll == 0) kernel::poll();
      too_many_ = record_.candidates > most;
      return !alone && !too_many_;
    });
  }
  return alone;
}

std::optional<FaceId> Candidates::one_that_hides_all() {
  start();
  shaft_.set(0);
  shaft_.narrow();
  std::optional<FaceId> alone;
  for_each_candidate(query_.view, shaft_.half_spaces(), query_.request.culling,
                     [&](std::uint32_t piece, bool /*inside*/) {
                       if (visit(piece, false)) alone = query_.view.scene.pieces()[piece].face;
                       return !alone;
                     });
  return alone;
}

// True if the piece hides all. `inside`: it lies inside every half-space of the shaft, and therefore above all side
// planes.
bool Candidates::visit(std::uint32_t index, bool inside) {
  if (search_.seen.is_set(index) || !may_occlude(query_.view, query_.plane, query_.request, index)) return false;
  const Piece& piece = query_.view.scene.pieces()[index];
  const auto vertices = query_.view.scene.corners(piece);
  ++record_.tree_candidates;
  // 3. Only what enters the shaft,
  if (!inside) clip_.take(vertices);
  const Sides sides = inside ? kInside : shaft_.sides();
  if (!sides.some_above_each) return false;
  search_.seen.set(index);
  const int facing = facing_of(query_.view, piece);
  if (facing == 0) return false;
  ++record_.candidates;
  const bool left_out = backs_.is_left_out(index, facing);
  if (left_out && sides.all_above_each) return false;
  // clipped by the source's plane.
  if (sides.some_below_first) ++record_.clipped;
  if (inside) clip_.take(vertices);
  const OutlineId outline = clip_.add_occluder(sides.some_below_first, facing);
  search_.outline_pieces.push_back(index);
  if (sides.all_above_each && query_.request.culls()) {
    outlines_.set_inside_source(outline);
    return false;
  }
  outlines_.set_within_lines(outline, sides.wholly_above >> SourceShaft::kSidePlanesBeforeEdges);
  // 4. Does it hide all?
  if (search_.edges.hides_all(outline, source_count_)) return true;
  if (left_out) {
    outlines_.remove_last();
    search_.outline_pieces.pop_back();
  }
  return false;
}

}  // namespace exactff::visibility
