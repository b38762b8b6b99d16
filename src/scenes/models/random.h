// Random numbers that are the same on every machine: SplitMix64 (Steele, Lea and Flood 2014). Nothing from <random> is
// used, because its distributions differ between libraries.
#pragma once

#include <cstddef>
#include <cstdint>

#include "kernel/expect.h"

namespace exactff::models {

class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t bits() {
    state_ += 0x9e3779b97f4a7c15u;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }

  // A multiple of 2^-53 in [0, 1).
  double unit() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
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
