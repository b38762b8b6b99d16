#include "support/random_frames.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "generate/vectors.h"
#include "kernel/vec.h"
#include "support/transform.h"

namespace exactff::validation {

using generate::PlainFace;
using generate::PlainPatch;
using generate::PlainScene;
using generate::Random;
using generate::operator+;
using kernel::cross;

namespace {

// Columns of an affine map of space; the receiver goes to `origin`.
struct Frame {
  std::array<Vec3, 3> column{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  Vec3 origin;

  [[nodiscard]] Vec3 direction(const Vec3& v) const {
    const auto sum = [&](double Vec3::*c) { return column[0].*c * v.x + column[1].*c * v.y + column[2].*c * v.z; };
    return {sum(&Vec3::x), sum(&Vec3::y), sum(&Vec3::z)};
  }
  // The image of a plane's normal.
  [[nodiscard]] Vec3 normal(const Vec3& n) const {
    const Vec3 a = cross(column[1], column[2]);
    const Vec3 b = cross(column[2], column[0]);
    const Vec3 c = cross(column[0], column[1]);
    return Frame{{a, b, c}, {}}.direction(n);
  }
  [[nodiscard]] double determinant() const {
    const Vec3 c = cross(column[0], column[1]);
    return c.x * column[2].x + c.y * column[2].y + c.z * column[2].z;
  }
};

// Columns of integers below `size`, so that every corner is exact for sizes up to 2^44.
Frame random_frame(Random& random, double size) {
  const auto whole = [&] { return std::floor(random.between(-size, size + 1)); };
  const auto vector = [&] {
    const double x = whole();
    const double y = whole();
    return Vec3{x, y, whole()};
  };
  for (;;) {
    Frame frame;
    for (Vec3& column : frame.column) column = vector();
    frame.origin = vector();
    if (frame.determinant() != 0) return frame;
  }
}

void apply(PlainScene& scene, Frame frame) {
  if (frame.determinant() < 0) std::swap(frame.column[0], frame.column[1]);  // fronts stay fronts
  for (Vec3& vertex : scene.vertices) vertex = frame.direction(vertex) + frame.origin;
  scene.point = frame.direction(scene.point) + frame.origin;
  const Vec3 normal = frame.normal(scene.normal);
  if (!(normal == Vec3{})) scene.normal = normal;
}

Vec3 times(const Vec3& v, const Vec3& factor) { return {v.x * factor.x, v.y * factor.y, v.z * factor.z}; }

void scale_axes(PlainScene& scene, const Vec3& factor) {
  for (Vec3& vertex : scene.vertices) vertex = times(vertex, factor);
  scene.point = times(scene.point, factor);
  scene.normal = times(scene.normal, {1 / factor.x, 1 / factor.y, 1 / factor.z});
}

void scale_axes_apart(PlainScene& scene, Random& random) {
  const auto power = [&] { return std::ldexp(1.0, 100 * random.integer(-9, 9)); };
  const double x = power();
  const double y = power();
  scale_axes(scene, {x, y, power()});
}

double largest_coordinate(const PlainScene& scene) {
  double largest = 0;
  std::vector<Vec3> all = scene.vertices;
  all.push_back(scene.point);
  for (const Vec3& v : all) largest = std::max({largest, std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  return largest;
}

// Coordinates are integer multiples of the smallest subnormal number, or so large that their differences overflow a
// double; the normal is equally small, or nearly as large.
void scale_to_the_ends(PlainScene& scene, Random& random) {
  const int largest = std::ilogb(largest_coordinate(scene));
  generate::scale(scene, std::ldexp(1.0, random.one_in(2) ? -1074 : 1023 - largest));
  const double scale = std::ldexp(1.0, random.one_in(2) ? -1074 : 960);
  scene.normal = times(scene.normal, {scale, scale, scale});
}

// Nothing coincides exactly any more, but everything does nearly.
void round(PlainScene& scene, Random& random) {
  const std::array<double, 5> factors{0.1, 1.0 / 3, 0.7, 1e-7, 3e13};
  generate::scale(scene, factors[random.below(factors.size())]);
  if (random.one_in(2)) scene = nudged(scene, random);
}

}  // namespace

void move_to_a_random_frame(PlainScene& scene, Random& random) {
  switch (random.below(8)) {
    case 0:
      return;
    case 1:
      return apply(scene, random_frame(random, 2));
    case 2:
      apply(scene, random_frame(random, 3));
      return scale_axes_apart(scene, random);
    case 3:
      apply(scene, random_frame(random, 3));
      return scale_to_the_ends(scene, random);
    case 4:
    case 5:
      return apply(scene, random_frame(random, 0x1p44));
    case 6:
      apply(scene, random_frame(random, 0x1p20));
      return round(scene, random);
    default:
      return round(scene, random);
  }
}

void renumber(PlainScene& scene, Random& random) {
  std::vector<std::uint32_t> number(scene.vertices.size());
  std::iota(number.begin(), number.end(), 0u);
  shuffle(random, number);
  const std::vector<Vec3> old = scene.vertices;
  for (std::size_t i = 0; i < old.size(); ++i) scene.vertices[number[i]] = old[i];
  for (PlainPatch& patch : scene.patches) {
    for (PlainFace& face : patch.faces) {
      for (auto& ring : face.rings)
        std::ranges::transform(ring, ring.begin(), [&](auto index) { return number[index]; });
    }
  }
}

}  // namespace exactff::validation
