#include "stress/stress.h"

#include <cstdlib>

#include "support/test.h"

namespace exactff::stress {
namespace {

Row row_with_error(double stiffness, double error) {
  Row row;
  row.stiffness = stiffness;
  row.status = Status::kCertified;
  row.agrees = true;
  for (Answer& answer : row.answers) answer.error = error;
  return row;
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
  report.families.push_back({nullptr, {row_with_error(1, 0), row_with_error(2, 0)}});
  EXPECT_TRUE(report.sound());
  report.families[0].rows[1].agrees = false;
  EXPECT_FALSE(report.sound());
  report.families[0].rows[1].agrees = true;
  report.families[0].rows[1].status = Status::kNotCertified;
  EXPECT_FALSE(report.sound());
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
    const Enclosure truth = *scene_case.truth;
    ASSERT_EQ(truth.nearest(), result.value) << stiffness;
    ASSERT_TRUE(truth.overlaps(result.enclosure)) << stiffness;
    ASSERT_EQ(result.status == Status::kZero, truth.upper() == 0.0) << stiffness;
  }
}

INSTANTIATE_TEST_SUITE_P(All, StressFamily, testing::Range<std::size_t>(0, all_families().size()),
                         [](const testing::TestParamInfo<std::size_t>& tested) {
                           std::string name(all_families()[tested.param].name);
                           std::erase(name, '-');
                           return name;
                         });

std::string values_of(const Report& report) { return table::csv_text(table_of(report)); }

TEST(Stress, ValuesDoNotDependOnTheNumberOfThreads) {
  const std::vector<std::string> some = {"overlap", "horizon-ulp"};
  const Report one = run({some, 1});
  EXPECT_TRUE(one.sound());
  EXPECT_EQ(values_of(one), values_of(run({some, 3})));
}

// Cancelled after `rows` finished scenes.
Report interrupted_run(std::size_t rows, const std::vector<std::string>& families) {
  std::atomic<std::size_t> done = 0;
  return run({families, 1}, {[&](const Progress& p) { done = p.done; }, [&] { return done >= rows; }});
}

TEST(Stress, KeepsTheFamiliesThatAreFinishedWhenItIsCancelled) {
  const Report whole = run({{"overlap"}, 1});
  const std::size_t rows = whole.families.front().rows.size();
  const Report report = interrupted_run(rows, {"overlap", "shrink", "crack"});
  ASSERT_EQ(report.families.size(), 1U);
  EXPECT_EQ(values_of(report), values_of(whole));
  EXPECT_EQ(report.unfinished, 2U);
  EXPECT_THROW((void)interrupted_run(rows - 1, {"overlap", "shrink"}), Cancelled);
}

TEST(StressCommand, WritesItsValuesAndReplacesThem) {
  const TemporaryDirectory directory;
  const std::string file = (directory.path() / "out.csv").string();
  for (int turn = 0; turn < 2; ++turn) {
    const auto run = run_exactff({"stress", "--family", "overlap", "--threads", "1", "-o", file});
    EXPECT_EQ(run.exit_code, 0);
    EXPECT_HOLDS(run.output, "rounded to a double, in every one of 28 scenes");
  }
  EXPECT_HOLDS(text_of(file), "\noverlap,1,");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(directory.path()), {}), 1) << "nothing beside the file";
  EXPECT_EQ(run_exactff({"stress", "--family", "overlap", "-o", directory.path() / "out"}).exit_code, 2);
  const auto refused = run_exactff({"stress", "--family", "overlaps", "-o", file});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_HOLDS(refused.error, "there is no family 'overlaps'");
  EXPECT_HOLDS(run_exactff({"stress", "--list"}).output, "crack-ulp");
}

}  // namespace
}  // namespace exactff::stress
