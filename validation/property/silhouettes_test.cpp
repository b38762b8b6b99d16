// A search by silhouettes finds what a search by outlines and the Booleans find. EXACTFF_TEST_SCALE multiplies the
// number of random scenes.
#include "contour/contour.h"
#include "exact/source_planes.h"
#include "kernel/ball.h"
#include "support/random_meshes.h"
#include "support/solve.h"
#include "support/test.h"
#include "visibility/visible_boundary.h"

namespace exactff::validation {
namespace {

using visibility::BoundaryRequest;
using visibility::EdgeWorkspace;
using visibility::PlaneVisibility;
using visibility::Silhouetting;

struct Tally {
  std::uint64_t searches = 0, by_silhouettes = 0, partly_hidden = 0;
};

Ball integral(const visibility::View& view, const PlaneVisibility& seen) {
  contour::ContourIntegral contour(view.normal().exact);
  seen.boundary.for_each_piece([&](const visibility::BoundaryPiece& piece) { contour.add(piece); });
  return contour.evaluate(256);
}

// Boundaries with the same integral and the same area, both to 60 digits or exactly.
void expect_same(const visibility::View& view, const PlaneVisibility& found, const PlaneVisibility& expected) {
  EXPECT_EQ(found.boundary.empty(), expected.boundary.empty());
  EXPECT_EQ(*found.fraction, *expected.fraction);
  EXPECT_EQ(found.record.horizon_clipped, expected.record.horizon_clipped);
  if (found.boundary.empty() || expected.boundary.empty()) return;
  Enclosure a, b;
  EnclosureInside::set(a, integral(view, found));
  EnclosureInside::set(b, integral(view, expected));
  EXPECT_TRUE(a.overlaps(b)) << "by silhouettes " << a.midpoint() << ", else " << b.midpoint();
}

void check_scene(const PlainScene& plain, Random& random, EdgeWorkspace& workspace, EdgeWorkspace& other,
                 Tally& tally) {
  const Scene scene = generate::build(plain);
  const ExactSource source(scene, scene.select(plain.source));
  for (const Receiver& receiver : receivers_about(scene, plain, random)) {
    const visibility::View view(scene, receiver);
    for (const visibility::SourcePlane& plane : ExactSourceInside::planes(source).planes) {
      const PlaneVisibility found =
          find_visible_boundary(view, plane, {.fraction = true, .silhouettes = Silhouetting::kAlways}, workspace);
      const PlaneVisibility by_outlines =
          find_visible_boundary(view, plane, {.fraction = true, .silhouettes = Silhouetting::kNever}, other);
      expect_same(view, found, by_outlines);
      ++tally.searches;
      tally.by_silhouettes += found.record.silhouettes > 0 ? 1 : 0;
      tally.partly_hidden += found.record.outcome == Outcome::kPartlyHidden ? 1 : 0;
      if (random.one_in(4)) {
        const PlaneVisibility by_booleans =
            find_visible_boundary(view, plane, {.engine = Engine::kBoolean, .fraction = true}, other);
        expect_same(view, found, by_booleans);
      }
    }
  }
}

class Silhouettes : public testing::TestWithParam<RandomFamily> {};

TEST_P(Silhouettes, GiveTheSameBoundary) {
  EdgeWorkspace workspace, other;
  Tally tally;
  for (std::uint64_t i = 0; i < scaled_count(GetParam().count / 2 + 1); ++i) {
    SCOPED_TRACE("seed " + std::to_string(seed_of(i)));
    Random random(seed_of(i));
    const PlainScene plain = GetParam().make(random);
    check_scene(plain, random, workspace, other, tally);
    if (HasFailure()) return;
  }
  RecordProperty("searches", std::to_string(tally.searches));
  RecordProperty("by_silhouettes", std::to_string(tally.by_silhouettes));
  RecordProperty("partly_hidden", std::to_string(tally.partly_hidden));
}

INSTANTIATE_TEST_SUITE_P(RandomScenes, Silhouettes, testing::ValuesIn(random_families()),
                         [](const auto& family) { return family.param.name; });
INSTANTIATE_TEST_SUITE_P(RandomMeshes, Silhouettes, testing::ValuesIn(mesh_families()),
                         [](const auto& family) { return family.param.name; });

}  // namespace
}  // namespace exactff::validation
