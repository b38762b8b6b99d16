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

// --- Square grid ---

// For objects that stand apart without a regular order: each stands in its own cell of a square grid.

// Calls add(x, y, cell) for a point in each of `count` cells of a grid over [0, side]^2, row by row. The point is at
// least `margin` of a cell away from the borders of its cell; `cell` is the side of a cell.
template <class Add>
void for_each_cell(Random& random, int count, double side, double margin, const Add& add) {
  int columns = 1;
  while (columns * columns < count) ++columns;
  const double cell = side / columns;
  for (int i = 0; i < count; ++i) {
    const double x = cell * (i % columns + random.between(margin, 1.0 - margin));
    const double y = cell * (i / columns + random.between(margin, 1.0 - margin));
    add(x, y, cell);
  }
}

}  // namespace exactff::models
