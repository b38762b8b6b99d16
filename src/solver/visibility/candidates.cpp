#include "visibility/candidates.h"

#include "kernel/poll.h"

namespace exactff::visibility {

namespace {

constexpr std::uint64_t kCandidatesPerPoll = 1'024;

}  // namespace

void Candidates::start() {
  search_.outline_panels.clear();
  search_.seen.clear(panels_.end());
  backs_.start();
  too_many_ = false;
}

std::optional<PanelId> Candidates::gather(std::uint64_t most) {
  const BoundaryRequest& request = query_.request;
  start();
  outlines_.watch_for_shared_corners();
  std::optional<PanelId> alone;
  const OutlineId shafts = request.culls() ? static_cast<OutlineId>(source_count_) : 1;
  for (OutlineId source = 0; source < shafts && !alone && !too_many_; ++source) {
    shaft_.set(source);
    for_each_panel(query_, shaft_.half_spaces(), [&](PanelId panel, bool inside) {
      if (visit(panel, inside)) alone = panel;
      if (record_.tree_candidates % kCandidatesPerPoll == 0) kernel::poll();
      too_many_ = record_.candidates > most;
      return !alone && !too_many_;
    });
  }
  return alone;
}

void Candidates::add_covers() {
  for (const std::uint32_t cover : query_.plane.covers) {
    clip_.take(query_.view.scene.corners(query_.view.scene.pieces()[cover]));
    (void)clip_.add_occluder(false, facing_of(query_.view, query_.view.scene.pieces()[cover]));
    search_.outline_panels.push_back(cover);
  }
}

std::optional<PanelId> Candidates::one_that_hides_all() {
  start();
  shaft_.set(0);
  shaft_.narrow();
  std::optional<PanelId> alone;
  for_each_panel(query_, shaft_.half_spaces(), [&](PanelId panel, bool /*inside*/) {
    if (visit(panel, false)) alone = panel;
    return !alone;
  });
  return alone;
}

// True if the panel hides all. `inside`: it lies inside every half-space of the shaft, and therefore above all side
// planes.
bool Candidates::visit(PanelId panel, bool inside) {
  if (search_.seen.is_set(panel) || !may_occlude(query_.view, query_.plane, query_.request, panel)) return false;
  const auto vertices = panels_.corners(panel);
  ++record_.tree_candidates;
  // 3. Only what enters the shaft,
  if (!inside) clip_.take(vertices);
  const Sides sides = inside ? kInsideShaft : shaft_.sides();
  if (!sides.some_above_each) return false;
  search_.seen.set(panel);
  const int facing = facing_of(query_.view, panels_.piece(panel));
  if (facing == 0) return false;
  ++record_.candidates;
  const bool left_out = backs_.is_left_out(panel, facing);
  if (left_out && sides.all_above_each) return false;
  // clipped by the source's plane.
  if (sides.some_below_first) ++record_.clipped;
  if (inside) clip_.take(vertices);
  const OutlineId outline = clip_.add_occluder(sides.some_below_first, facing);
  search_.outline_panels.push_back(panel);
  if (sides.all_above_each && query_.request.culls()) {
    outlines_.set_inside_source(outline);
    return false;
  }
  outlines_.set_within_lines(outline, sides.wholly_above >> SourceShaft::kSidePlanesBeforeEdges);
  // 4. Does it hide all?
  if (search_.edges.hides_all(outline, source_count_)) return true;
  if (left_out) {
    outlines_.remove_last();
    search_.outline_panels.pop_back();
  }
  return false;
}

}  // namespace exactff::visibility
