#include "visibility/visible_boundary.h"

#include <algorithm>

#include "scene/scene_data.h"
#include "visibility/convex_clip.h"
#include "visibility/edge_walk.h"

namespace exactff::visibility {

using kernel::Direction;
using kernel::Rational;
using kernel::Ring;

View::View(const Scene& scene_in, const Receiver& receiver)
    : scene(scene_in), x(receiver.point), n(receiver.normal), on(receiver.on) {}

Direction View::normal() const { return kernel::make_direction(kernel::exact_vector(n).v); }

bool may_occlude(const View& view, const SourcePlane& plane, const Request& request, std::uint32_t piece) {
  const FaceId face = view.scene.pieces()[piece].face;
  if (view.on && face == *view.on) return false;
  if (std::binary_search(plane.pieces.begin(), plane.pieces.end(), piece)) return false;
  const std::vector<FaceId>* only = request.only_occluders;
  return only == nullptr || std::binary_search(only->begin(), only->end(), face);
}

// The frame's (p, q) are the projected coordinates divided by h, so areas must be multiplied by h^2 before they are
// compared.
Rational share_of_source(const View& view, const SourcePlane& plane, const PlaneFrame& frame, const Rational& doubled) {
  const kernel::ScaledVec3 s = kernel::exact_difference(plane.point, view.x);
  const Rational h = kernel::times_power_of_two(dot(plane.normal.exact, s.v), s.exponent);
  return doubled / 2 * frame.unit_area() * h * h / union_area(view.scene, plane).area;
}

namespace {

// Takes one plane through the steps, stopping as soon as nothing is left.
class Walk {
 public:
  Walk(const View& view, const SourcePlane& plane, const Request& request)
      : view_(view), plane_(plane), request_(request) {
    result_.record.engine = Engine::kBoolean;
  }

  // Steps 1 to 3 alone.
  Cutters find_cutters() {
    if (!gather_source() || side_of(plane_, view_.x) <= 0 || !clip_by_horizon()) return {};
    make_hull();
    if (gather_occluders()) list_cutters();
    return std::move(result_.cutters);
  }

  PlaneVisibility run() {
    result_.record.outcome = find_outcome();
    if (request_.fraction) result_.fraction = fraction();
    if (request_.keep_geometry) keep_geometry();
    return std::move(result_);
  }

 private:
  Outcome find_outcome();
  bool gather_source();
  bool clip_by_horizon();
  void make_hull();
  bool gather_occluders();
  void trace_source();
  void trace_loops();
  void list_cutters();
  [[nodiscard]] Rational fraction();
  void keep_geometry();
  const PlaneFrame& frame();

  const View& view_;
  const SourcePlane& plane_;
  const Request& request_;
  PlaneVisibility result_;

  std::vector<Ring> source_;   // convex pieces, whole
  std::vector<Ring> clipped_;  // above the horizon
  Ring hull_;                  // of clipped_
  std::vector<Occluder> occluders_;
  std::optional<PlaneFrame> frame_;
  std::vector<RegionLoop> loops_;
  bool whole_ = false;  // the visible region is the whole unclipped source
};

Outcome Walk::find_outcome() {
  // 1. Cull.
  if (!gather_source()) return Outcome::kReceiverFace;
  if (side_of(plane_, view_.x) <= 0) return Outcome::kBehind;
  // 2. Clip by the receiver's horizon.
  if (!clip_by_horizon()) return Outcome::kBelowHorizon;
  // 3. and 5. Candidates in the shaft.
  make_hull();
  if (!gather_occluders()) return Outcome::kHiddenByOne;
  if (request_.list_cutters) list_cutters();
  // 4. No candidates.
  if (occluders_.empty()) {
    trace_source();
    return Outcome::kUnoccluded;
  }
  // 6. Project and subtract.
  std::vector<Polygon2> source;
  std::vector<Polygon2> shadows;
  for (const Ring& ring : clipped_) source.push_back(frame().to_polygon(ring));
  for (const Occluder& occluder : occluders_) shadows.push_back(frame().to_polygon(occluder.ring));
  loops_ = difference(source, shadows);
  // 7. Boundary loops of the visible region.
  trace_loops();
  return loops_.empty() ? Outcome::kHiddenByUnion : Outcome::kPartlyHidden;
}

// The pieces as x sees them, without the face that the receiver lies on. False if none is left.
bool Walk::gather_source() {
  const auto vertices = view_.scene.vertices();
  for (const std::uint32_t index : plane_.pieces) {
    const Piece& piece = view_.scene.pieces()[index];
    if (view_.on && piece.face == *view_.on) continue;
    Ring ring;
    for (const std::uint32_t corner : view_.scene.corners(piece)) {
      ring.push_back(kernel::make_direction(kernel::exact_difference(vertices[corner], view_.x).v));
    }
    source_.push_back(std::move(ring));
  }
  return !source_.empty();
}

bool Walk::clip_by_horizon() {
  const Direction normal = view_.normal();
  for (const Ring& ring : source_) {
    Ring above = ring;
    const ClipResult clipped = clip(above, normal);
    if (clipped != ClipResult::kInside) result_.record.horizon_clipped = true;
    if (clipped != ClipResult::kEmpty) clipped_.push_back(std::move(above));
  }
  return !clipped_.empty();
}

const PlaneFrame& Walk::frame() {
  if (!frame_) frame_.emplace(plane_.normal.exact, clipped_);
  return *frame_;
}

void Walk::make_hull() {
  if (clipped_.size() == 1) {
    hull_ = clipped_.front();
  } else {
    std::vector<Polygon2> polygons;
    for (const Ring& ring : clipped_) polygons.push_back(frame().to_polygon(ring));
    for (const Point2& corner : convex_hull(polygons)) {
      hull_.push_back(kernel::make_direction(frame().to_direction(corner)));
    }
    if (!frame().keeps_orientation()) std::reverse(hull_.begin(), hull_.end());
  }
  drop_collinear_corners(hull_);
}

// False if one occluder hides all; the other occluders are then not needed.
bool Walk::gather_occluders() {
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
void Walk::trace_source() {
  whole_ = !result_.record.horizon_clipped && source_.size() == plane_.pieces.size();
  if (clipped_.size() == 1) {
    for (std::size_t i = 0; i < hull_.size(); ++i) {
      result_.boundary.push_back({hull_[i].exact, hull_[(i + 1) % hull_.size()].exact});
    }
    result_.record.loops = 1;
    result_.record.edges = hull_.size();
    return;
  }
  result_.record.source_joined = true;
  std::vector<Polygon2> polygons;
  for (const Ring& ring : clipped_) polygons.push_back(frame().to_polygon(ring));
  loops_ = join(polygons);
  trace_loops();
}

void Walk::trace_loops() {
  for (const RegionLoop& loop : loops_) {
    std::vector<kernel::ExactVec3> corners;
    for (const Point2& corner : loop.corners) corners.push_back(frame().to_direction(corner));
    if (!frame().keeps_orientation()) std::reverse(corners.begin(), corners.end());
    for (std::size_t i = 0; i < corners.size(); ++i) {
      result_.boundary.push_back({corners[i], corners[(i + 1) % corners.size()]});
    }
    result_.record.edges += corners.size();
  }
  result_.record.loops = loops_.size();
  result_.record.source_joined = clipped_.size() > 1;
}

// A candidate's shadow meets the interior of the hull; a source of several pieces may have a gap there.
void Walk::list_cutters() {
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

Rational Walk::fraction() {
  if (whole_) return 1;
  if (result_.boundary.empty()) return 0;
  const Rational doubled = loops_.empty() ? doubled_area(frame().to_polygon(hull_)) : doubled_area(loops_);
  return share_of_source(view_, plane_, frame(), doubled);
}

void Walk::keep_geometry() {
  PlaneGeometry& geometry = result_.geometry;
  geometry.source = std::move(source_);
  if (clipped_.empty()) return;
  if (loops_.empty() && result_.record.outcome == Outcome::kUnoccluded) {
    loops_ = {{frame().to_polygon(hull_), false}};
  }
  frame();
  geometry.clipped = std::move(clipped_);
  geometry.occluders = std::move(occluders_);
  geometry.frame = std::move(frame_);
  geometry.visible = std::move(loops_);
}

}  // namespace

PlaneVisibility find_visible_boundary(const View& view, const SourcePlane& plane, const Request& request) {
  const bool by_edges = request.engine != Engine::kBoolean && !request.keep_geometry;
  std::optional<PlaneVisibility> found = by_edges ? find_by_edges(view, plane, request) : std::nullopt;
  if (!found) return Walk(view, plane, request).run();
  if (request.list_cutters) found->cutters = Walk(view, plane, request).find_cutters();
  return std::move(*found);
}

}  // namespace exactff::visibility
