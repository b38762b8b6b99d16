#include "visibility/boolean_walk.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "kernel/expect.h"
#include "scene/scene.h"

namespace exactff::visibility {

// --- Convex clip ---

// Repeated clips construct corners from constructed corners: without the division the numbers would grow with each
// clip.
Direction crossing(const ExactVec3& a, const Integer& da, const ExactVec3& b, const Integer& db) {
  ExactVec3 direction = a * abs(db) + b * abs(da);
  make_primitive(direction);
  return kernel::make_direction(std::move(direction));
}

ClipResult clip(Ring& ring, const Direction& normal) {
  std::vector<int> signs(ring.size());
  std::transform(ring.begin(), ring.end(), signs.begin(), [&](const Direction& t) { return side(normal, t); });
  if (std::none_of(signs.begin(), signs.end(), [](int s) { return s > 0; })) {
    ring.clear();
    return ClipResult::kEmpty;
  }
  if (std::none_of(signs.begin(), signs.end(), [](int s) { return s < 0; })) return ClipResult::kInside;

  Ring kept;
  kept.reserve(ring.size() + 1);
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const std::size_t next = (i + 1) % ring.size();
    if (signs[i] >= 0) kept.push_back(ring[i]);
    if (signs[i] * signs[next] < 0) {
      const ExactVec3& a = ring[i].exact;
      const ExactVec3& b = ring[next].exact;
      kept.push_back(crossing(a, dot(normal.exact, a), b, dot(normal.exact, b)));
    }
  }
  ring = std::move(kept);
  return ClipResult::kCut;
}

namespace {

// Drops corners that lie on the line through their neighbours. Requires positive area.
void drop_collinear_corners(Ring& ring) {
  Ring kept;
  kept.reserve(ring.size());
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Direction& before = kept.empty() ? ring.back() : kept.back();
    if (orientation(before, ring[i], ring[(i + 1) % ring.size()]) != 0) kept.push_back(ring[i]);
  }
  EXACTFF_EXPECT(kept.size() >= 3);
  ring = std::move(kept);
}

}  // namespace

std::vector<Direction> side_planes(const Ring& ring) {
  std::vector<Direction> planes;
  planes.reserve(ring.size());
  for (std::size_t i = 0; i < ring.size(); ++i) {
    planes.push_back(kernel::make_direction(cross(ring[(i + 1) % ring.size()].exact, ring[i].exact)));
  }
  return planes;
}

// --- Shaft ---

namespace {

// value * 2^exponent as a double within relative error 2^-52, or NaN outside the range in which filters work.
double approximate(const Integer& value, long exponent) {
  long own = 0;
  const double mantissa = mpz_get_d_2exp(&own, value.get_mpz_t());
  constexpr long kSafeExponent = 900;
  if (mantissa == 0.0) return 0.0;
  if (std::abs(own + exponent) > kSafeExponent) return std::numeric_limits<double>::quiet_NaN();
  return std::ldexp(mantissa, static_cast<int>(own + exponent));
}

}  // namespace

Shaft::Shaft(const Scene& scene, const Vec3& x, const Ring& hull, const ExactVec3& front, const Vec3& point)
    : scene_(scene), x_(x), hull_(hull), sides_(side_planes(hull)) {
  ExactVec3 away = front;
  negate(away);
  const ScaledVec3 s = kernel::exact_difference(point, x);
  offset_.value = dot(away, s.v);
  offset_.exponent = s.exponent;
  // kernel::approx scales by 2^-(bits of the largest component).
  offset_.approx = approximate(offset_.value, offset_.exponent - bit_length(away));
  toward_ = kernel::make_direction(std::move(away));

  for (const Direction& side_plane : sides_) half_spaces_.push_back({kernel::to_vec3(side_plane.approx), 0.0});
  const Vec3 m = kernel::to_vec3(toward_.approx);
  half_spaces_.push_back({m, 0.0});
  half_spaces_.push_back({{-m.x, -m.y, -m.z}, -offset_.approx});
}

const ScaledVec3& Shaft::exact_corner(std::size_t corner) {
  std::optional<ScaledVec3>& exact = exact_corners_[corner];
  if (!exact) exact = kernel::exact_difference(scene_.vertices()[corners_[corner]], x_);
  return *exact;
}

int Shaft::side_sign(const Direction& normal, std::size_t corner) {
  const int filtered = sign_of_dot(normal.approx, approx_corners_[corner]);
  return filtered != kUncertain ? filtered : sign(dot(normal.exact, exact_corner(corner).v));
}

// M . t - h: the dot product errs by less than 8u m, the offset by a relative error of 2u, the last subtraction by u m:
// in all within certified_sign's 16u m.
int Shaft::depth_sign(std::size_t corner) {
  const Approx3& m = toward_.approx;
  const Approx3& t = approx_corners_[corner];
  const double terms[] = {m.x * t.x, m.y * t.y, m.z * t.z, -offset_.approx};
  double sum = 0.0;
  double magnitude = 0.0;
  for (const double term : terms) {
    sum += term;
    magnitude += std::abs(term);
  }
  const int filtered = kernel::certified_sign(sum, magnitude);
  if (filtered != kUncertain) return filtered;

  const ScaledVec3& exact = exact_corner(corner);
  Integer value = dot(toward_.exact, exact.v);
  Integer h = offset_.value;
  const long common = std::min(exact.exponent, offset_.exponent);
  value <<= static_cast<mp_bitcnt_t>(exact.exponent - common);
  h <<= static_cast<mp_bitcnt_t>(offset_.exponent - common);
  return kernel::compare(value, h);
}

bool Shaft::may_meet(std::span<const std::uint32_t> corners, ShaftCulling culling) {
  const std::size_t n = corners.size();
  depth_.resize(n);
  for (std::size_t c = 0; c < n; ++c) depth_[c] = depth_sign(c);
  if (std::none_of(depth_.begin(), depth_.end(), [](int s) { return s < 0; })) return false;
  if (culling == ShaftCulling::kNone) return true;

  const auto some_corner_inside = [&](const Direction& normal) {
    for (std::size_t c = 0; c < n; ++c) {
      if (side_sign(normal, c) > 0) return true;
    }
    return false;
  };
  return some_corner_inside(toward_) && std::all_of(sides_.begin(), sides_.end(), some_corner_inside);
}

// Affine, so all corners must share one scale. Corners on x's side stay; a crossing is
// (a |g_b| + b |g_a|) up to a factor, g = M . t - h.
bool Shaft::clip_to_source_plane(Ring& ring) {
  if (std::none_of(depth_.begin(), depth_.end(), [](int s) { return s > 0; })) return false;
  const std::size_t n = corners_.size();
  long common = offset_.exponent;
  for (std::size_t c = 0; c < n; ++c) common = std::min(common, exact_corner(c).exponent);
  std::vector<ScaledVec3> t(n);
  std::vector<Integer> g(n);
  const Integer h = offset_.value << static_cast<mp_bitcnt_t>(offset_.exponent - common);
  for (std::size_t c = 0; c < n; ++c) {
    t[c] = exact_corner(c);
    lower_exponent(t[c], common);
    g[c] = dot(toward_.exact, t[c].v) - h;
  }
  for (std::size_t c = 0; c < n; ++c) {
    const std::size_t next = (c + 1) % n;
    if (depth_[c] <= 0) ring.push_back(kernel::make_direction(t[c].v));
    if (depth_[c] * depth_[next] < 0) {
      ring.push_back(crossing(t[c].v, g[c], t[next].v, g[next]));
    }
  }
  return true;
}

bool Shaft::hides_all(const Ring& ring) const {
  for (std::size_t j = 0; j < ring.size(); ++j) {
    const Direction inward = kernel::make_direction(cross(ring[(j + 1) % ring.size()].exact, ring[j].exact));
    const auto inside = [&](const Direction& s) { return side(inward, s) >= 0; };
    if (!std::all_of(hull_.begin(), hull_.end(), inside)) return false;
  }
  return true;
}

Fate Shaft::test(std::uint32_t piece_index, ShaftCulling culling, Occluder& occluder, bool& was_cut) {
  const Piece& piece = scene_.pieces()[piece_index];
  corners_ = scene_.corners(piece);
  const auto vertices = scene_.vertices();
  approx_corners_.clear();
  for (const std::uint32_t corner : corners_) {
    approx_corners_.push_back(kernel::approx_difference(vertices[corner], x_));
  }
  exact_corners_.assign(corners_.size(), std::nullopt);
  // a. Nowhere near the shaft?
  if (!may_meet(corners_, culling)) return Fate::kOutside;

  // b. Seen edge-on? And the orientation as x sees it.
  const auto relative = [&](int f) { return kernel::exact_difference(vertices[piece.frame[f]], x_).v; };
  const int facing = sign(dot(cross(relative(0), relative(1)), relative(2)));
  if (facing == 0) return Fate::kOutside;

  // c. Clip by the source's plane.
  Ring& ring = occluder.ring;
  ring.clear();
  occluder.face = piece.face;
  was_cut = clip_to_source_plane(ring);
  if (!was_cut) {
    for (std::size_t c = 0; c < corners_.size(); ++c) ring.push_back(kernel::make_direction(exact_corner(c).v));
  }
  if (facing > 0) std::reverse(ring.begin(), ring.end());
  // d. Does it hide all?
  if (hides_all(ring)) {
    ring = hull_;
    return Fate::kHidesAll;
  }

  // e. Clip by the side planes.
  for (const Direction& side_plane : sides_) {
    const ClipResult result = clip(ring, side_plane);
    if (result == ClipResult::kEmpty) return Fate::kOutside;
    was_cut = was_cut || result == ClipResult::kCut;
  }
  return Fate::kInShaft;
}

// --- Boolean walk ---

namespace {

// Takes one plane through the steps, stopping as soon as nothing is left.
class BooleanWalk {
 public:
  BooleanWalk(const View& view, const SourcePlane& plane, const BoundaryRequest& request)
      : view_(view), plane_(plane), request_(request) {
    result_.record.engine = Engine::kBoolean;
  }

  // Steps 1 to 5 alone.
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
  // 4. Find candidates. 5. Stop if one hides all.
  make_hull();
  if (!gather_occluders()) return Outcome::kHiddenByOne;
  if (request_.list_cutters) list_cutters();
  result_.record.source_joined = clipped_.size() > 1;
  // 7. The boundary: of the source, if there are no candidates;
  if (occluders_.empty() && plane_.covers.empty()) {
    trace_source();
    return Outcome::kUnoccluded;
  }
  // else project and subtract,
  std::vector<Polygon2> shadows;
  for (const Occluder& occluder : occluders_) shadows.push_back(frame().to_polygon(occluder.ring));
  for (const std::uint32_t cover : plane_.covers) {
    Ring ring = ring_of(view_, cover);
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
  for (const std::uint32_t index : plane_.pieces) source_.push_back(ring_of(view_, index));
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
