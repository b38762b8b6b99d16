// Each area is r sqrt(q) with r rational and q = |normal|^2. For one plane the ratio is rational. For several planes,
// balls of increasing precision decide unless the ratio is the midpoint of two doubles, which is rational. Square roots
// of integers are linearly independent over the rationals if no product of two of them is a square (Besicovitch 1940).
// So the ratio is rational only if it is the same for every class of commensurable planes. That is tested exactly,
// because balls would never decide a midpoint.
#include "exact/fraction.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "exactff/enclosure.h"
#include "kernel/ball.h"
#include "kernel/expect.h"

namespace exactff::exact {

using kernel::Integer;
using kernel::Rational;

namespace {

struct Area {
  Rational coefficient;  // r
  Integer radicand;      // q
};

Area area_of(const PlaneShare& plane) {
  return {plane.projected_area / abs(plane.normal[plane.axis]), dot(plane.normal, plane.normal)};
}

Ball ratio_at(std::span<const PlaneShare> planes, long bits) {
  using kernel::to_ball;
  Ball visible(bits), whole(bits);
  for (const PlaneShare& plane : planes) {
    const auto [coefficient, radicand] = area_of(plane);
    const Ball area = sqrt(to_ball(radicand, bits)) * to_ball(coefficient, bits);
    whole = whole + area;
    visible = visible + area * to_ball(plane.fraction, bits);
  }
  return visible / whole;
}

struct CommensurableClass {
  Integer radicand;
  Rational visible;
  Rational whole;
};

void add_to_classes(std::vector<CommensurableClass>& classes, const PlaneShare& plane) {
  const Area area = area_of(plane);
  for (CommensurableClass& one : classes) {
    const Integer product = area.radicand * one.radicand;
    if (!mpz_perfect_square_p(product.get_mpz_t())) continue;
    // sqrt(q) = sqrt(q q') / q' sqrt(q')
    const Rational coefficient = area.coefficient * Rational(sqrt(product)) / one.radicand;
    one.visible += coefficient * plane.fraction;
    one.whole += coefficient;
    return;
  }
  classes.push_back({area.radicand, area.coefficient * plane.fraction, area.coefficient});
}

// The ratio if it is rational, else empty.
std::optional<Rational> rational_ratio(std::span<const PlaneShare> planes) {
  std::vector<CommensurableClass> classes;
  for (const PlaneShare& plane : planes) add_to_classes(classes, plane);
  const Rational ratio = classes.front().visible / classes.front().whole;
  const bool same = std::all_of(classes.begin(), classes.end(),
                                [&](const CommensurableClass& one) { return one.visible == ratio * one.whole; });
  return same ? std::optional(ratio) : std::nullopt;
}

}  // namespace

double visible_fraction(std::span<const PlaneShare> planes) {
  EXACTFF_EXPECT(!planes.empty());
  const Rational& first = planes.front().fraction;
  const auto equals_first = [&](const PlaneShare& plane) { return plane.fraction == first; };
  if (std::all_of(planes.begin(), planes.end(), equals_first)) return kernel::nearest_double(first);

  constexpr long kFirstBits = 128;
  constexpr long kBitsBeforeTheExactTest = 512;
  for (long bits = kFirstBits;; bits *= 2) {
    if (const std::optional<double> nearest = EnclosureInside::of(ratio_at(planes, bits)).nearest()) return *nearest;
    if (bits != kBitsBeforeTheExactTest) continue;
    if (const std::optional<Rational> ratio = rational_ratio(planes)) return kernel::nearest_double(*ratio);
  }
}

}  // namespace exactff::exact
