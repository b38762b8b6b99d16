// What a comparison of methods runs, ladders of settings at chosen receivers, and how its errors are summed up.
#include "kernel/statistics.h"
#include "study/runs.h"
#include "study/settings.h"
#include "study/sight.h"
#include "study/statistics.h"
#include "support/test.h"
#include "text/phrases.h"
#include "unit/reports/study_support.h"

namespace exactff::study {
namespace {

TEST(ParseLadder, TakesSeveralValuesOfOneSetting) {
  const Ladder ladder = parse_ladder(" area-sampling : pattern=stratified , samples = 4|16 | 64");
  EXPECT_EQ(ladder.name, "area, stratified");
  EXPECT_EQ(ladder.along, "samples");
  ASSERT_EQ(ladder.rungs.size(), 3U);
  for (const methods::Choice& rung : ladder.rungs) EXPECT_EQ(rung.settings.word("pattern"), "stratified");
  EXPECT_EQ(ladder.rungs[0].settings.whole("samples"), 4);
  EXPECT_EQ(ladder.rungs[2].settings.whole("samples"), 64);
  EXPECT_EQ(rung_text(ladder, 1), "16");
  EXPECT_EQ(rung_name(ladder, 1), "area, stratified, samples 16");
}

TEST(ParseLadder, NamesWhatItDoesNotKnow) {
  EXPECT_HOLDS(complaint([] { (void)parse_ladder("hemicub:resolution=64|32"); }), "hemicube");
  EXPECT_HOLDS(complaint([] { (void)parse_ladder("hemicube:resolutions=64|32"); }), "resolution");
  for (const char* wrong : {"", ":", "hemicube:", "hemicube:resolution", "hemicube:resolution=64|", "hemicube:=3",
                            "hemicube:resolution=64|x", "hemicube:resolution=64|33", "exact|hemicube"}) {
    EXPECT_NE(complaint([&] { (void)parse_ladder(wrong); }), "") << wrong;
  }
}

std::vector<ExactRow> rows_seeing(const std::vector<Sight>& sights) {
  std::vector<ExactRow> rows(sights.size());
  for (std::size_t i = 0; i < sights.size(); ++i) rows[i].sight = sights[i];
  return rows;
}

TEST(ChooseReceivers, TakesAThirdFromThoseThatSeeAll) {
  std::vector<Sight> sights(100, Sight::kPartly);
  sights.insert(sights.end(), 100, Sight::kVisible);
  sights.insert(sights.begin(), 50, Sight::kHidden);
  const auto chosen = choose_receivers(rows_seeing(sights), 12);
  ASSERT_EQ(chosen.size(), 12U);
  EXPECT_TRUE(std::ranges::is_sorted(chosen));
  EXPECT_EQ(std::set(chosen.begin(), chosen.end()).size(), 12U);
  EXPECT_EQ(std::ranges::count_if(chosen, [](std::size_t i) { return i >= 150; }), 4);
  EXPECT_EQ(std::ranges::count_if(chosen, [](std::size_t i) { return i < 50; }), 0);
  EXPECT_EQ(chosen[0], 50U + 6U) << "evenly: the middles of eighths";
  EXPECT_EQ(chosen[7], 50U + 93U);
}

TEST(Settings, ImpossibleValuesAreInputErrors) {
  const auto refused = [](Sweeps sweeps) { return !complaint([&] { complete(sweeps, {1.0, 1.0, true}); }).empty(); };
  EXPECT_TRUE(refused({.eps_b = {-1.0}}));
  EXPECT_TRUE(refused({.eps_b = {std::numeric_limits<double>::infinity()}}));
  EXPECT_TRUE(refused({.eps_a = {-1.0}}));
  EXPECT_TRUE(refused({.rays = {0}}));
  EXPECT_TRUE(refused({.eps_b = {0.0}, .eps_a = {0.0}}));
  EXPECT_FALSE(refused({.eps_b = {0.0}, .eps_a = {0.1}}));
}

TEST(Statistics, OfErrorsAgreeWithHandValues) {
  const std::vector<double> errors = {3, -4, 0, 0};
  const ErrorStatistics s = error_statistics(errors);
  EXPECT_EQ(s.rms, 2.5);
  EXPECT_EQ(s.mean, -0.25);
  EXPECT_EQ(s.p99, 4);
  EXPECT_EQ(s.worst, 4);
  EXPECT_EQ(s.not_a_number, 0U);
}

// The literal variant of Nettle's method has such errors in scenes of 1e76.
TEST(Statistics, ErrorsNearTheLargestDoubleDoNotOverflow) {
  const std::vector<double> errors = {0x1p1023, 0x1p1023, 0x1.8p1023, -0x1.8p1023};
  const ErrorStatistics s = error_statistics(errors);
  EXPECT_EQ(s.mean, 0x1p1022);
  EXPECT_EQ(s.worst, 0x1.8p1023);
  EXPECT_LE(s.rms, s.worst);
  EXPECT_EQ(kernel::median(errors), 0x1p1023);
  EXPECT_TRUE(std::isfinite(kernel::mean_half_width(errors)));
  EXPECT_NEAR(kernel::mean_half_width(std::vector{0x1p600, -0x1p600}) / kernel::mean_half_width(std::vector{1.0, -1.0}),
              0x1p600, 0x1p550);
}

TEST(Statistics, TheSlopeOfAPowerLawIsItsExponent) {
  const std::vector<std::pair<double, double>> points = {{1, 8}, {4, 4}, {16, 2}, {0, 9}};
  EXPECT_NEAR(kernel::fitted_slope(points).value(), -0.5, 1e-12);
  const std::vector<std::pair<double, double>> one = {{1, 8}, {1, 4}};
  EXPECT_FALSE(kernel::fitted_slope(one).has_value());
}

TEST(Text, DurationsTakeTheUnitThatFits) {
  EXPECT_EQ(text::duration(3.12e-7), "312 ns");
  EXPECT_EQ(text::duration(4.512e-6), "4.51 µs");
  EXPECT_EQ(text::duration(0.0012), "1.2 ms");
  EXPECT_EQ(text::duration(125), "2 min 5 s");
}

TEST(Text, ASharedPartIsNeverRoundedToNoneOrAll) {
  EXPECT_EQ(text::share(0, 10), "0 %");
  EXPECT_EQ(text::share(1, 100000), "under 0.1 %");
  EXPECT_EQ(text::share(99999, 100000), "over 99.9 %");
  EXPECT_EQ(text::share(1, 3), "33.3 %");
  EXPECT_EQ(text::share(3, 3), "100 %");
}

}  // namespace
}  // namespace exactff::study
