// Random numbers that are the same on every machine. Nothing from <random> is used, because its distributions differ
// between libraries.
#pragma once

#include <cstddef>
#include <cstdint>

#include "kernel/expect.h"
#include "kernel/split_mix.h"

namespace exactff::models {

class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t bits() { return kernel::mixed(state_ += kernel::kGoldenGamma); }

  // A multiple of 2^-53 in [0, 1).
  double unit() { return kernel::unit_fraction(bits()); }
  double between(double low, double high) { return low + (high - low) * unit(); }
  // 0 .. count - 1; requires count > 0. The bias is below count * 2^-64.
  std::size_t below(std::size_t count) {
    EXACTFF_EXPECT(count > 0);
    return static_cast<std::size_t>(bits() % count);
  }
  // Both ends included.
  int integer(int low, int high) { return low + static_cast<int>(below(static_cast<std::size_t>(high - low) + 1)); }
  bool one_in(std::size_t count) { return below(count) == 0; }

 private:
  std::uint64_t state_;
};

}  // namespace exactff::models
