// The study: statistics, sweeps, tables, figures and the report.
#include "exactff/study.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <set>
#include <sstream>
#include <string>

#include "exactff/report.h"
#include "page/gnuplot.h"
#include "report/figures.h"
#include "report/report.h"
#include "report/tables.h"
#include "study/radiosity.h"
#include "study/settings.h"
#include "study/silent_errors.h"
#include "study/statistics.h"
#include "support/program.h"
#include "text/escape.h"
#include "text/phrases.h"
#include "unit/study_support.h"

namespace exactff::study {
namespace {

namespace fs = std::filesystem;
using validation::expect_same_values;
using validation::request_with_methods;
using validation::small_request;
using validation::small_room;
using validation::text_of;
using validation::value_tables;

// --- statistics --------------------------------------------------------------------------------------

TEST(Statistics, OfErrorsAgreeWithHandValues) {
  const std::vector<double> errors = {3, -4, 0, 0};
  const ErrorStatistics s = error_statistics(errors);
  EXPECT_EQ(s.rms, 2.5);
  EXPECT_EQ(s.mean, -0.25);
  EXPECT_EQ(s.p99, 4);
  EXPECT_EQ(s.worst, 4);
  EXPECT_EQ(s.not_a_number, 0U);
}

TEST(Statistics, OfNothingAreZero) {
  const ErrorStatistics s = error_statistics({});
  EXPECT_EQ(s.rms, 0);
  EXPECT_EQ(s.worst, 0);
}

TEST(Statistics, WhatIsNoNumberIsCountedApart) {
  const std::vector<double> errors = {1, std::numeric_limits<double>::quiet_NaN(), -1};
  const ErrorStatistics s = error_statistics(errors);
  EXPECT_EQ(s.not_a_number, 1U);
  EXPECT_EQ(s.rms, 1);
}

TEST(Statistics, TheRmsOfTinyErrorsDoesNotUnderflow) {
  const std::vector<double> errors = {3e-200, 4e-200};
  EXPECT_NEAR(error_statistics(errors).rms / 1e-200, std::sqrt(12.5), 1e-15 * 10);
}

// The literal variant of Nettle's method has such errors in scenes of 1e76.
TEST(Statistics, ErrorsNearTheLargestDoubleDoNotOverflow) {
  const std::vector<double> errors = {0x1p1023, 0x1p1023, 0x1.8p1023, -0x1.8p1023};
  const ErrorStatistics s = error_statistics(errors);
  EXPECT_EQ(s.mean, 0x1p1022);
  EXPECT_EQ(s.worst, 0x1.8p1023);
  EXPECT_LE(s.rms, s.worst);
  EXPECT_EQ(median(errors), 0x1p1023);
  EXPECT_TRUE(std::isfinite(mean_half_width(errors)));
  EXPECT_NEAR(mean_half_width(std::vector{0x1p600, -0x1p600}) / mean_half_width(std::vector{1.0, -1.0}), 0x1p600,
              0x1p550);
}

TEST(Statistics, PercentilesAreOfTheNearestRank) {
  std::vector<double> values;
  for (int i = 100; i >= 1; --i) values.push_back(i);
  EXPECT_EQ(percentile(values, 99), 99);
  EXPECT_EQ(percentile(values, 100), 100);
  EXPECT_EQ(percentile(values, 0.5), 1);
  values.push_back(101);
  EXPECT_EQ(percentile(values, 99), 100);  // ceil(99.99)
  EXPECT_EQ(percentile({7}, 99), 7);
}

TEST(Statistics, TheMedianOfAnEvenCountIsTheMeanOfTheMiddleTwo) {
  EXPECT_EQ(median({5, 1, 3}), 3);
  EXPECT_EQ(median({4, 1, 3, 2}), 2.5);
  EXPECT_EQ(median({}), 0);
}

TEST(Statistics, TheSlopeOfAPowerLawIsItsExponent) {
  const std::vector<std::pair<double, double>> points = {{1, 8}, {4, 4}, {16, 2}, {0, 9}};
  EXPECT_NEAR(fitted_slope(points).value(), -0.5, 1e-12);
  const std::vector<std::pair<double, double>> one = {{1, 8}, {1, 4}};
  EXPECT_FALSE(fitted_slope(one).has_value());
}

// --- words and numbers -------------------------------------------------------------------------------

TEST(Text, ShortestDecimalsReadBack) {
  EXPECT_EQ(text::shortest(0.1), "0.1");
  EXPECT_EQ(text::shortest(1e300), "1e+300");
  EXPECT_EQ(text::shortest(-0.0), "-0");
  EXPECT_EQ(text::shortest(5e-324), "5e-324");
}

TEST(Text, ASharedPartIsNeverRoundedToNoneOrAll) {
  EXPECT_EQ(text::share(0, 10), "0 %");
  EXPECT_EQ(text::share(1, 100000), "under 0.1 %");
  EXPECT_EQ(text::share(99999, 100000), "over 99.9 %");
  EXPECT_EQ(text::share(1, 3), "33.3 %");
  EXPECT_EQ(text::share(3, 3), "100 %");
}

TEST(Text, FieldsAreQuotedWhereTheyMustBe) {
  EXPECT_EQ(text::csv_field("plain"), "plain");
  EXPECT_EQ(text::csv_field("1,2"), "\"1,2\"");
  EXPECT_EQ(text::csv_field("a \"b\""), "\"a \"\"b\"\"\"");
}

TEST(Text, DurationsTakeTheUnitThatFits) {
  EXPECT_EQ(text::duration(3.12e-7), "312 ns");
  EXPECT_EQ(text::duration(4.512e-6), "4.51 µs");
  EXPECT_EQ(text::duration(0.0012), "1.2 ms");
  EXPECT_EQ(text::duration(125), "2 min 5 s");
}

// --- sweeps ------------------------------------------------------------------------------------------

TEST(Settings, DefaultsFollowTheLargestContribution) {
  Sweeps sweeps;
  complete(sweeps, {20.0, 100.0, true});
  EXPECT_EQ(sweeps.eps_b, (std::vector<double>{2, 0.2, 0.02, 0.002, 0.0002}));
  EXPECT_EQ(sweeps.eps_a.front(), 0.0);
  EXPECT_EQ(sweeps.eps_a[1], 10.0);
}

TEST(Settings, ASmallProductIsRunInFull) {
  Sweeps sweeps{{0.1, 0.01}, {0.0}, {4, 16}, {1, 2}, {SamplePattern::kJittered}, {Variant::kMended}};
  complete(sweeps, {});
  const SettingPlan plan = combine(sweeps);
  EXPECT_TRUE(plan.full_product);
  EXPECT_EQ(plan.settings.size(), 8U);
  EXPECT_EQ(plan.settings[plan.base].eps_b, 0.01);
  EXPECT_EQ(plan.settings[plan.base].rays, 16);
}

TEST(Settings, ALargeProductIsSweptThroughTheBase) {
  Sweeps sweeps;
  complete(sweeps, {1.0, 1.0, true});
  const SettingPlan plan = combine(sweeps);
  EXPECT_FALSE(plan.full_product);
  for (const Parameter p : {Parameter::kEpsB, Parameter::kRays, Parameter::kSeed, Parameter::kVariant}) {
    EXPECT_GE(line_through(plan.settings, plan.base, p).size(), 2U);
  }
  for (std::size_t i = 0; i < plan.settings.size(); ++i) {
    EXPECT_EQ(find_setting(plan.settings, plan.settings[i]), i) << "a setting occurs twice";
  }
}

TEST(Settings, WhatAPatternIgnoresMakesNoSetting) {
  Sweeps sweeps{{0.1}, {0.0}, {1, 4}, {1, 2, 3}, {SamplePattern::kCentre, SamplePattern::kRegular}, {Variant::kMended}};
  complete(sweeps, {});
  EXPECT_EQ(combine(sweeps).settings.size(), 3U);  // centre; regular with 1 and with 4 rays
}

TEST(Settings, RepetitionsAreDropped) {
  Sweeps sweeps{{0.1, 0.1}, {0.0}, {4}, {1}, {SamplePattern::kJittered}, {Variant::kMended}};
  complete(sweeps, {});
  EXPECT_EQ(sweeps.eps_b.size(), 1U);
}

TEST(Settings, WithNothingToSampleOnlyEpsBIsSwept) {
  Sweeps sweeps;
  complete(sweeps, {1.0, 1.0, false});
  const auto left_out = leave_out(sweeps, {1.0, 1.0, false});
  EXPECT_EQ(left_out.size(), 4U);
  EXPECT_EQ(sweeps.eps_b.size(), 5U);
  EXPECT_EQ(sweeps.rays.size() * sweeps.eps_a.size() * sweeps.seeds.size() * sweeps.patterns.size(), 1U);
}

TEST(Settings, ImpossibleValuesAreInputErrors) {
  const auto refused = [](Sweeps sweeps) {
    try {
      complete(sweeps, {1.0, 1.0, true});
    } catch (const InputError&) {
      return true;
    }
    return false;
  };
  EXPECT_TRUE(refused({.eps_b = {-1.0}}));
  EXPECT_TRUE(refused({.eps_b = {std::numeric_limits<double>::infinity()}}));
  EXPECT_TRUE(refused({.eps_a = {-1.0}}));
  EXPECT_TRUE(refused({.rays = {0}}));
  EXPECT_TRUE(refused({.eps_b = {0.0}, .eps_a = {0.0}}));
  EXPECT_FALSE(refused({.eps_b = {0.0}, .eps_a = {0.1}}));
}

// --- silent errors -----------------------------------------------------------------------------------

Loop rectangle(double x0, double y0, double x1, double y1, bool hole = false) {
  return {{{x0, y0, 1}, {x1, y0, 1}, {x1, y1, 1}, {x0, y1, 1}}, hole};
}

// The unit square at z = 1; the part to the left of `seen` is visible.
PlaneDrawing unit_source(double seen) {
  PlaneDrawing plane;
  plane.normal = {0, 0, 1};
  plane.source = plane.clipped_source = {rectangle(0, 0, 1, 1)};
  plane.visible = {rectangle(0, 0, seen, 1)};
  return plane;
}

Leaf leaf(double x0, double x1, LeafReason reason) {
  Leaf result;
  result.corners = {{{x0, 0, 1}, {x1, 0, 1}, {x1, 1, 1}, {x0, 1, 1}}};
  result.corner_count = 4;
  result.reason = reason;
  return result;
}

TEST(SilentErrors, AreSampledLeavesThatAreSeenInPart) {
  const std::vector<PlaneDrawing> truth = {unit_source(0.5)};
  const std::vector<Leaf> leaves = {
      leaf(0, 0.5, LeafReason::kSampledVisible),      // right
      leaf(0.5, 1, LeafReason::kSampledHidden),       // right
      leaf(0.25, 0.75, LeafReason::kSampledVisible),  // silent
      leaf(0.25, 0.75, LeafReason::kEpsF),            // the sampled value is neither 0 nor 1
      leaf(0.6, 0.8, LeafReason::kSampledVisible),    // wrong
      leaf(0.1, 0.2, LeafReason::kSampledHidden),     // wrong
  };
  const SampledVerdict verdict = judge_leaves(leaves, truth);
  EXPECT_EQ(verdict.silent, 1U);
  EXPECT_EQ(verdict.wrong, 2U);
}

TEST(SilentErrors, HolesOfTheVisibleRegionAreNotVisible) {
  const std::vector<Loop> loops = {rectangle(0, 0, 1, 1), rectangle(0.25, 0.25, 0.75, 0.75, true)};
  const std::vector<Vec3> window = {{0, 0, 1}, {1, 0, 1}, {1, 0.5, 1}, {0, 0.5, 1}};
  EXPECT_NEAR(area_inside(loops, window, {0, 0, 1}), 0.5 - 0.125, 1e-15);
}

TEST(SilentErrors, AConcaveRegionIsClippedToItsTrueArea) {
  // A U whose two arms reach into the window: the clipped loop runs back along the window's side.
  const Loop u{{{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {2, 3, 0}, {2, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}}, false};
  const std::vector<Vec3> window = {{0, 2, 0}, {3, 2, 0}, {3, 4, 0}, {0, 4, 0}};
  EXPECT_NEAR(area_inside({u}, window, {0, 0, 1}), 2.0, 1e-15);
  EXPECT_NEAR(area_inside({u}, {window.rbegin(), window.rend()}, {0, 0, 1}), 2.0, 1e-15);
}

TEST(SilentErrors, ALeafIsHeldAgainstItsOwnPlane) {
  PlaneDrawing other = unit_source(1.0);
  other.normal = {0, 0, -1};
  const std::vector<PlaneDrawing> truth = {other, unit_source(0.5)};
  EXPECT_EQ(judge_leaves({leaf(0, 1, LeafReason::kSampledVisible)}, truth).silent, 1U);
}

// --- the whole ---------------------------------------------------------------------------------------

const Study& small_study() {
  static const Scene scene = small_room(true);
  static const Study study = run(small_request(scene, 1));
  return study;
}

// With all methods.
const Study& whole_study() {
  static const Scene scene = small_room(true);
  static const Study study = run(request_with_methods(scene, 1));
  return study;
}

TEST(Study, ValueTablesAreTheSameBytesForAnyNumberOfThreads) {
  const Study two = run(request_with_methods(*whole_study().request.scene, 2));
  expect_same_values(whole_study(), two, "");
  for (const auto& [file, text] : value_tables(two)) EXPECT_EQ(text.find("thread"), std::string::npos) << file;
}

TEST(Study, OfAllMethodsHasAllTables) {
  std::set<std::string_view> files;
  for (const report::StudyTable& table : report::tables()) {
    EXPECT_TRUE(table.has_rows(whole_study())) << table.file;
    EXPECT_TRUE(files.insert(table.file).second) << table.file;
  }
  EXPECT_EQ(value_tables(whole_study()).size(), 9U);
}

TEST(Study, WithoutMethodsHasNoTableOfThem) {
  EXPECT_EQ(value_tables(small_study()).size(), 3U);
  for (const report::StudyTable& table : report::tables()) {
    EXPECT_EQ(table.has_rows(small_study()), std::string(table.file).find("method") == std::string::npos &&
                                                 table.file != "slopes.csv" && table.file != "receivers.csv" &&
                                                 table.file != "profile.csv")
        << table.file;
  }
}

TEST(Study, ValuesHaveARowPerReceiverAndSetting) {
  const std::string text = text_of(report::tables()[0], small_study());
  std::size_t rows = 0;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) rows += line.starts_with('#') ? 0 : 1;
  EXPECT_EQ(rows, 1 + small_study().exact.size() * small_study().settings.size());
}

TEST(Study, ErrorsAreApproximateMinusExact) {
  const Study& study = small_study();
  for (std::size_t k = 0; k < study.settings.size(); ++k) {
    for (std::size_t i = 0; i < study.exact.size(); ++i) {
      const SampleRow& row = study.samples[k][i];
      EXPECT_EQ(row.error, row.form_factor - study.exact[i].form_factor);
      // For rho B = (5, 5, 15), the third channel is the largest.
      EXPECT_DOUBLE_EQ(row.radiosity_error, 15 * row.error);
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

TEST(Study, WithoutOccludersLeavesTheSamplingSweepsOut) {
  const Scene scene = small_room(false);
  Request request = small_request(scene, 1);
  request.sweeps.eps_a = {0.0, 0.1};
  const Study study = run(std::move(request));
  std::set<std::string> left_out;
  for (const LeftOut& item : study.left_out) left_out.insert(item.what);
  EXPECT_TRUE(left_out.contains("sweep of eps_A"));
  EXPECT_TRUE(left_out.contains("sweep of the number of rays"));
  EXPECT_TRUE(left_out.contains("sweep of seeds"));
  for (const Summary& summary : study.summaries) EXPECT_EQ(summary.rays, 0U);
}

TEST(Study, NeedsAReceiverAndASource) {
  const Scene scene = small_room(true);
  Request request = small_request(scene, 1);
  request.receivers.clear();
  EXPECT_THROW((void)run(std::move(request)), InputError);
  SceneBuilder dark("dark");
  for (const Vec3& v : {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}}) dark.add_vertex(v);
  dark.add_face(dark.patch("floor"), dark.add_material({}), {{0, 1, 2}});
  const Scene unlit = dark.build();
  EXPECT_THROW((void)run(small_request(unlit, 1)), InputError);
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
  try {
    (void)run(small_request(scene, 1));
    FAIL() << "a radiosity of 5e307 was accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("reduce the emissions"), std::string::npos) << error.what();
  }
}

TEST(Study, StopsWhenItIsCancelled) {
  const Scene scene = small_room(true);
  const Hooks hooks{{}, [] { return true; }};
  EXPECT_THROW((void)run(small_request(scene, 2), hooks), Cancelled);
}

// The report on a study, without figures.
struct UndrawnReport {
  report::StudyReport report;
  report::Pages pages;

  void add(const std::string& name, const std::string& title, const Study& study) {
    report::Page page;
    page.left_out = study.left_out;
    for (page::Figure& figure : report::figures(study, page.left_out)) {
      if (!name.empty()) figure.id = name + '-' + figure.id;
      page.drawn.figures.push_back({std::move(figure), "<svg></svg>"});
    }
    report.scenes.push_back({name, title, study});
    pages.scenes.push_back(std::move(page));
  }
  [[nodiscard]] std::string text() const { return report::report_page(report, pages); }
};

void expect_nothing_fetched(const std::string& text) {
  for (const char* outside : {"http:", "https:", "<script", "src=", "<link", "@import", "url("}) {
    EXPECT_EQ(text.find(outside), std::string::npos) << outside;
  }
}

TEST(Study, TheReportHoldsEveryFigureAndFetchesNothing) {
  for (const Study* study : {&small_study(), &whole_study()}) {
    UndrawnReport undrawn;
    undrawn.add("", study->request.scene_name, *study);
    const auto& drawn = undrawn.pages.scenes.front().drawn.figures;
    ASSERT_GE(drawn.size(), study == &whole_study() ? 12U : 6U);
    const std::string text = undrawn.text();
    for (const page::DrawnFigure& one : drawn) {
      EXPECT_NE(text.find("<figure id=\"" + one.figure.id + "\""), std::string::npos) << one.figure.id;
    }
    expect_nothing_fetched(text);
    EXPECT_NE(text.find("room &lt;&amp;&gt;"), std::string::npos) << "names are escaped";
    EXPECT_EQ(text.find("room <&>"), std::string::npos);
  }
}

TEST(Study, AReportOnSeveralScenesAndChaptersHoldsThemAll) {
  UndrawnReport undrawn;
  undrawn.report.title = "Two <rooms>";
  undrawn.add("one", "Room 1", small_study());
  undrawn.add("two", "Room & 2", whole_study());
  page::Chapter chapter{.name = "a-chapter", .title = "What was <found>"};
  chapter.paragraphs = {"One is less than two: 1 < 2."};
  chapter.tables = {{"Numbers & names", {"name", "number"}, {{"a < b", "17.5"}}}};
  chapter.values = {{"a-chapter.csv", "a number", "# of one\nx\n1\n"}};
  undrawn.report.chapters.push_back(chapter);
  undrawn.pages.chapters.emplace_back().left_out.push_back({"the rest", "it is < nothing"});
  undrawn.report.left_out.push_back({"Room <3>", "this report is abridged"});
  const std::string text = undrawn.text();
  for (const char* part :
       {"Two &lt;rooms&gt;", "Room 1", "Room &amp; 2", "What was &lt;found&gt;", "1 &lt; 2.", "Numbers &amp; names",
        "a &lt; b", ">17.5<", "a-chapter.csv", "the rest", "it is &lt; nothing", "Room &lt;3&gt;", "SCENE_values.csv",
        "SCENE_profile.csv", "<code>two</code> (Room &amp; 2)"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part;
  }
  std::set<std::string> ids;
  for (std::size_t at = text.find(" id=\""); at != std::string::npos; at = text.find(" id=\"", at + 1)) {
    const std::string id = text.substr(at + 5, text.find('"', at + 5) - at - 5);
    EXPECT_TRUE(ids.insert(id).second) << id << " occurs twice";
  }
  expect_nothing_fetched(text);
}

TEST(Study, EveryFigureHasItsOwnName) {
  std::vector<LeftOut> left_out;
  std::set<std::string> ids;
  for (const page::Figure& figure : report::figures(whole_study(), left_out))
    EXPECT_TRUE(ids.insert(figure.id).second) << figure.id;
}

TEST(InlinedSvg, HasItsOwnIdsAndNothingFromOutside) {
  const std::string svg =
      "<?xml version=\"1.0\"?>\n<svg viewBox=\"0 0 1 1\"\n xmlns=\"http://www.w3.org/2000/svg\"\n "
      "xmlns:xlink=\"http://www.w3.org/1999/xlink\">\n<title>x</title><circle id='p'/><use xlink:href='#p'/>"
      "<g color=\"black\" fill=\"black\"/></svg>\n";
  const std::string text = page::inlined(svg, "fig", "A \"title\"");
  EXPECT_TRUE(text.starts_with("<svg role=\"img\" aria-label=\"A &quot;title&quot;\""));
  EXPECT_NE(text.find("id='fig-p'"), std::string::npos);
  EXPECT_NE(text.find("href='#fig-p'"), std::string::npos);
  EXPECT_NE(text.find("fill=\"currentColor\""), std::string::npos);
  EXPECT_EQ(text.find("http:"), std::string::npos);
  EXPECT_EQ(text.find("<title>"), std::string::npos);
  EXPECT_EQ(text.find("color=\"black\""), std::string::npos);
}

TEST(InlinedSvg, ComesFromEveryFigureThatGnuplotDraws) {
  const validation::EnvironmentVariable locale(
      "LC_ALL",
      "C");  // as on a machine without locales: the scripts are UTF-8 all the same
  const validation::TemporaryDirectory scratch;
  std::vector<LeftOut> left_out;
  std::vector<page::Figure> all = report::figures(small_study(), left_out);
  std::set<bool> kinds;
  for (const page::Figure& figure : all) {
    if (!kinds.insert(figure.map).second) continue;  // one line figure and one map: gnuplot takes its time
    const page::PlotResult plot = page::run_gnuplot(figure.script, scratch.path());
    if (plot.outcome == page::PlotResult::Outcome::kNoProgram) GTEST_SKIP() << "gnuplot is not installed";
    EXPECT_EQ(plot.outcome, page::PlotResult::Outcome::kDrawn) << plot.message;
    EXPECT_EQ(plot.message, "") << "gnuplot warned about " << figure.id;
    EXPECT_EQ(page::inlined(plot.svg, figure.id, figure.title).find("http"), std::string::npos);
  }
  EXPECT_EQ(kinds.size(), 2U);
}

// --- the folder --------------------------------------------------------------------------------------

class OutputFolder : public ::testing::Test {
 protected:
  OutputFolder() : root_(fs::temp_directory_path() / ("exactff-study-test-" + std::to_string(::getpid()))) {
    fs::remove_all(root_);
    fs::create_directories(root_);
  }
  ~OutputFolder() override {
    std::error_code ignored;
    fs::remove_all(root_, ignored);
  }

  std::set<std::string> names() const {
    std::set<std::string> found;
    for (const auto& entry : fs::directory_iterator(root_)) found.insert(entry.path().filename().string());
    return found;
  }

  fs::path root_;
};

TEST_F(OutputFolder, OfAStrangerIsRefused) {
  fs::create_directories(root_ / "out");
  EXPECT_NO_THROW(report::check_output_folder(root_ / "out"));
  std::ofstream(root_ / "out" / "thesis.txt") << "do not lose me";
  EXPECT_THROW(report::check_output_folder(root_ / "out"), InputError);
  std::ofstream(root_ / "file") << "x";
  EXPECT_THROW(report::check_output_folder(root_ / "file"), InputError);
}

TEST_F(OutputFolder, OfAnEarlierStudyMayBeReplaced) {
  fs::create_directories(root_ / "out");
  std::ofstream(root_ / "out" / "report.html") << "<!doctype html>\n";
  EXPECT_THROW(report::check_output_folder(root_ / "out"), InputError) << "a page of anybody's";
  std::ofstream(root_ / "out" / "room_summary.csv") << "# exactff 0.1.0 compare: summary\n";
  EXPECT_NO_THROW(report::check_output_folder(root_ / "out" / ""));
  std::ofstream(root_ / "out" / "values.csv") << "a,b\n";
  EXPECT_THROW(report::check_output_folder(root_ / "out"), InputError) << "a table of somebody else's";
}

TEST_F(OutputFolder, OfACancelledStudyIsNotThere) {
  const Hooks hooks{{}, [] { return true; }};
  EXPECT_THROW((void)report::write(small_study(), root_ / "out", hooks), Cancelled);
  EXPECT_TRUE(names().empty());
}

TEST_F(OutputFolder, OfSeveralScenesHasTheirNamesBeforeTheFiles) {
  report::StudyReport report;
  report.title = "rooms";
  report.scenes.push_back({"one", "One", small_study()});
  report.scenes.push_back({"two", "Two", small_study()});
  report.chapters.push_back({.name = "more", .title = "More", .values = {{"more.csv", "one", "# of one\nx\n1\n"}}});
  {
    const validation::EnvironmentVariable path("PATH", root_);
    (void)write(report, root_ / "out");
  }
  for (const char* file : {"one_values.csv", "two_values.csv", "one_timings.csv", "more.csv", "report.html"}) {
    EXPECT_TRUE(fs::exists(root_ / "out" / file)) << file;
  }
  EXPECT_FALSE(fs::exists(root_ / "out" / "values.csv"));
  const std::string table = validation::text_of(root_ / "out" / "more.csv");
  EXPECT_TRUE(table.starts_with("# exactff ") && table.ends_with(" compare: one\n# of one\nx\n1\n")) << table;
  EXPECT_NO_THROW(report::check_output_folder(root_ / "out"));
}

TEST_F(OutputFolder, WithoutGnuplotHoldsTablesAndAReportThatSaysSo) {
  const validation::EnvironmentVariable path("PATH", root_);
  const auto messages = report::write(small_study(), root_ / "out");
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_NE(messages.front().find("gnuplot"), std::string::npos);
  EXPECT_EQ(names(), std::set<std::string>{"out"});
  for (const report::StudyTable& table : report::tables()) {
    EXPECT_EQ(fs::exists(root_ / "out" / table.file), table.has_rows(small_study())) << table.file;
  }
  EXPECT_TRUE(fs::exists(root_ / "out" / "report.html"));
}

// Its recursion would take years: the probes of the budget stop early and report this.
TEST(Study, RefusesABaseSettingThatWouldNotEnd) {
  const Scene scene = validation::small_room(true);
  study::Request request = validation::small_request(scene, 1);
  request.receivers = grid_receivers(scene, scene.select("floor"), {40, 40});
  request.sweeps = {.eps_b = {1e-300}, .rays = {4}, .seeds = {1}};
  try {
    static_cast<void>(study::run(request));
    FAIL() << "it ended";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("would take more than"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("use a larger --eps-b"), std::string::npos) << error.what();
  }
}

TEST(Study, RadiositiesThatOverflowAreNotNan) {
  const double most = std::numeric_limits<double>::max(), infinity = std::numeric_limits<double>::infinity();
  const Rgb error = times(Rgb{most, most, 1.0}, 5.0);
  EXPECT_EQ(error, (Rgb{infinity, infinity, 5.0}));
  EXPECT_EQ(times(Rgb{0.0, 0.5, 1.0}, error), (Rgb{0.0, infinity, 5.0}));
  Rgb sum = error;
  add(sum, times(Rgb{most, -most, 1.0}, -5.0));
  EXPECT_EQ(sum, (Rgb{infinity, infinity, 0.0}));
}

}  // namespace
}  // namespace exactff::study
