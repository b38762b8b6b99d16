// The comparison of methods in a study: values, errors, slopes, methods of users, and what it leaves out.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "exactff/study.h"
#include "report/report.h"
#include "study/settings.h"
#include "study/sight.h"
#include "study/statistics.h"
#include "text/escape.h"
#include "unit/reports/study_support.h"

namespace exactff::study {
namespace {

using validation::left_out_text;
using validation::request_with_methods;
using validation::small_request;
using validation::small_room;

Study study_of(const Scene& scene, const std::vector<std::string>& ladders, const MethodSweep& sweep) {
  Request request = small_request(scene, 2);
  validation::scatter(request);
  request.sweeps.enabled = false;
  request.methods = sweep;
  for (const std::string& text : ladders) request.methods.ladders.push_back(parse_ladder(text));
  return run(std::move(request));
}

const Slope& slope_of(const Study& study, const std::string& ladder, Sight sight) {
  for (std::size_t l = 0; l < study.methods.ladders.size(); ++l) {
    if (study.methods.ladders[l].name != ladder) continue;
    const auto& slope = sight == Sight::kPartly ? study.methods.slopes[l].partly : study.methods.slopes[l].visible;
    if (slope) return *slope;
  }
  static const Slope kNone{NAN, NAN, NAN, 0, 0};
  ADD_FAILURE() << "no slope of " << ladder;
  return kNone;
}

TEST(Slopes, OfAreaSamplingAreThoseOfTheory) {
  const Scene room = small_room(true);
  const Study study = study_of(room,
                               {"area-sampling:pattern=random,samples=4|16|64|256|1024",
                                "area-sampling:pattern=stratified,samples=4|16|64|256|1024", "exact"},
                               {.seeds = 12, .receivers = 12, .budget = 100.0});
  for (const Sight sight : {Sight::kPartly, Sight::kVisible}) {
    const Slope& random = slope_of(study, "area, random", sight);
    EXPECT_NEAR(random.exponent, -0.5, 0.1);
    EXPECT_EQ(random.seeds, 12U);
    EXPECT_EQ(random.rungs, 5U);
    const Slope& stratified = slope_of(study, "area, stratified", sight);
    EXPECT_NEAR(stratified.exponent, sight == Sight::kPartly ? -0.75 : -1.0, 0.1);
    for (const Slope& slope : {random, stratified}) {
      EXPECT_LT(slope.low, slope.exponent);
      EXPECT_GT(slope.high, slope.exponent);
      EXPECT_NEAR(slope.high + slope.low, 2 * slope.exponent, 1e-12);
      EXPECT_LT(slope.high - slope.low, 0.2);
    }
  }
  EXPECT_FALSE(study.methods.slopes.back().partly.has_value()) << "one rung has no slope";
}

TEST(MethodStudy, HoldsEveryRungAtTheChosenReceivers) {
  const Scene room = small_room(true);
  const Study study = study_of(room, {"exact", "hemicube:resolution=8|16|32", "area-sampling:samples=1|4"},
                               {.seeds = 3, .receivers = 5, .budget = 100.0});
  const MethodStudy& methods = study.methods;
  ASSERT_EQ(methods.cells.size(), 6U);
  EXPECT_EQ(methods.receivers, choose_receivers(study.exact, 5));
  EXPECT_EQ(methods.setup_seconds.size(), 3U);
  EXPECT_EQ(methods.slopes.size(), 3U);
  for (const MethodCell& cell : methods.cells) {
    const bool random = cell.ladder == 2;
    EXPECT_EQ(cell.seeds, random ? (std::vector<std::uint64_t>{1, 2, 3}) : std::vector<std::uint64_t>{0});
    std::vector<double> errors;
    for (std::size_t s = 0; s < cell.seeds.size(); ++s) {
      ASSERT_EQ(cell.values[s].size(), 5U);
      for (std::size_t r = 0; r < 5; ++r) {
        // For rho B = (5, 5, 15), the third channel is the largest.
        const double error = cell.values[s][r] - study.exact[methods.receivers[r]].form_factor;
        EXPECT_DOUBLE_EQ(cell.radiosity_errors[s][r], 15.0 * error);
        errors.push_back(cell.radiosity_errors[s][r]);
      }
    }
    EXPECT_EQ(cell.error.rms, error_statistics(errors).rms);
    EXPECT_GT(cell.seconds, 0.0);
    EXPECT_EQ(cell.error.worst == 0.0, cell.ladder == 0) << "exact is exact, nothing else is";
  }
  EXPECT_NE(methods.cells[4].values[0], methods.cells[4].values[1]) << "seeds differ";
  EXPECT_EQ(methods.cells[5].work, 4.0) << "samples";
  ASSERT_EQ(methods.fields.size(), 2U);
  EXPECT_EQ(methods.fields[0].rung, 1U);
  for (const MethodField& field : methods.fields) ASSERT_EQ(field.radiosity_errors.size(), study.exact.size());
  for (std::size_t r = 0; r < 5; ++r) {
    EXPECT_EQ(methods.fields[0].radiosity_errors[methods.receivers[r]], methods.cells[2].radiosity_errors[0][r]);
  }
}

// Every setting of the sweeps is compared with the methods, with as many seeds as the budget allows, but never on one
// or two seeds alone. What was run at every receiver is not run again.
TEST(MethodStudy, HoldsEverySettingOfTheSweeps) {
  const Scene scene = small_room(true);
  Request request = request_with_methods(scene, 2);
  validation::scatter(request);
  request.methods.seeds = 5;
  request.methods.ladders = {parse_ladder("exact"), parse_ladder("adaptive:rays=4,eps_B=0.5|0.1")};
  for (const double budget : {10.0, 1e-9}) {
    request.methods.budget = budget;
    const Study study = run(request);
    std::vector<std::size_t> found(study.settings.size(), 0);
    for (const MethodCell& cell : study.methods.cells) {
      const methods::Choice& rung = study.methods.ladders[cell.ladder].rungs[cell.rung];
      for (const std::size_t k : cell.settings) {
        ++found[k];
        EXPECT_EQ(rung, without_seed(choice_of(study.settings[k])));
        EXPECT_EQ(study.times[k].mean, cell.seconds);
        const std::uint64_t seed = cell.seeds.front() == 0 ? 0 : study.settings[k].seed - 1;
        ASSERT_LT(seed, cell.values.size());
        for (std::size_t r = 0; r < study.methods.receivers.size(); ++r) {
          const SampleRow& row = study.samples[k][study.methods.receivers[r]];
          EXPECT_EQ(cell.values[seed][r], row.form_factor);
          EXPECT_EQ(cell.radiosity_errors[seed][r], row.radiosity_error);
        }
      }
      const bool stochastic = rung.method->stochastic(rung.settings);
      EXPECT_EQ(cell.seeds.size(), !stochastic ? 1U : budget > 1.0 ? 5U : 3U);
    }
    EXPECT_EQ(found, std::vector<std::size_t>(study.settings.size(), 1)) << "each setting once, whatever its seed";
    const Ladder& line = study.methods.ladders[budget > 1.0 ? 1 : 0];
    ASSERT_EQ(line.name, "adaptive, 4 rays");
    EXPECT_EQ(line.rungs.size(), 3U) << "0.5, 0.1, and 0.05 of the sweeps";
    EXPECT_EQ(rung_text(line, 2), "0.05");
  }
}

// A method of a user, added as methods.h explains: what a function makes of the exact method.
using Made =
    std::function<methods::Estimate(methods::Evaluator& exact, const methods::PreparedSource&, const Settings&)>;

struct MadeOfExact : methods::Evaluator {
  std::unique_ptr<methods::Evaluator> exact;
  Settings settings;
  Made made;
  void look_from(const Receiver& receiver) override { exact->look_from(receiver); }
  using Evaluator::form_factor;
  methods::Estimate form_factor(const methods::PreparedSource& source) override {
    return made(*exact, source, settings);
  }
};

struct MadeOnScene : methods::PreparedScene {
  MadeOnScene(const Scene& given, Made function)
      : PreparedScene(given), exact(methods::method_named("exact").prepare(given)), made(std::move(function)) {}
  std::unique_ptr<methods::PreparedSource> prepare_source(const Selection& selection) const override {
    return exact->prepare_source(selection);
  }
  std::unique_ptr<methods::Evaluator> configure(const Settings& settings) const override {
    auto evaluator = std::make_unique<MadeOfExact>();
    evaluator->exact = exact->configure(methods::method_named("exact").defaults());
    evaluator->settings = settings;
    evaluator->made = made;
    return evaluator;
  }
  std::unique_ptr<methods::PreparedScene> exact;
  Made made;
};

void add_users_method(const std::string& name, const std::vector<SettingSpec>& settings, const Made& made) {
  methods::add_method(
      {.name = name, .summary = "of a test", .source = "", .settings = settings, .prepare = [made](const Scene& scene) {
         return std::make_unique<MadeOnScene>(scene, made);
       }});
}

// Of these ladders alone, with a little work.
Study study_of_ladders(const Scene& scene, const std::vector<std::string>& ladders, double budget = 1.0) {
  Request request = request_with_methods(scene, 1);
  validation::scatter(request);
  request.methods.budget = budget;
  request.sweeps.enabled = false;
  request.seconds_for_a_time = 0.02;
  for (const std::string& ladder : ladders) request.methods.ladders.push_back(parse_ladder(ladder));
  return run(std::move(request));
}

TEST(MethodTimes, AreMultiplesOfTheExactMethods) {
  add_users_method("three-times-exact", {}, [](auto& exact, const auto& source, const auto&) {
    for (int k = 0; k < 2; ++k) (void)exact.form_factor(source);
    return exact.form_factor(source);
  });
  const Scene scene = small_room(true);
  const Study study = study_of_ladders(scene, {"exact", "three-times-exact"}, 0.005);
  ASSERT_EQ(study.methods.cells.size(), 2U);
  const MethodCell &exact = study.methods.cells[0], &thrice = study.methods.cells[1];
  EXPECT_EQ(exact.seconds, study.exact_time.mean);
  EXPECT_EQ(exact.seconds_partly, study.exact_time.mean_partly);
  EXPECT_NEAR(thrice.seconds / exact.seconds, 3.0, 1.2) << "on a busy machine, too";
  EXPECT_LE(thrice.ratio_low, thrice.seconds / exact.seconds);
  EXPECT_GE(thrice.ratio_high, thrice.seconds / exact.seconds);
}

TEST(MethodStudy, TakesAUsersMethodLikeAnyOther) {
  add_users_method("off-by-one-over-n", {number_setting("n", 1.0, 1.0, 1e6, "how little it is off")},
                   [](auto& exact, const auto& source, const Settings& settings) {
                     methods::Estimate estimate = exact.form_factor(source);
                     estimate.form_factor += 1.0 / settings.number("n");
                     estimate.counters.add("samples", static_cast<std::uint64_t>(settings.number("n")));
                     return estimate;
                   });
  const Scene scene = small_room(true);
  const Study study = study_of_ladders(scene, {"off-by-one-over-n:n=10|100|1000"});
  ASSERT_EQ(study.methods.cells.size(), 3U);
  const double rho_b = 0.5 * 30.0;  // the channel where the lamp is brightest
  EXPECT_NEAR(study.methods.cells[1].error.rms, rho_b / 100.0, 1e-12);
  ASSERT_TRUE(study.methods.slopes[0].partly.has_value());
  EXPECT_NEAR(study.methods.slopes[0].partly->exponent, -1.0, 1e-9);
}

TEST(MethodStudy, CountsValuesThatAreNoNumbersOrLeaveTheRange) {
  add_users_method("constant", {word_setting("of", {"one-and-a-half", "nan", "inf"}, "which value")},
                   [](auto&, const auto&, const Settings& settings) {
                     methods::Estimate estimate{1.5, {}};
                     if (settings.word("of") == "nan") estimate.form_factor = std::numeric_limits<double>::quiet_NaN();
                     if (settings.word("of") == "inf") estimate.form_factor = std::numeric_limits<double>::infinity();
                     estimate.counters.add("samples", 1);
                     return estimate;
                   });
  const Scene scene = small_room(true);
  const Study sound = study_of_ladders(scene, {"exact", "hemicube:resolution=16"});
  EXPECT_TRUE(report::range_sentences(sound).empty()) << report::range_sentences(sound).front();
  const Study study = study_of_ladders(scene, {"exact", "constant:of=nan", "constant:of=inf", "constant"});
  const std::vector<std::string> sentences = report::range_sentences(study);
  ASSERT_EQ(sentences.size(), 3U);
  EXPECT_TRUE(sentences[0].starts_with("6 of 6 values of constant, nan are not finite numbers; ")) << sentences[0];
  EXPECT_TRUE(sentences[1].starts_with("6 of 6 values of constant, inf are not finite numbers; ")) << sentences[1];
  EXPECT_EQ(
      sentences[2],
      "6 of 6 values of constant lie outside [0, 1], by at most 0.5; the cause is the method’s formula, not rounding.");
  for (const MethodCell& cell : study.methods.cells) {
    const bool is_number = report::is_exact(study, cell) || cell.ladder == 3;
    EXPECT_EQ(std::isfinite(report::relative_error(study, cell)), is_number);
  }
  EXPECT_EQ(report::cheapest(study, 1e-2), nullptr) << "a method without numbers is right to nothing";
  for (const MethodCell* cell : report::pareto_front(study))
    EXPECT_TRUE(std::isfinite(report::relative_error(study, *cell)));
  report::StudyReport report;
  report.scenes.push_back({"", "room", study});
  report::Pages pages;
  pages.scenes.emplace_back();
  const std::string page = report::report_page(report, pages);
  for (const std::string& sentence : sentences) EXPECT_NE(page.find("<p>" + text::html(sentence)), std::string::npos);
}

TEST(MethodStudy, EndsALadderWhereItsBudgetEnds) {
  const Scene room = small_room(true);
  const std::vector<std::string> ladders = {"area-sampling:pattern=random,samples=1|100|100000",
                                            "hemicube:resolution=1024", "exact"};
  const Study study = study_of(room, ladders, {.seeds = 2, .receivers = 4, .budget = 1e-3});
  ASSERT_EQ(study.methods.ladders.size(), 2U) << "the hemicube is beyond the budget from the start";
  EXPECT_EQ(study.methods.ladders[1].name, "exact");
  ASSERT_EQ(study.methods.cells.size(), 3U);
  EXPECT_EQ(study.methods.cells[2].ladder, 1U);
  EXPECT_EQ(study.methods.setup_seconds.size(), 2U);
  const std::string said = left_out_text(study.left_out);
  EXPECT_NE(said.find("method area, random, samples 100000: "), std::string::npos) << said;
  EXPECT_NE(said.find("method hemicube, resolution 1024: "), std::string::npos) << said;
  EXPECT_NE(said.find("--method-budget"), std::string::npos);
}

TEST(MethodStudy, TellsWhichMethodRefusesTheScene) {
  const Scene scene = small_room(true);
  Request request = small_request(scene, 1);
  validation::scatter(request);
  request.sweeps.enabled = false;
  request.methods.enabled = true;
  methods::Method picky = methods::method_named("hemicube");
  picky.name = "picky";
  picky.prepare = [](const Scene&) -> std::unique_ptr<methods::PreparedScene> {
    throw InputError(Problem{{}, 0, "no scene will do", "of all there are", {}});
  };
  request.methods.ladders = {{"picky", "", {{&picky, picky.defaults()}}}, parse_ladder("exact")};
  const Study study = run(std::move(request));
  ASSERT_EQ(study.methods.ladders.size(), 1U);
  EXPECT_NE(left_out_text(study.left_out).find("method picky: no scene will do"), std::string::npos);
}

}  // namespace
}  // namespace exactff::study
