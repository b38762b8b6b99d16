// The report on a study: figures, pages, and the folder that they are written to.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "page/gnuplot.h"
#include "page/output_folder.h"
#include "report/report.h"
#include "support/folder.h"
#include "support/program.h"
#include "unit/reports/study_support.h"

namespace exactff::study {
namespace {

namespace fs = std::filesystem;
using validation::small_study;
using validation::whole_study;

// --- pages -------------------------------------------------------------------------------------------

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

TEST(InlinedSvg, HasItsOwnIdsAndNothingFromOutside) {
  const std::string svg =
      "<?xml version=\"1.0\"?>\n<svg viewBox=\"0 0 1 1\"\n xmlns=\"http://www.w3.org/2000/svg\"\n "
      "xmlns:xlink=\"http://www.w3.org/1999/xlink\">\n<title>x</title><circle id='p'/><use xlink:href='#p'/>"
      "<g color=\"black\" fill=\"black\"/></svg>\n";
  const std::string text = page::inline_svg(svg, "fig", "A \"title\"");
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
    EXPECT_EQ(page::inline_svg(plot.svg, figure.id, figure.title).find("http"), std::string::npos);
  }
  EXPECT_EQ(kinds.size(), 2U);
}

// --- the folder --------------------------------------------------------------------------------------

TEST(OutputFolder, OfAnEarlierStudyMayBeReplaced) {
  const validation::TemporaryDirectory directory;
  const fs::path out = directory.path() / "out";
  fs::create_directories(out);
  std::ofstream(out / "report.html") << "<!doctype html>\n";
  EXPECT_THROW(page::check_output_folder(out), InputError) << "a page of anybody's";
  std::ofstream(out / "room_summary.csv") << "# exactff 0.1.0 compare: summary\n";
  EXPECT_NO_THROW(page::check_output_folder(out / ""));
  std::ofstream(out / "values.csv") << "a,b\n";
  EXPECT_THROW(page::check_output_folder(out), InputError) << "a table of somebody else's";
}

}  // namespace
}  // namespace exactff::study
