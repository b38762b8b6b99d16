// Radiosities, and statistics of the errors of a study. All sums run in the given order, so that the bits are the same
// everywhere.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "exactff/receiver.h"
#include "exactff/scene.h"
#include "exactff/study.h"

namespace exactff::study {

// Radiosities and errors near the largest double overflow. An infinity times 0 is 0 here, as its true value times 0
// would be, and a sum that has become infinite stays so: neither is NaN, unless a value was.
[[nodiscard]] inline double product(double a, double b) {
  return (std::isinf(a) && b == 0.0) || (a == 0.0 && std::isinf(b)) ? 0.0 : a * b;
}
[[nodiscard]] inline Rgb times(const Rgb& a, const Rgb& b) {
  return {product(a.r, b.r), product(a.g, b.g), product(a.b, b.b)};
}
[[nodiscard]] inline Rgb times(const Rgb& a, double s) { return times(a, Rgb{s, s, s}); }
inline void add(Rgb& sum, const Rgb& term) {
  const auto add_to = [](double& total, double x) { total = std::isinf(total) && std::isinf(x) ? total : total + x; };
  add_to(sum.r, term.r);
  add_to(sum.g, term.g);
  add_to(sum.b, term.b);
}

// The component of largest magnitude, with its sign.
[[nodiscard]] inline double largest_in_magnitude(const Rgb& c) {
  const auto smaller = [](double a, double b) { return std::abs(a) < std::abs(b); };
  return std::max({c.r, c.g, c.b}, smaller);
}

// The largest rho_r B_s over the channels: the radiosity that a form factor of 1 would give the receiver.
[[nodiscard]] inline double largest_rho_b(const Scene& scene, const Receiver& receiver, const Rgb& source_radiosity) {
  return times(scene.receiver_reflectance(receiver.on), source_radiosity).largest();
}

// All zero for an empty list. NaN and infinite values are counted and otherwise left out.
[[nodiscard]] ErrorStatistics error_statistics(std::span<const double> errors);

// Sets the error statistics of the cell from its errors.
void summarise(MethodCell& cell, const Study& study);
// Fits error = c * work^exponent over the rungs, for each seed separately.
[[nodiscard]] LadderSlopes slopes_of(const Study& study, std::size_t ladder);

[[nodiscard]] Summary summarise(const std::vector<SampleRow>& rows, const Study& study, double eps_b);
// The radiosity of the brightest receiver, largest channel.
[[nodiscard]] double largest_radiosity(const Study& study);

}  // namespace exactff::study
