// For objects that stand apart without a regular order: each stands in its own cell of a grid.
#pragma once

namespace exactff::models {

// The side of the smallest square grid that has at least `count` cells.
inline int columns_for(int count) {
  int columns = 1;
  while (columns * columns < count) ++columns;
  return columns;
}

}  // namespace exactff::models
