// Receivers drawn at random, uniformly by area, with the same bits on every machine.
//
// The random numbers are the words of std::mt19937_64, which the C++ standard fixes; its distributions are not fixed,
// and not used.
//   1. The convex pieces of the faces are fans of triangles p, q, r. A triangle's area is half the length of
//      (q - p) x (r - p), which is irrational; its share is the whole number w = floor(that length / unit), with a unit
//      of at most 2^-129 of the longest. The error of each share is then at most 2^-129 of the sum.
//   2. A random integer below the sum of all w selects the triangle. It has as many words as needed and is drawn again
//      while it is too large.
//   3. Two words more, k and l: u = (4k + 2) / 2^66 and v = (4l + 1) / 2^66. Where u + v > 1 they become 1 - u and
//      1 - v; u + v = 1 does not occur. The point is (1 - u - v) p + u q + v r, strictly inside the triangle, rounded
//      once.
#include <algorithm>
#include <array>
#include <optional>
#include <random>

#include "exactff/error.h"
#include "exactff/receiver.h"
#include "kernel/float_environment.h"
#include "kernel/poll.h"
#include "receivers/own_pieces.h"
#include "scene/face_points.h"
#include "text/refuse.h"

namespace exactff {
namespace {

using kernel::ExactVec3;
using kernel::Integer;

struct Triangle {
  FaceId face{};
  std::array<std::uint32_t, 3> vertex{};
};

// Its corners relative to the first one, in units of 2^exponent.
FacePoints points_of(const Scene& scene, const Triangle& t) {
  return face_points(scene.vertices(), {{t.vertex[0], t.vertex[1], t.vertex[2]}});
}

std::vector<Triangle> triangles_of(const Scene& scene, std::span<const FaceId> on) {
  std::vector<Triangle> triangles;
  for (const FaceId face : on) {
    for (const Piece& piece : scene.pieces_of(face)) {
      const std::span<const std::uint32_t> v = scene.corners(piece);
      for (std::size_t i = 2; i < v.size(); ++i) triangles.push_back({face, {v[0], v[i - 1], v[i]}});
    }
  }
  return triangles;
}

// Twice the area is the square root of square * 2^exponent; the exponent is even.
struct SquaredArea {
  Integer square;
  long exponent = 0;

  // 2^top is more than the square root and at most twice as much.
  [[nodiscard]] long top() const { return (kernel::bit_length(square) + 1 + exponent) >> 1; }
};

SquaredArea squared_area(const FacePoints& triangle) {
  const ExactVec3 normal = newell(triangle, 0, 3);
  return {dot(normal, normal), 4 * triangle.exponent};
}

// floor(sqrt(a) / 2^exponent)
Integer whole_units(const SquaredArea& a, long exponent) {
  const long shift = a.exponent - 2 * exponent;
  Integer scaled = a.square;
  if (shift >= 0) {
    scaled <<= static_cast<mp_bitcnt_t>(shift);
  } else {
    scaled >>= static_cast<mp_bitcnt_t>(-shift);
  }
  return sqrt(scaled);
}

// The cumulative sums of the triangles' shares.
std::vector<Integer> cumulated_shares(const Scene& scene, const std::vector<Triangle>& triangles) {
  constexpr long kShareBits = 130;
  std::vector<SquaredArea> areas;
  areas.reserve(triangles.size());
  std::optional<long> top;
  for (const Triangle& triangle : triangles) {
    areas.push_back(squared_area(points_of(scene, triangle)));
    if (kernel::sign(areas.back().square) > 0) top = std::max(top.value_or(areas.back().top()), areas.back().top());
  }
  std::vector<Integer> sums;
  sums.reserve(triangles.size());
  Integer sum = 0;
  for (const SquaredArea& area : areas) sums.push_back(sum += whole_units(area, top.value_or(0) - kShareBits));
  return sums;
}

class RandomNumbers {
 public:
  explicit RandomNumbers(std::uint64_t seed) : engine_(seed) {}

  // `count` words, the first one most significant.
  Integer words(std::size_t count) {
    words_.resize(count);
    for (std::uint64_t& word : words_) word = engine_();
    Integer number;
    mpz_import(number.get_mpz_t(), count, 1, sizeof(std::uint64_t), 0, 0, words_.data());
    return number;
  }

  // Uniform among 0, ..., limit - 1.
  Integer below(const Integer& limit) {
    const auto bits = static_cast<std::size_t>(kernel::bit_length(limit));
    const std::size_t count = (bits + 63) / 64;
    while (true) {
      Integer number = words(count);
      number >>= 64 * count - bits;
      if (number < limit) return number;
    }
  }

 private:
  std::mt19937_64 engine_;
  std::vector<std::uint64_t> words_;
};

constexpr long kWeightBits = 66;

// Weights of the corners, in units of 2^-kWeightBits; they sum to one.
std::array<Integer, 3> random_weights(RandomNumbers& numbers) {
  const Integer whole = Integer(1) << kWeightBits;
  Integer u = 4 * numbers.words(1) + 2;
  Integer v = 4 * numbers.words(1) + 1;
  if (u + v > whole) {
    u = whole - u;
    v = whole - v;
  }
  return {whole - u - v, u, v};
}

// One coordinate of the weighted mean of the corners.
double rounded_mean(const std::array<double, 3>& corners, const std::array<Integer, 3>& weights) {
  std::array<kernel::BinaryDouble, 3> numbers;
  int exponent = kernel::BinaryDouble::kExponentOfZero;
  for (std::size_t i = 0; i < 3; ++i) {
    numbers[i] = kernel::decompose(corners[i]);
    exponent = std::min(exponent, numbers[i].exponent);
  }
  Integer sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Integer term = weights[i] * numbers[i].mantissa;
    sum += term << static_cast<mp_bitcnt_t>(numbers[i].exponent - exponent);
  }
  return kernel::sign(sum) == 0 ? 0.0 : kernel::nearest_double(sum, exponent - kWeightBits);
}

Vec3 point_in(const Scene& scene, const Triangle& triangle, RandomNumbers& numbers) {
  const std::array<Integer, 3> weights = random_weights(numbers);
  const auto corner = [&](std::size_t i) -> const Vec3& { return scene.vertices()[triangle.vertex[i]]; };
  const Vec3 &p = corner(0), &q = corner(1), &r = corner(2);
  return {rounded_mean({p.x, q.x, r.x}, weights), rounded_mean({p.y, q.y, r.y}, weights),
          rounded_mean({p.z, q.z, r.z}, weights)};
}

void check_sample_count(std::uint64_t count) {
  if (count >= 1 && count <= kMostReceivers) return;
  text::refuse(std::to_string(count) + " samples",
               "the number of receivers must be between 1 and " + std::to_string(kMostReceivers),
               count < 1 ? "give at least 1" : "use fewer samples");
}

}  // namespace

std::vector<Receiver> sample_receivers(const Scene& scene, std::span<const FaceId> on, std::uint64_t count,
                                       std::uint64_t seed) {
  const kernel::StandardArithmetic arithmetic;
  check_sample_count(count);
  const std::vector<Triangle> triangles = triangles_of(scene, on);
  const std::vector<Integer> sums = cumulated_shares(scene, triangles);
  if (sums.empty()) {
    text::refuse("no face to sample has area", "samples are distributed by area", "choose another patch");
  }
  RandomNumbers numbers(seed);
  std::vector<Receiver> receivers;
  receivers.reserve(count);
  kernel::Steps samples("receivers", count);
  for (std::uint64_t i = 1; i <= count; ++i) {
    samples.take();
    const auto chosen = std::upper_bound(sums.begin(), sums.end(), numbers.below(sums.back())) - sums.begin();
    const Triangle& triangle = triangles[static_cast<std::size_t>(chosen)];
    receivers.push_back(receiver_on(scene, triangle.face, {triangle.face}, point_in(scene, triangle, numbers)));
    receivers.back().id = std::to_string(i);
  }
  return receivers;
}

}  // namespace exactff
