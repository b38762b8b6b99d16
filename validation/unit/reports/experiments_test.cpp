// The experiments of the report, each on a scene that is small enough for a test, and their shared helpers.
#include "experiments/experiments.h"

#include "kernel/statistics.h"
#include "page/gnuplot.h"
#include "support/test.h"

namespace exactff::experiments {
namespace {

const Hooks kNoHooks;

// A floor and a wall that meet, and a lamp above the floor.
MeshingScene corner() {
  const Rgb grey{0.75, 0.5, 0.25};
  PlainScene plain;
  add(plain, "floor", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, grey, {});
  add(plain, "wall", {{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}}, grey, {});
  add(plain, "lamp", {{0.375, 0.375, 1}, {0.375, 0.625, 1}, {0.625, 0.625, 1}, {0.625, 0.375, 1}}, {}, {4, 4, 4});
  return {generate::build(plain), {.eye = {4, 1.5, 3}, .look = {0.25, 0.5, 0.25}, .up = {0, 0, 1}, .fov = 22.0}};
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

TEST(KarkanisTimes, TheShaftSavesPairsAndChangesNoBit) {
  const WorkRow row = work_row(40, true);
  EXPECT_EQ(row.differences, std::size_t{0});
  EXPECT_EQ(row.looked_at_without, 40U * 40U);  // every other triangle and the light behind them
  EXPECT_LT(row.looked_at, *row.looked_at_without / 4);
  EXPECT_GT(row.visible, 30U);
  EXPECT_GT(row.sum, 0.0);
  EXPECT_FALSE(work_row(10, false).differences);
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

TEST(KarkanisTimes, NamesWhatTheBudgetLeavesOut) {
  TimesSize size{.triangles = {10, 20, 40}};
  size.budget = 0.0;
  const Result result = karkanis_times(size, kNoHooks);
  ASSERT_EQ(result.left_out.size(), 1U);
  EXPECT_HOLDS(result.left_out[0].what, "20 and 40");
  ASSERT_EQ(result.values.size(), 1U);
  EXPECT_EQ(result.values[0].csv, karkanis_times(size, kNoHooks).values[0].csv);
}

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

}  // namespace
}  // namespace exactff::experiments
