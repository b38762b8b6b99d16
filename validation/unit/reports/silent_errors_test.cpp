// Leaves of the adaptive algorithm whose rays miss that a source is seen in part.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "study/sight.h"
#include "unit/reports/study_support.h"

namespace exactff::study {
namespace {

using validation::small_request;
using validation::small_room;

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

TEST(SilentErrors, OfAStudyAreSummedUp) {
  const Scene room = small_room(true);
  const Study study = run(small_request(room, 1));
  bool any = false;
  for (std::size_t k = 0; k < study.settings.size(); ++k) {
    double worst = 0.0;
    for (const SampleRow& row : study.samples[k]) {
      worst = std::max(worst, std::abs(row.silent_error));
      EXPECT_TRUE(row.silent_error == 0.0 || row.silent_leaves + row.wrong_leaves > 0);
    }
    EXPECT_EQ(study.summaries[k].silent.worst, worst);
    any = any || worst > 0.0;
  }
  EXPECT_TRUE(any);
}

TEST(SilentErrors, HolesOfTheVisibleRegionAreNotVisible) {
  const std::vector<Loop> loops = {rectangle(0, 0, 1, 1), rectangle(0.25, 0.25, 0.75, 0.75, true)};
  const std::vector<Vec3> window = {{0, 0, 1}, {1, 0, 1}, {1, 0.5, 1}, {0, 0.5, 1}};
  EXPECT_NEAR(area_inside(loops, window, {0, 0, 1}), 0.5 - 0.125, 1e-15);
}

}  // namespace
}  // namespace exactff::study
