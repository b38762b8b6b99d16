// Which point of which face a texel shows.
//
// Notation: the triangle a, b, c of the texture is scaled by twice the size of the picture, so that the centre p of the
// texel in column i and row j is (2 i + 1, 2 height - 2 j - 1), in integers.
//
//   1. For each triangle, faces in order, and each texel whose centre may lie in its box: p lies in the triangle if no
//      side has it on its outer side, by the signs of det(side, p - its beginning).
//   2. Its point is A + s (B - A) + t (C - A) with s = det(p - a, c - a) / d, t = det(b - a, p - a) / d,
//      d = det(b - a, c - a), for the corners A, B, C of the face. If p lies on the boundary, s and t are first moved
//      towards those of the centre, 1/3, by kInwards of the way: on an edge, roundings would decide on which side of a
//      neighbour the point lies.
//
// Every sign is decided by a filter in doubles, or else by rationals. The point is computed in double-double arithmetic
// with an error bound, and by rationals where that does not determine the double.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "exactff/render.h"
#include "kernel/double_double.h"
#include "kernel/float_environment.h"
#include "kernel/numbers.h"
#include "kernel/vec.h"
#include "render/job.h"
#include "scene/scene.h"
#include "scene/triangulation.h"
#include "text/escape.h"
#include "text/hashes.h"
#include "text/phrases.h"
#include "text/refuse.h"

namespace exactff::render {
namespace {

using kernel::Rational;
using kernel::double_double::Bounded;

constexpr double kInwards = 0x1p-30;
constexpr std::uint32_t kNoTriangle = std::numeric_limits<std::uint32_t>::max();

struct Centre {
  int x = 0, y = 0;
};

Centre centre_of(const Size& size, int column, int row) { return {2 * column + 1, 2 * size.height - 2 * row - 1}; }

template <class Number>
Number det(const Number& ax, const Number& ay, const Number& bx, const Number& by) {
  return ax * by - ay * bx;
}

// The triangle in units of half a texel, as rationals.
struct ExactTriangle {
  std::array<Rational, 3> x, y;

  ExactTriangle(const std::array<TexturePoint, 3>& at, const Size& size) {
    for (std::size_t k = 0; k < 3; ++k) {
      x[k] = kernel::to_rational(at[k].u) * (2 * size.width);
      y[k] = kernel::to_rational(at[k].v) * (2 * size.height);
    }
  }
  // Twice the area of the triangle from corner `from` to corner `to` to p.
  [[nodiscard]] Rational area(std::size_t from, std::size_t to, const Rational& px, const Rational& py) const {
    return det<Rational>(x[to] - x[from], y[to] - y[from], px - x[from], py - y[from]);
  }
  [[nodiscard]] Rational area() const { return area(0, 1, x[2], y[2]); }
};

// Where a centre lies in a triangle.
class TriangleTest {
 public:
  TriangleTest(const std::array<TexturePoint, 3>& at, const Size& size) : at_(at), size_(size) {
    for (std::size_t k = 0; k < 3; ++k) {
      x_[k] = 2.0 * size.width * at[k].u;
      y_[k] = 2.0 * size.height * at[k].v;
    }
    turn_ = sign_of(0, 1, x_[2], y_[2], [](const ExactTriangle& t) { return t.area(); });
  }

  // 1 if it runs counter-clockwise, -1 clockwise, 0 if it has no area.
  [[nodiscard]] int turn() const { return turn_; }
  // 1 strictly inside, 0 on the boundary, -1 outside.
  [[nodiscard]] int place_of(const Centre& p) const {
    int place = 1;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t next = (k + 1) % 3;
      const int side = sign_of(k, next, p.x, p.y, [&](const ExactTriangle& t) { return t.area(k, next, p.x, p.y); });
      if (side * turn_ < 0) return -1;
      if (side == 0) place = 0;
    }
    return place;
  }
  // The first and last whole number n so that 2 n + 1 may lie between the corners' coordinates.
  [[nodiscard]] static std::array<int, 2> range(const std::array<double, 3>& corners, int count) {
    const auto [low, high] = std::ranges::minmax(corners);
    const auto whole = [count](double n) { return static_cast<int>(std::clamp(n, -1.0, count + 0.0)); };
    return {std::max(0, whole(std::floor(0.5 * low) - 1.0)), std::min(count - 1, whole(std::ceil(0.5 * high) + 1.0))};
  }
  [[nodiscard]] std::array<int, 2> columns() const { return range(x_, size_.width); }
  [[nodiscard]] std::array<int, 2> rows_upwards() const { return range(y_, size_.height); }

 private:
  // Let m be the largest magnitude of all coordinates, at least 1. With u = 2^-53, a coordinate is off by u m, a
  // difference (at most 2 m) by 4.1 u m, a product of two by 20.6 u m^2, and their difference, at most 8 m^2, by
  // 50 u m^2. 64 u m^2 = 2^-47 m^2 is used.
  template <class Exact>
  [[nodiscard]] int sign_of(std::size_t from, std::size_t to, double px, double py, const Exact& exact) const {
    const double value = det(x_[to] - x_[from], y_[to] - y_[from], px - x_[from], py - y_[from]);
    double m = std::max({1.0, std::abs(px), std::abs(py)});
    for (const std::size_t k : {from, to}) m = std::max({m, std::abs(x_[k]), std::abs(y_[k])});
    if (std::abs(value) > 0x1p-47 * m * m) return value > 0.0 ? 1 : -1;
    return kernel::sign(exact(ExactTriangle(at_, size_)));
  }

  const std::array<TexturePoint, 3>& at_;
  Size size_;
  std::array<double, 3> x_{}, y_{};
  int turn_ = 0;
};

void require_possible(const Lightmap& lightmap) {
  const Size& size = lightmap.size;
  if (std::min(size.width, size.height) < 1 || std::max(size.width, size.height) > kLongestSide) {
    text::refuse("a lightmap has " + std::to_string(size.width) + " x " + std::to_string(size.height) + " texels",
                 "each side has from 1 to " + std::to_string(kLongestSide), "give a size such as 512x512");
  }
  if (lightmap.margin < 0 || lightmap.margin > kLongestSide) {
    text::refuse("a lightmap has a margin of " + std::to_string(lightmap.margin) + " texels",
                 "it is from 0 to " + std::to_string(kLongestSide), "give a number such as 4");
  }
  constexpr double kMostTexels = 1e9;
  if (static_cast<double>(size.width) * size.height > kMostTexels) {
    text::refuse("a lightmap has " + text::rounded(static_cast<double>(size.width) * size.height) + " texels",
                 "it is kept in memory, and at most 1e9 are", "make it smaller");
  }
}

std::vector<FaceId> faces_of(const Scene& scene, const std::vector<Selection>& on) {
  std::vector<bool> wanted(scene.faces().size(), on.empty());
  for (const Selection& selection : on) {
    for (const FaceId face : scene.faces_of(selection)) wanted[index_of(face)] = true;
  }
  std::vector<FaceId> faces;
  for (std::size_t f = 0; f < wanted.size(); ++f) {
    if (wanted[f] && scene.faces()[f].piece_count > 0) faces.push_back(static_cast<FaceId>(f));
  }
  return faces;
}

}  // namespace

Atlas::Atlas(const Scene& scene, const Lightmap& lightmap) : scene_(&scene), lightmap_(lightmap) {
  const kernel::StandardArithmetic arithmetic;
  require_possible(lightmap);
  const std::size_t texels = pixels_of(lightmap.size);
  shown_.assign(texels, kNoTriangle);
  for (const FaceId face : faces_of(scene, lightmap.on)) take(face);
  if (charts_.faces == 0) {
    text::refuse("no face has texture coordinates of set " + std::to_string(lightmap.set),
                 "they say where a face lies in a lightmap",
                 "unwrap the scene in the program that made it, and export OBJ with vt");
  }
  std::vector<bool> inside(texels), overlaps(texels);
  for (std::uint32_t first = 0, next = 0; first < triangles_.size(); first = next) {
    const std::uint64_t before = charts_.texels;
    bool flat = true, outside = false;
    for (; next < triangles_.size() && triangles_[next].face == triangles_[first].face; ++next) {
      flat = !fill(next, inside, overlaps) && flat;
      for (const TexturePoint& p : triangles_[next].at)
        outside = outside || !(std::min(p.u, p.v) >= 0.0 && std::max(p.u, p.v) <= 1.0);
    }
    if (flat) ++charts_.flat;
    if (outside) ++charts_.outside;
    if (!flat && !outside && charts_.texels == before) ++charts_.missed;
  }
}

void Atlas::take(FaceId face) {
  if (scene_->texture(face, lightmap_.set).empty()) {
    ++charts_.without;
    return;
  }
  ++charts_.faces;
  const FaceTexture texture(*scene_, face, lightmap_.set);
  for (const Piece& piece : scene_->pieces_of(face)) {
    for (const std::vector<std::uint32_t>& corners : triangles_of(*scene_, piece)) {
      Triangle triangle{.face = face};
      for (std::size_t k = 0; k < 3; ++k) {
        triangle.vertices[k] = corners[k];
        triangle.at[k] = *texture.find(places(*scene_)[corners[k]]);
      }
      triangles_.push_back(triangle);
    }
  }
}

// Whether it has area in the texture.
bool Atlas::fill(std::uint32_t index, std::vector<bool>& inside, std::vector<bool>& overlaps) {
  const TriangleTest test(triangles_[index].at, lightmap_.size);
  if (test.turn() == 0) return false;
  const auto [left, right] = test.columns();
  const auto [lowest, highest] = test.rows_upwards();
  for (int row = lightmap_.size.height - 1 - highest; row <= lightmap_.size.height - 1 - lowest; ++row) {
    for (int column = left; column <= right; ++column) {
      const int place = test.place_of(centre_of(lightmap_.size, column, row));
      if (place < 0) continue;
      const std::size_t texel = pixel_at(lightmap_.size, column, row);
      if (shown_[texel] == kNoTriangle) {
        shown_[texel] = index;
        ++charts_.texels;
      }
      if (place == 0) continue;
      if (inside[texel] && !overlaps[texel]) {
        overlaps[texel] = true;
        ++charts_.overlapping;
        if (!charts_.first_overlap) charts_.first_overlap = {triangles_[shown_[texel]].face, triangles_[index].face};
      }
      inside[texel] = true;
    }
  }
  return true;
}

// --- Points ---

namespace {

Bounded exact_bounded_of(double x) { return {x, 0.0, 0.0}; }

Bounded difference_of(double a, double b) {
  const auto exact = kernel::double_double::two_sum(a, -b);
  return {exact.hi, exact.lo, 0.0};
}

// The shares s and t, in double-double arithmetic and, where needed, exactly.
class Shares {
 public:
  Shares(const std::array<TexturePoint, 3>& at, const Size& size, const Centre& p)
      : at_(at), size_(size), p_(p), inwards_(TriangleTest(at, size).place_of(p) == 0 ? kInwards : 0.0) {
    std::array<Bounded, 3> x, y;
    for (std::size_t k = 0; k < 3; ++k) {
      x[k] = 2.0 * size.width * exact_bounded_of(at[k].u);
      y[k] = 2.0 * size.height * exact_bounded_of(at[k].v);
    }
    const Bounded px = exact_bounded_of(p.x) - x[0], py = exact_bounded_of(p.y) - y[0];
    const Bounded bx = x[1] - x[0], by = y[1] - y[0], cx = x[2] - x[0], cy = y[2] - y[0];
    const Bounded d = sum_of_products(bx, cy, -by, cx);
    const Bounded third = inwards_ * (exact_bounded_of(1.0) / exact_bounded_of(3.0));
    s_ = (1.0 - inwards_) * (sum_of_products(px, cy, -py, cx) / d) + third;
    t_ = (1.0 - inwards_) * (sum_of_products(bx, py, -by, px) / d) + third;
  }

  // a + s (b - a) + t (c - a), rounded once.
  [[nodiscard]] double between(double a, double b, double c) {
    if (a == b && a == c) return a;
    const Bounded fine = sum_of_products(s_, difference_of(b, a), t_, difference_of(c, a)) + exact_bounded_of(a);
    if (const auto quick = kernel::double_double::nearest(fine)) return *quick;
    if (!exact_) {
      const ExactTriangle triangle(at_, size_);
      const Rational d = triangle.area(), inwards = kernel::to_rational(inwards_);
      const auto moved = [&](const Rational& share) -> Rational { return (1 - inwards) * share / d + inwards / 3; };
      exact_.emplace(
          std::array<Rational, 2>{moved(triangle.area(2, 0, p_.x, p_.y)), moved(triangle.area(0, 1, p_.x, p_.y))});
    }
    const Rational from = kernel::to_rational(a);
    return kernel::nearest_double(Rational(from + (*exact_)[0] * (kernel::to_rational(b) - from) +
                                           (*exact_)[1] * (kernel::to_rational(c) - from)));
  }

 private:
  const std::array<TexturePoint, 3>& at_;
  Size size_;
  Centre p_;
  double inwards_;
  Bounded s_, t_;
  std::optional<std::array<Rational, 2>> exact_;
};

}  // namespace

std::optional<Hit> Atlas::hit(int column, int row) const {
  const kernel::StandardArithmetic arithmetic;
  const Size& size = lightmap_.size;
  if (column < 0 || row < 0 || column >= size.width || row >= size.height) return std::nullopt;
  const std::uint32_t index = shown_[pixel_at(size, column, row)];
  if (index == kNoTriangle) return std::nullopt;
  const Triangle& triangle = triangles_[index];
  Shares shares(triangle.at, size, centre_of(size, column, row));
  const auto corner = [&](std::size_t k) -> const Vec3& { return scene_->vertices()[triangle.vertices[k]]; };
  const Vec3 &a = corner(0), &b = corner(1), &c = corner(2);
  return Hit{triangle.face,
             false,
             {shares.between(a.x, b.x, c.x), shares.between(a.y, b.y, c.y), shares.between(a.z, b.z, c.z)}};
}

// --- In words ---

std::string words_of(const Scene& scene, const Lightmap& map) {
  std::string words = std::to_string(map.size.width) + 'x' + std::to_string(map.size.height) +
                      " texels of texture coordinates " + std::to_string(map.set) + ", v = 1 above the first row";
  for (std::size_t s = 0; s < map.on.size(); ++s)
    words += (s == 0 ? ", on " : " + ") + text::printable(scene.name_of(map.on[s]));
  if (map.margin > 0) words += ", margin " + std::to_string(map.margin);
  text::Fnv1a hash;
  for (const FaceId face : faces_of(scene, map.on)) {
    const std::span<const TexturePoint> points = scene.texture(face, map.set);
    hash.add(std::uint64_t{points.size()});
    for (const TexturePoint& p : points) {
      hash.add(p.u);
      hash.add(p.v);
    }
  }
  return words + ", hash " + hash.digits();
}

}  // namespace exactff::render
