// Interim analyses of a function at random points: means over parts of different weights, and how many points they
// take.
#include "view_factors/interim_analyses.h"

#include "kernel/split_mix.h"
#include "kernel/vec.h"
#include "support/test.h"
#include "view_factors/exact_scene.h"
#include "view_factors/prepared_patch.h"
#include "view_factors/sampled_factor.h"
#include "view_factors/strata.h"

namespace exactff::view_factors {
namespace {

constexpr double kRisk = 1e-6;
constexpr std::uint64_t kAnyEffort = std::uint64_t{1} << 62;

// 1 on a strip of each part's x, 0 elsewhere.
class Strip : public SampledFunction {
 public:
  Strip(std::vector<Part> parts, const Units& units, double from, double to)
      : SampledFunction(std::move(parts)), units_(units), from_(from), to_(to) {}
  [[nodiscard]] double range(const Tile&) override { return 1.0; }
  [[nodiscard]] std::optional<double> at(const Point& point, std::size_t) override {
    ++points_;
    const double x = std::ldexp(point.at.x, static_cast<int>(units_.exponent + units_.shift));
    return x >= from_ && x < to_ ? 1.0 : 0.0;
  }
  [[nodiscard]] std::uint64_t effort() const override { return 300 * points_; }

 private:
  const Units& units_;
  double from_, to_;
  std::uint64_t points_ = 0;
};

class AnalysesOfStrips : public testing::Test {
 protected:
  AnalysesOfStrips() : scene_(build()), exact_(scene_) {}
  static Scene build() {
    PlainScene plain;
    plain.add_ring(plain.patch("left"), {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    plain.add_ring(plain.patch("right"), {{2, 0, 0}, {3, 0, 0}, {2.5, 2, 0}});
    return generate::build(plain);
  }
  // A square and a triangle of area 1 each.
  [[nodiscard]] std::vector<Part> parts(double left, double right) const {
    std::vector<Part> result;
    for (const auto& [name, weight] : {std::pair("left", left), std::pair("right", right)}) {
      result.push_back(parts_of(exact_, scene_.select(name)).front());
      result.back().weight = weight;
    }
    return result;
  }

  const Scene scene_;
  const ExactScene exact_;
};

TEST_F(AnalysesOfStrips, HoldTheirMeansWhateverThePartsWeigh) {
  for (const auto& [left, right] : {std::pair(1.0, 1.0), std::pair(1e-6, 1.0), std::pair(3.0, 0.25)}) {
    for (const double width : {0.001, 0.1, 0.5}) {
      // Of the square alone, and all of both.
      Strip strip(parts(left, right), exact_.units, 0.25, 0.25 + width);
      Strip all(parts(left, right), exact_.units, -1.0, 4.0);
      const double mean = width * left / (left + right);
      InterimAnalyses analyses(strip, exact_.units, kRisk, 0);
      for (int analysis = 0; analysis < 3; ++analysis) {
        const InterimAnalyses::Mean found = analyses.analyse();
        EXPECT_LE(std::abs(found.value - mean), found.error) << left << ' ' << width;
        EXPECT_LE(found.error, 0.6);
        (void)analyses.prepare(0.5 * found.error, kAnyEffort, 20000);
      }
      InterimAnalyses of_all(all, exact_.units, kRisk, 0);
      EXPECT_NEAR(of_all.analyse().value, 1.0, 1e-12);
    }
  }
}

// Analyses before, of which the risk is one with theirs, make them wider.
TEST_F(AnalysesOfStrips, AreWiderAfterOthers) {
  Strip strip(parts(1.0, 1.0), exact_.units, 0.25, 0.5);
  InterimAnalyses first(strip, exact_.units, kRisk, 0), later(strip, exact_.units, kRisk, 100);
  EXPECT_EQ(later.count(), 100U);
  EXPECT_LT(first.analyse().error, later.analyse().error);
  EXPECT_EQ(later.count(), 101U);
}

// 0 or 1 at each place, whatever it is nearby.
class Noise : public SampledFunction {
 public:
  Noise(std::vector<Part> parts, std::uint64_t seed) : SampledFunction(std::move(parts)), seed_(seed) {}
  [[nodiscard]] double range(const Tile&) override { return 1.0; }
  [[nodiscard]] std::optional<double> at(const Point& point, std::size_t) override {
    const std::uint64_t bits = std::bit_cast<std::uint64_t>(point.at.x) ^ std::bit_cast<std::uint64_t>(point.at.y) << 1;
    return kernel::split_mix(seed_, bits) >> 63 == 0 ? 0.0 : 1.0;
  }
  [[nodiscard]] std::uint64_t effort() const override { return 0; }

 private:
  std::uint64_t seed_;
};

TEST_F(AnalysesOfStrips, DoNotTakeNoiseForKnown) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Noise noise(parts(1.0, 1.0), seed);
    InterimAnalyses analyses(noise, exact_.units, kRisk, 0);
    for (const std::size_t points : {0, 2000, 10000}) {
      const bool is_prepared = points == 0 || analyses.prepare_for_all(points);
      ASSERT_TRUE(is_prepared);
      const InterimAnalyses::Mean found = analyses.analyse();
      EXPECT_LE(std::abs(found.value - 0.5), found.error) << seed;
      // Five standard errors of points that are independent; half of each square at least is left by any control
      // variate.
      EXPECT_GT(found.error, 5.0 * 0.5 / std::sqrt(2.0 * static_cast<double>(analyses.strata()))) << seed;
    }
  }
}

// No interval is narrower than what is proved of the point factor asks for, however much the points agree.
TEST(SampledMean, IsAsWideAsWhatIsProvedSays) {
  PlainScene plain;
  plain.add_ring(plain.patch("below"), {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  plain.add_ring(plain.patch("above"), {{0, 1, 1}, {1, 1, 1}, {1, 0, 1}, {0, 0, 1}});
  const Scene scene = generate::build(plain);
  const ExactScene exact(scene);
  const PreparedPatch below(exact, scene.select("below"), Columns::kPatches);
  const PreparedPatch above(exact, scene.select("above"), Columns::kPatches);
  SampledMean mean(exact, below, above, 20000, 1.0);
  constexpr double kTruth = 0.19982489569838746;
  double last = 1.0;
  for (int analysis = 0; analysis < 3; ++analysis) {
    ASSERT_TRUE(mean.analyse(kAnyEffort));
    const double width = mean.upper() - mean.lower();
    EXPECT_LE(mean.lower(), kTruth);
    EXPECT_GE(mean.upper(), kTruth);
    EXPECT_LT(width, last);
    last = width;
  }
  EXPECT_LT(last, 1e-3);
  // Of 20,000 points in any number of analyses.
  EXPECT_FALSE(mean.may_reach(1e-7, kAnyEffort));
  EXPECT_TRUE(mean.may_reach(last, kAnyEffort));
}

}  // namespace
}  // namespace exactff::view_factors
