#include "stress/stress.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <set>
#include <sstream>

#include "stress/families.h"
#include "support/program.h"

namespace exactff::stress {
namespace {

using validation::run_program;
using validation::TemporaryDirectory;

TEST(StressClosedForm, TurnsWithTheAxesAndTheNormal) {
  for (int axis = 0; axis < 3; ++axis) {
    for (double sign : {-1.0, 1.0}) {
      const double length = 3.0 * sign;
      ClosedForm form({axis == 0 ? length : 0, axis == 1 ? length : 0, axis == 2 ? length : 0});
      form.add({axis, Rational(sign), {0, 1}, {0, 1}});
      EXPECT_EQ(form.value().decimals(30), "0.138531605994892996780769708634") << axis << ' ' << sign;
    }
  }
}

TEST(StressDoubleFormulas, LoseDigitsInTheKnownOrder) {
  const double h = 1e-2;
  const Vec3 x{100, 37, -50};
  const std::vector<Polygon> region = {{{0, 0, 0}, {0, h, 0}, {h, h, 0}, {h, 0, 0}}};
  ClosedForm form(kUp);
  form.add({2, 50, {Rational(-100), Rational(h) - 100}, {Rational(-37), Rational(h) - 37}});
  const double truth = form.value().nearest().value();
  const auto error = [&](AngleFormula formula) {
    return std::abs(form_factor_in_double(region, x, kUp, formula) / truth - 1);
  };
  EXPECT_GT(error(AngleFormula::kAcos), 1e-6);
  EXPECT_LT(error(AngleFormula::kAtan2), 1e-6);
  EXPECT_GT(error(AngleFormula::kAtan2), 1e-10);
  EXPECT_LT(error(AngleFormula::kAtan2Difference), 1e-10);
}

Row row_with_error(double stiffness, double error) {
  Row row;
  row.stiffness = stiffness;
  row.status = Status::kCertified;
  row.agrees = true;
  for (Answer& answer : row.answers) answer.error = error;
  return row;
}

TEST(StressJudgement, AMethodIsUsableUpToItsFirstFailure) {
  FamilyResult result;
  for (const auto& [stiffness, error] : {std::pair{1.0, 1e-9}, {10.0, 1e-5}, {100.0, 0.1}, {1000.0, 1e-9}}) {
    result.rows.push_back(row_with_error(stiffness, error));
  }
  EXPECT_EQ(usable_up_to(result, Method::kAcos, 1e-3), 10.0);
  EXPECT_EQ(usable_up_to(result, Method::kAcos, 1e-6), 1.0);
  EXPECT_EQ(usable_up_to(result, Method::kAcos, 1e-12), 0.0);
  EXPECT_EQ(usable_up_to(result, Method::kAcos, 1.0), 1000.0);
  EXPECT_EQ(reaches_text(result, Method::kAcos), "10 · 1 · –");
}

// F is 1e-6 there: an error of 2 % of it is far within a tolerance that is absolute.
TEST(StressJudgement, TampierisAlgorithmIsJudgedByItsTolerance) {
  FamilyResult result;
  for (const double stiffness : {1.0, 10.0, 100.0}) {
    Row& row = result.rows.emplace_back(row_with_error(stiffness, 0.02));
    row.tolerance = 1e-7;
    row.truth = Enclosure::of(1e-6);
    row.answers[static_cast<std::size_t>(Method::kAdaptive)].value = 1.02e-6;
  }
  EXPECT_EQ(kept_up_to(result, Method::kAdaptive), 100.0);
  EXPECT_EQ(reaches_text(result, Method::kAdaptive), "all");
  EXPECT_EQ(usable_up_to(result, Method::kAdaptive, 1e-3), 0.0) << "relative to F it is not";
  result.rows[1].answers[static_cast<std::size_t>(Method::kAdaptive)].value = 1.2e-6;
  EXPECT_EQ(kept_up_to(result, Method::kAdaptive), 1.0);
  result.rows[1].answers[static_cast<std::size_t>(Method::kAdaptive)].refused = true;
  EXPECT_EQ(reaches_text(result, Method::kAdaptive), "1 (refused)");
}

TEST(StressJudgement, ADisagreementIsNotSound) {
  Report report;
  report.families.push_back({{}, {row_with_error(1, 0), row_with_error(2, 0)}});
  EXPECT_TRUE(report.sound());
  report.families[0].rows[1].agrees = false;
  EXPECT_FALSE(report.sound());
  report.families[0].rows[1].agrees = true;
  report.families[0].rows[1].status = Status::kNotCertified;
  EXPECT_FALSE(report.sound());
}

TEST(StressFamilies, HaveNamesOfTheirOwnAndRiseFromABenignStart) {
  std::set<std::string_view> names, titles;
  for (const Family& family : all_families()) {
    EXPECT_TRUE(names.insert(family.info.name).second) << family.info.name;
    EXPECT_TRUE(titles.insert(family.info.title).second) << family.info.title;
    EXPECT_EQ(family.stiffnesses.front(), 1.0) << family.info.name;
    for (std::size_t i = 1; i < family.stiffnesses.size(); ++i) {
      EXPECT_LT(family.stiffnesses[i - 1], family.stiffnesses[i]) << family.info.name;
    }
  }
  EXPECT_GE(names.size(), 30U);
}

bool has_closed_form(const Case& scene_case) { return scene_case.truth.has_value(); }

TEST(StressFamilies, SayWhatTheirTruthRestsOn) {
  for (const Family& family : all_families()) {
    EXPECT_EQ(has_closed_form(family.make(1)), family.info.evidence != Evidence::kCertified) << family.info.name;
  }
}

// Compares the exact value with the closed form at the start, in the middle and as far as a short test allows.
class StressFamily : public testing::TestWithParam<std::size_t> {};

TEST_P(StressFamily, ExactValueIsWhatTheTruthRoundsTo) {
  const Family& family = all_families()[GetParam()];
  constexpr std::size_t kMostFaces = 200;
  for (double stiffness : family.stiffnesses) {
    const Case scene_case = family.make(stiffness);
    if (scene_case.scene.faces().size() > kMostFaces) break;
    const ExactSource source(scene_case.scene, scene_case.scene.select("source"));
    const FormFactor result =
        exact_form_factor(scene_case.scene, scene_case.receiver, source, {.engine = Engine::kBoth});
    ASSERT_NE(result.status, Status::kNotCertified) << stiffness;
    if (!scene_case.truth) continue;
    const Enclosure truth = scene_case.truth->value();
    ASSERT_EQ(truth.nearest(), result.value) << stiffness;
    ASSERT_TRUE(truth.overlaps(result.enclosure)) << stiffness;
    ASSERT_EQ(result.status == Status::kZero, truth.upper() == 0.0) << stiffness;
  }
}

INSTANTIATE_TEST_SUITE_P(All, StressFamily, testing::Range<std::size_t>(0, all_families().size()),
                         [](const testing::TestParamInfo<std::size_t>& tested) {
                           std::string name(all_families()[tested.param].info.name);
                           std::erase(name, '-');
                           return name;
                         });

std::string values_of(const Report& report) {
  std::string text;
  for (const StressTable& table : tables()) {
    if (table.file != "timings.csv") text += table::csv_text(table.make(report));
  }
  return text;
}

TEST(Stress, ValuesDoNotDependOnTheNumberOfThreads) {
  const std::vector<std::string> some = {"overlap", "horizon-ulp"};
  const Report one = run({some, 1, {}});
  EXPECT_TRUE(one.sound());
  EXPECT_EQ(values_of(one), values_of(run({some, 3, {}})));
}

TEST(Stress, AnUnknownFamilyIsAnInputErrorThatNamesTheKnownOnes) {
  try {
    (void)run({{"cracks"}, 1, {}});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("'cracks'"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("crack-ulp"), std::string::npos);
  }
}

// Cancelled after `rows` finished scenes.
Report interrupted_run(std::size_t rows, const std::vector<std::string>& families) {
  std::atomic<std::size_t> done = 0;
  return run({families, 1, {}}, {[&](const Progress& p) { done = p.done; }, [&] { return done >= rows; }});
}

TEST(Stress, KeepsTheFamiliesThatAreFinishedWhenItIsCancelled) {
  const Report whole = run({{"overlap"}, 1, {}});
  const std::size_t rows = whole.families.front().rows.size();
  const Report report = interrupted_run(rows, {"overlap", "shrink", "crack"});
  ASSERT_EQ(report.families.size(), 1U);
  std::string values = values_of(report);
  const std::string said = R"("unfinished":["shrink","crack"],)";
  for (std::size_t at = 0; (at = values.find(said)) != std::string::npos;) values.erase(at, said.size());
  EXPECT_EQ(values, values_of(whole));
  EXPECT_EQ(report.unfinished, (std::vector<std::string>{"shrink", "crack"}));
  EXPECT_THROW((void)interrupted_run(rows - 1, {"overlap", "shrink"}), Cancelled);

  const TemporaryDirectory directory;
  const std::filesystem::path folder = directory.path() / "out", part = part_of(folder);
  EXPECT_EQ(part, directory.path() / "out.part");
  write_part(report, folder);
  EXPECT_FALSE(std::filesystem::exists(folder));
  for (const char* table : {"values.csv", "summary.csv", "timings.csv"}) {
    EXPECT_NE(validation::text_of(part / table).find(said), std::string::npos) << table;
  }
  EXPECT_NE(validation::text_of(part / "report.html").find("Not finished: shrink and crack."), std::string::npos);
  (void)write(whole, folder);
  EXPECT_FALSE(std::filesystem::exists(part)) << "a complete result removes it";
  EXPECT_EQ(validation::text_of(folder / "values.csv").find("unfinished"), std::string::npos);
}

TEST(StressCommand, WritesItsFilesAndReplacesThem) {
  const TemporaryDirectory directory;
  const std::string folder = (directory.path() / "out").string();
  for (int turn = 0; turn < 2; ++turn) {
    const auto run = run_program(EXACTFF_PROGRAM, {"stress", "--family", "overlap", "--threads", "1", "-o", folder});
    EXPECT_EQ(run.exit_code, 0);
    EXPECT_NE(run.output.find("rounded to a double, in every one of 28 scenes"), std::string::npos) << run.output;
  }
  for (const char* file : {"report.html", "values.csv", "summary.csv", "timings.csv"}) {
    EXPECT_TRUE(std::filesystem::exists(std::filesystem::path(folder) / file)) << file;
  }
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(directory.path()), {}), 1) << "nothing beside the folder";
}

TEST(StressCommand, ListsItsFamilies) {
  const auto run = run_program(EXACTFF_PROGRAM, {"stress", "--list"});
  EXPECT_EQ(run.exit_code, 0);
  for (const FamilyInfo& family : families()) {
    EXPECT_NE(run.output.find(family.name), std::string::npos) << family.name;
  }
}

TEST(StressJudgement, NoNumberIsNotUsable) {
  FamilyResult result;
  result.rows = {row_with_error(1, std::numeric_limits<double>::quiet_NaN())};
  EXPECT_EQ(usable_up_to(result, Method::kAcos, 1e300), 0.0);
}

}  // namespace
}  // namespace exactff::stress
