// What a report concludes from a comparison of methods, in words.
#include <gtest/gtest.h>

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "exactff/study.h"
#include "report/report.h"
#include "study/settings.h"

namespace exactff::study {
namespace {

// Ladders whose rungs have these errors and seconds, on a scene whose brightest receiver has radiosity 2.
class Verdicts : public ::testing::Test {
 protected:
  Verdicts() {
    study_.exact.resize(2);
    study_.exact[0].radiosity = {0.5, 2.0, 1.0};
  }
  void add(const std::string& text, const std::vector<std::pair<double, double>>& errors_and_seconds) {
    study_.methods.ladders.push_back(parse_ladder(text));
    ASSERT_EQ(study_.methods.ladders.back().rungs.size(), errors_and_seconds.size());
    for (std::size_t rung = 0; rung < errors_and_seconds.size(); ++rung) {
      MethodCell& cell = study_.methods.cells.emplace_back();
      cell.ladder = study_.methods.ladders.size() - 1;
      cell.rung = rung;
      cell.error.rms = 2.0 * errors_and_seconds[rung].first;
      cell.seconds = errors_and_seconds[rung].second;
    }
  }
  // The default ones.
  void add_exact() { add("exact", {{0.0, 1e-4}}); }
  void add_hemicube() { add("hemicube:resolution=64|128", {{5e-3, 2e-4}, {5e-4, 8e-4}}); }
  void add_wallace() { add("wallace:splits=1|2", {{0.2, 5e-5}, {4e-4, 9e-4}}); }
  void add_control() { add("adaptive-exact-visibility:eps_B=0.1", {{1e-9, 1e-6}}); }

  Study study_;
};

TEST_F(Verdicts, TheCheapestIsTheFastestThatIsRightEnough) {
  add_exact();
  add_hemicube();
  add_wallace();
  add_control();
  const auto name = [&](double wanted, std::optional<std::size_t> ladder = {}) {
    const MethodCell* cell = report::cheapest(study_, wanted, ladder);
    return cell == nullptr ? std::string("none") : report::cell_name(study_, *cell);
  };
  EXPECT_EQ(name(0.3), "wallace, splits 1");
  EXPECT_EQ(name(5e-3), "hemicube, resolution 64") << "at most, not below";
  EXPECT_EQ(name(1e-3), "hemicube, resolution 128");
  EXPECT_EQ(name(4.5e-4), "wallace, splits 2");
  EXPECT_EQ(name(1e-4), "none") << "neither exact nor the control is a rival";
  EXPECT_EQ(name(1e-4, 3), "adaptive, exact V, eps_B 0.1") << "but may be asked for";
  EXPECT_EQ(name(1e-3, 2), "wallace, splits 2");
  study_.methods.cells[2].error.not_a_number = 1;
  EXPECT_EQ(name(1e-3), "wallace, splits 2") << "what is no number is not right";
  study_.methods.cells[4].seconds = kNotTimed;
  EXPECT_EQ(name(1e-3), "none");
}

TEST_F(Verdicts, TheFrontHoldsWhatNobodyBeats) {
  add_exact();
  add_hemicube();
  add_wallace();
  add_control();
  std::vector<std::string> names;
  for (const MethodCell* cell : report::pareto_front(study_)) names.push_back(report::cell_name(study_, *cell));
  EXPECT_EQ(names, (std::vector<std::string>{"wallace, splits 1", "exact"}));
  study_.methods.cells[0].seconds = 1.0;
  names.clear();
  for (const MethodCell* cell : report::pareto_front(study_)) names.push_back(report::cell_name(study_, *cell));
  EXPECT_EQ(names, (std::vector<std::string>{"wallace, splits 1", "hemicube, resolution 64", "hemicube, resolution 128",
                                             "wallace, splits 2", "exact"}));
}

TEST_F(Verdicts, SayWhatTheOthersNeed) {
  add_exact();
  add_hemicube();
  add_wallace();
  add_control();
  EXPECT_EQ(report::method_sentences(study_),
            (std::vector<std::string>{
                "On this scene the exact value takes 100 µs per receiver on average; the fastest other method that is "
                "accurate to 10⁻³ of the brightest receiver (RMS), hemicube, resolution 128, takes 8 times as long, "
                "and no other setting that was run is accurate to 10⁻⁴.",
                report::verdict(study_)}));
}

TEST_F(Verdicts, NameTheErrorFromWhichOnAnotherIsFaster) {
  add_exact();
  add_hemicube();
  add_wallace();
  add_control();
  EXPECT_EQ(report::verdict(study_),
            "Use the exact method (100 µs per receiver) when the RMS error must stay below 20 % of the brightest "
            "receiver; when 20 % will do, use wallace, splits 1, in 50 % of its time.");
}

TEST_F(Verdicts, AreForExactWhereNothingIsAsFast) {
  add_exact();
  EXPECT_NE(report::verdict(study_).find("no other method was run"), std::string::npos) << report::verdict(study_);
  add("hemicube:resolution=64", {{0.05, 2e-4}});
  EXPECT_EQ(report::verdict(study_),
            "Use the exact method whatever error you accept: it takes 100 µs per receiver, and no setting of another "
            "method that was run is as fast.");
}

TEST_F(Verdicts, GrantAMethodThatErrsByRoundingAlone) {
  add_exact();
  add("wallace:splits=1", {{1e-15, 5e-5}});
  EXPECT_EQ(report::verdict(study_),
            "Use wallace, splits 1 in a scene like this, where it errs by rounding alone, in 50 % of its time; use the "
            "exact method (100 µs per receiver) when every digit must be proved.");
}

// What a smaller eps_B does to the RMS error is told in the direction in which it goes.
TEST_F(Verdicts, SayWhetherASmallerToleranceHelps) {
  study_.settings = {{.eps_b = 0.1}, {.eps_b = 0.01}};
  study_.summaries.resize(2);
  study_.samples.resize(2);
  study_.times.resize(2);
  const auto said = [&](double before, double after) {
    study_.summaries[0].radiosity.rms = before;
    study_.summaries[1].radiosity.rms = after;
    std::string found;
    for (const std::string& sentence : report::headlines(study_)) {
      if (sentence.starts_with("Lowering")) found = sentence;
    }
    return found.substr(0, found.find(';'));
  };
  const std::string begin = "Lowering ε_B by a factor of 10, from 0.1 to 0.01, ";
  EXPECT_EQ(said(0.3, 0.1), begin + "lowers the RMS error by a factor of 3");
  EXPECT_EQ(said(0.28, 0.3), begin + "raises the RMS error by a factor of 1.1");
  EXPECT_EQ(said(0.3, 0.3001), begin + "hardly changes the RMS error");
  EXPECT_EQ(said(0.3, 0.0), "") << "no factor";
  EXPECT_EQ(said(0.0, 0.3), "") << "no factor";
}

TEST_F(Verdicts, WarnWhereTheMachineDrifted) {
  EXPECT_EQ(report::drift_warning(study_), "");
  study_.exact_fastest = 0.9;
  study_.exact_slowest = 1.6;
  EXPECT_TRUE(report::drift_warning(study_).starts_with(
      "The machine’s speed drifted while times were measured: the exact method took from 0.9 to 1.6 times its median "
      "time."))
      << report::drift_warning(study_);
}

TEST_F(Verdicts, OfADarkSceneSaySo) {
  study_.exact[0].radiosity = {};
  add_exact();
  EXPECT_NE(report::verdict(study_).find("every form factor of this scene is 0"), std::string::npos);
}

TEST(SlopeWords, SayWhatTheoryExpects) {
  const Ladder random = parse_ladder("area-sampling:pattern=random,samples=4|16");
  const Ladder stratified = parse_ladder("area-sampling:pattern=stratified,samples=4|16");
  const Ladder hemicube = parse_ladder("hemicube:resolution=8|16");
  const auto words = [](const Slope& slope, const Ladder& ladder, Sight sight) {
    const report::SlopeWords said = report::slope_words(slope, ladder, sight);
    return said.fitted + " | " + said.theory;
  };
  EXPECT_EQ(words({-0.51, -0.53, -0.49, 30, 5}, random, Sight::kPartly), "−0.51 (−0.53 to −0.49) | −1/2");
  EXPECT_EQ(words({-0.75, -0.8, -0.7, 30, 5}, stratified, Sight::kPartly),
            "−0.75 (−0.8 to −0.7) | −3/4 with one shadow edge across the source");
  EXPECT_EQ(words({-1.0, -1.0, -1.0, 1, 5}, hemicube, Sight::kVisible), "−1 | ");
  EXPECT_EQ(words({-1.3, -1.31, -1.29, 30, 5}, stratified, Sight::kVisible),
            "−1.3 (−1.3 to −1.3) | −1 where nothing is discontinuous");
}

}  // namespace
}  // namespace exactff::study
