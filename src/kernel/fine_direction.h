// A direction from x in double-double form, for code that only stores it.
#pragma once

#include <array>

namespace exactff::kernel {

// Every true component is within `error` of hi + lo (0: exact).
struct FineDirection {
  std::array<double, 3> hi{};
  std::array<double, 3> lo{};
  double error = 0.0;
};

}  // namespace exactff::kernel
