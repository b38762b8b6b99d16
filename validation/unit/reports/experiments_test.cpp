// The experiments of the report, each on a scene that is small enough for a test, and their shared helpers.
#include "experiments/experiments.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "exactff/scene_files.h"
#include "kernel/statistics.h"
#include "page/gnuplot.h"

namespace exactff::experiments {
namespace {

const Hooks kNoHooks;

// --- what they share -----------------------------------------------------------------------------------

TEST(Experiments, AreFoundByNameAndNearlyByAnother) {
  ASSERT_EQ(all_experiments().size(), 4U);
  for (const Experiment& e : all_experiments()) EXPECT_EQ(&experiment_named(e.name), &e);
  try {
    (void)experiment_named("karkanis");
    FAIL() << "there is none of that name";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("karkanis-times"), std::string::npos) << error.what();
  }
}

// A floor and a wall that meet, and a lamp above the floor.
MeshingScene corner() {
  SceneBuilder builder;
  const MaterialId grey = builder.add_material({.name = "grey", .reflectance = {0.75, 0.5, 0.25}});
  const MaterialId lamp = builder.add_material({.name = "lamp", .reflectance = {}, .radiosity = {4.0, 4.0, 4.0}});
  const auto add = [&](const char* name, MaterialId material, const std::vector<Vec3>& ring) {
    std::vector<std::uint32_t> corners;
    for (const Vec3& corner : ring) corners.push_back(builder.add_vertex(corner));
    builder.add_face(builder.patch(name), material, {corners});
  };
  add("floor", grey, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  add("wall", grey, {{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}});
  add("lamp", lamp, {{0.375, 0.375, 1}, {0.375, 0.625, 1}, {0.625, 0.625, 1}, {0.625, 0.375, 1}});
  return {builder.build(), {.eye = {4, 1.5, 3}, .look = {0.25, 0.5, 0.25}, .up = {0, 0, 1}, .fov = 22.0}};
}

MeshingSize small_meshing() { return {.parts = {1, 2, 4, 8}, .pixels = 16}; }

// The values of a run, joined.
std::string values_of(const Result& result) {
  std::string text;
  for (const CsvFile& table : result.values) text += table.file + '\n' + table.csv;
  return text;
}

struct SmallRun {
  const char* name;
  std::function<Result(int threads, const Hooks&)> run;
};

std::vector<SmallRun> small_runs() {
  const auto scatter = [](int threads, const Hooks& hooks) {
    return hemicube_scatter(ScatterSize{.scenes = 3, .triangles = 30, .resolutions = {20}}, threads, hooks);
  };
  const auto cells = [](int threads, const Hooks& hooks) {
    return meshing(corner(), MeshingSize{.parts = {1, 2}, .pixels = 6}, threads, hooks);
  };
  return {{"scatter", scatter}, {"cells", cells}};
}

TEST(Experiments, GiveTheSameBytesOfValuesForAnyNumberOfThreads) {
  for (const SmallRun& small : small_runs()) {
    const Result one = small.run(1, kNoHooks);
    EXPECT_FALSE(one.paragraphs.empty()) << small.name;
    EXPECT_FALSE(one.values.empty()) << small.name;
    EXPECT_EQ(values_of(one), values_of(small.run(3, kNoHooks))) << small.name;
    for (const page::Figure& figure : one.figures) EXPECT_FALSE(figure.script.empty()) << figure.id;
  }
}

TEST(Experiments, GiveUpWhenCancelled) {
  Hooks hooks;
  hooks.cancelled = [] { return true; };
  for (const SmallRun& small : small_runs()) EXPECT_THROW((void)small.run(2, hooks), Cancelled) << small.name;
  EXPECT_THROW((void)karkanis_times(TimesSize{.triangles = {10}}, hooks), Cancelled);
}

// --- Karkanis' two plots -------------------------------------------------------------------------------

TEST(HemicubeScatter, AFinerHemicubeMissesFewerAndErrsLess) {
  const ScatterSize size{.scenes = 2, .triangles = 100, .resolutions = {20, 200}};
  const std::vector<ScatterPoint> points = scatter_points(size, 1, kNoHooks);
  const auto missed = [&](std::size_t r) {
    return std::ranges::count_if(points, [&](const ScatterPoint& p) { return p.exact > 0.0 && p.hemicube[r] == 0.0; });
  };
  EXPECT_GT(missed(0), 10);
  EXPECT_LT(missed(1), missed(0) / 2);
  const auto error = [&](std::size_t r) {
    std::vector<double> errors;
    for (const ScatterPoint& p : points) {
      if (p.exact > 1e-3) errors.push_back(std::abs(p.hemicube[r] - p.exact) / p.exact);
    }
    return kernel::median(errors);
  };
  EXPECT_LT(error(1), 0.2 * error(0));
}

TEST(HemicubeScatter, DrawsWhatIsMissedApart) {
  const Result result = hemicube_scatter(ScatterSize{.scenes = 1, .triangles = 100, .resolutions = {20}}, 1, kNoHooks);
  ASSERT_EQ(result.figures.size(), 2U);
  for (const page::Figure& figure : result.figures) EXPECT_NE(figure.script.find("missed"), std::string::npos);
}

// --- times ---------------------------------------------------------------------------------------------

TEST(KarkanisTimes, LocalExponentsOfHisTimesAreThosePublished) {
  EXPECT_NEAR(local_exponent(50, 0.2, 100, 2.8), 3.807, 1e-3);
  EXPECT_NEAR(local_exponent(200, 300.0, 500, 28800.0), 4.981, 1e-3);
}

TEST(KarkanisTimes, TheShaftSavesPairsAndChangesNoBit) {
  const WorkRow row = work_row(40, true);
  EXPECT_EQ(row.differences, std::size_t{0});
  EXPECT_EQ(row.looked_at_without, 40U * 40U);  // every other triangle and the light behind them
  EXPECT_LT(row.looked_at, *row.looked_at_without / 4);
  EXPECT_GT(row.visible, 30U);
  EXPECT_GT(row.sum, 0.0);
  EXPECT_FALSE(work_row(10, false).differences);
}

TEST(KarkanisTimes, NamesWhatTheBudgetLeavesOut) {
  TimesSize size{.triangles = {10, 20, 40}};
  size.budget = 0.0;
  const Result result = karkanis_times(size, kNoHooks);
  ASSERT_EQ(result.left_out.size(), 1U);
  EXPECT_NE(result.left_out[0].what.find("20 and 40"), std::string::npos) << result.left_out[0].what;
  ASSERT_EQ(result.values.size(), 1U);
  EXPECT_EQ(result.values[0].csv, karkanis_times(size, kNoHooks).values[0].csv);
}

// --- cells of one radiosity ---

TEST(Meshing, SeesTheCornellBoxOfTheFile) {
  const Scene ours = cornell_box().scene, theirs = read_obj(EXACTFF_DATA_DIR "/scenes/cornell_box.obj");
  EXPECT_TRUE(std::ranges::equal(ours.vertices(), theirs.vertices()));
  ASSERT_EQ(ours.faces().size(), theirs.faces().size());
  for (std::size_t f = 0; f < ours.faces().size(); ++f) {
    const Face &one = ours.faces()[f], &other = theirs.faces()[f];
    EXPECT_EQ(one.rings, other.rings);
    EXPECT_EQ(ours.patch(one.patch).name, theirs.patch(other.patch).name);
    EXPECT_EQ(ours.material(one.material).name, theirs.material(other.material).name);
    EXPECT_EQ(ours.material(one.material).reflectance, theirs.material(other.material).reflectance);
    EXPECT_EQ(ours.material(one.material).radiosity, theirs.material(other.material).radiosity);
  }
}

TEST(Meshing, SmallerCellsErrLess) {
  const MeshingStudy study = meshing_study(corner(), small_meshing(), 1, kNoHooks);
  ASSERT_EQ(study.levels.size(), 3U);
  EXPECT_EQ(study.reference.parts, 8);
  EXPECT_EQ(study.levels[1].cells, 9U);
  EXPECT_GT(study.levels[0].all.pixels, 100U);
  EXPECT_GT(study.levels[0].all.rms, 0.001);
  for (std::size_t l = 0; l < 3; ++l) {
    const MeshingLevel& level = study.levels[l];
    EXPECT_GE(level.all.worst, level.all.p99);
    EXPECT_GT(level.all.p99, level.all.rms);
    EXPECT_GT(level.share_of_worst_tenth, 0.15);
    EXPECT_EQ(level.patches[2].pixels, 0U) << "the lamp does not count";
    EXPECT_EQ(level.patches[0].pixels + level.patches[1].pixels, level.all.pixels);
    if (l == 0) continue;
    EXPECT_LT(level.all.rms, 0.9 * study.levels[l - 1].all.rms);
  }
  ASSERT_TRUE(study.slope);
  EXPECT_GT(*study.slope, 0.5);
  EXPECT_LT(*study.slope, 2.0);
}

// Light that is the same everywhere does not depend on cells: B is 2 in all of this room, whose walls emit 1 and
// reflect a half, but for one that reflects all.
TEST(Meshing, InAFurnaceCellsDoNotMatter) {
  SceneBuilder builder;
  const MaterialId glow =
      builder.add_material({.name = "glow", .reflectance = {0.5, 0.5, 0.5}, .radiosity = {1, 1, 1}});
  const MaterialId white = builder.add_material({.name = "white", .reflectance = {1, 1, 1}});
  const auto corner_at = [&](int i) {
    return Vec3{static_cast<double>(i & 1), static_cast<double>(i >> 1 & 1), static_cast<double>(i >> 2 & 1)};
  };
  for (int i = 0; i < 8; ++i) builder.add_vertex(corner_at(i));
  const std::vector<std::vector<std::uint32_t>> sides = {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1},
                                                         {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}};
  for (std::size_t i = 0; i < sides.size(); ++i) {
    builder.add_face(builder.patch("side " + std::to_string(i)), i == 0 ? white : glow, {sides[i]});
  }
  const MeshingScene room{builder.build(),
                          {.eye = {0.5, 0.5, 0.875}, .look = {0.5, 0.5, 0}, .up = {0, 1, 0}, .fov = 90.0}};
  const MeshingStudy study = meshing_study(room, {.parts = {1, 2}, .pixels = 8}, 1, kNoHooks);
  EXPECT_EQ(study.levels.front().all.pixels, 16U) << "48 of 64 show a wall that emits";
  EXPECT_LT(study.levels.front().all.worst, 1e-3);
  EXPECT_NEAR(study.levels.front().all.mean_ratio, 1.0, 1e-3);
  EXPECT_LT(study.reference.half_width, 0.05);
}

// --- the plot they need --------------------------------------------------------------------------------

TEST(ScatterPlot, RoundsItsPointsAndDrawsEachPlaceOnce) {
  const page::Axes axes{.x = "x", .y = "y"};
  const std::string script = page::scatter_plot(
      axes,
      {{"cloud", {{0.123456, 1.0}, {0.123461, 1.0}, {2.0, 0.0}, {3.0, 5.0}}, 1}, {"diagonal", {{1, 1}, {2, 2}}, 0}});
  EXPECT_NE(script.find("0.1235 1\n3 5\nEND"), std::string::npos) << script;
  EXPECT_NE(script.find("'diagonal'"), std::string::npos);
  EXPECT_EQ(script.find("0.12346"), std::string::npos);
  EXPECT_EQ(page::scatter_plot(axes, {{"nothing", {{-1.0, 1.0}}, 1}}), "");
}

}  // namespace
}  // namespace exactff::experiments
