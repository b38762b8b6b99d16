// Profiles across the edges of shadows.
#include "study/sight.h"

#include <variant>

#include "study/settings.h"
#include "support/test.h"
#include "unit/reports/study_support.h"

namespace exactff::study {
namespace {

// A lamp [-1, 1]^2 at height 2 and half a plane at height 1, x > 0: the floor sees all of the lamp where x < -1 and
// nothing where x > 1.
Scene half_plane() {
  const Rgb grey{0.5, 0.5, 0.5};
  PlainScene plain;
  add(plain, "floor", {{-4, -1, 0}, {4, -1, 0}, {4, 1, 0}, {-4, 1, 0}}, grey, {});
  add(plain, "lamp", {{-1, -1, 2}, {-1, 1, 2}, {1, 1, 2}, {1, -1, 2}}, {}, {2, 2, 2});
  add(plain, "half", {{0, -50, 1}, {50, -50, 1}, {50, 50, 1}, {0, 50, 1}}, grey, {});
  return generate::build(plain);
}

// A study up to its exact values, on a grid of the floor.
struct Begun {
  const Scene& scene;
  std::vector<ExactSource> sources;
  Study study;

  explicit Begun(const Scene& of, GridSize size = {8, 2}) : scene(of) {
    study.request.scene = &scene;
    study.request.receivers = grid_receivers(scene, scene.select("floor"), size);
    study.request.sources = scene.emitters();
    study.request.threads = 2;
    sources.emplace_back(scene, scene.select("lamp"));
    for (const Receiver& receiver : study.request.receivers) {
      study.exact.emplace_back().sight = sights(scene, receiver, sources).front();
    }
  }
};

TEST(Profiles, HaveTheirKinksWhereTheHalfPlaneCastsThem) {
  const Scene scene = half_plane();
  Begun begun(scene);
  begun.study.methods.ladders = {parse_ladder("exact"), parse_ladder("hemicube:resolution=8|16|32")};
  const auto profile = std::get<Profile>(find_profile(begun.study, begun.sources, {}));
  EXPECT_EQ(profile.where, "row 1 of floor");
  ASSERT_EQ(profile.receivers.size(), 256U);
  const double start = profile.receivers.front().point.x;
  EXPECT_EQ(start, -4 + 8.0 / 512);
  ASSERT_EQ(profile.kinks.size(), 2U);
  EXPECT_NEAR(profile.kinks[0], -1 - start, 1e-6);
  EXPECT_NEAR(profile.kinks[1], 1 - start, 1e-6);
  ASSERT_EQ(profile.others.size(), 1U);
  EXPECT_EQ(profile.others[0].name, "hemicube, resolution 16");
  for (std::size_t i = 0; i < 256; ++i) {
    EXPECT_NEAR(profile.position[i], profile.receivers[i].point.x - start, 1e-12);
    const double f = exact_form_factor(scene, profile.receivers[i], begun.sources.front()).value;
    EXPECT_DOUBLE_EQ(profile.exact[i], 0.5 * 2 * f);
    EXPECT_NEAR(profile.others[0].radiosity[i], profile.exact[i], 0.1);
  }
}

// --- Leaves of the adaptive algorithm whose rays miss that a source is seen in part ---

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

TEST(SilentErrors, AddUpToWhatTheFormFactorIsOffBy) {
  const PlaneDrawing plane = unit_source(0.75);
  const auto error = [&](double x0, double x1, LeafReason reason) {
    Leaf one = leaf(x0, x1, reason);
    one.form_factor = 0.2;
    return judge_leaves({one}, {plane}).error;
  };
  EXPECT_NEAR(error(0.5, 1, LeafReason::kSampledVisible), 0.2 * 0.5, 1e-15);
  EXPECT_NEAR(error(0.5, 1, LeafReason::kSampledHidden), -0.2 * 0.5, 1e-15);
  EXPECT_NEAR(error(0, 1, LeafReason::kSampledVisible), 0.2 * 0.25, 1e-15);
  EXPECT_NEAR(error(0.8, 1, LeafReason::kSampledVisible), 0.2, 1e-15);
  EXPECT_NEAR(error(0, 0.5, LeafReason::kSampledHidden), -0.2, 1e-15);
  EXPECT_EQ(error(0, 0.5, LeafReason::kSampledVisible), 0.0);
  EXPECT_EQ(error(0, 1, LeafReason::kEpsF), 0.0) << "not decided by sampling";
}

}  // namespace
}  // namespace exactff::study
