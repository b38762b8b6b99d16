// Leaves of the adaptive algorithm whose rays miss that a source is seen in part.
#include "study/silent_errors.h"

#include <gtest/gtest.h>

#include <vector>

namespace exactff::study {
namespace {

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

}  // namespace
}  // namespace exactff::study
