#include "visibility/boolean_walk.h"

#include <algorithm>

#include "scene/scene_data.h"
#include "visibility/convex_clip.h"

namespace exactff::visibility {

using kernel::Direction;
using kernel::ExactVec3;
using kernel::Rational;
using kernel::Ring;

namespace {

// Takes one plane through the steps, stopping as soon as nothing is left.
class BooleanWalk {
 public:
  BooleanWalk(const View& view, const SourcePlane& plane, const BoundaryRequest& request)
      : view_(view), plane_(plane), request_(request) {
    result_.record.engine = Engine::kBoolean;
  }

  // Steps 1 to 4 alone.
  Cutters find_cutters() {
    if (view_.is_buried || view_.is_own(plane_.pieces.front()) || side_of(plane_, view_.x) <= 0) return {};
    gather_source();
    if (!clip_by_horizon()) return {};
    make_hull();
    if (gather_occluders()) list_cutters();
    return std::move(result_.cutters);
  }

  PlaneGeometry find_geometry();

  PlaneVisibility run() {
    result_.record.outcome = find_outcome();
    PlaneRecord& record = result_.record;
    record.edges = pieces_.size();
    if (record.outcome == Outcome::kHiddenByOne) record.cover = 1;
    if (record.outcome == Outcome::kHiddenByUnion) record.cover = record.candidates;
    if (request_.fraction) result_.fraction = fraction();
    result_.boundary = VisibleBoundary(std::move(pieces_));
    return std::move(result_);
  }

 private:
  Outcome find_outcome();
  void gather_source();
  [[nodiscard]] Ring ring_of(std::uint32_t piece) const;
  bool clip_by_horizon();
  void make_hull();
  bool gather_occluders();
  void trace_source();
  void trace_loops();
  void trace(const std::vector<ExactVec3>& loop);
  void list_cutters();
  [[nodiscard]] Rational fraction();
  [[nodiscard]] std::vector<Polygon2> clipped_polygons();
  const PlaneFrame& frame();

  const View& view_;
  const SourcePlane& plane_;
  const BoundaryRequest& request_;
  PlaneVisibility result_;

  std::vector<Ring> source_;   // convex pieces, whole
  std::vector<Ring> clipped_;  // above the horizon
  Ring hull_;                  // of clipped_
  std::vector<Occluder> occluders_;
  std::optional<PlaneFrame> frame_;
  std::vector<RegionLoop> loops_;
  std::vector<BoundaryPiece> pieces_;
  bool whole_ = false;  // the visible region is the whole unclipped source
};

Outcome BooleanWalk::find_outcome() {
  // 1. Cull.
  if (view_.is_buried) return Outcome::kBuried;
  if (view_.is_own(plane_.pieces.front())) return Outcome::kReceiverFace;
  gather_source();
  if (side_of(plane_, view_.x) <= 0) return Outcome::kBehind;
  // 2. Clip by the receiver's horizon.
  if (!clip_by_horizon()) return Outcome::kBelowHorizon;
  // 3. Find candidates. 4. Stop if one hides all.
  make_hull();
  if (!gather_occluders()) return Outcome::kHiddenByOne;
  if (request_.list_cutters) list_cutters();
  result_.record.source_joined = clipped_.size() > 1;
  // 6. The boundary: of the source, if there are no candidates;
  if (occluders_.empty() && plane_.covers.empty()) {
    trace_source();
    return Outcome::kUnoccluded;
  }
  // else project and subtract,
  std::vector<Polygon2> shadows;
  for (const Occluder& occluder : occluders_) shadows.push_back(frame().to_polygon(occluder.ring));
  for (const std::uint32_t cover : plane_.covers) {
    Ring ring = ring_of(cover);
    if (facing_of(view_, view_.scene.pieces()[cover]) > 0) std::ranges::reverse(ring);
    shadows.push_back(frame().to_polygon(ring));
  }
  loops_ = difference(clipped_polygons(), shadows);
  // and trace the loops of what is left.
  trace_loops();
  if (occluders_.empty()) return loops_.empty() ? Outcome::kBuried : Outcome::kUnoccluded;
  return loops_.empty() ? Outcome::kHiddenByUnion : Outcome::kPartlyHidden;
}

// The pieces as x sees them.
void BooleanWalk::gather_source() {
  for (const std::uint32_t index : plane_.pieces) source_.push_back(ring_of(index));
}

// As x sees the front of the piece.
Ring BooleanWalk::ring_of(std::uint32_t piece) const {
  Ring ring;
  for (const std::uint32_t corner : view_.scene.corners(view_.scene.pieces()[piece])) {
    ring.push_back(kernel::make_direction(kernel::exact_difference(view_.scene.vertices()[corner], view_.x).v));
  }
  return ring;
}

bool BooleanWalk::clip_by_horizon() {
  const Direction normal = view_.normal();
  for (const Ring& ring : source_) {
    Ring above = ring;
    const ClipResult clipped = clip(above, normal);
    if (clipped != ClipResult::kInside) result_.record.horizon_clipped = true;
    if (clipped != ClipResult::kEmpty) clipped_.push_back(std::move(above));
  }
  return !clipped_.empty();
}

const PlaneFrame& BooleanWalk::frame() {
  if (!frame_) frame_.emplace(plane_.normal.exact, clipped_);
  return *frame_;
}

std::vector<Polygon2> BooleanWalk::clipped_polygons() {
  std::vector<Polygon2> polygons;
  for (const Ring& ring : clipped_) polygons.push_back(frame().to_polygon(ring));
  return polygons;
}

void BooleanWalk::make_hull() {
  if (clipped_.size() == 1) {
    hull_ = clipped_.front();
  } else {
    for (const Point2& corner : convex_hull(clipped_polygons())) {
      hull_.push_back(kernel::make_direction(frame().to_direction(corner)));
    }
    if (!frame().keeps_orientation()) std::reverse(hull_.begin(), hull_.end());
  }
  drop_collinear_corners(hull_);
}

// False if one occluder hides all; the other occluders are then not needed.
bool BooleanWalk::gather_occluders() {
  Shaft shaft(view_.scene, view_.x, hull_, plane_.normal.exact, plane_.point);
  PlaneRecord& record = result_.record;
  bool hidden = false;
  Occluder occluder;
  const HalfSpaceGroups half_spaces(shaft.half_spaces());
  for_each_candidate(view_, half_spaces, request_.culling, [&](std::uint32_t piece, bool) {
    if (!may_occlude(view_, plane_, request_, piece)) return true;
    ++record.tree_candidates;
    bool was_cut = false;
    const Fate fate = shaft.test(piece, request_.culling, occluder, was_cut);
    if (fate == Fate::kOutside) return true;
    ++record.candidates;
    if (was_cut) ++record.clipped;
    if (fate == Fate::kHidesAll) {
      hidden = true;
      result_.cutters = {occluder.face};
    }
    occluders_.push_back(std::move(occluder));
    occluder = {};
    return !hidden;
  });
  return !hidden;
}

// Without occluders a single convex piece is its own boundary.
void BooleanWalk::trace_source() {
  whole_ = !result_.record.horizon_clipped;
  if (clipped_.size() == 1) {
    std::vector<ExactVec3> corners;
    for (const Direction& corner : hull_) corners.push_back(corner.exact);
    trace(corners);
    return;
  }
  loops_ = join(clipped_polygons());
  trace_loops();
}

void BooleanWalk::trace_loops() {
  for (const RegionLoop& loop : loops_) {
    std::vector<ExactVec3> corners;
    for (const Point2& corner : loop.corners) corners.push_back(frame().to_direction(corner));
    if (!frame().keeps_orientation()) std::reverse(corners.begin(), corners.end());
    trace(corners);
  }
}

void BooleanWalk::trace(const std::vector<ExactVec3>& loop) {
  for (std::size_t i = 0; i < loop.size(); ++i) pieces_.push_back({loop[i], loop[(i + 1) % loop.size()]});
  ++result_.record.loops;
}

// A candidate's shadow meets the interior of the hull; a source of several pieces may have a gap there.
void BooleanWalk::list_cutters() {
  std::vector<std::vector<Direction>> pieces;
  if (clipped_.size() > 1) {
    for (const Ring& piece : clipped_) pieces.push_back(side_planes(piece));
  }
  const auto cuts_piece = [](const Occluder& occluder, const std::vector<Direction>& sides) {
    Ring shadow = occluder.ring;
    return std::none_of(sides.begin(), sides.end(),
                        [&](const Direction& plane) { return clip(shadow, plane) == ClipResult::kEmpty; });
  };
  Cutters& cutters = result_.cutters;
  for (const Occluder& occluder : occluders_) {
    const auto cuts = [&](const std::vector<Direction>& sides) { return cuts_piece(occluder, sides); };
    if (pieces.empty() || std::any_of(pieces.begin(), pieces.end(), cuts)) cutters.push_back(occluder.face);
  }
  std::sort(cutters.begin(), cutters.end());
  cutters.erase(std::unique(cutters.begin(), cutters.end()), cutters.end());
}

Rational BooleanWalk::fraction() {
  if (whole_) return 1;
  if (pieces_.empty()) return 0;
  const Rational doubled = loops_.empty() ? doubled_area(frame().to_polygon(hull_)) : doubled_area(loops_);
  return share_of_source(view_, plane_, frame(), doubled);
}

PlaneGeometry BooleanWalk::find_geometry() {
  const Outcome outcome = find_outcome();
  PlaneGeometry geometry;
  geometry.source = std::move(source_);
  if (clipped_.empty()) return geometry;
  if (loops_.empty() && outcome == Outcome::kUnoccluded) loops_ = {{frame().to_polygon(hull_), false}};
  frame();
  geometry.clipped = std::move(clipped_);
  geometry.occluders = std::move(occluders_);
  geometry.frame = std::move(frame_);
  geometry.visible = std::move(loops_);
  return geometry;
}

}  // namespace

PlaneVisibility find_by_booleans(const View& view, const SourcePlane& plane, const BoundaryRequest& request) {
  return BooleanWalk(view, plane, request).run();
}

Cutters find_cutters(const View& view, const SourcePlane& plane, const BoundaryRequest& request) {
  return BooleanWalk(view, plane, request).find_cutters();
}

PlaneGeometry find_geometry(const View& view, const SourcePlane& plane) {
  const BoundaryRequest request;
  return BooleanWalk(view, plane, request).find_geometry();
}

}  // namespace exactff::visibility
