// The study as a whole: values, tables, threads, what it refuses.
#include "report/report.h"
#include "study/settings.h"
#include "study/sight.h"
#include "study/statistics.h"
#include "support/test.h"
#include "text/escape.h"
#include "unit/reports/study_support.h"

namespace exactff::study {
namespace {

using validation::value_tables;

TEST(Study, ValueTablesAreTheSameBytesForAnyNumberOfThreads) {
  const Study two = run(request_with_methods(*whole_study().request.scene, 2));
  expect_same_values(whole_study(), two, "");
  for (const auto& [file, text] : value_tables(two)) EXPECT_EQ(text.find("thread"), std::string::npos) << file;
}

TEST(Study, TablesReadBackToTheSameBytes) {
  const TemporaryDirectory directory;
  for (const report::StudyTable& one : report::tables()) {
    const table::Table made = one.make(whole_study());
    for (const char* extension : {".csv", ".npz", ".jsonl"}) {
      const auto file = directory.path() / (std::string(one.file) + extension);
      table::write(made, file);
      EXPECT_EQ(table::csv_text(table::read(file)), table::csv_text(made)) << file;
    }
  }
}

TEST(Study, RadiosityAddsOverTheSources) {
  const Scene scene = small_room(true);
  Request request = small_request(scene, 1);
  request.sources = {scene.select("lamp"), scene.select("plate")};
  const Study both = run(std::move(request));
  for (std::size_t i = 0; i < both.exact.size(); ++i) {
    ASSERT_EQ(both.exact[i].terms.size(), 2U);
    const double lamp = both.exact[i].terms[0].value, plate = both.exact[i].terms[1].value;
    EXPECT_EQ(lamp, small_study().exact[i].form_factor);
    EXPECT_DOUBLE_EQ(both.exact[i].form_factor, lamp + plate);
    EXPECT_DOUBLE_EQ(both.exact[i].radiosity.b, 0.5 * (30 * lamp + 1 * plate));
  }
}

// Sums and means of such radiosities would overflow, and the tables would contain inf or nan.
TEST(Study, RefusesSourcesNearTheLargestDouble) {
  SceneBuilder builder("blinding");
  for (const Vec3& v : {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) builder.add_vertex(v);
  const MaterialId grey = builder.add_material({"grey", {0.5, 0.5, 0.5}, {}});
  const MaterialId blinding = builder.add_material({"blinding", {}, {1e308, 1e308, 1e308}});
  builder.add_face(builder.patch("floor"), grey, {{0, 1, 2}});
  builder.add_face(builder.patch("lamp"), blinding, {{0, 3, 1}});
  const Scene scene = builder.build();
  EXPECT_HOLDS(complaint([&] { (void)run(small_request(scene, 1)); }), "reduce the emissions");
}

// Its recursion would take years: the probes of the budget stop early and report this.
TEST(Study, RefusesABaseSettingThatWouldNotEnd) {
  const Scene scene = small_room(true);
  Request request = small_request(scene, 1);
  request.receivers = grid_receivers(scene, scene.select("floor"), {40, 40});
  request.sweeps = {.eps_b = {1e-300}, .rays = {4}, .seeds = {1}};
  const std::string said = complaint([&] { (void)run(request); });
  EXPECT_HOLDS(said, "would take more than");
  EXPECT_HOLDS(said, "use a larger --eps-b");
}

TEST(SweepBudget, DropsTheDearestSettingsAndKeepsTheBase) {
  const Scene room = small_room(true);
  Request request = small_request(room, 1);
  request.sweeps = {{0.5, 0.05, 0.005}, {0.0}, {1, 16, 256}, {1}, {SamplePattern::kJittered}, {Variant::kMended}};
  request.sweep_budget = 1e9;
  const Study whole = run(request);
  AdaptiveOptions dearest = whole.settings[whole.base];
  dearest.eps_b = 0.005;
  dearest.rays = 256;
  std::set<std::size_t> counts{whole.settings.size()};
  std::size_t before = 1;
  for (double budget = 0.0; budget < 1.0; budget = std::max(2.0 * budget, 1e-5)) {
    request.sweep_budget = budget;
    const Study study = run(request);
    counts.insert(study.settings.size());
    EXPECT_GE(study.settings.size(), std::exchange(before, study.settings.size()));
    EXPECT_EQ(study.settings[study.base], whole.settings[whole.base]);
    EXPECT_EQ(study.samples.size(), study.settings.size());
    const bool complete = study.settings.size() == 9;
    EXPECT_EQ(complete, std::ranges::none_of(study.left_out,
                                             [](const LeftOut& one) { return holds(one.why, "--sweep-budget"); }));
    EXPECT_EQ(find_setting(study.settings, dearest).has_value(), complete) << "it goes first";
  }
  EXPECT_TRUE(counts.contains(1) && counts.contains(9) && counts.size() > 3) << "some budgets are in between";
}

// --- The comparison of methods in a study: values, errors, slopes, methods of users, and what it leaves out ---

Study study_of(const Scene& scene, const std::vector<std::string>& ladders, const MethodSweep& sweep) {
  Request request = small_request(scene, 2);
  validation::scatter(request);
  request.sweeps.enabled = false;
  request.methods = sweep;
  for (const std::string& text : ladders) request.methods.ladders.push_back(parse_ladder(text));
  return run(std::move(request));
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

// A method of a user, added as include/README.md explains: what a function makes of the exact method.
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
  const std::string page = report::report_page(report, std::vector<report::Page>(1));
  for (const std::string& sentence : sentences) EXPECT_HOLDS(page, "<p>" + text::html(sentence));
}

TEST(MethodStudy, TellsWhichMethodRefusesTheScene) {
  const Scene scene = small_room(true);
  methods::Method picky = methods::method_named("hemicube");
  picky.name = "picky";
  picky.prepare = [](const Scene&) -> std::unique_ptr<methods::PreparedScene> {
    throw InputError(Problem{{}, 0, "no scene will do", "of all there are", {}});
  };
  Request request = request_with_methods(scene, 1);
  validation::scatter(request);
  request.sweeps.enabled = false;
  request.methods.ladders = {{"picky", "", {{&picky, picky.defaults()}}}, parse_ladder("exact")};
  const Study study = run(std::move(request));
  ASSERT_EQ(study.methods.ladders.size(), 1U);
  EXPECT_TRUE(std::ranges::any_of(study.left_out, [](const LeftOut& one) {
    return one.what == "method picky" && holds(one.why, "no scene will do");
  }));
}

}  // namespace
}  // namespace exactff::study
