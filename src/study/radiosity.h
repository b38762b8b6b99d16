// Colours of radiosity.
#pragma once

#include <algorithm>
#include <cmath>

#include "exactff/receiver.h"
#include "exactff/scene.h"

namespace exactff::study {

[[nodiscard]] inline Rgb times(const Rgb& a, const Rgb& b) { return {a.r * b.r, a.g * b.g, a.b * b.b}; }
[[nodiscard]] inline Rgb times(const Rgb& a, double s) { return {a.r * s, a.g * s, a.b * s}; }
inline void add(Rgb& sum, const Rgb& term) {
  sum.r += term.r;
  sum.g += term.g;
  sum.b += term.b;
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

}  // namespace exactff::study
