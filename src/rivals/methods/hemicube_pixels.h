// The pixels of a hemicube and their delta form factors.
//
// Notation: x is the origin, (u, v, n) its frame. The top face is n = 1 with n x n pixels over u, v in [-1, 1]; the
// sides are u = 1, u = -1, v = 1, v = -1 with n columns over [-1, 1] and n/2 rows from the horizon up. A pixel's delta
// form factor is F(x -> pixel), by Eq. (4) and not by the integrand at its centre, so that they all sum to 1.
#pragma once

#include <cstddef>
#include <vector>

namespace exactff::methods {

inline constexpr int kHemicubeFaces = 5;

class HemicubePixels {
 public:
  // Requires an even resolution >= 2.
  explicit HemicubePixels(int resolution);

  [[nodiscard]] int resolution() const { return resolution_; }
  // Pixels are numbered face by face, row by row; face 0 is the top.
  [[nodiscard]] int rows(int face) const { return face == 0 ? resolution_ : resolution_ / 2; }
  [[nodiscard]] std::size_t first(int face) const;
  [[nodiscard]] std::size_t count() const { return first(kHemicubeFaces); }
  [[nodiscard]] const std::vector<double>& form_factors() const { return form_factors_; }

 private:
  void set_top();
  void set_sides();

  int resolution_;
  std::vector<double> form_factors_;
};

}  // namespace exactff::methods
