// A contour in double-double beside the same contour in balls over exact integers, and random contours, for the tests
// of contour/quick_contour.h and its parts.
#pragma once

#include "contour/contour.h"
#include "contour/quick_contour.h"
#include "kernel/bounded_vectors.h"
#include "support/test.h"

namespace exactff::contour {

using kernel::double_double::kInflation;

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr long kBits = 600;

// An end of an edge, or the point where the plane through x and the corners c, d meets it.
struct End {
  enum class Kind { kA, kB, kCrossing } kind = Kind::kA;
  std::uint32_t c = 0;
  std::uint32_t d = 0;
};
inline constexpr End kA{End::Kind::kA};
inline constexpr End kB{End::Kind::kB};

inline End crossing(std::uint32_t c, std::uint32_t d) { return {End::Kind::kCrossing, c, d}; }

// Of the edge between the corners a and b.
struct Part {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  End begin, end;
};

// --- A contour in both arithmetics ---

// The corners are vertices seen from x, or directions given by integers.
struct Both {
  Vec3 normal{0, 0, 1};
  Vec3 x;
  std::vector<QuickCorner> corners;
  std::vector<kernel::ExactVec3> exact;
  std::vector<Part> pieces;

  std::uint32_t add(const Vec3& vertex, int scale_exponent = 0) {
    corners.push_back(quick_corner(vertex, x, scale_exponent));
    exact.push_back(kernel::exact_difference(vertex, x).v);
    return static_cast<std::uint32_t>(corners.size() - 1);
  }
  std::uint32_t add(const kernel::ExactVec3& direction) {
    corners.push_back(quick_corner(direction));
    exact.push_back(direction);
    return static_cast<std::uint32_t>(corners.size() - 1);
  }
  void close_loop() {
    const auto count = static_cast<std::uint32_t>(corners.size());
    for (std::uint32_t i = 0; i < count; ++i) pieces.push_back({i, (i + 1) % count, kA, kB});
  }

  // The lines are computed again for every piece. At most `batch` pieces are added at a time.
  [[nodiscard]] QuickContour::Value quick(std::size_t batch = 1000) const {
    QuickContour contour(normal);
    std::vector<QuickEdge> edges;
    std::vector<QuickPiece> quick_pieces;
    const auto number = [&](std::uint32_t a, std::uint32_t b) {
      edges.push_back({a, b});
      return static_cast<std::uint32_t>(edges.size() - 1);
    };
    const auto number_of_end = [&](const End& end) {
      if (end.kind == End::Kind::kCrossing) return number(end.c, end.d);
      return end.kind == End::Kind::kA ? QuickPiece::kAtA : QuickPiece::kAtB;
    };
    for (const auto& [a, b, begin, end] : pieces) {
      quick_pieces.push_back({number(a, b), number_of_end(begin), number_of_end(end)});
    }
    std::vector<QuickLine> lines(edges.size());
    contour.make_lines(corners, edges, lines);
    for (std::size_t i = 0; i < quick_pieces.size(); i += batch) {
      contour.add(std::span(quick_pieces).subspan(i, std::min(batch, quick_pieces.size() - i)), lines);
    }
    return contour.value();
  }

  [[nodiscard]] visibility::EdgeParameter parameter(const Part& piece, const End& end) const {
    if (end.kind == End::Kind::kA) return {1, 0};
    if (end.kind == End::Kind::kB) return {0, 1};
    const kernel::ExactVec3 plane = cross(exact[end.c], exact[end.d]);
    return {abs(dot(plane, exact[piece.b])), abs(dot(plane, exact[piece.a]))};
  }
  [[nodiscard]] Enclosure ball() const {
    ContourIntegral contour(kernel::exact_vector(normal).v);
    for (const Part& piece : pieces) {
      contour.add({exact[piece.a], exact[piece.b], parameter(piece, piece.begin), parameter(piece, piece.end)});
    }
    return EnclosureInside::of(contour.evaluate(kBits));
  }
};

inline Enclosure enclosure_of(const QuickContour::Value& value) {
  Ball ball;
  Ball part;
  arb_set_d(ball.get(), value.hi);
  arb_set_d(part.get(), value.lo);
  arb_add(ball.get(), ball.get(), part.get(), ARF_PREC_EXACT);
  arb_set_d(part.get(), value.error);
  arb_add_error(ball.get(), part.get());
  return EnclosureInside::of(ball);
}

inline bool answers(const QuickContour::Value& value) { return std::isfinite(value.error); }

inline double relative_error(const QuickContour::Value& value) { return value.error / std::abs(value.hi); }

// --- Random corners and loops ---

inline Vec3 random_vector(generate::Random& random, double size) {
  return {random.between(-size, size), random.between(-size, size), random.between(-size, size)};
}

// A triangle of about this size, near a point above x.
inline Both triangle(generate::Random& random, double size) {
  Both both;
  both.x = random_vector(random, 1);
  both.normal = {random.between(-0.3, 0.3), random.between(-0.3, 0.3), 1};
  const Vec3 middle{random.between(-2, 2), random.between(-2, 2), random.between(3, 5)};
  for (int i = 0; i < 3; ++i) {
    const Vec3 offset = random_vector(random, size);
    both.add(Vec3{middle.x + offset.x, middle.y + offset.y, middle.z + offset.z});
  }
  return both;
}

// The part of the triangle between its first corner and the cutter's line c d: a loop with pieces of all kinds. c and d
// lie on either side, at a random depth between x and the triangle.
inline Both cut_triangle(generate::Random& random, double size) {
  Both both = triangle(random, size);
  const std::array<QuickCorner, 3> corners = {both.corners[0], both.corners[1], both.corners[2]};
  const double t = random.between(0.2, 0.8);
  const double u = random.between(0.2, 0.8);
  const double depth = random.between(0.3, 1);
  // The point with these barycentric coordinates, seen from x at this depth.
  const auto point = [&](double k0, double k1, double k2) {
    const auto along = [&](int i) {
      return depth * (k0 * corners[0].hi[i] + k1 * corners[1].hi[i] + k2 * corners[2].hi[i]);
    };
    return Vec3{both.x.x + along(0), both.x.y + along(1), both.x.z + along(2)};
  };
  // Through the points t and u along the two sides, extended by half at either end.
  const std::uint32_t c = both.add(point(1 - 1.5 * t + 0.5 * u, 1.5 * t, -0.5 * u));
  const std::uint32_t d = both.add(point(1 - 1.5 * u + 0.5 * t, -0.5 * t, 1.5 * u));
  both.pieces = {{0, 1, kA, crossing(c, d)}, {c, d, crossing(0, 1), crossing(2, 0)}, {2, 0, crossing(c, d), kB}};
  if (random.one_in(2)) std::swap(both.pieces[1].a, both.pieces[1].b);
  return both;
}

inline kernel::Integer random_integer(generate::Random& random, int bits) {
  kernel::Integer result;
  for (int done = 0; done < bits; done += 16) result = (result << 16) + static_cast<long>(random.below(65536));
  result >>= static_cast<mp_bitcnt_t>((bits + 15) / 16 * 16 - bits);
  return random.one_in(2) ? result : kernel::Integer(-result);
}

inline kernel::ExactVec3 random_direction(generate::Random& random, int bits) {
  return {random_integer(random, bits), random_integer(random, bits), random_integer(random, bits)};
}

// --- Truths ---

inline kernel::Rational exactly(double hi, double lo) { return kernel::to_rational(hi) + kernel::to_rational(lo); }

inline Enclosure true_angle(const kernel::Rational& sine, const kernel::Rational& cosine) {
  Ball ball = kernel::to_ball(sine, kBits);
  arb_atan2(ball.get(), ball.get(), kernel::to_ball(cosine, kBits).get(), kBits);
  return EnclosureInside::of(ball);
}

inline bool holds(const Bounded& angle, const Enclosure& truth) {
  return enclosure_of({angle.hi, angle.lo, kInflation * angle.error}).contains(truth);
}

}  // namespace exactff::contour
