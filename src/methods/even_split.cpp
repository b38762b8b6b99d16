#include "methods/even_split.h"

#include <array>

namespace exactff::methods {

using namespace sampled;

namespace {

// The point at i/m of the way from a to b; exact at the ends.
Vec3 between(const Vec3& a, const Vec3& b, int i, int m) {
  if (i == 0) return a;
  if (i == m) return b;
  return a + (b - a) * (static_cast<double>(i) / m);
}

void split_triangle(const SubPatch& s, int m, std::vector<SubPatch>& parts) {
  const Vec3 a = s.corner(0), b = s.corner(1), c = s.corner(2);
  const auto at = [&](int i, int j) {  // row j of m from ab to c, with m - j steps in it
    return j == m ? c : between(between(a, c, j, m), between(b, c, j, m), i, m - j);
  };
  for (int j = 0; j < m; ++j) {
    for (int i = 0; i < m - j; ++i) {
      parts.push_back(make_sub_patch(std::array{at(i, j), at(i + 1, j), at(i, j + 1)}));
      if (i + 1 < m - j) parts.push_back(make_sub_patch(std::array{at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)}));
    }
  }
}

void split_quadrilateral(const SubPatch& s, int m, std::vector<SubPatch>& parts) {
  const Vec3 a = s.corner(0), b = s.corner(1), c = s.corner(2), d = s.corner(3);
  const auto at = [&](int i, int j) { return between(between(a, b, i, m), between(d, c, i, m), j, m); };
  for (int j = 0; j < m; ++j) {
    for (int i = 0; i < m; ++i) {
      parts.push_back(make_sub_patch(std::array{at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)}));
    }
  }
}

}  // namespace

void split_evenly(const SubPatch& s, int m, std::vector<SubPatch>& parts) {
  parts.clear();
  if (m == 1) {
    parts.push_back(s);
  } else if (s.shape == PatchShape::kTriangle) {
    split_triangle(s, m, parts);
  } else {
    split_quadrilateral(s, m, parts);
  }
}

Vec3 centre_of(const SubPatch& s) {
  const Vec3 sum = s.corner(0) + s.corner(1) + s.corner(2);
  return s.shape == PatchShape::kTriangle ? sum * (1.0 / 3.0) : (sum + s.corner(3)) * 0.25;
}

}  // namespace exactff::methods
