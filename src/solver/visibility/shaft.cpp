#include "visibility/shaft.h"

#include <algorithm>
#include <limits>

#include "visibility/convex_clip.h"

namespace exactff::visibility {

using kernel::Approx3;
using kernel::Direction;
using kernel::ExactVec3;
using kernel::Integer;
using kernel::kUncertain;
using kernel::Ring;
using kernel::ScaledVec3;
using kernel::sign;

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
  return cmp(value, h) < 0 ? -1 : cmp(value, h) > 0 ? 1 : 0;
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

}  // namespace exactff::visibility
