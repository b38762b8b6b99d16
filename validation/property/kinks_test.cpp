// A search for kinks that begins with a proof by silhouettes finds the kinks that a search by outlines finds.
// EXACTFF_TEST_SCALE multiplies the number of random scenes.
#include "exact/source_planes.h"
#include "gradient/gradient.h"
#include "support/random_meshes.h"
#include "support/solve.h"
#include "support/test.h"
#include "visibility/visible_boundary.h"

namespace exactff::validation {
namespace {

using gradient::KinkProof;
using gradient::KinkSearch;
using visibility::BoundaryRequest;
using visibility::PlaneQuery;
using visibility::Silhouetting;

struct KinkTally {
  std::uint64_t searches = 0, proved = 0, kinks = 0;
};

class Kinks : public testing::TestWithParam<RandomFamily> {
 protected:
  void check(const visibility::View& view, const visibility::SourcePlane& plane, KinkTally& tally) {
    const BoundaryRequest with{.silhouettes = Silhouetting::kAlways}, without{.silhouettes = Silhouetting::kNever};
    const bool is_visible = !find_visible_boundary(view, plane, without, workspace_).boundary.empty();
    for (const KinkSearch::Extent extent : {KinkSearch::Extent::kFirst, KinkSearch::Extent::kAll}) {
      found_.find({view, plane, with}, is_visible, extent);
      expected_.find({view, plane, without}, is_visible, extent);
      ASSERT_EQ(found_.kink().has_value(), expected_.kink().has_value());
      if (!found_.kink()) continue;
      EXPECT_EQ(found_.kink()->reason, expected_.kink()->reason);
      EXPECT_EQ(found_.kink()->faces, expected_.kink()->faces);
    }
    ++tally.searches;
    tally.kinks += found_.kink() ? 1 : 0;
    if (side_of(plane, view.x) > 0) tally.proved += proof_.excludes_kinks({view, plane, with}) ? 1 : 0;
  }

 private:
  visibility::EdgeWorkspace workspace_;
  KinkSearch found_, expected_;
  KinkProof proof_;
};

TEST_P(Kinks, AreThoseOfASearchWithoutProof) {
  KinkTally tally;
  for (std::uint64_t i = 0; i < scaled_count(GetParam().count / 2 + 1); ++i) {
    Random random(seed_of(i));
    const PlainScene plain = GetParam().make(random);
    SCOPED_TRACE("seed " + std::to_string(seed_of(i)) + '\n' + generate::to_obj(plain));
    const Scene scene = generate::build(plain);
    const ExactSource source(scene, scene.select(plain.source));
    for (const Receiver& receiver : receivers_about(scene, plain, random)) {
      const visibility::View view(scene, receiver);
      for (const visibility::SourcePlane& plane : ExactSourceInside::planes(source).planes) check(view, plane, tally);
    }
    if (HasFailure()) return;
  }
  RecordProperty("searches", std::to_string(tally.searches));
  RecordProperty("proved", std::to_string(tally.proved));
  RecordProperty("kinks", std::to_string(tally.kinks));
}

INSTANTIATE_TEST_SUITE_P(RandomScenes, Kinks, testing::ValuesIn(random_families()),
                         [](const auto& family) { return family.param.name; });
INSTANTIATE_TEST_SUITE_P(RandomMeshes, Kinks, testing::ValuesIn(mesh_families()),
                         [](const auto& family) { return family.param.name; });

}  // namespace
}  // namespace exactff::validation
