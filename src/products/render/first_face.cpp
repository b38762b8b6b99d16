// The first face that a ray meets, decided exactly.
//
// Notation: the ray is o + t d. p, q, r is the frame of a convex piece of a face, n = (q - p) x (r - p) its normal. The
// ray meets the plane of the piece at t = N / D with N = n . (p - o) and D = n . d.
//
//   1. For each piece whose box the ray may enter, nearer boxes first:
//      a. D = 0: the ray meets it edge-on, or not at all; pass on. N and D must have the same sign, since t > 0.
//      b. t is certainly beyond the best piece so far: pass on.
//      c. A side of the piece has the line on its outer side, by the sign of det(d, c_i - o, c_i+1 - o): pass on.
//      d. Compare t with that of the best piece; of two that are equal, the one that comes first is better
//         (scene/contacts.h), as in a view (view.h).
//   2. The point is o + t d for the best piece, rounded once per coordinate.
//
// Every sign is decided by a floating-point filter with a proved bound, or else by exact integers. For t the filter
// gives an interval; where two intervals overlap, the fractions are compared exactly. The point is computed in
// double-double arithmetic with an error bound, and by rationals where that does not determine the double.
#include <array>
#include <boost/container/small_vector.hpp>
#include <cmath>
#include <limits>

#include "exactff/render.h"
#include "kernel/double_double.h"
#include "kernel/filter.h"
#include "kernel/float_environment.h"
#include "kernel/numbers.h"
#include "kernel/vec.h"
#include "receivers/own_pieces.h"
#include "scene/contacts.h"
#include "scene/shaft_tree.h"
#include "text/refuse.h"

namespace exactff::render {
namespace {

using kernel::Approx3;
using kernel::Integer;
using kernel::Rational;
using kernel::ScaledVec3;
using kernel::double_double::Bounded;

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr Vec3 kOrigin{};

// The exact number lies within `error` of `value`; infinite if the filter declines.
struct Estimate {
  double value = 0.0;
  double error = kInfinite;

  [[nodiscard]] bool sign_is_certain() const { return std::abs(value) > error; }
};

// n . v for n = e x f. Each component of e, f and v carries u = 2^-53. A component of n is wrong by at most 4u of the
// magnitude of its two products; the product with v and the sum add 4u. The total is below 9u of the sum m of all
// magnitudes, against 16u m = 2^-49 m, where m is computed to within 8u. Underflow is excluded as in kernel/filter.h.
struct ApproxNormal {
  Vec3 n, magnitude;
  bool moderate = false;

  ApproxNormal(const Approx3& e, const Approx3& f) {
    const double yz = e.y * f.z, zy = e.z * f.y, zx = e.z * f.x, xz = e.x * f.z, xy = e.x * f.y, yx = e.y * f.x;
    n = {yz - zy, zx - xz, xy - yx};
    magnitude = {std::abs(yz) + std::abs(zy), std::abs(zx) + std::abs(xz), std::abs(xy) + std::abs(yx)};
    moderate = is_moderate(e) && is_moderate(f);
  }

  [[nodiscard]] Estimate dot(const Approx3& v) const {
    const double m = magnitude.x * std::abs(v.x) + magnitude.y * std::abs(v.y) + magnitude.z * std::abs(v.z);
    const bool usable = moderate && is_moderate(v) && m >= 0x1p-700 && m <= 0x1p900;
    return {n.x * v.x + n.y * v.y + n.z * v.z, usable ? 0x1p-49 * m : kInfinite};
  }

 private:
  static bool is_moderate(const Approx3& v) { return kernel::max_norm(v) <= 0x1p300; }
};

// An interval that contains t >= 0.
struct Depth {
  double low = 0.0;
  double high = kInfinite;
};

// |N| / |D|, of which the quotient and the sums are rounded: 4u each way are enough.
Depth depth_of(const Estimate& numerator, const Estimate& denominator) {
  if (!numerator.sign_is_certain() || !denominator.sign_is_certain()) return {};
  const double a = std::abs(numerator.value), b = std::abs(denominator.value);
  constexpr double kTiny = 0x1p-1060;
  return {(a - numerator.error) / (b + denominator.error) * (1.0 - 0x1p-49) - kTiny,
          (a + numerator.error) / (b - denominator.error) * (1.0 + 0x1p-49) + kTiny};
}

// t = numerator / denominator * 2^exponent, both positive.
struct ExactDepth {
  Integer numerator, denominator;
  long exponent = 0;
};

int compare(const ExactDepth& a, const ExactDepth& b) {
  Integer left = a.numerator * b.denominator, right = b.numerator * a.denominator;
  const long shift = a.exponent - b.exponent;
  (shift >= 0 ? left : right) <<= static_cast<mp_bitcnt_t>(std::abs(shift));
  return cmp(left, right);
}

Bounded exact_bounded(const kernel::double_double::DoubleDouble& x) { return kernel::double_double::bounded(x, 0.0); }

struct FineVec3 {
  Bounded x, y, z;
};

FineVec3 fine_difference(const Vec3& a, const Vec3& b) {
  using kernel::double_double::two_sum;
  return {exact_bounded(two_sum(a.x, -b.x)), exact_bounded(two_sum(a.y, -b.y)), exact_bounded(two_sum(a.z, -b.z))};
}

FineVec3 fine_cross(const FineVec3& a, const FineVec3& b) {
  using kernel::double_double::sum_of_products;
  return {sum_of_products(a.y, b.z, -a.z, b.y), sum_of_products(a.z, b.x, -a.x, b.z),
          sum_of_products(a.x, b.y, -a.y, b.x)};
}

// One ray through a scene.
class Search {
 public:
  Search(const Scene& scene, const Ray& ray)
      : scene_(scene), o_(ray.origin), d_(ray.direction), approx_d_{d_.x, d_.y, d_.z} {}

  std::optional<Hit> run() {
    shaft_tree(scene_).along_ray(RaySlabs(o_, d_), [this](std::uint32_t piece) {
      look_at(piece);
      return best_ ? best_->depth.high : std::numeric_limits<double>::max();
    });
    if (!best_) return std::nullopt;
    const Piece& piece = scene_.pieces()[best_->piece];
    return Hit{piece.face, best_->back, point_on(piece)};
  }

 private:
  struct Best {
    std::uint32_t piece = 0;
    bool back = false;
    Depth depth;
  };

  void look_at(std::uint32_t index) {
    const Piece& piece = scene_.pieces()[index];
    if (piece.transparent) return;
    const Vec3 &p = corner(piece.frame[0]), &q = corner(piece.frame[1]), &r = corner(piece.frame[2]);
    const ApproxNormal normal(kernel::approx_difference(q, p), kernel::approx_difference(r, p));
    const Estimate denominator = normal.dot(approx_d_);
    const Estimate numerator = normal.dot(kernel::approx_difference(p, o_));
    const int facing = sign_of(denominator, {p, q}, {p, r}, {kOrigin, d_});
    if (facing == 0 || sign_of(numerator, {p, q}, {p, r}, {o_, p}) != facing) return;
    const Depth depth = depth_of(numerator, denominator);
    if (best_ && depth.low > best_->depth.high) return;
    if (!is_pierced(piece, facing)) return;
    const Best found{index, facing > 0, depth};
    if (!best_ || is_better(found)) best_ = found;
  }

  [[nodiscard]] const Vec3& corner(std::uint32_t index) const { return scene_.vertices()[index]; }

  static int sign_of(const Estimate& estimate, const kernel::Arrow& a, const kernel::Arrow& b, const kernel::Arrow& c) {
    if (estimate.sign_is_certain()) return estimate.value > 0.0 ? 1 : -1;
    return kernel::exact_sign_of_det(a, b, c);
  }

  // Requires D != 0. Seen from o, the corners run counter-clockwise if D < 0, and det(d, a, b) of a side (a, b) is
  // negative where d lies on its inner side.
  [[nodiscard]] bool is_pierced(const Piece& piece, int facing) const {
    const auto corners = scene_.corners(piece);
    const Vec3* last = &corner(corners.back());
    Approx3 to_last = kernel::approx_difference(*last, o_);
    for (const std::uint32_t vertex : corners) {
      const Vec3& next = corner(vertex);
      const Approx3 to_next = kernel::approx_difference(next, o_);
      int side = kernel::sign_of_det(approx_d_, to_last, to_next);
      if (side == kernel::kUncertain) side = kernel::exact_sign_of_det({kOrigin, d_}, {o_, *last}, {o_, next});
      if (side == -facing) return false;
      last = &next;
      to_last = to_next;
    }
    return true;
  }

  [[nodiscard]] bool is_better(const Best& other) const {
    if (other.depth.high < best_->depth.low) return true;
    if (other.depth.low > best_->depth.high) return false;
    const int order = compare(exact_depth(other.piece), exact_depth(best_->piece));
    if (order != 0) return order < 0;
    return contacts(scene_).comes_first({other.piece, !other.back}, {best_->piece, !best_->back});
  }

  [[nodiscard]] ExactDepth exact_depth(std::uint32_t index) const {
    const Piece& piece = scene_.pieces()[index];
    const Vec3& p = corner(piece.frame[0]);
    const ScaledVec3 e = kernel::exact_difference(corner(piece.frame[1]), p),
                     f = kernel::exact_difference(corner(piece.frame[2]), p), to_p = kernel::exact_difference(p, o_),
                     d = kernel::exact_vector(d_);
    const kernel::ExactVec3 n = kernel::cross(e.v, f.v);
    return {abs(kernel::dot(n, to_p.v)), abs(kernel::dot(n, d.v)), to_p.exponent - d.exponent};
  }

  [[nodiscard]] Vec3 point_on(const Piece& piece) const {
    const Vec3 &p = corner(piece.frame[0]), &q = corner(piece.frame[1]), &r = corner(piece.frame[2]);
    const Bounded t = fine_depth(piece);
    std::optional<Rational> exact_t;
    std::array<double, 3> point{};
    for (int axis = 0; axis < 3; ++axis) {
      const double at = kernel::coordinate(p, axis), from = kernel::coordinate(o_, axis),
                   slope = kernel::coordinate(d_, axis);
      if (at == kernel::coordinate(q, axis) &&
          at == kernel::coordinate(r, axis)) {  // the plane is perpendicular to this axis
        point[axis] = at;
        continue;
      }
      if (const auto quick = kernel::double_double::nearest(exact_bounded({from, 0.0}) + slope * t)) {
        point[axis] = *quick;
        continue;
      }
      if (!exact_t) {
        const ExactDepth depth = exact_depth(best_->piece);
        Rational quotient(depth.numerator, depth.denominator);
        quotient.canonicalize();
        exact_t = kernel::times_power_of_two(std::move(quotient), depth.exponent);
      }
      point[axis] = kernel::nearest_double(kernel::to_rational(from) + *exact_t * kernel::to_rational(slope));
    }
    return {point[0], point[1], point[2]};
  }

  // t in double-double arithmetic. A number beyond the range makes the error infinite or NaN.
  [[nodiscard]] Bounded fine_depth(const Piece& piece) const {
    const Vec3& p = corner(piece.frame[0]);
    const FineVec3 n =
        fine_cross(fine_difference(corner(piece.frame[1]), p), fine_difference(corner(piece.frame[2]), p));
    const FineVec3 to_p = fine_difference(p, o_);
    const Bounded numerator = sum_of_products(n.x, to_p.x, n.y, to_p.y) + n.z * to_p.z;
    const Bounded denominator = (d_.x * n.x + d_.y * n.y) + d_.z * n.z;
    return numerator / denominator;
  }

  const Scene& scene_;
  const Vec3 o_, d_;
  const Approx3 approx_d_;
  std::optional<Best> best_;
};

}  // namespace

std::optional<Hit> first_hit(const Scene& scene, const Ray& ray) {
  const kernel::StandardArithmetic arithmetic;
  for (const Vec3& v : {ray.origin, ray.direction}) {
    if (kernel::is_finite(v)) continue;
    text::refuse("the ray's origin or direction is not finite", "a ray needs a point and a direction",
                 "give three finite numbers for each");
  }
  if (ray.direction == Vec3{}) {
    text::refuse("the ray's direction is (0, 0, 0)", "it points nowhere", "give a direction of any length but zero");
  }
  return Search(scene, ray).run();
}

Receiver receiver_at(const Scene& scene, const Hit& hit) {
  const kernel::StandardArithmetic arithmetic;
  return receiver_on(scene, hit.face, own_faces(scene, hit.face, hit.point, tolerance_of_computed_points(scene)),
                     hit.point, hit.back ? Looks::kToBack : Looks::kToFront);
}

}  // namespace exactff::render
