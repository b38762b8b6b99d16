// The study as a whole: values, tables, threads, what it refuses.
#include "exactff/study.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <limits>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "report/report.h"
#include "study/statistics.h"
#include "support/program.h"
#include "unit/reports/study_support.h"

namespace exactff::study {
namespace {

using validation::expect_same_values;
using validation::request_with_methods;
using validation::small_request;
using validation::small_room;
using validation::small_study;
using validation::value_tables;
using validation::whole_study;

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

TEST(Study, TablesReadBackToTheSameBytes) {
  const validation::TemporaryDirectory directory;
  for (const report::StudyTable& one : report::tables()) {
    const table::Table made = one.make(whole_study());
    for (const char* extension : {".csv", ".npz", ".jsonl"}) {
      const auto file = directory.path() / (std::string(one.file) + extension);
      table::write(made, file);
      EXPECT_EQ(table::csv_text(table::read(file)), table::csv_text(made)) << file;
    }
  }
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
