// Receivers at random points of faces.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <vector>

#include "exactff/receiver.h"
#include "support/complaint.h"
#include "unit/scenes/polygon_faces.h"

namespace exactff {
namespace {

using Polygon = validation::PolygonFace;
using validation::letter_l;
using validation::polygon;
using validation::samples_of;
using validation::scene_of;
using validation::window_frame;

// Pearson's statistic of the counts lies within the central 1 - 2e-5 of its distribution. The expected counts here are
// in the hundreds, where that is chi-squared to far better than the bounds are wide. Both ends matter: too even is not
// random either.
void expect_shares(const std::vector<std::uint64_t>& counts, const std::vector<double>& shares) {
  ASSERT_EQ(counts.size(), shares.size());
  double count = 0.0, whole = 0.0, statistic = 0.0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    count += static_cast<double>(counts[i]);
    whole += shares[i];
  }
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const double expected = count * shares[i] / whole;
    ASSERT_GT(expected, 100.0);
    statistic += (static_cast<double>(counts[i]) - expected) * (static_cast<double>(counts[i]) - expected) / expected;
  }
  const boost::math::chi_squared distribution(static_cast<double>(counts.size() - 1));
  EXPECT_LT(statistic, quantile(complement(distribution, 1e-5)));
  EXPECT_GT(statistic, quantile(distribution, 1e-5));
}

std::vector<std::uint64_t> counts_by(const std::vector<Receiver>& receivers, std::size_t cells,
                                     const std::function<std::size_t(const Receiver&)>& cell_of) {
  std::vector<std::uint64_t> counts(cells, 0);
  for (const Receiver& receiver : receivers) ++counts.at(cell_of(receiver));
  return counts;
}

TEST(SampleReceivers, AreTheSameOnEveryMachine) {
  // From a separate computation with Python's integers and a separate implementation of Matsumoto and Nishimura's
  // generator.
  const Scene scene =
      scene_of({polygon({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), polygon({{0, 0, 2}, {3, 0, 2.5}, {3, 1, 2.5}, {0, 1, 2}})});
  const auto receivers = samples_of(scene, 6, 42);
  EXPECT_EQ(receivers[0].point, (Vec3{0x1.4babd9a0b0d7cp+1, 0x1.ebc13264515e2p-1, 0x1.37474ef01d795p+1}));
  EXPECT_EQ(receivers[1].point, (Vec3{0x1.187273d8bae7fp-2, 0x1.8fa32b81059dfp-2, 0}));
  EXPECT_EQ(receivers[4].point, (Vec3{0x1.0f714d13ed6aep-1, 0x1.c8e7d9eeb4942p-2, 0}));
  EXPECT_EQ(receivers[5].point, (Vec3{0x1.03ad44e185a1cp+1, 0x1.d9bd4cdf31f72p-1, 0x1.2b478b7aeb9afp+1}));
  EXPECT_EQ(receivers[4].on, std::vector{FaceId{0}});
  EXPECT_EQ(receivers[5].on, std::vector{FaceId{1}});
}

TEST(SampleReceivers, FacesAreChosenByTheirArea) {
  // Triangles in many planes, with areas of 1/2 |a x b| that have no common unit.
  std::vector<Polygon> faces;
  std::vector<double> areas;
  for (int i = 1; i <= 12; ++i) {
    const double a = 1.0 + i % 5, b = 0.5 * i, c = 0.25 * (i % 3), d = 7.0 * i;
    faces.push_back(polygon({{d, 0, 0}, {d + a, 0, c}, {d, b, 1}}));
    areas.push_back(0.5 * std::sqrt(c * b * (c * b) + a * a + a * b * (a * b)));
  }
  const Scene scene = scene_of(faces);
  const auto receivers = samples_of(scene, 20000);
  expect_shares(counts_by(receivers, faces.size(), [](const Receiver& r) { return index_of(r.on.front()); }), areas);
}

TEST(SampleReceivers, ATriangleIsFilledEvenly) {
  // 64 congruent triangles: by column and row, and by which half of the little square.
  const Scene scene = scene_of({polygon({{0, 0, 0}, {8, 0, 0}, {0, 8, 0}})});
  std::map<std::array<int, 3>, std::uint64_t> cells;
  for (const Receiver& r : samples_of(scene, 20000)) {
    const double column = std::floor(r.point.x), row = std::floor(r.point.y);
    const bool upper = r.point.x - column + (r.point.y - row) > 1.0;
    ++cells[{static_cast<int>(column), static_cast<int>(row), upper ? 1 : 0}];
  }
  ASSERT_EQ(cells.size(), 64U);
  std::vector<std::uint64_t> counts;
  for (const auto& [cell, count] : cells) counts.push_back(count);
  expect_shares(counts, std::vector<double>(64, 1.0));
}

TEST(SampleReceivers, ASeedAlwaysGivesTheSameAndTheFirstOnesDoNotDependOnTheirNumber) {
  const Scene scene = scene_of({window_frame(), letter_l()});
  const auto few = samples_of(scene, 10, 7), many = samples_of(scene, 100, 7), others = samples_of(scene, 10, 8);
  for (std::size_t i = 0; i < few.size(); ++i) {
    EXPECT_EQ(few[i].point, many[i].point);
    EXPECT_EQ(few[i].on, many[i].on);
    EXPECT_EQ(few[i].id, many[i].id);
    EXPECT_NE(few[i].point, others[i].point);
  }
}

TEST(SampleReceivers, OfANonPlanarFaceLieOnItsTriangles) {
  const Scene scene = scene_of({polygon({{0, 0, 0}, {1, 0, 0}, {1, 1, 1}, {0, 1, 0}})});
  ASSERT_EQ(scene.faces()[0].shape, FaceShape::kTriangulated);
  for (const Receiver& r : samples_of(scene, 200)) {
    // The diagonal from the origin: below it z = y, above it z = x.
    EXPECT_NEAR(r.point.z, std::min(r.point.x, r.point.y), 0x1p-52);
    EXPECT_EQ(r.normal, r.point.x > r.point.y ? (Vec3{0, -0.5, 0.5}) : (Vec3{-0.5, 0, 0.5}));
  }
}

TEST(SampleReceivers, ImpossibleCountsAreRefused) {
  const Scene scene = scene_of({letter_l()});
  EXPECT_EQ(validation::complaint([&] { (void)samples_of(scene, 0); }),
            "0 samples (the number of receivers must be between 1 and 4194304); give at least 1");
  EXPECT_EQ(validation::complaint([&] { (void)samples_of(scene, 4194305); }),
            "4194305 samples (the number of receivers must be between 1 and 4194304); use fewer samples");
}

}  // namespace
}  // namespace exactff
