// Things that stand apart without order: each in a cell of its own.
#pragma once

namespace exactff::models {

// Of the smallest square grid that has so many cells.
inline int columns_for(int count) {
  int columns = 1;
  while (columns * columns < count) ++columns;
  return columns;
}

}  // namespace exactff::models
