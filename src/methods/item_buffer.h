// Which face of a scene each pixel of a hemicube sees: an item buffer by depth.
//
// A pixel belongs to what the ray from x through its centre meets first. A polygon with corners p_k is seen there if
//   E_k(D) = s D . (p_k x p_k+1) > 0  for every side k, D = (column, row, n) of the centre in whole numbers, s = +-1 so
// that E is positive within. Its nearness along D is N . D / d, with the plane N . p = d. No corner is projected, so
// what reaches behind x needs no care; the polygon is clipped to a face's frustum for the rows and columns to look at.
//
// Ties: a centre on a side belongs to the polygon on the one side of it that lies towards greater columns, or for a
// side that runs along the row, greater rows; two polygons that share the side form it from the same two corners, so
// that E differs by the sign alone and exactly one of them has the pixel. Of equal nearness the polygon drawn first
// stays; polygons in one plane that is parallel to two axes of the scene are equally near to the last bit, those in
// another one may differ by roundings.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "methods/hemicube_pixels.h"
#include "sampled/vec.h"

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
  std::vector<Vec3> sides_;  // s p_k x p_k+1 of the polygon at hand
  std::vector<Form> forms_;  // the same on the face at hand
  std::vector<Vec3> polygon_, clipped_;
};

}  // namespace exactff::methods
