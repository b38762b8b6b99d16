// Eq. (4) in double-double beside Eq. (4) in balls over exact integers. EXACTFF_TEST_SCALE multiplies the number of
// random loops.
#include "contour/quick_contour.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>
#include <vector>

#include "contour/contour.h"
#include "contour/quick_angle.h"
#include "contour/quick_vector.h"
#include "exactff/enclosure.h"
#include "generate/random.h"
#include "support/random_scenes.h"

namespace exactff::contour {
namespace {

using generate::Random;
using kernel::ExactVec3;
using kernel::Integer;
using kernel::Rational;
using kernel::sign;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr long kBits = 600;

// An end of an edge, or the point where the plane through x and the corners c, d meets it.
struct End {
  enum class Kind { kA, kB, kCrossing } kind = Kind::kA;
  std::uint32_t c = 0;
  std::uint32_t d = 0;
};
constexpr End kA{End::Kind::kA};
constexpr End kB{End::Kind::kB};

End crossing(std::uint32_t c, std::uint32_t d) { return {End::Kind::kCrossing, c, d}; }

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
  std::vector<ExactVec3> exact;
  std::vector<Part> pieces;

  std::uint32_t add(const Vec3& vertex, int scale_exponent = 0) {
    corners.push_back(quick_corner(vertex, x, scale_exponent));
    exact.push_back(kernel::exact_difference(vertex, x).v);
    return static_cast<std::uint32_t>(corners.size() - 1);
  }
  std::uint32_t add(const ExactVec3& direction) {
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
    const ExactVec3 plane = cross(exact[end.c], exact[end.d]);
    return {abs(dot(plane, exact[piece.b])), abs(dot(plane, exact[piece.a]))};
  }
  [[nodiscard]] Enclosure ball() const {
    ContourIntegral contour(kernel::exact_vector(normal).v);
    for (const Part& piece : pieces) {
      contour.add({exact[piece.a], exact[piece.b], parameter(piece, piece.begin), parameter(piece, piece.end)});
    }
    return Enclosure(contour.evaluate(kBits));
  }
};

Enclosure enclosure_of(const QuickContour::Value& value) {
  Ball ball;
  Ball part;
  arb_set_d(ball.get(), value.hi);
  arb_set_d(part.get(), value.lo);
  arb_add(ball.get(), ball.get(), part.get(), ARF_PREC_EXACT);
  arb_set_d(part.get(), value.error);
  arb_add_error(ball.get(), part.get());
  return Enclosure(ball);
}

bool answers(const QuickContour::Value& value) { return std::isfinite(value.error); }

double relative_error(const QuickContour::Value& value) { return value.error / std::abs(value.hi); }

// Returns true if the double was determined.
bool expect_the_truth(const Both& both) {
  const QuickContour::Value value = both.quick();
  if (!answers(value)) return false;
  EXPECT_EQ(value.hi, value.hi + value.lo);
  const Enclosure truth = both.ball();
  EXPECT_TRUE(enclosure_of(value).contains(truth))
      << value.hi << " + " << value.lo << " +/- " << value.error << ", but " << truth.midpoint();
  const std::optional<double> found = enclosure_of(value).nearest();
  if (found) {
    EXPECT_EQ(found, truth.nearest());
  }
  return found.has_value();
}

// --- Random loops ---

Vec3 random_vector(Random& random, double size) {
  return {random.between(-size, size), random.between(-size, size), random.between(-size, size)};
}

// A triangle of about this size, near a point above x.
Both triangle(Random& random, double size) {
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
Both cut_triangle(Random& random, double size) {
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

Integer random_integer(Random& random, int bits) {
  Integer result;
  for (int done = 0; done < bits; done += 16) result = (result << 16) + static_cast<long>(random.below(65536));
  result >>= static_cast<mp_bitcnt_t>((bits + 15) / 16 * 16 - bits);
  return random.one_in(2) ? result : Integer(-result);
}

ExactVec3 random_direction(Random& random, int bits) {
  return {random_integer(random, bits), random_integer(random, bits), random_integer(random, bits)};
}

struct Count {
  std::size_t loops = 0;
  std::size_t found = 0;
};

// `make` makes a loop; every enclosure must contain the true value.
template <typename Make>
Count expect_the_truth_of(std::size_t count, std::uint64_t first_seed, Make make) {
  Count result{.loops = validation::scaled_count(count)};
  for (std::uint64_t seed = first_seed; seed < first_seed + result.loops; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(validation::seed_of(seed));
    result.found += expect_the_truth(make(random)) ? 1 : 0;
    if (::testing::Test::HasFailure()) break;
  }
  return result;
}

TEST(QuickContour, RoundsEveryTriangleOfModerateSize) {
  const Count count = expect_the_truth_of(500, 1, [](Random& random) {
    const double size = std::exp2(random.between(-8, 1));
    Both both = triangle(random, size);
    both.close_loop();
    EXPECT_LT(both.quick().error, size * 0x1p-97);
    return both;
  });
  RecordProperty("found", static_cast<int>(count.found));
  EXPECT_EQ(count.found, count.loops);
}

// Squares that face x at a slant.
TEST(QuickContour, KeepsItsBitsOfWhatIsPlainlySeen) {
  const Count count = expect_the_truth_of(200, 501, [](Random& random) {
    Both both;
    const double u = random.between(-0.5, 0.5);
    const double v = random.between(-0.5, 0.5);
    const auto corner = [&](double s, double t) { both.add(Vec3{s + 0.1, t + 0.3, 2 + u * s + v * t}); };
    corner(-1, -1);
    corner(-1, 1);
    corner(1, 1);
    corner(1, -1);
    both.close_loop();
    EXPECT_LT(relative_error(both.quick()), 0x1p-95);
    return both;
  });
  EXPECT_EQ(count.found, count.loops);
}

TEST(QuickContour, RoundsNearlyEveryTinyTriangle) {
  const Count count = expect_the_truth_of(500, 1001, [](Random& random) {
    Both both = triangle(random, 1e-8);
    both.close_loop();
    return both;
  });
  RecordProperty("found", static_cast<int>(count.found));
  EXPECT_GT(count.found, count.loops * 98 / 100);
}

TEST(QuickContour, RoundsWhatCrossingsLeave) {
  const Count count = expect_the_truth_of(
      500, 2001, [](Random& random) { return cut_triangle(random, std::exp2(random.between(-8, 0))); });
  RecordProperty("found", static_cast<int>(count.found));
  EXPECT_GT(count.found, count.loops * 99 / 100);
}

TEST(QuickContour, EnclosesTinyLoopsWithCrossings) {
  const Count count = expect_the_truth_of(
      500, 3001, [](Random& random) { return cut_triangle(random, std::exp2(random.between(-30, -15))); });
  RecordProperty("found", static_cast<int>(count.found));
  EXPECT_GT(count.found, count.loops * 9 / 10);
}

TEST(QuickContour, EnclosesSlivers) {
  const Count count = expect_the_truth_of(500, 4001, [](Random& random) {
    Both both = triangle(random, 1);
    both.corners.clear();
    both.exact.clear();
    const Vec3 p{random.between(-2, 2), random.between(-2, 2), random.between(3, 5)};
    const double width = std::exp2(random.between(-45, -10));
    both.add(p);
    both.add(Vec3{p.x + random.between(0, 1), p.y + random.between(0, 1), p.z});
    both.add(Vec3{p.x + width * random.between(0, 1), p.y + width * random.between(0, 1), p.z + width});
    both.close_loop();
    return both;
  });
  RecordProperty("found", static_cast<int>(count.found));
  EXPECT_GT(count.found, count.loops * 2 / 3);
}

TEST(QuickContour, EnclosesLoopsNearTheHorizon) {
  const Count count = expect_the_truth_of(500, 5001, [](Random& random) {
    Both both;
    both.normal = {0, 0, 1};
    both.x = random_vector(random, 1);
    const double height = std::exp2(random.between(-40, 0));
    for (int i = 0; i < 4; ++i) {
      both.add(Vec3{both.x.x + random.between(2, 3), both.x.y + random.between(-1, 1),
                    both.x.z + height * random.between(0, 1)});
    }
    both.close_loop();
    return both;
  });
  RecordProperty("found", static_cast<int>(count.found));
  EXPECT_GT(count.found, count.loops / 3);
}

TEST(QuickContour, EnclosesAnglesNearAHalfTurn) {
  const Count count = expect_the_truth_of(500, 6001, [](Random& random) {
    Both both;
    const Vec3 a = random_vector(random, 1);
    const double gap = std::exp2(random.between(-40, 0));
    const double s = random.between(0.5, 2);
    both.add(a);
    both.add(Vec3{-s * a.x + gap * random.between(-1, 1), -s * a.y + gap * random.between(-1, 1), -s * a.z + gap});
    both.add(random_vector(random, 1));
    both.close_loop();
    return both;
  });
  RecordProperty("found", static_cast<int>(count.found));
  EXPECT_GT(count.found, count.loops * 9 / 10);
}

// Arbitrary pieces, not closed, with directions of more or fewer bits than double-double has.
TEST(QuickContour, EnclosesPiecesOfExactDirections) {
  const Count count = expect_the_truth_of(1000, 7001, [](Random& random) {
    Both both;
    both.normal = random_vector(random, 1);
    for (int i = 0; i < 8; ++i) both.add(random_direction(random, 4 + static_cast<int>(random.below(400))));
    for (int i = 0; i < 6; ++i) {
      const auto pick = [&](std::uint32_t other) {
        return (other + 1 + static_cast<std::uint32_t>(random.below(7))) % 8;
      };
      const std::uint32_t a = static_cast<std::uint32_t>(random.below(8));
      Part piece{a, pick(a), kA, kB};
      for (End* end : {&piece.begin, &piece.end}) {
        const std::uint32_t c = static_cast<std::uint32_t>(random.below(8));
        const End other = crossing(c, pick(c));
        const ExactVec3 plane = cross(both.exact[other.c], both.exact[other.d]);
        const int signs = sign(dot(plane, both.exact[piece.a])) * sign(dot(plane, both.exact[piece.b]));
        if (signs < 0) *end = other;
      }
      both.pieces.push_back(piece);
    }
    return both;
  });
  RecordProperty("found", static_cast<int>(count.found));
  EXPECT_GT(count.found, count.loops * 8 / 10);
}

TEST(QuickContour, EnclosesCornersOfAnyModerateSize) {
  const Count count = expect_the_truth_of(500, 8001, [](Random& random) {
    Both both;
    const double direction = random.one_in(2) ? 1 : -1;
    for (int i = 0; i < 5; ++i) {
      const Vec3 t = random_vector(random, 1);
      const double size = std::exp2(direction * random.between(0, 199));
      both.add(Vec3{size * t.x, size * t.y, size * t.z});
    }
    const ExactVec3 plane = cross(both.exact[3], both.exact[4]);
    const bool crosses = sign(dot(plane, both.exact[0])) * sign(dot(plane, both.exact[1])) < 0;
    both.pieces = {{0, 1, kA, crosses ? crossing(3, 4) : kB}, {1, 2, kA, kB}, {2, 0, kA, kB}};
    return both;
  });
  RecordProperty("found", static_cast<int>(count.found));
  EXPECT_GT(count.found, count.loops * 8 / 10);
}

// Every step of the arc tangent table, both ends of each step, in every octant.
TEST(QuickContour, EnclosesAnglesOfEveryStep) {
  constexpr int kSteps = 512;
  for (int k = -kSteps; k <= kSteps; ++k) {
    for (const bool steep : {false, true}) {
      for (const int side : {1, -1}) {
        if (!steep && k == 0) continue;  // a is collinear with b and x
        Both both;
        both.normal = {0.3, 0.4, 0.5};
        both.add(ExactVec3{1, 0, 0});
        both.add(steep ? ExactVec3{k, side * kSteps, 0} : ExactVec3{side * kSteps, k, 0});
        both.pieces = {{0, 1, kA, kB}};
        ASSERT_TRUE(expect_the_truth(both)) << k << ' ' << steep << ' ' << side;
        ASSERT_LT(relative_error(both.quick()), 0x1p-86) << k << ' ' << steep << ' ' << side;
      }
    }
  }
}

// --- Properties ---

TEST(QuickContour, AgreesWithTheClosedFormBelowACorner) {
  // J. R. Howell, configuration B-3 with a = b = c = 1.
  Both both;
  for (const ExactVec3& corner : {ExactVec3{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}}) both.add(corner);
  both.close_loop();
  EXPECT_EQ(enclosure_of(both.quick()).nearest(), 0.138531605994892996780769708634);
  EXPECT_LT(both.quick().error, 0x1p-96);
}

TEST(QuickContour, ThePieceInTheOtherSenseIsTheNegative) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    Random random(validation::seed_of(seed));
    Both forward = cut_triangle(random, 1);
    Both backward = forward;
    for (Part& piece : backward.pieces) std::swap(piece.begin, piece.end);
    EXPECT_EQ(forward.quick().hi, -backward.quick().hi) << seed;
  }
}

TEST(QuickContour, TheLengthOfTheNormalMeansNothing) {
  for (const int exponent : {-1060, -900, -1, 1, 900, 1020}) {
    Both both;
    for (const ExactVec3& corner : {ExactVec3{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}}) both.add(corner);
    both.close_loop();
    both.normal = {0.25, -0.5, 4};  // few bits, so that any shift is exact
    const QuickContour::Value plain = both.quick();
    both.normal = {std::ldexp(0.25, exponent), std::ldexp(-0.5, exponent), std::ldexp(4, exponent)};
    EXPECT_EQ(both.quick().hi, plain.hi) << exponent;
    EXPECT_EQ(both.quick().lo, plain.lo) << exponent;
    EXPECT_TRUE(expect_the_truth(both)) << exponent;
  }
}

TEST(QuickContour, TheSizeOfAllCornersMeansNothing) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    Random random(validation::seed_of(seed));
    Both both = cut_triangle(random, 1);
    const QuickContour::Value plain = both.quick();
    for (const double scale : {0x1p190, 0x1p-190}) {
      Both scaled = both;
      for (QuickCorner& corner : scaled.corners) {
        for (int i = 0; i < 3; ++i) {
          corner.hi[i] *= scale;
          corner.lo[i] *= scale;
        }
      }
      EXPECT_EQ(scaled.quick().hi, plain.hi) << seed;
      EXPECT_EQ(scaled.quick().lo, plain.lo) << seed;
    }
  }
}

TEST(QuickContour, ANormalWithComponentsOfAnyRatioIsEnclosed) {
  Both both;
  for (const ExactVec3& corner : {ExactVec3{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}}) both.add(corner);
  both.close_loop();
  for (const Vec3& normal : {Vec3{1e-320, 0, 1e300}, Vec3{5e-324, 5e-324, 5e-324}, Vec3{1e308, -1e308, 1.5e308}}) {
    both.normal = normal;
    EXPECT_TRUE(expect_the_truth(both));
  }
}

// --- Declining ---

Both one_piece(const ExactVec3& a, const ExactVec3& b) {
  Both both;
  both.add(a);
  both.add(b);
  both.pieces = {{0, 1, kA, kB}};
  return both;
}

TEST(QuickContour, DeclinesAnEdgeOnOneLineWithX) {
  const Integer big = Integer(1) << 400;
  EXPECT_FALSE(answers(one_piece({1, 2, 3}, {1, 2, 3}).quick()));
  EXPECT_FALSE(answers(one_piece({1, 2, 3}, {-1, -2, -3}).quick()));
  EXPECT_FALSE(answers(one_piece({1, 2, 3}, {2, 4, 6}).quick()));
  EXPECT_FALSE(answers(one_piece({big, big, big}, {big, big, big + (Integer(1) << 200) + 1}).quick()));
  EXPECT_FALSE(answers(one_piece({big, big, big}, {-big, -big, -big - (Integer(1) << 200) - 1}).quick()));
  EXPECT_TRUE(answers(one_piece({1, 2, 3}, {1, 2, 4}).quick()));
}

// If one piece is declined, the whole sum is declined.
TEST(QuickContour, StaysDeclined) {
  Both both = one_piece({1, 2, 3}, {2, 4, 6});
  both.add(ExactVec3{1, 5, 2});
  both.pieces.push_back({1, 2, kA, kB});
  EXPECT_FALSE(answers(both.quick()));
  EXPECT_FALSE(enclosure_of(both.quick()).nearest().has_value());
}

TEST(QuickContour, DeclinesACrossingThatIsNone) {
  const auto crossed_by = [](const ExactVec3& c, const ExactVec3& d) {
    Both both = one_piece({1, 0, 1}, {0, 1, 1});
    both.add(c);
    both.add(d);
    both.pieces[0].end = crossing(2, 3);
    return answers(both.quick());
  };
  EXPECT_TRUE(crossed_by({0, 0, 1}, {1, 2, 0}));
  EXPECT_FALSE(crossed_by({0, 0, 1}, {1, 0, 0}));     // through a
  EXPECT_FALSE(crossed_by({0, 0, 1}, {0, 1, 0}));     // through b
  EXPECT_FALSE(crossed_by({0, 0, 1}, {1, -2, 0}));    // beside the edge
  EXPECT_FALSE(crossed_by({1, 0, 1}, {0, 1, 1}));     // along it
  EXPECT_FALSE(crossed_by({1, 2, 3}, {2, 4, 6}));     // no plane
  EXPECT_FALSE(crossed_by({1, 2, 3}, {-2, -4, -6}));  // no plane
  const Integer big = Integer(1) << 300;
  EXPECT_FALSE(crossed_by({0, 0, 1}, {big, 1, 0}));  // too near to a for double-double
}

TEST(QuickContour, DeclinesCornersTooLargeOrTooSmall) {
  const auto with = [](const Vec3& vertex, int scale_exponent) {
    QuickContour contour({0, 0, 1});
    const std::vector<QuickCorner> corners{quick_corner({1, 0, 0}, {}, 0), quick_corner(vertex, {}, scale_exponent)};
    std::vector<QuickLine> lines(1);
    contour.make_lines(corners, std::vector<QuickEdge>{{0, 1}}, lines);
    contour.add(std::vector<QuickPiece>{{0, QuickPiece::kAtA, QuickPiece::kAtB}}, lines);
    return answers(contour.value());
  };
  EXPECT_TRUE(with({0, 1, 0}, 200));
  EXPECT_TRUE(with({0, 1, 0}, -200));
  EXPECT_FALSE(with({0, 1, 0}, 201));
  EXPECT_FALSE(with({0, 1, 0}, -201));
  EXPECT_FALSE(with({0, 1, 0}, 2000));
  EXPECT_FALSE(with({0, 1, 0}, -2000));
  EXPECT_FALSE(with({0, 0, 0}, 0));
  EXPECT_FALSE(with({0, 1, std::nan("")}, 0));
  EXPECT_FALSE(with({0, kInfinity, 0}, 0));
}

TEST(QuickContour, ALoopWithoutAreaIsNotRounded) {
  Both both = one_piece({1, 2, 3}, {1, 2, 4});
  both.pieces.push_back({1, 0, kA, kB});
  EXPECT_TRUE(answers(both.quick()));
  EXPECT_FALSE(enclosure_of(both.quick()).nearest().has_value());
  EXPECT_TRUE(enclosure_of(both.quick()).contains(0.0));
}

// --- Corners ---

Rational exactly(double hi, double lo) { return kernel::to_rational(hi) + kernel::to_rational(lo); }

TEST(QuickCorner, IsTheExactDifference) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Random random(validation::seed_of(seed));
    const Vec3 p = random_vector(random, std::exp2(random.between(-40, 40)));
    const Vec3 q = random_vector(random, std::exp2(random.between(-40, 40)));
    const int exponent = static_cast<int>(random.below(200)) - 100;
    const QuickCorner corner = quick_corner(p, q, exponent);
    EXPECT_EQ(corner.error, 0.0);
    const std::array<double, 3> from = {q.x, q.y, q.z};
    const std::array<double, 3> to = {p.x, p.y, p.z};
    for (int i = 0; i < 3; ++i) {
      const Rational difference = kernel::to_rational(to[i]) - kernel::to_rational(from[i]);
      EXPECT_EQ(exactly(corner.hi[i], corner.lo[i]), kernel::times_power_of_two(difference, exponent)) << seed;
    }
  }
}

TEST(QuickCorner, TheErrorCoversWhatUnderflows) {
  for (const int exponent : {-900, -960, -1000, -1010, -1074, -1500}) {
    const Vec3 p{1.0 / 3, 1e-200, 3};
    const Vec3 q{1e-17, 0, 1e-9};
    const QuickCorner corner = quick_corner(p, q, exponent);
    EXPECT_GT(corner.error, 0.0);
    EXPECT_LT(corner.error, 0x1p-900);
    const std::array<double, 3> from = {q.x, q.y, q.z};
    const std::array<double, 3> to = {p.x, p.y, p.z};
    for (int i = 0; i < 3; ++i) {
      const Rational difference = kernel::to_rational(to[i]) - kernel::to_rational(from[i]);
      const Rational lost = kernel::times_power_of_two(difference, exponent) - exactly(corner.hi[i], corner.lo[i]);
      EXPECT_LE(abs(lost), kernel::to_rational(corner.error)) << exponent;
    }
  }
}

TEST(QuickCorner, IsNoNumberWhereItOverflows) {
  EXPECT_TRUE(std::isnan(quick_corner({1.5e308, 0, 0}, {-1.5e308, 0, 0}, -100).hi[0]));
  EXPECT_TRUE(std::isnan(quick_corner({0, 1, 0}, {}, 1024).hi[1]));
  EXPECT_TRUE(std::isnan(quick_corner({0, 0, 1}, {}, 5000).hi[2]));
  EXPECT_EQ(quick_corner({0, 5e-324, 0}, {}, 1074).hi[1], 1.0);
}

TEST(QuickCorner, OfAnExactDirectionKeepsItsErrorBound) {
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    Random random(validation::seed_of(seed));
    ExactVec3 direction = random_direction(random, 1 + static_cast<int>(random.below(600)));
    direction.y >>= static_cast<mp_bitcnt_t>(random.below(120));
    if (is_zero(direction)) continue;
    const QuickCorner corner = quick_corner(direction);
    const long bits = bit_length(direction);
    EXPECT_TRUE(bits > 106 || corner.error == 0.0) << seed;
    EXPECT_LE(corner.error, 0x1p-105);
    double largest = 0.0;
    for (int i = 0; i < 3; ++i) {
      const Rational lost =
          kernel::times_power_of_two(Rational(direction[i]), -bits) - exactly(corner.hi[i], corner.lo[i]);
      EXPECT_LE(abs(lost), kernel::to_rational(corner.error)) << seed;
      EXPECT_EQ(corner.hi[i], corner.hi[i] + corner.lo[i]);
      largest = std::max(largest, std::abs(corner.hi[i]));
    }
    EXPECT_GE(largest, 0.5);
    EXPECT_LE(largest, 1.0);  // 1 - 2^-60 rounds to 1
  }
}

TEST(QuickCorner, OfAFewBitsIsExact) {
  const QuickCorner corner = quick_corner(ExactVec3{3, -5, (Integer(1) << 100) + 1});
  EXPECT_EQ(corner.error, 0.0);
  EXPECT_EQ(corner.hi[2], 0.5);
  EXPECT_EQ(corner.lo[2], 0x1p-101);
  EXPECT_EQ(corner.hi[1], -5 * 0x1p-101);
}

// --- Arithmetic ---

// Every operation, with numbers at the limits that their bounds allow. The bound of the operation must hold. If the
// operands are exact, the bound must not be a hundred times too large for the worst of many cases.
class Arithmetic : public ::testing::Test {
 protected:
  struct Operand {
    Bounded bounded;
    Rational truth;
  };

  static Operand operand(Random& random, bool exact) {
    const double hi = random.between(0.5, 2) * (random.one_in(2) ? 1 : -1) * std::exp2(random.between(-3, 3));
    const DoubleDouble x = two_sum(hi, hi * 0x1p-53 * random.between(-1, 1));
    const double error = exact ? 0.0 : std::abs(hi) * std::exp2(random.between(-100, -30));
    const Rational shift = kernel::to_rational(random.one_in(2) ? error : -error);
    return {{x.hi, x.lo, error}, exactly(x.hi, x.lo) + shift};
  }

  // |result - truth| / error.
  static double share(const Bounded& result, const Rational& truth) {
    const Rational lost = abs(Rational(exactly(result.hi, result.lo) - truth));
    EXPECT_EQ(result.hi, result.hi + result.lo);
    return Rational(lost / kernel::to_rational(kInflation * result.error)).get_d();
  }

  // `shares` returns the share of the bound that one case uses.
  template <typename Shares>
  static void expect_sharp_bounds(Shares shares) {
    double worst = 0.0;
    for (std::uint64_t seed = 1; seed <= validation::scaled_count(4000); ++seed) {
      Random random(validation::seed_of(seed));
      worst = std::max(worst, shares(random, true));
      ASSERT_LE(worst, 1.0) << seed;
      ASSERT_LE(shares(random, false), 1.0) << seed;
    }
    EXPECT_GT(worst, 0.05);
  }
};

TEST_F(Arithmetic, SumsKeepTheirBounds) {
  expect_sharp_bounds([](Random& random, bool exact) {
    const Operand x = operand(random, exact);
    const Operand y = operand(random, exact);
    return share(x.bounded + y.bounded, x.truth + y.truth);
  });
}

// Operands that cancel down to a few of their last bits, or completely.
TEST_F(Arithmetic, SumsThatCancelKeepTheirBounds) {
  for (std::uint64_t seed = 1; seed <= validation::scaled_count(4000); ++seed) {
    Random random(validation::seed_of(seed));
    const Operand x = operand(random, true);
    const double hi = -x.bounded.hi * (1 + 0x1p-52 * static_cast<double>(random.below(5)));
    const DoubleDouble y = two_sum(hi, hi * 0x1p-53 * random.between(-1, 1));
    const Rational truth = x.truth + exactly(y.hi, y.lo);
    ASSERT_LE(share(x.bounded + bounded(y, 0), truth), 1.0) << seed;
    const DoubleDouble sum = accurate_sum(parts(x.bounded), y);
    ASSERT_LE(abs(Rational(exactly(sum.hi, sum.lo) - truth)), abs(truth) * kernel::to_rational(0x1p-104)) << seed;
  }
}

TEST_F(Arithmetic, ProductsKeepTheirBounds) {
  expect_sharp_bounds([](Random& random, bool exact) {
    const Operand x = operand(random, exact);
    const Operand y = operand(random, exact);
    return share(x.bounded * y.bounded, x.truth * y.truth);
  });
  expect_sharp_bounds([](Random& random, bool exact) {
    const Operand y = operand(random, exact);
    const double t = random.between(0, 1);
    return share(t * y.bounded, kernel::to_rational(t) * y.truth);
  });
}

TEST_F(Arithmetic, SumsOfProductsKeepTheirBounds) {
  expect_sharp_bounds([](Random& random, bool exact) {
    const Operand a = operand(random, exact);
    const Operand b = operand(random, exact);
    const Operand c = operand(random, exact);
    const Operand d = operand(random, exact);
    return share(sum_of_products(a.bounded, b.bounded, c.bounded, d.bounded), a.truth * b.truth + c.truth * d.truth);
  });
}

TEST_F(Arithmetic, QuotientsKeepTheirBounds) {
  expect_sharp_bounds([](Random& random, bool exact) {
    const Operand x = operand(random, exact);
    const Operand y = operand(random, exact);
    return share(x.bounded / y.bounded, x.truth / y.truth);
  });
}

TEST_F(Arithmetic, RootsKeepTheirBounds) {
  expect_sharp_bounds([](Random& random, bool exact) {
    Operand x = operand(random, exact);
    if (x.bounded.hi < 0.0) x = {-x.bounded, -x.truth};
    // A rational root within 2^-300.
    Integer root;
    const Integer scaled =
        kernel::times_power_of_two(x.truth, 600).get_num() / kernel::times_power_of_two(x.truth, 600).get_den();
    mpz_sqrt(root.get_mpz_t(), scaled.get_mpz_t());
    return share(square_root(x.bounded), kernel::times_power_of_two(Rational(root), -300));
  });
}

TEST_F(Arithmetic, DeclinesDivisorsThatMayBeZero) {
  EXPECT_EQ((Bounded{1} / Bounded{0}).error, kInfinity);
  EXPECT_EQ((Bounded{1} / Bounded{1, 0, 0x1p-19}).error, kInfinity);
  EXPECT_EQ(square_root(Bounded{1, 0, 0x1p-19}).error, kInfinity);
  EXPECT_EQ(square_root(Bounded{-1, 0, 0}).error, kInfinity);
  EXPECT_EQ(square_root(Bounded{0, 0, 0}).error, kInfinity);
}

// --- Vectors ---

using Truth = std::array<Rational, 3>;

struct VectorOperand {
  Vector bounded;
  Truth truth;
};

class VectorArithmetic : public Arithmetic {
 protected:
  static VectorOperand vector_operand(Random& random, bool exact, double size = 1) {
    VectorOperand result;
    const double error = exact ? 0.0 : size * std::exp2(random.between(-100, -30));
    for (int i = 0; i < 3; ++i) {
      const double hi = random.between(-1, 1) * size;
      result.bounded.c[i] = two_sum(hi, hi * 0x1p-53 * random.between(-1, 1));
      const Rational shift = kernel::to_rational(random.one_in(2) ? error : -error);
      result.truth[i] = exactly(result.bounded.c[i].hi, result.bounded.c[i].lo) + shift;
    }
    result.bounded = vector(result.bounded.c, error);
    return result;
  }

  static double worst_share(const Vector& result, const Truth& truth) {
    double worst = 0.0;
    for (int i = 0; i < 3; ++i) {
      worst = std::max(worst, share({result.c[i].hi, result.c[i].lo, result.error}, truth[i]));
    }
    return worst;
  }
};

Truth true_combination(const Rational& l, const Truth& p, const Rational& m, const Truth& q) {
  return {l * p[0] + m * q[0], l * p[1] + m * q[1], l * p[2] + m * q[2]};
}

TEST_F(VectorArithmetic, DifferencesKeepTheirBounds) {
  expect_sharp_bounds([](Random& random, bool exact) {
    const VectorOperand p = vector_operand(random, exact);
    VectorOperand q = vector_operand(random, exact, std::exp2(random.between(-60, 0)));
    if (random.one_in(2)) {  // near p
      for (int i = 0; i < 3; ++i) q.truth[i] += p.truth[i];
      q.bounded = difference(p.bounded, vector({-q.bounded.c[0], -q.bounded.c[1], -q.bounded.c[2]}, q.bounded.error));
      if (exact) q.bounded.error = 0;  // the rounded sum is an exact operand
      if (exact) {
        for (int i = 0; i < 3; ++i) q.truth[i] = exactly(q.bounded.c[i].hi, q.bounded.c[i].lo);
      }
    }
    return worst_share(difference(p.bounded, q.bounded), true_combination(1, p.truth, -1, q.truth));
  });
}

TEST_F(VectorArithmetic, CrossProductsKeepTheirBounds) {
  expect_sharp_bounds([](Random& random, bool exact) {
    const VectorOperand p = vector_operand(random, exact);
    const VectorOperand q = vector_operand(random, exact);
    const auto component = [&](int j, int k) -> Rational { return p.truth[j] * q.truth[k] - p.truth[k] * q.truth[j]; };
    return worst_share(cross(p.bounded, q.bounded), {component(1, 2), component(2, 0), component(0, 1)});
  });
}

TEST_F(VectorArithmetic, DotProductsKeepTheirBounds) {
  expect_sharp_bounds([](Random& random, bool exact) {
    const VectorOperand p = vector_operand(random, exact);
    const VectorOperand q = vector_operand(random, exact);
    return share(dot(p.bounded, q.bounded),
                 p.truth[0] * q.truth[0] + p.truth[1] * q.truth[1] + p.truth[2] * q.truth[2]);
  });
}

TEST_F(VectorArithmetic, CombinationsKeepTheirBounds) {
  expect_sharp_bounds([](Random& random, bool exact) {
    const VectorOperand p = vector_operand(random, exact);
    const VectorOperand q = vector_operand(random, exact);
    const Operand l = operand(random, exact || random.one_in(2));
    const Operand m = operand(random, exact || random.one_in(2));
    return worst_share(combination(l.bounded, p.bounded, m.bounded, q.bounded),
                       true_combination(l.truth, p.truth, m.truth, q.truth));
  });
}

// p is t q up to a relative difference between 2^-100 and 1.
TEST_F(VectorArithmetic, NearCancellationsKeepTheirBounds) {
  expect_sharp_bounds([](Random& random, bool exact) {
    const VectorOperand q = vector_operand(random, exact);
    VectorOperand p;
    const double t = random.between(0.5, 2);
    const double away = std::exp2(random.between(-100, 0));
    for (int i = 0; i < 3; ++i) {
      const Bounded product = t * Bounded{q.bounded.c[i].hi, q.bounded.c[i].lo};
      const Bounded sum = product + Bounded{away * random.between(-1, 1)};
      p.bounded.c[i] = {sum.hi, sum.lo};
      p.truth[i] = exactly(sum.hi, sum.lo);
    }
    p.bounded = vector(p.bounded.c, 0.0);
    return worst_share(near_cancellation(p.bounded, t, q.bounded),
                       true_combination(1, p.truth, kernel::to_rational(-t), q.truth));
  });
}

// --- Angles ---

Enclosure true_angle(const Rational& sine, const Rational& cosine) {
  Ball ball = kernel::to_ball(sine, kBits);
  arb_atan2(ball.get(), ball.get(), kernel::to_ball(cosine, kBits).get(), kBits);
  return Enclosure(ball);
}

bool holds(const Bounded& angle, const Enclosure& truth) {
  return enclosure_of({angle.hi, angle.lo, kInflation * angle.error}).contains(truth);
}

class Angle : public Arithmetic {};

TEST_F(Angle, TheSeriesKeepsItsBound) {
  for (std::uint64_t seed = 1; seed <= validation::scaled_count(4000); ++seed) {
    Random random(validation::seed_of(seed));
    const double hi = random.between(-1, 1) * (random.one_in(2) ? 0x1p-9 : std::exp2(-random.between(9, 200)));
    const Bounded z = bounded(two_sum(hi, hi * 0x1p-53 * random.between(-1, 1)), 0);
    ASSERT_TRUE(holds(atan_near_zero(z), true_angle(exactly(z.hi, z.lo), 1))) << seed;
  }
}

TEST_F(Angle, AnglesKeepTheirBounds) {
  for (std::uint64_t seed = 1; seed <= validation::scaled_count(4000); ++seed) {
    Random random(validation::seed_of(seed));
    const bool exact = random.one_in(2);
    Operand s = operand(random, exact);
    const Operand c = operand(random, exact);
    const double scale = std::exp2(-static_cast<double>(random.below(60)));
    s = {{s.bounded.hi * scale, s.bounded.lo * scale, s.bounded.error * scale}, s.truth * kernel::to_rational(scale)};
    for (const bool swapped : {false, true}) {
      const Operand& sine = swapped ? c : s;
      const Operand& cosine = swapped ? s : c;
      const Bounded angle = atan2(sine.bounded, cosine.bounded, angle_constants());
      ASSERT_TRUE(std::isfinite(angle.error)) << seed;
      ASSERT_TRUE(holds(angle, true_angle(sine.truth, cosine.truth))) << seed;
      ASSERT_TRUE(!exact || angle.error < 0x1p-99 * std::abs(angle.hi)) << seed;
    }
  }
}

TEST_F(Angle, ASineThatMayBeZeroIsNoHindrance) {
  const Bounded angle = atan2(Bounded{0x1p-60, 0, 0x1p-50}, Bounded{1, 0, 0}, angle_constants());
  for (const double sine : {0x1p-60 + 0x1p-50, 0x1p-60 - 0x1p-50, 0.0}) {
    EXPECT_TRUE(holds(angle, true_angle(kernel::to_rational(sine), 1)));
  }
  const Bounded right = atan2(Bounded{1, 0, 0}, Bounded{0x1p-60, 0, 0x1p-50}, angle_constants());
  for (const double cosine : {0x1p-60 + 0x1p-50, 0x1p-60 - 0x1p-50, 0.0}) {
    EXPECT_TRUE(holds(right, true_angle(1, kernel::to_rational(cosine))));
  }
}

TEST_F(Angle, DeclinesTheOriginAndTheNegativeAxis) {
  const auto declined = [](const Bounded& s, const Bounded& c) {
    return std::isinf(atan2(s, c, angle_constants()).error);
  };
  EXPECT_TRUE(declined({0, 0, 0}, {0, 0, 0}));
  EXPECT_TRUE(declined({1, 0, 0x1p-10}, {1, 0, 0}));
  EXPECT_TRUE(declined({1, 0, 0}, {1, 0, 0x1p-10}));
  EXPECT_TRUE(declined({0, 0, 0}, {-1, 0, 0}));
  EXPECT_TRUE(declined({0x1p-50, 0, 0x1p-50}, {-1, 0, 0}));
  EXPECT_TRUE(declined({1, 0, 0}, {std::nan(""), 0, 0}));
  EXPECT_TRUE(declined({std::nan(""), 0, 0}, {1, 0, 0}));
  EXPECT_FALSE(declined({0x1p-48, 0, 0x1p-50}, {-1, 0, 0}));
}

// --- Four at a time ---

bool same(double x, double y) {
  return std::isnan(x) ? std::isnan(y) : std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
}

// Compares the results for four lanes with the results for one.
class Lanes : public ::testing::Test {
 protected:
  static constexpr std::size_t kLanes = 4;

  // Operands of every kind: ordinary, at the ends of the range, none.
  static double number(Random& random) {
    constexpr std::array kHostile = {0.0,     -0.0,      5e-324,    -5e-324,    0x1p-1022, 0x1.8p-1030,
                                     0x1p900, -0x1p1023, kInfinity, -kInfinity, 0x1p-600,  1.0};
    if (random.one_in(12)) return std::nan("");
    if (random.one_in(3)) return kHostile[random.below(kHostile.size())];
    return random.between(-1, 1) * std::exp2(random.between(-30, 30));
  }
  static Bounded bounded_number(Random& random) {
    const DoubleDouble x = two_sum(number(random), number(random) * 0x1p-60);
    const double error = random.one_in(3) ? 0.0 : std::abs(number(random)) * 0x1p-70;
    return {x.hi, random.one_in(9) ? number(random) : x.lo, random.one_in(9) ? kDeclined.error : error};
  }
  static Vector bounded_vector(Random& random) {
    const Bounded x = bounded_number(random), y = bounded_number(random), z = bounded_number(random);
    return vector({parts(x), parts(y), parts(z)}, z.error);
  }

  template <class One, class Make>
  static std::array<One, kLanes> four_of(Random& random, Make make) {
    return {make(random), make(random), make(random), make(random)};
  }
  static Four pack(const std::array<double, kLanes>& x) { return Four{x[0], x[1], x[2], x[3]}; }
  template <class T>
  static Four pack(const std::array<T, kLanes>& x, double T::*part) {
    return Four{x[0].*part, x[1].*part, x[2].*part, x[3].*part};
  }
  static FourBounded pack(const std::array<Bounded, kLanes>& x) {
    return {pack(x, &Bounded::hi), pack(x, &Bounded::lo), pack(x, &Bounded::error)};
  }
  static FourVector pack(const std::array<Vector, kLanes>& v) {
    const auto component = [&](std::size_t i) -> BasicDoubleDouble<Four> {
      return {Four{v[0].c[i].hi, v[1].c[i].hi, v[2].c[i].hi, v[3].c[i].hi},
              Four{v[0].c[i].lo, v[1].c[i].lo, v[2].c[i].lo, v[3].c[i].lo}};
    };
    return {{component(0), component(1), component(2)}, pack(v, &Vector::norm), pack(v, &Vector::error)};
  }

  static void expect_lane(const Four& four, std::size_t k, double one) {
    EXPECT_TRUE(same(four[k], one)) << "lane " << k << ": " << four[k] << " for " << one;
  }
  static void expect_lane(const FourBounded& four, std::size_t k, const Bounded& one) {
    expect_lane(four.hi, k, one.hi);
    expect_lane(four.lo, k, one.lo);
    expect_lane(four.error, k, one.error);
  }
  static void expect_lane(const FourVector& four, std::size_t k, const Vector& one) {
    for (std::size_t i = 0; i < 3; ++i) {
      expect_lane(four.c[i].hi, k, one.c[i].hi);
      expect_lane(four.c[i].lo, k, one.c[i].lo);
    }
    expect_lane(four.norm, k, one.norm);
    expect_lane(four.error, k, one.error);
  }

  // `function` of four lanes, and of the number in each lane.
  template <class Function, class... Ones>
  static void expect_same_of(Function function, const std::array<Ones, kLanes>&... ones) {
    const auto four = function(pack(ones)...);
    for (std::size_t k = 0; k < kLanes; ++k) expect_lane(four, k, function(ones[k]...));
  }

  template <class Test>
  static void for_many_seeds(Test test) {
    for (std::uint64_t seed = 1; seed <= validation::scaled_count(500) && !HasFailure(); ++seed) {
      SCOPED_TRACE("seed " + std::to_string(seed));
      Random random(validation::seed_of(seed));
      test(random);
    }
  }
};

TEST_F(Lanes, ArithmeticIsThatOfOne) {
  for_many_seeds([](Random& random) {
    const auto t = four_of<double>(random, number);
    const auto a = four_of<Bounded>(random, bounded_number), b = four_of<Bounded>(random, bounded_number);
    const auto c = four_of<Bounded>(random, bounded_number), d = four_of<Bounded>(random, bounded_number);
    expect_same_of([](const auto& x, const auto& y) { return x + y; }, a, b);
    expect_same_of([](const auto& x, const auto& y) { return x - y; }, a, b);
    expect_same_of([](const auto& x, const auto& y) { return x * y; }, a, b);
    expect_same_of([](const auto& x, const auto& y) { return x * y; }, t, b);
    expect_same_of([](const auto& x, const auto& y) { return x / y; }, a, b);
    expect_same_of([](const auto& x) { return square_root(x); }, a);
    expect_same_of([](const auto& x) { return absolute(x); }, a);
    expect_same_of(
        [](const auto& w, const auto& x, const auto& y, const auto& z) { return sum_of_products(w, x, y, z); }, a, b, c,
        d);
  });
}

TEST_F(Lanes, VectorsAreThoseOfOne) {
  for_many_seeds([](Random& random) {
    const auto t = four_of<double>(random, number);
    const auto l = four_of<Bounded>(random, bounded_number), m = four_of<Bounded>(random, bounded_number);
    const auto p = four_of<Vector>(random, bounded_vector), q = four_of<Vector>(random, bounded_vector);
    expect_same_of([](const auto& x, const auto& y) { return dot(x, y); }, p, q);
    expect_same_of([](const auto& x, const auto& y) { return cross(x, y); }, p, q);
    expect_same_of([](const auto& x, const auto& y) { return difference(x, y); }, p, q);
    expect_same_of([](const auto& x, const auto& k, const auto& y) { return near_cancellation(x, k, y); }, p, t, q);
    expect_same_of([](const auto& j, const auto& x, const auto& k, const auto& y) { return combination(j, x, k, y); },
                   l, p, m, q);
  });
}

TEST_F(Lanes, AnglesAreThoseOfOne) {
  const auto angle = [](const auto& sine, const auto& cosine) { return atan2(sine, cosine, angle_constants()); };
  for_many_seeds([&](Random& random) {
    const auto s = four_of<Bounded>(random, bounded_number), c = four_of<Bounded>(random, bounded_number);
    expect_same_of(angle, s, c);
  });
}

// Both sides of every step of the table and of every octant; each lane has a different step and octant.
TEST_F(Lanes, AnglesOfEveryStepAreThoseOfOneAndEncloseTheTruth) {
  const auto angle = [](const auto& sine, const auto& cosine) { return atan2(sine, cosine, angle_constants()); };
  const auto point = [](int octant, double ratio) -> std::pair<Bounded, Bounded> {
    const double x = octant & 1 ? -1.0 : 1.0, y = octant & 2 ? -ratio : ratio;
    return octant & 4 ? std::pair<Bounded, Bounded>{{y}, {x}} : std::pair<Bounded, Bounded>{{x}, {y}};
  };
  for (int k = 0; k <= 2 * kAtanSteps; ++k) {
    const double step = static_cast<double>(k) / (2 * kAtanSteps);  // between two steps for odd k
    for (int octant = 0; octant < 8; ++octant) {
      std::array<Bounded, kLanes> s, c;
      for (int i = 0; i < 4; ++i) {
        const double ratio = i == 0   ? step
                             : i == 1 ? std::nextafter(step, -1)
                             : i == 2 ? std::nextafter(step, 2)
                                      : static_cast<double>((37 * k) % 509) / 509;
        std::tie(s[static_cast<std::size_t>(i)], c[static_cast<std::size_t>(i)]) = point((octant + i) % 8, ratio);
      }
      expect_same_of(angle, s, c);
      const FourBounded found = angle(pack(s), pack(c));
      for (std::size_t i = 0; i < kLanes; ++i) {
        if (s[i].hi == 0.0) continue;  // an axis; declined if it is the negative one
        const Enclosure truth = true_angle(exactly(s[i].hi, 0), exactly(c[i].hi, 0));
        ASSERT_TRUE(holds({found.hi[i], found.lo[i], found.error[i]}, truth)) << k << ' ' << octant << ' ' << i;
        ASSERT_LT(found.error[i], 0x1p-99 * std::abs(found.hi[i]) + 8 * kUnderflow) << k << ' ' << octant << ' ' << i;
      }
    }
  }
}

// --- Company ---

bool same(const Vector& p, const Vector& q) {
  bool result = same(p.norm, q.norm) && same(p.error, q.error);
  for (std::size_t i = 0; i < 3; ++i) result = result && same(p.c[i].hi, q.c[i].hi) && same(p.c[i].lo, q.c[i].lo);
  return result;
}
bool same(const Bounded& x, const Bounded& y) { return same(x.hi, y.hi) && same(x.lo, y.lo) && same(x.error, y.error); }
bool same(const QuickLine& f, const QuickLine& g) {
  return f.reversed == g.reversed && same(f.a, g.a) && same(f.b, g.b) && same(f.along, g.along) &&
         same(f.cross, g.cross) && same(f.size, g.size) && same(f.weight, g.weight);
}

// Corners that are declined for every possible reason, between other corners.
std::vector<QuickCorner> mixed_corners(Random& random) {
  const double nan = std::nan("");
  std::vector<QuickCorner> corners{{{nan, nan, nan}, {}, 0}, {{kInfinity, 1, 0}, {}, 0},
                                   {{0, 0, 0}, {}, 0},       {{5e-324, 5e-324, 0}, {}, 0},
                                   {{0x1p300, 1, 1}, {}, 0}, {{1, 1, 1}, {}, kInfinity}};
  for (int i = 0; i < 6; ++i) corners.push_back(quick_corner(random_vector(random, 1), random_vector(random, 1), 0));
  return corners;
}

TEST(QuickContourInCompany, ALineIsWhatItIsAlone) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    Random random(validation::seed_of(seed));
    const QuickContour contour(random_vector(random, 1));
    const std::vector<QuickCorner> corners = mixed_corners(random);
    const auto any = [&] { return static_cast<std::uint32_t>(random.below(corners.size())); };
    for (std::size_t count = 0; count <= 9; ++count) {
      std::vector<QuickEdge> edges;
      for (std::size_t i = 0; i < count; ++i) edges.push_back({any(), any()});
      std::vector<QuickLine> lines(count + 1);  // one too many: it stays as it is
      contour.make_lines(corners, edges, lines);
      EXPECT_TRUE(same(lines[count], QuickLine()));
      for (std::size_t i = 0; i < count; ++i) {
        std::vector<QuickLine> alone(1);
        contour.make_lines(corners, std::span(edges).subspan(i, 1), alone);
        EXPECT_TRUE(same(lines[i], alone[0])) << seed << ' ' << i << " of " << count;
      }
    }
  }
}

// A piece from a to a, which adds nothing, at any position among any number of pieces.
TEST(QuickContourInCompany, APieceIsWhatItIsAlone) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    Random random(validation::seed_of(seed));
    const Both both = cut_triangle(random, 1);
    for (const Part& part : both.pieces) {
      Both alone = both;
      alone.pieces = {part};
      const QuickContour::Value expected = alone.quick();
      for (std::size_t count = 1; count <= 6; ++count) {
        for (std::size_t place = 0; place < count; ++place) {
          Both among = both;
          among.pieces.assign(count, {1, 2, kA, kA});
          among.pieces[place] = part;
          EXPECT_EQ(among.quick().hi, expected.hi) << seed;
          EXPECT_EQ(among.quick().lo, expected.lo) << seed;
          EXPECT_LT(among.quick().error, 2 * expected.error + 0x1p-98) << seed;
        }
      }
    }
  }
}

// Pieces of two sizes, so that only one needs all steps. The sum of both must not depend on the lanes.
TEST(QuickContourInCompany, TwoPiecesAreWhatTheyAreApart) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Random random(validation::seed_of(seed));
    Both both = cut_triangle(random, std::exp2(random.between(-8, 0)));
    const Both other = cut_triangle(random, std::exp2(random.between(-2, 1)));
    const auto first = static_cast<std::uint32_t>(both.corners.size());
    both.corners.insert(both.corners.end(), other.corners.begin(), other.corners.end());
    Part second = other.pieces[random.below(3)];
    for (std::uint32_t* corner :
         {&second.a, &second.b, &second.begin.c, &second.begin.d, &second.end.c, &second.end.d}) {
      *corner += first;
    }
    both.pieces = {both.pieces[random.below(3)], second};
    EXPECT_EQ(both.quick().hi, both.quick(1).hi) << seed;
    EXPECT_EQ(both.quick().lo, both.quick(1).lo) << seed;
  }
}

// A declined piece invalidates its own sum in any position; lanes that repeat a piece invalidate none.
TEST(QuickContourInCompany, EveryNumberOfPiecesIsSummedWhole) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    Random random(validation::seed_of(seed));
    Both both = cut_triangle(random, 1);
    const std::vector<Part> loop = both.pieces;
    both.pieces.clear();
    for (std::size_t count = 1; count <= 13; ++count) {
      both.pieces.push_back(loop[count % loop.size()]);
      const QuickContour::Value value = both.quick();
      ASSERT_TRUE(answers(value));
      EXPECT_LT(value.error, 0x1p-94);
      EXPECT_TRUE(enclosure_of(value).contains(both.ball())) << seed << ' ' << count;
      Both spoilt = both;
      spoilt.pieces[random.below(count)] = {0, 0, kA, kB};
      EXPECT_FALSE(answers(spoilt.quick())) << seed << ' ' << count;
    }
  }
}

TEST(QuickContourInCompany, NothingAddedIsNothing) {
  EXPECT_TRUE(same(Both().quick().hi, -0.0) || same(Both().quick().hi, 0.0));
  EXPECT_LT(Both().quick().error, 0x1p-900);
}

}  // namespace
}  // namespace exactff::contour
