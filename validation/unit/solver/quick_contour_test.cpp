// Eq. (4) in double-double beside Eq. (4) in balls over exact integers. EXACTFF_TEST_SCALE multiplies the number of
// random loops.
#include "contour/quick_contour.h"

#include "contour/contour.h"
#include "support/test.h"
#include "unit/solver/quick_contour_support.h"

namespace exactff::contour {
namespace {

using kernel::ExactVec3;
using kernel::Integer;
using kernel::sign;
using namespace kernel::double_double;

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
  EXPECT_EQ(count.found, count.loops);
}

TEST(QuickContour, RoundsWhatCrossingsLeave) {
  const Count count = expect_the_truth_of(
      500, 2001, [](Random& random) { return cut_triangle(random, std::exp2(random.between(-8, 0))); });
  EXPECT_GT(count.found, count.loops * 99 / 100);
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
  EXPECT_GT(count.found, count.loops * 8 / 10);
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

// A declined piece invalidates its own sum in any position; lanes that repeat a piece invalidate none.
TEST(QuickContour, SumsEveryNumberOfPiecesWhole) {
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

// The unit square (0,1)^2 at z = 1, as seen from the origin below.
Enclosure of_square(long bits) {
  const kernel::ExactVec3 corners[] = {{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}};
  ContourIntegral contour({0, 0, 1});
  for (int i = 0; i < 4; ++i) contour.add({corners[i], corners[(i + 1) % 4]});
  return EnclosureInside::of(contour.evaluate(bits));
}

TEST(Contour, RadiusShrinksWithThePrecision) {
  const Enclosure coarse = of_square(64), fine = of_square(2000);
  EXPECT_TRUE(coarse.overlaps(fine));
  EXPECT_TRUE(coarse.decimals(15).has_value());
  EXPECT_FALSE(coarse.decimals(25).has_value());
  EXPECT_TRUE(fine.decimals(590).has_value());
}

}  // namespace
}  // namespace exactff::contour
