// For objects that stand apart without a regular order: each stands in its own cell of a square grid.
#pragma once

#include "models/random.h"

namespace exactff::models {

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
