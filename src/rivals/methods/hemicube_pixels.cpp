#include "methods/hemicube_pixels.h"

#include <algorithm>
#include <array>

#include "adaptive/closed_form.h"
#include "kernel/expect.h"

namespace exactff::methods {

using namespace adaptive;

HemicubePixels::HemicubePixels(int resolution) : resolution_(resolution), form_factors_(count()) {
  EXACTFF_EXPECT(resolution >= 2 && resolution % 2 == 0);
  set_top();
  set_sides();
}

std::size_t HemicubePixels::first(int face) const {
  const auto n = static_cast<std::size_t>(resolution_);
  return face == 0 ? 0 : n * n + static_cast<std::size_t>(face - 1) * (n / 2 * n);
}

// Of each eight pixels that are equal by mirror symmetry, one is computed.
void HemicubePixels::set_top() {
  const int n = resolution_, half = n / 2;
  const auto line = [n](int i) { return static_cast<double>(2 * i - n) / n; };
  const auto set = [&](int row, int column, double f) {
    form_factors_[static_cast<std::size_t>(row) * static_cast<std::size_t>(n) + static_cast<std::size_t>(column)] = f;
  };
  for (int row = 0; row < half; ++row) {
    for (int column = 0; column <= row; ++column) {
      const double u0 = line(column), u1 = line(column + 1), v0 = line(row), v1 = line(row + 1);
      const SubPatch pixel = make_sub_patch(std::array<Vec3, 4>{{{u0, v0, 1}, {u0, v1, 1}, {u1, v1, 1}, {u1, v0, 1}}});
      const double f = unoccluded_form_factor(pixel, {0, 0, 1});
      for (const auto& [a, b] : {std::pair(row, column), std::pair(column, row)}) {
        for (const int i : {a, n - 1 - a}) {
          set(i, b, f);
          set(i, n - 1 - b, f);
        }
      }
    }
  }
}

// Of each two pixels of the first side, one is computed; the other sides are equal to the first.
void HemicubePixels::set_sides() {
  const int n = resolution_, half = n / 2;
  double* const side = form_factors_.data() + first(1);
  const auto at = [&](int row, int column) -> double& {
    return side[static_cast<std::size_t>(row) * static_cast<std::size_t>(n) + static_cast<std::size_t>(column)];
  };
  for (int row = 0; row < half; ++row) {
    const double n0 = 2.0 * row / n, n1 = 2.0 * (row + 1) / n;
    for (int column = 0; column < half; ++column) {
      const double v0 = static_cast<double>(2 * column - n) / n, v1 = static_cast<double>(2 * (column + 1) - n) / n;
      const SubPatch pixel = make_sub_patch(std::array<Vec3, 4>{{{1, v0, n0}, {1, v0, n1}, {1, v1, n1}, {1, v1, n0}}});
      at(row, column) = at(row, n - 1 - column) = unoccluded_form_factor(pixel, {0, 0, 1});
    }
  }
  const std::size_t size = first(2) - first(1);
  for (int face = 2; face < kHemicubeFaces; ++face) std::copy_n(side, size, form_factors_.data() + first(face));
}

}  // namespace exactff::methods
