// The experiments of the report, each on a scene that is small enough for a test, and their shared helpers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "exactff/models.h"
#include "exactff/scene_files.h"
#include "experiments/closure.h"
#include "experiments/experiment.h"
#include "experiments/gradient_differences.h"
#include "experiments/hemicube_resolution.h"
#include "experiments/hemicube_scatter.h"
#include "experiments/karkanis_times.h"
#include "experiments/meshing.h"
#include "experiments/nettle_rule.h"
#include "experiments/small_emitters.h"
#include "page/plot_script.h"

namespace exactff::experiments {
namespace {

const Hooks kNoHooks;

// --- what they share -----------------------------------------------------------------------------------

TEST(Experiments, AreFoundByNameAndNearlyByAnother) {
  ASSERT_EQ(all_experiments().size(), 9U);
  for (const Experiment& e : all_experiments()) EXPECT_EQ(&experiment_named(e.name), &e);
  try {
    (void)experiment_named("nettle");
    FAIL() << "there is none of that name";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("nettle-rule"), std::string::npos) << error.what();
  }
}

TEST(Experiments, AMeanSlopeHasStudentsInterval) {
  const std::vector<double> slopes = {-1.0, -2.0, -3.0};
  const SlopeFit fit = mean_slope(slopes);
  EXPECT_DOUBLE_EQ(fit.slope, -2.0);
  EXPECT_NEAR(fit.half_width, 4.3027 / std::sqrt(3.0), 1e-3);  // t of 2 degrees of freedom, standard deviation 1
  EXPECT_EQ(to_text(fit), "−2.00 ± 2.48");
  EXPECT_EQ(slope_text(0.996), "1.00");
  EXPECT_EQ(slope_text(-0.001), "0.00");
}

TEST(Experiments, TellWhereABrokenLineReachesAValue) {
  const Points line = {{1.0, 1.0}, {10.0, 100.0}, {100.0, 100.0}};
  EXPECT_NEAR(reaches(line, 10.0).value(), std::sqrt(10.0), 1e-12);
  EXPECT_FALSE(reaches(line, 1000.0));
  EXPECT_FALSE(reaches(line, 0.1));
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
  const auto resolution = [](int threads, const Hooks& hooks) {
    ResolutionSize size{.resolutions = {16, 32}, .rotations = {0, 45}, .distances = {1, 2, 4}};
    size.groups = 2;
    size.triangles = 20;
    size.places = 2;
    return hemicube_resolution(size, threads, hooks);
  };
  const auto nettle = [](int threads, const Hooks& hooks) {
    NettleSize size{.sides = {0.05, 0.1, 0.5}, .splits = {1, 2}, .rays = 4, .groups = 2};
    size.configurations = 3;
    size.orientations = 20;
    return nettle_rule(size, threads, hooks);
  };
  const auto emitters = [](int threads, const Hooks& hooks) {
    return small_emitters(EmittersSize{.lamps = 4, .grid = 3, .timed = 1, .choices = {"hemicube", "nettle:rays=4"}},
                          threads, hooks);
  };
  const auto room = [](int threads, const Hooks& hooks) {
    return closure(ClosureSize{.receivers = 4, .choices = {"hemicube", "nettle:rays=4"}}, threads, hooks);
  };
  const auto differences = [](int threads, const Hooks& hooks) {
    return gradient_differences(
        DifferencesSize{.receivers = 3, .steps = {0.01, 1e-4}, .choices = {"exact"}, .timed = 1}, threads, hooks);
  };
  const auto cells = [](int threads, const Hooks& hooks) {
    return meshing(corner(), MeshingSize{.parts = {1, 2}, .pixels = 6}, threads, hooks);
  };
  return {{"differences", differences},
          {"scatter", scatter},
          {"resolution", resolution},
          {"nettle", nettle},
          {"emitters", emitters},
          {"room", room},
          {"cells", cells}};
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
  const std::vector<ScatterDecade> coarse = scatter_decades(points, 0), fine = scatter_decades(points, 1);
  EXPECT_LT(fine.back().median, 0.2 * coarse.back().median);
}

// --- resolution, rotation, distance --------------------------------------------------------------------

TEST(HemicubeResolution, SlopesAreThoseOfCountingPixels) {
  ResolutionSize size{.resolutions = {16, 32, 64, 128, 256}, .rotations = {0, 20, 45}, .distances = {1, 2, 4, 8}};
  size.groups = 4;
  size.triangles = 60;
  size.places = 8;
  const ResolutionCurves curves = resolution_curves(size, 1, kNoHooks);
  EXPECT_NEAR(curves.triangles_by_resolution.slope(1e9).slope, -1.5, 0.2);
  EXPECT_NEAR(curves.aligned_by_resolution.slope(1e9).slope, -1.0, 0.3);
  EXPECT_LT(curves.turned_by_resolution.slope(1e9).slope, curves.aligned_by_resolution.slope(1e9).slope - 0.3);
  EXPECT_GT(curves.light_by_rotation.rms[0], 2.0 * curves.light_by_rotation.rms[1]);
  EXPECT_GT(curves.light_by_rotation.rms[2], 2.0 * curves.light_by_rotation.rms[1]);
  EXPECT_GT(curves.turned_by_distance.slope(1e9).slope, 1.0);
}

// --- times ---------------------------------------------------------------------------------------------

TEST(KarkanisTimes, TheShaftSavesPairsAndChangesNoBit) {
  const WorkRow row = work_row(40, true);
  EXPECT_EQ(row.differences, std::size_t{0});
  EXPECT_EQ(row.looked_at_without, 40U * 40U);  // every other triangle and the light behind them
  EXPECT_LT(row.looked_at, *row.looked_at_without / 4);
  EXPECT_GT(row.visible, 30U);
  EXPECT_GT(row.sum, 0.0);
  EXPECT_FALSE(work_row(10, false).differences);
}

// --- Nettle --------------------------------------------------------------------------------------------

const NettleCurve& curve(const std::vector<NettleCurve>& curves, NettleCase kind, int splits) {
  return *std::ranges::find_if(curves, [&](const NettleCurve& c) { return c.kind == kind && c.splits == splits; });
}

NettleSize small_nettle() {
  NettleSize size{.sides = {0.02, 0.04, 0.08, 0.3}, .splits = {1, 4}, .rays = 16, .groups = 4};
  size.configurations = 8;
  return size;
}

TEST(NettleRule, SlopesAreTwoWithoutOcclusionOneWithTheExactFractionAndNoneWithRays) {
  const std::vector<NettleCurve> curves = nettle_curves(small_nettle(), 1, kNoHooks);
  EXPECT_NEAR(curve(curves, NettleCase::kFree, 1).slope().slope, 2.0, 0.02);
  EXPECT_NEAR(curve(curves, NettleCase::kExactV, 1).slope().slope, 1.0, 0.1);
  EXPECT_LT(curve(curves, NettleCase::kRayV, 1).slope().slope, 0.5);
}

TEST(NettleRule, SplittingDividesTheErrorByTheNumberOfParts) {
  const std::vector<NettleCurve> curves = nettle_curves(small_nettle(), 1, kNoHooks);
  const double whole = curve(curves, NettleCase::kFree, 1).rms.front();
  const double split = curve(curves, NettleCase::kFree, 4).rms.front();
  EXPECT_NEAR(whole / split, 16.0, 0.5);
}

TEST(NettleRule, TheLiteralTextIsPerAreaAndKnowsNoDirection) {
  NettleSize size = small_nettle();
  size.orientations = 200;
  const NettleLiteral row = nettle_literal(size, 1, kNoHooks).front();
  EXPECT_NEAR(row.sender_over_receiver * row.side * row.side, 1.0, 0.01);
  EXPECT_NEAR(row.receiver_over_sender * row.side * row.side, 1.0, 0.01);
  EXPECT_NEAR(row.in_tenths / row.sender_over_receiver, 0.01, 1e-4);
  const TurnedAway turned = nettle_turned_away(size);
  EXPECT_EQ(turned.pairs, 200U);
  EXPECT_NEAR(static_cast<double>(turned.zero), 150.0, 25.0);
  EXPECT_EQ(turned.literal_positive, turned.zero);
}

// --- finite differences ---

// Those of exact values come near the derivative, since nothing but rounding disturbs a small step; those of samples
// are far from it at every step, and the worse the smaller it is.
TEST(GradientDifferences, OfExactValuesComeNearAndThoseOfSamplesDoNot) {
  const DifferencesSize size{.receivers = 12,
                             .steps = {0.1, 1e-3, 1e-5},
                             .choices = {"exact", "area-sampling:samples=64,pattern=random"},
                             .timed = 1};
  const DifferencesStudy study = differences_study(size, 1, kNoHooks);
  ASSERT_EQ(study.errors.size(), 4U);
  EXPECT_GT(study.receivers, 12U);
  for (const DifferenceErrors& errors : study.errors) {
    const double least = errors.rms[errors.best()];
    if (errors.choice == "exact") {
      EXPECT_EQ(errors.best(), 2U) << errors.scene;
      EXPECT_LT(least, 1e-6) << errors.scene;
    } else {
      EXPECT_GT(least, 1e-2) << errors.scene;
      EXPECT_GT(errors.rms[2], 10.0 * errors.rms[1]) << errors.scene;
    }
  }
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

// --- emitters, closure ---------------------------------------------------------------------------------

TEST(SmallEmitters, ExactHasNoErrorAndTheHemicubeTheLargest) {
  const EmittersSize size{.lamps = 9, .grid = 4, .choices = {"exact", "hemicube", "adaptive:eps_B=0.001"}};
  const EmitterStudy study = emitter_study(size, 1, kNoHooks);
  ASSERT_EQ(study.methods.size(), 3U);
  EXPECT_GT(study.mean, 0.0);
  EXPECT_EQ(study.methods[0].worst, 0.0);
  EXPECT_GT(study.methods[2].rms, 0.0);
  EXPECT_GT(study.methods[1].rms, 10.0 * study.methods[2].rms);
  EXPECT_GE(study.methods[1].worst, study.methods[1].rms);
}

TEST(SmallEmitters, TheRadiosityIsThatOfAllLamps) {
  const EmitterStudy study = emitter_study({.lamps = 4, .grid = 3, .choices = {}}, 1, kNoHooks);
  const Scene hall = models::make_scene("emitters:n=4");
  for (std::size_t i = 0; i < study.receivers.size(); ++i) {
    const Receiver& receiver = study.receivers[i];
    double sum = 0.0;
    for (const Selection& lamp : hall.emitters()) {
      sum += hall.source_radiosity(lamp).r * exact_form_factor(hall, receiver, ExactSource(hall, lamp)).value;
    }
    EXPECT_DOUBLE_EQ(study.exact[i], hall.receiver_reflectance(receiver.on).r * sum);
  }
}

TEST(Closure, ExactBallsHoldOneAndTheHemicubeClosesThoughItsValuesErr) {
  const ClosureStudy study = closure_study({.receivers = 5, .choices = {"hemicube", "nettle:rays=4"}}, 1, kNoHooks);
  EXPECT_EQ(study.receivers, 5U);
  EXPECT_EQ(study.hold_one, 5U);
  EXPECT_LT(study.widest, 1e-14);
  EXPECT_LT(study.methods[0].worst, 1e-12);
  EXPECT_GT(study.methods[0].single_rms, 1e-5);
  EXPECT_GT(study.methods[1].rms, 1e-3);
}

// --- the plot they need --------------------------------------------------------------------------------

}  // namespace
}  // namespace exactff::experiments
