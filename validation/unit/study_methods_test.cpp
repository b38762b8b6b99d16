// The comparison of methods in a study: ladders, budgets, slopes, verdicts; shadow edges and profiles.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>

#include "exactff/study.h"
#include "report/report.h"
#include "report/verdicts.h"
#include "study/ladders.h"
#include "study/method_runs.h"
#include "study/profile.h"
#include "study/settings.h"
#include "study/shadow_edges.h"
#include "study/silent_errors.h"
#include "study/statistics.h"
#include "study/timing.h"
#include "support/complaint.h"
#include "text/escape.h"
#include "text/phrases.h"
#include "unit/study_support.h"

namespace exactff::study {
namespace {

using validation::complaint;
using validation::request_with_methods;
using validation::small_request;
using validation::small_room;

// What is left out, each with its reason.
std::string left_out_text(const std::vector<LeftOut>& left_out) {
  std::string text;
  for (const LeftOut& item : left_out) text += item.what + ": " + item.why + '\n';
  return text;
}

// --- ladders -------------------------------------------------------------------------------------------------

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

TEST(ParseLadder, OfOneRungHasNothingAlongWhichItGoes) {
  const Ladder ladder = parse_ladder("hemicube:resolution=64");
  EXPECT_EQ(ladder.rungs.size(), 1U);
  EXPECT_EQ(ladder.along, "");
  EXPECT_EQ(rung_text(ladder, 0), "");
  EXPECT_EQ(rung_name(ladder, 0), ladder.name);
  EXPECT_EQ(parse_ladder("exact").name, "exact");
}

TEST(ParseLadder, DropsRepetitions) {
  EXPECT_EQ(parse_ladder("hemicube:resolution=64|32|64").rungs.size(), 2U);
  // The centre pattern has one ray, whatever the number of rays is set to.
  EXPECT_EQ(parse_ladder("adaptive:pattern=centre,rays=1|4|16").rungs.size(), 1U);
}

TEST(ParseLadder, RefusesTwoSettingsWithSeveralValues) {
  const std::string said = complaint([] { (void)parse_ladder("nettle:rays=1|4,splits=1|2"); });
  EXPECT_NE(said.find("'rays' and 'splits' of nettle both have several values"), std::string::npos) << said;
}

TEST(ParseLadder, RefusesSeveralSeeds) {
  const std::string said = complaint([] { (void)parse_ladder("area-sampling:seed=1|2"); });
  EXPECT_NE(said.find("--method-seeds"), std::string::npos) << said;
}

TEST(ParseLadder, NamesWhatItDoesNotKnow) {
  EXPECT_NE(complaint([] { (void)parse_ladder("hemicub:resolution=64|32"); }).find("hemicube"), std::string::npos);
  EXPECT_NE(complaint([] { (void)parse_ladder("hemicube:resolutions=64|32"); }).find("resolution"), std::string::npos);
  for (const char* wrong : {"", ":", "hemicube:", "hemicube:resolution", "hemicube:resolution=64|", "hemicube:=3",
                            "hemicube:resolution=64|x", "hemicube:resolution=64|33", "exact|hemicube"}) {
    EXPECT_NE(complaint([&] { (void)parse_ladder(wrong); }), "") << wrong;
  }
}

TEST(DefaultLadders, AreEveryMethodByRisingEffort) {
  const std::vector<Ladder> ladders = default_ladders(20.0);
  std::set<std::string> names, methods;
  for (const Ladder& ladder : ladders) {
    EXPECT_TRUE(names.insert(ladder.name).second) << ladder.name;
    methods.insert(ladder.rungs.front().method->name);
    EXPECT_EQ(ladder.rungs.size() == 1, ladder.along.empty()) << ladder.name;
  }
  EXPECT_EQ(methods, (std::set<std::string>{"exact", "adaptive", "adaptive-exact-visibility", "hemicube", "nettle",
                                            "wallace", "area-sampling"}));
  const auto adaptive = std::ranges::find(ladders, std::string("adaptive, 16 rays"), &Ladder::name);
  ASSERT_NE(adaptive, ladders.end());
  for (std::size_t k = 0; k < adaptive->rungs.size(); ++k) {
    EXPECT_NEAR(adaptive->rungs[k].settings.number("eps_B"), 2.0 * std::pow(10.0, -static_cast<double>(k)), 1e-12);
  }
}

TEST(DefaultLadders, NeedNoLight) {
  for (const Ladder& ladder : default_ladders(0.0)) EXPECT_FALSE(ladder.name.starts_with("adaptive")) << ladder.name;
}

TEST(LeaveOut, TakesLaddersThatCannotShowAnything) {
  const auto left = [](const Sightings& sightings) {
    std::vector<Ladder> ladders = default_ladders(1.0);
    const std::size_t all = ladders.size();
    const auto left_out = leave_out(ladders, sightings);
    EXPECT_EQ(ladders.size() + left_out.size(), all);
    for (const LeftOut& item : left_out) {
      for (const Ladder& ladder : ladders) EXPECT_NE(item.what, "method " + ladder.name);
    }
    return left_out;
  };
  EXPECT_TRUE(left({true, true, 1.0}).empty());
  EXPECT_EQ(left({false, false, 1.0}).size(), default_ladders(1.0).size());
  EXPECT_EQ(left_out_text(left({true, false, 1.0})),
            "method adaptive, exact V: no receiver has a source hidden in part, so that there is no sampling to be "
            "replaced\n");
  EXPECT_EQ(left({true, true, 0.0}).size(), 5U) << "the adaptive ones";
}

// --- choices -------------------------------------------------------------------------------------------------

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

TEST(ChooseReceivers, TakesOthersWhereThereAreTooFew) {
  using enum Sight;
  EXPECT_EQ(choose_receivers(rows_seeing({kPartly, kVisible, kVisible, kVisible, kNothing}), 4),
            (std::vector<std::size_t>{0, 1, 2, 3}));
  EXPECT_EQ(choose_receivers(rows_seeing({kPartly, kPartly, kPartly, kVisible}), 100),
            (std::vector<std::size_t>{0, 1, 2, 3}));
  EXPECT_EQ(choose_receivers(rows_seeing({kPartly, kPartly, kPartly}), 3), (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_TRUE(choose_receivers(rows_seeing({kHidden, kNothing}), 4).empty());
  EXPECT_TRUE(choose_receivers({}, 4).empty());
}

TEST(PlannedSeconds, CountWorkAtFixedPrices) {
  methods::Counters none, rays, exact;
  rays.add("rays", 1000);
  rays.add("leaves", 10);
  const double before = planned_seconds(rays, 3);
  rays.add("leaves: sampled", 10);
  EXPECT_EQ(planned_seconds(rays, 3), before) << "counted among the leaves";
  EXPECT_GT(before, planned_seconds(none, 3));
  EXPECT_GT(planned_seconds(none, 3), 0.0);
  EXPECT_EQ(before, planned_seconds(rays, 3000));
  exact.add("exact V", 1);
  EXPECT_GT(planned_seconds(exact, 3000), planned_seconds(exact, 3)) << "every face may be in the way";
}

TEST(SpreadOrder, IsAPermutationWhoseBeginningsAreSpread) {
  for (std::size_t count = 0; count < 300; ++count) {
    const auto order = spread_order(count);
    EXPECT_EQ(order.size(), count);
    EXPECT_EQ(std::set(order.begin(), order.end()).size(), count);
    EXPECT_TRUE(order.empty() || *std::ranges::max_element(order) == count - 1);
  }
  for (const std::size_t count : {100, 256, 1024, 2310}) {
    const auto order = spread_order(count);
    for (std::size_t first = 8; first <= count; first *= 2) {
      std::vector<std::size_t> places(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(first));
      std::ranges::sort(places);
      std::size_t gap = places.front() + count - places.back();  // around the end
      for (std::size_t k = 1; k < first; ++k) gap = std::max(gap, places[k] - places[k - 1]);
      EXPECT_LE(gap, 6 * count / first) << first << " of " << count;
    }
  }
}

// --- runs ----------------------------------------------------------------------------------------------------

Study study_of(const Scene& scene, const std::vector<std::string>& ladders, const MethodSweep& sweep) {
  Request request = small_request(scene, 2);
  validation::scatter(request);
  request.sweeps.rays = {1};
  request.sweeps.seeds = {1};
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

TEST(Slopes, OfOneSeedHaveNoInterval) {
  const Scene room = small_room(true);
  const Study study = study_of(room, {"nettle:variant=literal,rays=1,splits=1|2|4"}, {.seeds = 1, .receivers = 8});
  const Slope& slope = slope_of(study, study.methods.ladders.front().name, Sight::kVisible);
  EXPECT_EQ(slope.seeds, 1U);
  EXPECT_EQ(slope.low, slope.exponent);
  EXPECT_EQ(slope.high, slope.exponent);
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

// A user-defined method: the exact value plus 1 / n, added as include/README.md explains.
struct OffByOneOverN : methods::Evaluator {
  std::unique_ptr<methods::Evaluator> exact;
  double n = 1.0;
  void look_from(const Receiver& receiver) override { exact->look_from(receiver); }
  methods::Estimate form_factor(const methods::PreparedSource& source) override {
    methods::Estimate estimate = exact->form_factor(source);
    estimate.form_factor += 1.0 / n;
    estimate.counters.add("samples", static_cast<std::uint64_t>(n));
    return estimate;
  }
};

struct OffOnScene : methods::PreparedScene {
  explicit OffOnScene(const Scene& given)
      : PreparedScene(given), exact(methods::method_named("exact").prepare(given)) {}
  std::unique_ptr<methods::PreparedSource> prepare_source(const Selection& selection) const override {
    return exact->prepare_source(selection);
  }
  std::unique_ptr<methods::Evaluator> configure(const Settings& settings) const override {
    auto evaluator = std::make_unique<OffByOneOverN>();
    evaluator->exact = exact->configure(methods::method_named("exact").defaults());
    evaluator->n = settings.number("n");
    return evaluator;
  }
  std::unique_ptr<methods::PreparedScene> exact;
};

TEST(MethodStudy, TakesAUsersMethodLikeAnyOther) {
  methods::add_method({.name = "off-by-one-over-n",
                       .summary = "the exact value plus 1 / n",
                       .source = "",
                       .settings = {number_setting("n", 1.0, 1.0, 1e6, "how little it is off")},
                       .prepare = [](const Scene& scene) { return std::make_unique<OffOnScene>(scene); }});
  const Scene scene = small_room(true);
  Request request = request_with_methods(scene, 1);
  validation::scatter(request);
  request.methods.budget = 1.0;
  request.methods.ladders = {parse_ladder("off-by-one-over-n:n=10|100|1000")};
  const Study study = run(std::move(request));
  ASSERT_EQ(study.methods.cells.size(), 3U);
  const double rho_b = 0.5 * 30.0;  // the channel where the lamp is brightest
  EXPECT_NEAR(study.methods.cells[1].error.rms, rho_b / 100.0, 1e-12);
  ASSERT_TRUE(study.methods.slopes[0].partly.has_value());
  EXPECT_NEAR(study.methods.slopes[0].partly->exponent, -1.0, 1e-9);
}

// A method that returns `value` everywhere.
struct Constant : methods::Evaluator {
  double value = 0.0;
  void look_from(const Receiver&) override {}
  using Evaluator::form_factor;
  methods::Estimate form_factor(const methods::PreparedSource&) override {
    methods::Estimate estimate{value, {}};
    estimate.counters.add("samples", 1);
    return estimate;
  }
};

struct ConstantOnScene : methods::PreparedScene {
  using PreparedScene::PreparedScene;
  std::unique_ptr<methods::Evaluator> configure(const Settings& settings) const override {
    auto evaluator = std::make_unique<Constant>();
    evaluator->value = 1.5;
    if (settings.word("of") == "nan") evaluator->value = std::numeric_limits<double>::quiet_NaN();
    if (settings.word("of") == "inf") evaluator->value = std::numeric_limits<double>::infinity();
    return evaluator;
  }
};

TEST(MethodStudy, CountsValuesThatAreNoNumbersOrLeaveTheRange) {
  methods::add_method({.name = "constant",
                       .summary = "the same everywhere",
                       .source = "",
                       .settings = {word_setting("of", {"one-and-a-half", "nan", "inf"}, "which value")},
                       .prepare = [](const Scene& scene) { return std::make_unique<ConstantOnScene>(scene); }});
  const Scene scene = small_room(true);
  const auto study_with = [&](const std::vector<std::string>& ladders) {
    Request request = request_with_methods(scene, 1);
    validation::scatter(request);
    request.methods.budget = 1.0;
    for (const std::string& ladder : ladders) request.methods.ladders.push_back(parse_ladder(ladder));
    return run(std::move(request));
  };
  const Study sound = study_with({"exact", "hemicube:resolution=16"});
  EXPECT_TRUE(report::range_sentences(sound).empty()) << report::range_sentences(sound).front();
  const Study study = study_with({"exact", "constant:of=nan", "constant:of=inf", "constant"});
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
  SceneBuilder builder("wide");
  const MaterialId lamp = builder.add_material({"lamp", {1, 1, 1}, {1, 1, 1}});
  const auto triangle = [&](const char* name, double z, double size, bool down) {
    const std::uint32_t a = builder.add_vertex({-size, -size, z});
    builder.add_vertex({size, -size, z});
    builder.add_vertex({0, size, z});
    builder.add_face(
        builder.patch(name), lamp,
        {down ? std::vector<std::uint32_t>{a, a + 2, a + 1} : std::vector<std::uint32_t>{a, a + 1, a + 2}});
  };
  triangle("floor", 0.0, 1.0, false);
  triangle("light", 1.0, 1.0, true);
  const Scene scene = builder.build();
  Request request;
  request.scene = &scene;
  request.receivers = grid_receivers(scene, scene.select("floor"), {4, 4});
  request.sources = {scene.select("light")};
  request.sweeps.eps_b = {0.1};
  request.seconds_for_a_time = 0.001;
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

// --- the sweeps' budget --------------------------------------------------------------------------------------

TEST(SweepBudget, DropsTheDearestSettingsAndKeepsTheBase) {
  const Scene room = small_room(true);
  Request request = small_request(room, 1);
  request.sweeps.eps_b = {0.5, 0.05, 0.005};
  request.sweeps.eps_a = {0.0};
  request.sweeps.rays = {1, 16, 256};
  request.sweeps.seeds = {1};
  request.sweeps.patterns = {SamplePattern::kJittered};
  request.sweeps.variants = {Variant::kMended};
  const auto within = [&](double budget) {
    Request asked = request;
    asked.sweep_budget = budget;
    return run(std::move(asked));
  };
  const Study whole = within(1e9);
  ASSERT_EQ(whole.settings.size(), 9U);
  EXPECT_EQ(left_out_text(whole.left_out).find("--sweep-budget"), std::string::npos);
  std::set<std::size_t> counts;
  std::size_t before = 1;
  for (double budget = 0.0; budget < 1.0; budget = std::max(2.0 * budget, 1e-5)) {
    const Study study = within(budget);
    counts.insert(study.settings.size());
    EXPECT_GE(study.settings.size(), before);
    before = study.settings.size();
    EXPECT_TRUE(same_setting(study.settings[study.base], whole.settings[whole.base]));
    EXPECT_EQ(study.samples.size(), study.settings.size());
    const bool complete = study.settings.size() == 9;
    EXPECT_EQ(left_out_text(study.left_out).find("--sweep-budget") == std::string::npos, complete);
    AdaptiveOptions dearest = whole.settings[whole.base];
    dearest.eps_b = 0.005;
    dearest.rays = 256;
    EXPECT_EQ(find_setting(study.settings, dearest).has_value(), complete) << "it goes first";
  }
  EXPECT_TRUE(counts.contains(1) && counts.contains(9) && counts.size() > 3) << "some budgets are in between";
}

// --- silent errors -------------------------------------------------------------------------------------------

TEST(SilentErrors, AddUpToWhatTheFormFactorIsOffBy) {
  // The unit square at z = 1; its left three quarters are visible.
  const auto rectangle = [](double x0, double x1) {
    return Loop{{{x0, 0, 1}, {x1, 0, 1}, {x1, 1, 1}, {x0, 1, 1}}, false};
  };
  PlaneDrawing plane;
  plane.normal = {0, 0, 1};
  plane.source = plane.clipped_source = {rectangle(0, 1)};
  plane.visible = {rectangle(0, 0.75)};
  const auto error = [&](double x0, double x1, LeafReason reason) {
    Leaf leaf;
    std::ranges::copy(rectangle(x0, x1).corners, leaf.corners.begin());
    leaf.corner_count = 4;
    leaf.form_factor = 0.2;
    leaf.reason = reason;
    return judge_leaves({leaf}, {plane}).error;
  };
  EXPECT_NEAR(error(0.5, 1, LeafReason::kSampledVisible), 0.2 * 0.5, 1e-15);
  EXPECT_NEAR(error(0.5, 1, LeafReason::kSampledHidden), -0.2 * 0.5, 1e-15);
  EXPECT_NEAR(error(0, 1, LeafReason::kSampledVisible), 0.2 * 0.25, 1e-15);
  EXPECT_NEAR(error(0.8, 1, LeafReason::kSampledVisible), 0.2, 1e-15);
  EXPECT_NEAR(error(0, 0.5, LeafReason::kSampledHidden), -0.2, 1e-15);
  EXPECT_EQ(error(0, 0.5, LeafReason::kSampledVisible), 0.0);
  EXPECT_EQ(error(0, 1, LeafReason::kEpsF), 0.0) << "not decided by sampling";
}

TEST(SilentErrors, OfAStudyAreSummedUp) {
  const Scene room = small_room(true);
  const Study study = run(small_request(room, 1));
  bool any = false;
  for (std::size_t k = 0; k < study.settings.size(); ++k) {
    double worst = 0.0;
    for (const SampleRow& row : study.samples[k]) {
      worst = std::max(worst, std::abs(row.silent_error));
      EXPECT_TRUE(row.silent_error == 0.0 || row.silent_leaves + row.wrong_leaves > 0);
    }
    EXPECT_EQ(study.summaries[k].silent.worst, worst);
    any = any || worst > 0.0;
  }
  EXPECT_TRUE(any);
}

// --- edges and profiles --------------------------------------------------------------------------------------

// A lamp [-1, 1]^2 at height 2 and half a plane at height 1, x > 0: the floor sees all of the lamp where x < -1 and
// nothing where x > 1.
Scene half_plane() {
  SceneBuilder builder("half plane");
  const MaterialId grey = builder.add_material({"grey", {0.5, 0.5, 0.5}, {}});
  const MaterialId lamp = builder.add_material({"lamp", {0, 0, 0}, {2, 2, 2}});
  const auto rectangle = [&](const char* name, MaterialId material, double x0, double x1, double y, double z,
                             bool down) {
    const std::uint32_t a = builder.add_vertex({x0, -y, z});
    builder.add_vertex({x1, -y, z});
    builder.add_vertex({x1, y, z});
    builder.add_vertex({x0, y, z});
    std::vector<std::uint32_t> ring = {a, a + 1, a + 2, a + 3};
    if (down) std::ranges::reverse(ring);
    builder.add_face(builder.patch(name), material, {ring});
  };
  rectangle("floor", grey, -4, 4, 1, 0, false);
  rectangle("lamp", lamp, -1, 1, 1, 2, true);
  rectangle("half", grey, 0, 50, 50, 1, false);
  return builder.build();
}

// A study up to its exact values, on a grid of the floor.
struct Begun {
  const Scene& scene;
  std::vector<ExactSource> sources;
  Study study;

  explicit Begun(const Scene& of, GridSize size = {8, 2}) : scene(of) {
    study.request.scene = &scene;
    study.request.receivers = grid_receivers(scene, scene.select("floor"), size);
    study.request.sources = scene.emitters();
    study.request.threads = 2;
    sources.emplace_back(scene, scene.select("lamp"));
    for (const Receiver& receiver : study.request.receivers) {
      study.exact.emplace_back().sight = sights(scene, receiver, sources).front();
    }
  }
};

TEST(ShadowEdges, AreWhereTheHalfPlaneCastsThem) {
  const Scene scene = half_plane();
  Begun begun(scene);
  const auto edges = std::get<ShadowEdges>(find_shadow_edges(begun.study.request, begun.sources, {}));
  ASSERT_EQ(edges.distance.size(), 16U);
  EXPECT_GT(edges.resolution, 0.0);
  EXPECT_LT(edges.resolution, 0.05);
  for (std::size_t i = 0; i < 16; ++i) {
    const double x = begun.study.request.receivers[i].point.x;
    const double distance = std::min(std::abs(x - 1), std::abs(x + 1));
    EXPECT_NEAR(edges.distance[i], distance, 0.75 * edges.resolution) << x;
  }
}

TEST(ShadowEdges, AreLeftOutWhereThereAreNone) {
  const auto why = [](const Scene& scene, const auto& change) {
    Begun begun(scene, {2, 2});
    change(begun.study.request.receivers);
    return std::get<LeftOut>(find_shadow_edges(begun.study.request, begun.sources, {})).why;
  };
  const auto nothing = [](const auto&) {};
  EXPECT_NE(why(small_room(false), nothing).find("of one kind all over the face"), std::string::npos);
  const Scene room = small_room(true);
  EXPECT_NE(why(room, [](auto& list) { list[1].cell.reset(); }).find("not one grid"), std::string::npos);
  EXPECT_NE(why(room, [](auto& list) { list[1].cell->lattice = std::make_shared<Lattice>(); }).find("not one grid"),
            std::string::npos);
}

TEST(Profiles, HaveTheirKinksWhereTheHalfPlaneCastsThem) {
  const Scene scene = half_plane();
  Begun begun(scene);
  begun.study.methods.ladders = {parse_ladder("exact"), parse_ladder("hemicube:resolution=8|16|32")};
  const auto profile = std::get<Profile>(find_profile(begun.study, begun.sources, {}));
  EXPECT_EQ(profile.where, "row 1 of floor");
  ASSERT_EQ(profile.receivers.size(), 256U);
  const double start = profile.receivers.front().point.x;
  EXPECT_EQ(start, -4 + 8.0 / 512);
  ASSERT_EQ(profile.kinks.size(), 2U);
  EXPECT_NEAR(profile.kinks[0], -1 - start, 1e-6);
  EXPECT_NEAR(profile.kinks[1], 1 - start, 1e-6);
  ASSERT_EQ(profile.others.size(), 1U);
  EXPECT_EQ(profile.others[0].name, "hemicube, resolution 16");
  for (std::size_t i = 0; i < 256; ++i) {
    EXPECT_NEAR(profile.position[i], profile.receivers[i].point.x - start, 1e-12);
    const double f = exact_form_factor(scene, profile.receivers[i], begun.sources.front()).value;
    EXPECT_DOUBLE_EQ(profile.exact[i], 0.5 * 2 * f);
    EXPECT_NEAR(profile.others[0].radiosity[i], profile.exact[i], 0.1);
  }
}

TEST(Profiles, AreLeftOutWithoutAPenumbra) {
  const Scene room = small_room(false);
  Begun begun(room);
  EXPECT_EQ(std::get<LeftOut>(find_profile(begun.study, begun.sources, {})).what, "penumbra profile");
}

// --- verdicts ------------------------------------------------------------------------------------------------

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
                "For errors below 20 % of the brightest receiver (RMS), the exact method is the fastest: no other "
                "setting that is at least as fast is more accurate than this (best: wallace, splits 1)."}));
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

TEST_F(Verdicts, OfADarkSceneSaySo) {
  study_.exact[0].radiosity = {};
  add_exact();
  EXPECT_NE(report::verdict(study_).find("every form factor of this scene is 0"), std::string::npos);
}

TEST_F(Verdicts, SayThatNoOtherIsRightOrAsFast) {
  add_exact();
  add("hemicube:resolution=64", {{0.05, 2e-4}});
  EXPECT_EQ(report::method_sentences(study_),
            (std::vector<std::string>{"On this scene the exact value takes 100 µs per receiver on average; no other "
                                      "setting that was run is accurate to 10⁻² of the brightest receiver (RMS).",
                                      "No setting of another method is as fast as the exact method."}));
}

TEST_F(Verdicts, SayNothingOfExactAlone) {
  EXPECT_TRUE(report::method_sentences(study_).empty());
  add_exact();
  EXPECT_TRUE(report::method_sentences(study_).empty());
}

TEST_F(Verdicts, OnADarkSceneAnErrorIsNoneOrBeyondMeasure) {
  study_.exact[0].radiosity = {};
  add_hemicube();
  study_.methods.cells[0].error.rms = 0.0;
  EXPECT_EQ(report::relative_error(study_, study_.methods.cells[0]), 0.0);
  EXPECT_TRUE(std::isinf(report::relative_error(study_, study_.methods.cells[1])));
}

TEST(PowersOfTen, AreWrittenAsPeopleDo) {
  EXPECT_EQ(report::power_of_ten(1e-2), "10⁻²");
  EXPECT_EQ(report::power_of_ten(1e-6), "10⁻⁶");
}

TEST(SlopeWords, SayWhetherTheoryAgrees) {
  const Ladder random = parse_ladder("area-sampling:pattern=random,samples=4|16");
  const Ladder stratified = parse_ladder("area-sampling:pattern=stratified,samples=4|16");
  const Ladder hemicube = parse_ladder("hemicube:resolution=8|16");
  const auto words = [](const Slope& slope, const Ladder& ladder, Sight sight) {
    const report::SlopeWords said = report::slope_words(slope, ladder, sight);
    return said.fitted + " | " + said.theory + " | " + said.reason;
  };
  EXPECT_EQ(words({-0.51, -0.53, -0.49, 30, 5}, random, Sight::kPartly), "−0.51 (−0.53 to −0.49) | −1/2 | ");
  EXPECT_EQ(words({-0.75, -0.8, -0.7, 30, 5}, stratified, Sight::kPartly),
            "−0.75 (−0.8 to −0.7) | −3/4 with one shadow edge across the source | ");
  EXPECT_EQ(words({-1.0, -1.0, -1.0, 1, 5}, hemicube, Sight::kVisible), "−1 |  | ");
  const std::string shallow = words({-0.55, -0.56, -0.54, 30, 5}, stratified, Sight::kPartly);
  EXPECT_NE(shallow.find(" | shallower, because "), std::string::npos) << shallow;
  const std::string steep = words({-1.3, -1.31, -1.29, 30, 5}, stratified, Sight::kVisible);
  EXPECT_NE(steep.find("−1 where nothing is discontinuous | steeper, because "), std::string::npos) << steep;
}

}  // namespace
}  // namespace exactff::study
