// The exact method step by step: which outcome, which candidates, what hides and what does not.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "exactff/exact.h"
#include "generate/plain_scene.h"
#include "support/solve.h"

namespace exactff {
namespace {

using generate::PlainScene;
using Corners = std::vector<Vec3>;

// Source [-1,1]^2 at z = 1 facing down, receiver at the origin facing up.
PlainScene scene_with(const std::vector<Corners>& occluders) {
  PlainScene scene;
  scene.add_ring(scene.patch("source"), {{-1, 1, 1}, {1, 1, 1}, {1, -1, 1}, {-1, -1, 1}});
  for (std::size_t i = 0; i < occluders.size(); ++i) {
    scene.add_ring(scene.patch("o" + std::to_string(i + 1)), occluders[i]);
  }
  return scene;
}

Corners square(double half, double z, double x = 0.0, double y = 0.0) {
  return {{x - half, y - half, z}, {x + half, y - half, z}, {x + half, y + half, z}, {x - half, y + half, z}};
}

PlaneRecord record_of(const PlainScene& scene) { return validation::solve(scene).planes.at(0); }
double value_of(const PlainScene& scene) { return validation::solve(scene).value; }
const double kOpen = value_of(scene_with({}));

TEST(VisibleBoundary, ReachesEveryOutcome) {
  EXPECT_EQ(record_of(scene_with({})).outcome, Outcome::kUnoccluded);
  EXPECT_EQ(record_of(scene_with({square(0.25, 0.5)})).outcome, Outcome::kPartlyHidden);
  EXPECT_EQ(record_of(scene_with({square(0.5, 0.5)})).outcome, Outcome::kHiddenByOne);
  EXPECT_EQ(record_of(scene_with({square(0.5, 0.5, -0.25), square(0.5, 0.5, 0.25)})).outcome, Outcome::kHiddenByUnion);
  PlainScene behind = scene_with({});
  behind.point.z = 2.0;
  EXPECT_EQ(record_of(behind).outcome, Outcome::kBehind);
  behind.point.z = 1.0;  // in the plane
  EXPECT_EQ(record_of(behind).outcome, Outcome::kBehind);
  PlainScene below = scene_with({});
  below.normal.z = -1.0;
  EXPECT_EQ(record_of(below).outcome, Outcome::kBelowHorizon);
}

TEST(VisibleBoundary, TheReceiversOwnFaceNeitherOccludesNorIlluminates) {
  const PlainScene plain = scene_with({square(0.25, 0.5)});
  const Scene scene = generate::build(plain);
  Receiver receiver = generate::receiver_of(plain);
  const ExactSource source(scene, scene.select("source"));
  receiver.on = scene.faces_of(scene.select("o1")).front();
  EXPECT_EQ(exact_form_factor(scene, receiver, source).value, kOpen);
  receiver.on = scene.faces_of(scene.select("source")).front();
  const FormFactor result = exact_form_factor(scene, receiver, source);
  EXPECT_EQ(result.status, Status::kZero);
  EXPECT_EQ(result.planes.at(0).outcome, Outcome::kReceiverFace);
}

TEST(VisibleBoundary, TouchingOccluderHidesNothing) {
  // Shadows that share an edge, a corner, or only the plane of a side with the source.
  for (const Corners& touching : {Corners{{0.5, -0.5, 0.5}, {2, -0.5, 0.5}, {2, 0.5, 0.5}, {0.5, 0.5, 0.5}},
                                  Corners{{0.5, 0.5, 0.5}, {2, 0.5, 0.5}, {2, 2, 0.5}, {0.5, 2, 0.5}},
                                  Corners{{0.5, 1, 0.5}, {0.5, 2, 0.5}, {2, 2, 0.5}}}) {
    const PlaneRecord record = record_of(scene_with({touching}));
    EXPECT_EQ(record.outcome, Outcome::kUnoccluded);
    EXPECT_EQ(record.candidates, 0U);
  }
}

TEST(VisibleBoundary, FacesSeenEdgeOnOrBeyondOrInTheSourcesPlaneHideNothing) {
  const Corners edge_on = {{-0.3, 0, 0.2}, {0.4, 0, 0.2}, {0.4, 0, 0.9}, {-0.3, 0, 0.9}};
  const Corners through_x = {{-1, 0, -1}, {1, 0, -1}, {1, 0, 0.9}, {-1, 0, 0.9}};
  const Corners coplanar = square(0.5, 1.0);
  const Corners farther = square(0.5, std::nextafter(1.0, 2.0));
  const Corners behind_x = square(5.0, -0.5);
  for (const Corners& harmless : {edge_on, through_x, coplanar, farther, behind_x}) {
    EXPECT_EQ(value_of(scene_with({harmless})), kOpen);
    EXPECT_EQ(record_of(scene_with({harmless})).candidates, 0U);
  }
}

TEST(VisibleBoundary, OneUlpNearerThanTheSourceHides) {
  EXPECT_EQ(record_of(scene_with({square(0.5, std::nextafter(1.0, 0.0))})).outcome, Outcome::kPartlyHidden);
  EXPECT_EQ(record_of(scene_with({square(1.0, std::nextafter(1.0, 0.0))})).outcome, Outcome::kHiddenByOne);
}

TEST(VisibleBoundary, AFaceThroughTheSourcesPlaneHidesWithItsNearPartOnly) {
  // A vertical wall at x = 0.5 from z = 0.5 up through the source: its part below z = 1 shades x > 0.5.
  const Corners wall = {{0.5, -4, 0.5}, {0.5, 4, 0.5}, {0.5, 4, 3}, {0.5, -4, 3}};
  const PlainScene scene = scene_with({wall});
  PlainScene half = scene_with({});
  half.patches.clear();
  half.add_ring(half.patch("source"), {{-1, 1, 1}, {0.5, 1, 1}, {0.5, -1, 1}, {-1, -1, 1}});
  EXPECT_EQ(value_of(scene), value_of(half));
  EXPECT_EQ(record_of(scene).clipped, 1U);
}

TEST(VisibleBoundary, AFaceThroughThePlaneOfXStaysBounded) {
  // Slanted from behind x to ahead of it; its shadow would reach to infinity without the clip.
  const Corners slanted = {{-3, -3, -0.5}, {3, -3, -0.5}, {3, 1, 0.7}, {-3, 1, 0.7}};
  const PlaneRecord record = record_of(scene_with({slanted}));
  EXPECT_EQ(record.candidates, 1U);
  EXPECT_TRUE(record.outcome == Outcome::kPartlyHidden || record.outcome == Outcome::kHiddenByOne);
}

TEST(VisibleBoundary, BothSidesOfAnOccluderBlock) {
  Corners reversed = square(0.25, 0.5);
  std::swap(reversed[1], reversed[3]);
  EXPECT_EQ(value_of(scene_with({reversed})), value_of(scene_with({square(0.25, 0.5)})));
}

TEST(VisibleBoundary, AHoleInAnOccluderLetsLightThrough) {
  PlainScene ring = scene_with({});
  ring.add_rings(ring.patch("o1"), {square(1.0, 0.5), square(0.25, 0.5)});
  PlainScene window = scene_with({});
  window.patches.clear();
  window.add_ring(window.patch("source"), {{-0.5, 0.5, 1}, {0.5, 0.5, 1}, {0.5, -0.5, 1}, {-0.5, -0.5, 1}});
  EXPECT_EQ(value_of(ring), value_of(window));
}

TEST(VisibleBoundary, CoplanarFacesOfTheSourceCountOnce) {
  PlainScene doubled = scene_with({});
  doubled.add_ring(doubled.patch("source"), {{-1, 1, 1}, {0.3, 1, 1}, {0.3, -1, 1}, {-1, -1, 1}});
  const FormFactor result = validation::solve(doubled);
  EXPECT_EQ(result.value, kOpen);
  EXPECT_EQ(result.planes.size(), 1U);
  EXPECT_EQ(result.planes[0].edges, 4U) << "collinear pieces merge, interior edges vanish";
}

TEST(VisibleBoundary, CoplanarFacesOfOtherPatchesCountFully) {
  PlainScene plain = scene_with({});
  plain.add_ring(plain.patch("twin"), {{-1, 1, 1}, {1, 1, 1}, {1, -1, 1}, {-1, -1, 1}});
  EXPECT_EQ(value_of(plain), kOpen);
  plain.source = "twin";
  EXPECT_EQ(value_of(plain), kOpen);
}

TEST(VisibleBoundary, OtherFacesOfTheSourceOccludeIt) {
  PlainScene plain = scene_with({});
  plain.add_ring(plain.patch("source"), square(0.25, 0.5));  // faces up, away from x: gives nothing itself
  EXPECT_EQ(value_of(plain), value_of(scene_with({square(0.25, 0.5)})));
}

TEST(VisibleBoundary, ADiscWithHorizonThroughItKeepsTheUpperPart) {
  PlainScene plain = scene_with({});
  plain.normal = {1, 0, 0};
  const FormFactor result = validation::solve(plain, {.visible_fraction = true, .exact_fraction = true});
  EXPECT_TRUE(result.planes[0].horizon_clipped);
  EXPECT_EQ(result.planes[0].exact_fraction, "1/2");
  EXPECT_EQ(result.visible_fraction, 0.5);
}

TEST(VisibleBoundary, StagesTellWhatWasLeftOut) {
  const auto ran = [](const PlainScene& scene, const std::string& stage) {
    for (const StageNote& note : stages(record_of(scene))) {
      if (note.stage == stage) return note.ran;
    }
    ADD_FAILURE() << "no stage " << stage;
    return false;
  };
  const PlainScene open = scene_with({});
  const PlainScene cut = scene_with({square(0.25, 0.5)});
  const PlainScene hidden = scene_with({square(0.5, 0.5)});
  EXPECT_FALSE(ran(open, "projection and Booleans"));
  EXPECT_TRUE(ran(open, "contour"));
  EXPECT_TRUE(ran(cut, "projection and Booleans"));
  EXPECT_FALSE(ran(cut, "horizon clip"));
  EXPECT_FALSE(ran(hidden, "projection and Booleans"));
  EXPECT_FALSE(ran(hidden, "contour"));
  EXPECT_TRUE(ran(hidden, "total occlusion"));
}

}  // namespace
}  // namespace exactff
