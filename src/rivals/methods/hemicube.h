// Finds the face of a scene that each pixel of a hemicube sees: an item buffer by depth.
//
// A pixel belongs to the polygon that the ray from x through its centre meets first. A polygon with corners p_k is seen
// there if
//   E_k(D) = s D . (p_k x p_k+1) > 0  for every side k, D = (column, row, n) of the centre in integers,
// s = +-1 so that E is positive within. Its nearness along D is N . D / d, with the plane N . p = d. No corner is
// projected, so polygons that reach behind x are no special case; the polygon is clipped to a face's frustum only to
// find the rows and columns to test.
//
// Ties: a centre on a side belongs to the polygon that lies towards greater columns from it, or, if the side runs along
// the row, towards greater rows. Two polygons that share the side compute it from the same two corners, so that E
// differs only by the sign and exactly one of them has the pixel. Of polygons with equal nearness the one drawn first
// stays. Polygons in one plane parallel to two axes of the scene have equal nearness to the last bit; in other planes
// it may differ by rounding errors.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "adaptive/sub_patch.h"

namespace exactff::methods {

// --- Hemicube pixels ---

// The pixels of a hemicube and their delta form factors.
//
// Notation: x is the origin, (u, v, n) its frame. The top face is n = 1 with n x n pixels over u, v in [-1, 1]; the
// sides are u = 1, u = -1, v = 1, v = -1 with n columns over [-1, 1] and n/2 rows from the horizon up. A pixel's delta
// form factor is F(x -> pixel), by Eq. (4) and not by the integrand at its centre, so that they all sum to 1.

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

// --- Item buffer ---

// A convex polygon in the frame (u, v, n) of x.
struct SeenItem {
  std::span<const Vec3> corners;
  bool clockwise = false;  // as x sees it
  Vec3 nearness;           // N / d: its product with p is 1 in the plane
  std::uint32_t item = 0;  // below ItemBuffer::kNothing
};

class ItemBuffer {
 public:
  static constexpr std::uint32_t kNothing = 0xffffffffU;

  void start(const HemicubePixels& pixels);
  void draw(const SeenItem& seen);
  [[nodiscard]] const std::vector<std::uint32_t>& items() const { return items_; }

 private:
  // A linear form of D = (column, row, depth) on one face.
  struct Form {
    double column, row, depth;
  };
  // Columns or rows, the last one included.
  struct Span {
    int first, last;
    [[nodiscard]] bool empty() const { return first > last; }
  };

  [[nodiscard]] bool clip_to_frustum(const SeenItem& seen, int face, Span& columns, Span& rows);
  void draw_on(int face, const SeenItem& seen, const Span& columns, const Span& rows);
  [[nodiscard]] Span inside(double row, Span columns) const;
  [[nodiscard]] double column_of(int column) const { return 2 * column + 1 - n_; }
  [[nodiscard]] double row_of(int face, int row) const { return face == 0 ? 2 * row + 1 - n_ : 2 * row + 1; }

  int n_ = 0;
  const HemicubePixels* pixels_ = nullptr;
  std::vector<std::uint32_t> items_;
  std::vector<double> nearness_;
  std::vector<Vec3> sides_;  // s p_k x p_k+1 of the current polygon
  std::vector<Form> forms_;  // the same on the current face
  std::vector<Vec3> polygon_, clipped_;
};

}  // namespace exactff::methods
