// One simple scene, a plate before a square, in numbers of every size: the result hardly changes.
#include <cmath>

#include "stress/family.h"

namespace exactff::stress {

namespace {

Span scaled(const Span& span, double factor) { return {span.low * factor, span.high * factor}; }
Span moved(const Span& span, double by) { return {span.low + by, span.high + by}; }

// Scales source and plate about the receiver, each by its own factor.
Case with_factors(double s, double source_factor, double plate_factor) {
  const Span side = scaled({-1, 1}, source_factor);
  return plate_before_source(s, {{0, 0, 0},
                                 kUp,
                                 side,
                                 side,
                                 source_factor,
                                 scaled({-0.25, 0.3}, plate_factor),
                                 scaled({-0.2, 0.35}, plate_factor),
                                 0.5 * plate_factor});
}

Case tiny(double s) { return with_factors(s, 1 / s, 1 / s); }
Case huge(double s) { return with_factors(s, s, s); }
Case mixed(double s) { return with_factors(s, s, 1 / s); }

// Multiples of 1/64, translated by a power of two: every coordinate of the translated scene is exact.
Case moved_away(double s) {
  const Span side{-1, 1}, plate{-0.265625, 0.296875};
  return plate_before_source(
      s, {{s, -s, s}, kUp, moved(side, s), moved(side, -s), 1 + s, moved(plate, s), moved(plate, -s), 0.5 + s});
}

// All normals have the direction (1, 2, 3); the last of them are denormal numbers.
Case short_normal(double s) {
  const double unit = std::ldexp(1.0, -74) / s;
  const Vec3 normal{unit, 2 * unit, 3 * unit};
  return plate_before_source(s, {{0, 0, 0}, normal, {0, 1}, {0, 1}, 1, {0.15, 0.3}, {0.05, 0.2}, 0.5});
}

}  // namespace

std::vector<Family> number_families() {
  return {
      {{"tiny", "Everything tiny", "1 / size",
        "All coordinates are scaled down. Squares of lengths underflow below 10⁻¹⁵⁴; |a × b|², a fourth power, "
        "underflows below about 10⁻⁸⁰."},
       decades(300),
       tiny},
      {{"huge", "Everything huge", "size",
        "All coordinates are scaled up. Squares of lengths overflow above 10¹⁵⁴, |a × b|² above 10⁷⁷."},
       decades(300),
       huge},
      {{"mixed-scales", "Tiny and huge at once", "size of the source, and 1 / size of the occluder",
        "The source is scaled up and the plate in front of it is scaled down: up to 10³⁰⁰ and 10⁻³⁰⁰ in one scene."},
       decades(300),
       mixed},
      {{"moved-away", "Everything far from the origin", "distance from the origin",
        "The scene is moved by a power of two. Its coordinates remain exact, and F stays the same to the last bit. Eq. "
        "(4) is not affected; shadow rays hit other points."},
       octaves(46, 2),
       moved_away},
      {{"short-normal", "Denormal normal", "1 / length, over 5·10²¹",
        "The receiver's normal is not a unit vector and becomes shorter, down to denormal numbers. Its direction stays "
        "the same."},
       octaves(1000, 40),
       short_normal},
  };
}

}  // namespace exactff::stress
