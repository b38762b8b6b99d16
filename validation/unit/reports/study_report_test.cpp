// The report on a study: figures, pages, and the folder that they are written to.
#include <unistd.h>

#include "page/gnuplot.h"
#include "page/output_folder.h"
#include "report/report.h"
#include "study/settings.h"
#include "support/test.h"
#include "unit/reports/study_support.h"

namespace exactff::study {
namespace {

namespace fs = std::filesystem;

// The report on a study, without figures.
struct UndrawnReport {
  report::StudyReport report;
  std::vector<report::Page> pages;

  void add(const std::string& name, const std::string& title, const Study& study) {
    report::Page page;
    page.left_out = study.left_out;
    for (page::Figure& figure : report::figures(study, page.left_out)) {
      if (!name.empty()) figure.id = name + '-' + figure.id;
      page.drawn.figures.push_back({std::move(figure), "<svg></svg>"});
    }
    report.scenes.push_back({name, title, study});
    pages.push_back(std::move(page));
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
    const auto& drawn = undrawn.pages.front().drawn.figures;
    ASSERT_GE(drawn.size(), study == &whole_study() ? 11U : 6U);
    const std::string text = undrawn.text();
    for (const page::DrawnFigure& one : drawn) {
      EXPECT_HOLDS(text, "<figure id=\"" + one.figure.id + "\"") << one.figure.id;
    }
    expect_nothing_fetched(text);
    EXPECT_HOLDS(text, "room &lt;&amp;&gt;") << "names are escaped";
    EXPECT_EQ(text.find("room <&>"), std::string::npos);
  }
}

TEST(OutputFolder, OfAnEarlierStudyMayBeReplaced) {
  const TemporaryDirectory directory;
  const fs::path out = directory.path() / "out";
  fs::create_directories(out);
  std::ofstream(out / "report.html") << "<!doctype html>\n";
  EXPECT_THROW(page::check_output_folder(out), InputError) << "a page of anybody's";
  std::ofstream(out / "room_summary.csv") << "# exactff 0.1.0 compare: summary\n";
  EXPECT_NO_THROW(page::check_output_folder(out / ""));
  std::ofstream(out / "values.csv") << "a,b\n";
  EXPECT_THROW(page::check_output_folder(out), InputError) << "a table of somebody else's";
}

// --- What a report concludes from a comparison of methods, in words ---

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

}  // namespace
}  // namespace exactff::study
