// The machine-readable output of a check, with values and names that may break a parser.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "check/report.h"
#include "exactff/check.h"
#include "page/gnuplot.h"
#include "support/holds.h"
#include "support/program.h"
#include "unit/products/check_support.h"

namespace exactff::check {
namespace {

using validation::holds;

// Receivers with awkward names; the second value has an error of 0.25, 1 relative.
Report awkward_report(const Criteria& criteria, double first = 0.5) {
  Truth truth;
  truth.file = "a,b:100%.csv";
  truth.column = "exact";
  truth.sources = {"l<&>\"amp"};
  truth.faces = {""};
  truth.rows.resize(2);
  truth.rows[0].receiver = "::error::x";
  truth.rows[0].value = truth.rows[0].lower = truth.rows[0].upper = 0.5;
  truth.rows[1].receiver = "a\x01\xFF\n]]>";
  truth.rows[1].value = truth.rows[1].lower = truth.rows[1].upper = 0.25;
  const std::vector<Measured> values = {{0, 7, first}, {1, 9, 0.5}};
  return judge(truth, values, criteria, "c,d:50%.csv");
}

TEST(JUnit, HasATestCasePerVerdict) {
  const std::string xml = junit_xml(awkward_report({.max_abs = 0.125, .rms = 0.5}));
  EXPECT_HOLDS(xml,
               "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
               "<testsuites name=\"exactff check\" tests=\"3\" failures=\"1\" errors=\"0\" time=\"0\">\n"
               "  <testsuite name=\"exactff check c,d:50%.csv\" tests=\"3\" failures=\"1\" errors=\"0\" time=\"0\">\n");
  EXPECT_HOLDS(xml, "<property name=\"truth\" value=\"a,b:100%.csv\"/>");
  EXPECT_HOLDS(xml, "<testcase classname=\"exactff.check.exact\" name=\"finite\" time=\"0\"/>\n");
  EXPECT_HOLDS(xml, "<testcase classname=\"exactff.check.exact\" name=\"rms\" time=\"0\"/>\n");
  EXPECT_HOLDS(xml, "<testcase classname=\"exactff.check.exact\" name=\"max-abs\" time=\"0\">\n      <failure ");
  EXPECT_TRUE(xml.ends_with("  </testsuite>\n</testsuites>\n"));
}

TEST(JUnit, EscapesNames) {
  const std::string xml = junit_xml(awkward_report({.max_abs = 0.125}));
  EXPECT_HOLDS(
      xml,
      "<failure message=\"max-abs: 0.25 is above the limit 0.125, worst at receiver 'a\\x01\\xff\\x0a]]&gt;', source "
      "'l&lt;&amp;&gt;&quot;amp'\" type=\"max-abs\">");
  EXPECT_HOLDS(xml,
               "worst rows by absolute error:\nreceiver 'a\\x01\\xff\\x0a]]&gt;', source 'l&lt;&amp;&gt;&quot;amp': "
               "exact 0.25, ");
  EXPECT_HOLDS(xml, ": exact 0.25, found 0.5, error 0.25, relative 1</failure>");
  EXPECT_FALSE(holds(xml, "\x01") || holds(xml, "\xFF"));
}

TEST(GitHubAnnotations, PointToTheWorstRowAndEscapeWhatEndsThem) {
  EXPECT_EQ(
      github_annotations(awkward_report({.max_abs = 0.125})),
      "::error file=c%2Cd%3A50%25.csv,line=9,title=exactff check%3A max-abs::max-abs: 0.25 is above the limit 0.125, "
      "worst at receiver 'a\\x01\\xff\\x0a]]>', source 'l<&>\"amp'%0Aexact 0.25, found 0.5, error 0.25, relative 1\n");
}

TEST(GitHubAnnotations, OfBadInputPointToItsLines) {
  const InputError error({{"a:b.csv", 3, "100 % wrong", "why", "do"}, {"", 0, "all wrong", "", ""}});
  EXPECT_EQ(github_annotations(error),
            "::error file=a%3Ab.csv,line=3,title=exactff check%3A bad input::a:b.csv:3: 100 %25 wrong (why); do\n"
            "::error title=exactff check%3A bad input::all wrong\n");
}

TEST(CheckJson, TellsEverythingAndSurvivesAnyName) {
  const auto json = nlohmann::json::parse(json_text(awkward_report({.max_abs = 0.125, .eps_b = {}}, std::nan(""))));
  EXPECT_EQ(json["passed"], false);
  EXPECT_EQ(json["truth"]["rows"], 2);
  EXPECT_EQ(json["verdicts"][0]["criterion"], "finite");
  EXPECT_EQ(json["verdicts"][1]["measured"], 0.25);
  EXPECT_EQ(json["verdicts"][1]["worst"]["line"], 9);
  EXPECT_EQ(json["overall"]["not_finite"], 1);
  EXPECT_EQ(json["overall"]["absolute"]["max"], 0.25);
  EXPECT_EQ(json["worst"][0]["value"], "nan");
  EXPECT_EQ(json["worst"][1]["receiver"], "a\x01\\xff\n]]>");
  EXPECT_TRUE(json["sources"].contains("l<&>\"amp"));
  EXPECT_EQ(json["histogram"]["bins"][0]["rows"], 1);
}

TEST(ErrorHistogram, IsDrawnWithoutComplaint) {
  const validation::TemporaryDirectory scratch;
  const Criteria criteria{.max_abs = 1e-9, .rms = 1.0, .quantiles = {{0.5, 0.0}, {0.9, 7.0}}};
  const page::PlotResult plot = page::run_gnuplot(histogram_script(awkward_report(criteria, 0.501)), scratch.path());
  if (plot.outcome == page::PlotResult::Outcome::kNoProgram) GTEST_SKIP() << "gnuplot is not installed";
  EXPECT_EQ(plot.outcome, page::PlotResult::Outcome::kDrawn);
  EXPECT_EQ(plot.message, "");
  for (const char* shown : {"max-abs", "quantile 0.9", "2 rows"}) EXPECT_HOLDS(plot.svg, shown);
  EXPECT_FALSE(holds(plot.svg, "quantile 0.5"));  // a logarithmic axis cannot show this limit
}

}  // namespace
}  // namespace exactff::check
