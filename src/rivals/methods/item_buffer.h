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

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "adaptive/vec.h"
#include "methods/hemicube_pixels.h"

namespace exactff::methods {

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
