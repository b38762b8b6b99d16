#include "exact/visible_share.h"

#include <cmath>
#include <limits>

#include "exact/region.h"
#include "visibility/visible_boundary.h"

namespace exactff::exact {

using kernel::ExactVec3;
using kernel::Rational;
using visibility::BoundaryPiece;

namespace {

Point<double> rounded(const Point<Rational>& p) { return {kernel::nearest_double(p.u), kernel::nearest_double(p.v)}; }

// True if the open segment pq meets the interior of a convex polygon.
bool meets_exactly(const SmallPolygon<Rational>& polygon, const Point<Rational>& p, const Point<Rational>& q) {
  Rational from = 0, to = 1;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Point<Rational>& next = polygon.after(k);
    const Rational at_p = turn(polygon[k], next, p), at_q = turn(polygon[k], next, q);
    if (at_p <= 0 && at_q <= 0) return false;
    if (at_p < 0) from = std::max(from, Rational(at_p / (at_p - at_q)));
    if (at_q < 0) to = std::min(to, Rational(at_p / (at_p - at_q)));
  }
  return from < to;
}

}  // namespace

VisibleShare::VisibleShare(const Scene& scene, const Receiver& receiver, const visibility::SourcePlane& plane,
                           Workspace& workspace)
    : view_(scene, receiver), plane_(plane), away_(plane.normal.exact) {
  const visibility::PlaneVisibility seen =
      find_visible_boundary(view_, plane, {}, WorkspaceInside::memory(workspace).edges);
  all_ = seen.record.outcome == Outcome::kUnoccluded;
  if (all_ || seen.boundary.empty()) return;
  make_frame();
  seen.boundary.for_each_piece([this](const BoundaryPiece& piece) { add(piece); });
}

void VisibleShare::make_frame() {
  std::vector<kernel::Ring> rings;
  for (const std::uint32_t index : plane_.pieces) rings.push_back(ring_of(view_, index));
  frame_.emplace(away_, rings);
  const int k = longest_axis(away_);
  kernel::negate(away_);
  const kernel::Approx3 away = kernel::approx(away_);
  if (!std::isfinite(away.x + away.y + away.z)) return;  // the error of every window is then infinite
  away_approx_ = {away.x, away.y, away.z};
  // The double form of `away` has its own scale, and so has everything divided by it.
  const Rational scale = Rational(away_[k]) / kernel::to_rational(away_approx_[static_cast<std::size_t>(k)]);
  const auto scaled = [&](const Point<Rational>& p) { return rounded({Rational(p.u * scale), Rational(p.v * scale)}); };
  low_approx_ = scaled(frame_->low());
  size_approx_ = scaled(frame_->size());
}

void VisibleShare::add(const BoundaryPiece& piece) {
  Piece added;
  added.exact_p = frame_->to_plane(piece.from());
  added.exact_q = frame_->to_plane(piece.to());
  if (!frame_->keeps_orientation()) std::swap(added.exact_p, added.exact_q);
  added.p = rounded(added.exact_p);
  added.q = rounded(added.exact_q);
  const ExactVec3 normal = view_.normal().exact;
  added.horizon = kernel::sign(dot(normal, piece.a)) == 0 && kernel::sign(dot(normal, piece.b)) == 0;
  pieces_.push_back(std::move(added));
}

// The outlines of other pieces of the source do not run through the interior of this piece, so they bound nothing
// there.
void VisibleShare::start(std::uint32_t index) {
  if (pieces_.empty()) return;
  std::vector<Point<Rational>> ring;
  for (const std::uint32_t corner : view_.scene.corners(view_.scene.pieces()[index])) {
    ring.push_back(frame_->to_plane(kernel::exact_difference(view_.scene.vertices()[corner], view_.x).v));
  }
  for (Piece& piece : pieces_) {
    piece.outline = piece.horizon;
    for (std::size_t k = 0; k < ring.size() && !piece.outline; ++k) {
      piece.outline = on_edge(piece, ring[k], ring[k + 1 < ring.size() ? k + 1 : 0]);
    }
  }
}

// Tests whether both ends lie on the line ab. That is enough: the region's boundary lies in the source, so the piece
// then lies between a and b. Coordinates are in the unit square, each within 2^-54, so a turn is within 2^-50.
bool VisibleShare::on_edge(const Piece& piece, const Point<Rational>& a, const Point<Rational>& b) const {
  constexpr double kBound = 0x1p-50;
  const Point<double> from = rounded(a), to = rounded(b);
  for (const Point<double>& end : {piece.p, piece.q}) {
    if (std::abs(turn(from, to, end)) > kBound) return false;
  }
  return turn(a, b, piece.exact_p) == 0 && turn(a, b, piece.exact_q) == 0;
}

// With u = 2^-53: the terms of the depth have a relative error of 3u each, so the depth is wrong by less than 6u times
// the sum S of their magnitudes. The quotient p is then wrong by 6u S over the depth, relatively, and by u more; the
// box by 2u of its own numbers. 16u covers the following operations, and another 16u the division. All of this holds,
// and the depth is certainly positive, while S is below 2^48 times the depth.
Point<double> VisibleShare::flat(const Vec3& t, double& error) const {
  const std::array<double, 3> d{t.x, t.y, t.z};
  double depth = 0.0, magnitude = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    depth += away_approx_[axis] * d[axis];
    magnitude += std::abs(away_approx_[axis] * d[axis]);
  }
  const auto [i, j] = frame_->axes();
  const double p = d[static_cast<std::size_t>(i)] / depth, q = d[static_cast<std::size_t>(j)] / depth;
  const double worst = magnitude / depth;
  const auto bound = [&](double value, double low, double size) {
    return 0x1p-48 * (std::abs(value) * (worst + 1.0) + std::abs(low) + size) / size;
  };
  const double here = std::max(bound(p, low_approx_.u, size_approx_.u), bound(q, low_approx_.v, size_approx_.v));
  const bool holds = depth > 0.0 && worst < 0x1p48 && here >= 0.0;
  error = holds ? std::max(error, here) : std::numeric_limits<double>::infinity();
  return {(p - low_approx_.u) / size_approx_.u, (q - low_approx_.v) / size_approx_.v};
}

void VisibleShare::set_window(std::span<const Vec3> directions) {
  window_.corners.clear();
  window_.error = 0.0;
  for (const Vec3& direction : directions) window_.corners.push_back(flat(direction, window_.error));
  if (!frame_->keeps_orientation()) window_.corners.reverse();
}

SmallPolygon<Rational> VisibleShare::exact_window(std::span<const Vec3> directions) const {
  SmallPolygon<Rational> corners;
  for (const Vec3& direction : directions) corners.push_back(frame_->to_plane(kernel::exact_vector(direction).v));
  if (!frame_->keeps_orientation()) corners.reverse();
  return corners;
}

namespace {

struct Turn {
  double value, error;
  [[nodiscard]] bool certainly_positive() const { return value > error; }
  [[nodiscard]] bool certainly_not_positive() const { return value <= -error; }
};

// turn(a, b, p). Write |.| for the sum of the magnitudes of two coordinates. A turn of a side e and an offset f, whose
// coordinates have errors of at most E and G, is wrong by less than |e| G + |f| E + 2 E G, plus 2^-51 of the magnitudes
// of its products. The coordinates of p are wrong by at most 2^-53.
Turn turn_of(const Point<double>& a, const Point<double>& b, const Point<double>& p, double window_error) {
  const double eu = b.u - a.u, ev = b.v - a.v, fu = p.u - a.u, fv = p.v - a.v;
  const double side = std::abs(eu) + std::abs(ev), offset = std::abs(fu) + std::abs(fv);
  const double side_error = 2.0 * window_error + 0x1p-53 * side;
  const double offset_error = window_error + 0x1p-53 + 0x1p-53 * offset;
  return {eu * fv - ev * fu, 1.01 * (side * offset_error + offset * side_error + 2.0 * side_error * offset_error +
                                     0x1p-51 * (std::abs(eu * fv) + std::abs(ev * fu)))};
}

}  // namespace

// Clips the piece by the window's sides in the same way as meets_exactly.
//
// The error of a crossing. Let p and d = p - q be the height and the fall as computed, e and f their errors, c = p / d
// as computed, and u = 2^-53. The true height is within e of p; the true fall is within f + u (f + |d|) of d, since f
// and d are rounded sums. Where |d| > 4 f, the true fall has the sign of d and is larger than |d| / 1.4, so the true
// quotient is within
//   1.4 (e + |p / d| (f + u (f + |d|))) / |d|  <  1.41 (e + |c| f) / |d| + 1.5u |c|
// of p / d. The division adds u |c|; the sum and the difference of c and its error add u |c| and u of that error. In
// all, this is less than 1.42 (e + |c| f) / |d| + 4u |c|. Twice the quotient and 8u (1 + |c|) are used: the rest covers
// the five roundings in the bound itself, and quotients that underflow.
VisibleShare::Meeting VisibleShare::meets(const Piece& piece) const {
  double from_low = 0.0, from_high = 0.0, to_low = 1.0, to_high = 1.0;
  bool unsure = false;
  for (std::size_t k = 0; k < window_.corners.size(); ++k) {
    const auto height = [&](const Point<double>& end) {
      return turn_of(window_.corners[k], window_.corners.after(k), end, window_.error);
    };
    const Turn p = height(piece.p), q = height(piece.q);
    if (p.certainly_not_positive() && q.certainly_not_positive()) return Meeting::kNo;
    if (p.certainly_positive() && q.certainly_positive()) continue;
    const Turn fall{p.value - q.value, p.error + q.error};
    if (!(std::abs(fall.value) > 4.0 * fall.error)) {
      unsure = true;
      continue;
    }
    const double crossing = p.value / fall.value;
    const double error =
        2.0 * (p.error + std::abs(crossing) * fall.error) / std::abs(fall.value) + 0x1p-50 * (1.0 + std::abs(crossing));
    if (fall.value < 0.0) {
      from_low = std::max(from_low, crossing - error);
      from_high = std::max(from_high, crossing + error);
    } else {
      to_low = std::min(to_low, crossing - error);
      to_high = std::min(to_high, crossing + error);
    }
  }
  if (from_low > to_high) return Meeting::kNo;
  return !unsure && from_high < to_low ? Meeting::kYes : Meeting::kUnsure;
}

bool VisibleShare::partly(std::span<const Vec3> directions) {
  SmallPolygon<Rational> exact;
  for (const Piece& piece : pieces_) {
    if (piece.outline) continue;
    const Meeting meeting = meets(piece);
    if (meeting == Meeting::kYes) return true;
    if (meeting == Meeting::kNo) continue;
    ++undecided_;
    if (exact.size() == 0) exact = exact_window(directions);
    if (meets_exactly(exact, piece.exact_p, piece.exact_q)) return true;
  }
  return false;
}

namespace {

// Strictly between 0 and 1.
double proper_share(double share) { return std::clamp(share, std::numeric_limits<double>::min(), 1.0 - 0x1p-53); }

}  // namespace

// A bound on the change of the share when the corners of the window move by the error e of their coordinates.
//
// Let P be the sum of |du| + |dv| over the sides, W the doubled area, and s the visible share, all of the computed
// window. While the corners move straight to their true places, every point of a side moves by at most e along u and
// along v, and the side's |du| and |dv| grow by at most 2e: it sweeps an area of at most e (|du| + |dv| + 4e). Four
// sides sweep at most D = e P + 16 e^2. An area that the window gains or loses changes (visible area - s * whole area)
// by at most itself, so this difference, 0 for the computed window, is at most D for the true one, and the share
// changes by at most 2 D / (W - 2 D). With a bound of at most kAccuracy = 2^-30, and W <= P^2 / 8 as for every polygon
// in a box of half-perimeter P / 2, e is at most 2^-35 P. Then D < 1.01 e P, 2 D < 2^-30 W, and the change is less than
// 2.1 e P / W. The bound is 4 (e + u) P / W, u = 2^-53, of which almost a half is to spare.
//
// The rounding of the sum over n pieces, in of(), is not part of this bound. All coordinates are at most about 1. The
// ends of a piece are wrong by u / 2. A computed height above a line, its turn over the line's length, is wrong by 4u
// times the distance of two points, at most 6u; this moves each of three cuts, and where the triangle is so flat that
// its orientation is wrong, all of it. A constructed corner is wrong by u / 2 in each coordinate, and by 4u of the side
// along its side; the turns that are added up by 4u of their factors. With the window's diameter at most P / 2, the sum
// of all this is below 96u P for a doubled area. Adding up n areas of at most W errs by n^2 u W. So the share is wrong
// by less than n 96u P / W + n^2 u more. Since e >= 2^-48 = 32u, the first part is less than n times the bound, and
// below 2^25 pieces the whole error is less than 1/2, so that of() can tell 0 from 1.
double VisibleShare::window_blur(double doubled_area_of_window) const {
  double around = 0.0;
  const SmallPolygon<double>& corners = window_.corners;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Point<double>& next = corners.after(k);
    around += std::abs(next.u - corners[k].u) + std::abs(next.v - corners[k].v);
  }
  const double moved = 4.0 * around * (window_.error + 0x1p-53);
  return doubled_area_of_window > 0.0 ? moved / doubled_area_of_window : std::numeric_limits<double>::infinity();
}

double VisibleShare::of(std::span<const Vec3> directions) {
  EXACTFF_EXPECT(directions.size() == 3 || directions.size() == 4);
  if (all_) return 1.0;
  if (pieces_.empty()) return 0.0;
  set_window(directions);
  const double whole = doubled_area(window_.corners);
  if (!(window_blur(whole) <= kAccuracy)) {
    ++undecided_;
    return of_exactly(directions);
  }
  const bool in_part = partly(directions);
  const Point<double> c = middle_of(window_.corners);
  double visible = 0.0;
  for (const Piece& piece : pieces_) visible += wedge(window_.corners, c, piece.p, piece.q);
  const double share = visible / whole;
  return in_part ? proper_share(share) : share > 0.5 ? 1.0 : 0.0;
}

// False if rounding has turned a direction away from the plane.
bool VisibleShare::all_meet_plane(std::span<const Vec3> directions) const {
  return std::all_of(directions.begin(), directions.end(), [this](const Vec3& direction) {
    return kernel::sign(dot(away_, kernel::exact_vector(direction).v)) > 0;
  });
}

double VisibleShare::of_exactly(std::span<const Vec3> directions) {
  EXACTFF_EXPECT(directions.size() == 3 || directions.size() == 4);
  if (all_) return 1.0;
  if (pieces_.empty() || !all_meet_plane(directions)) return 0.0;
  const SmallPolygon<Rational> window = exact_window(directions);
  const Rational whole = doubled_area(window);
  if (whole <= 0) return 0.0;
  const bool in_part = std::any_of(pieces_.begin(), pieces_.end(), [&](const Piece& piece) {
    return !piece.outline && meets_exactly(window, piece.exact_p, piece.exact_q);
  });
  const Point<Rational> c = middle_of(window);
  Rational visible(0);
  for (const Piece& piece : pieces_) visible += wedge(window, c, piece.exact_p, piece.exact_q);
  const double share = kernel::nearest_double(visible / whole);
  return in_part ? proper_share(share) : share > 0.5 ? 1.0 : 0.0;
}

}  // namespace exactff::exact
