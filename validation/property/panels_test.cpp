// A scene costs less if its neighbouring faces in one plane are joined, and nothing else changes: the edge engine,
// which looks at panels, agrees in every bit with the Booleans, which look at pieces, and with polygons that were never
// cut. EXACTFF_TEST_SCALE multiplies the number of random scenes.
#include "scene/panels.h"

#include "generate/vectors.h"
#include "support/oracle_check.h"
#include "support/random_meshes.h"
#include "support/solve.h"
#include "support/test.h"
#include "support/transform.h"
#include "visibility/plane_visibility.h"

namespace exactff::validation {
namespace {

using generate::operator+;
using generate::operator*;

constexpr ExactOptions kBothEngines{.engine = Engine::kBoth, .visible_fraction = true};

// The source is cut as well.
PlainScene all_retriangulated(const PlainScene& scene, Random& random) {
  PlainScene renamed = scene;
  renamed.source = "no patch";
  std::erase_if(renamed.patches, [](const generate::PlainPatch& patch) { return patch.faces.empty(); });
  PlainScene cut = retriangulated(renamed, random);
  cut.source = scene.source;
  return cut.patch(cut.source).faces.empty() ? scene : cut;  // a source without area has no pieces
}

bool has_sheets(const Scene& scene) { return !panels(scene).empty(); }

class PanelsOf : public testing::TestWithParam<RandomFamily> {};

TEST_P(PanelsOf, CutPolygonsHideWhatTheyHidBefore) {
  std::uint64_t joined = 0;
  for (std::uint64_t i = 0; i < scaled_count(1 + GetParam().count / 4); ++i) {
    Random random(seed_of(i));
    const PlainScene plain = GetParam().make(random);
    const PlainScene cut = all_retriangulated(plain, random);
    const Scene scene = generate::build(cut);
    joined += has_sheets(scene) ? 1 : 0;
    // Of faces that lie on each other, the way they are cut tells which belong to a solid.
    if (some_is_buried(scene) || some_is_buried(generate::build(plain))) continue;
    const ExactSource source(scene, scene.select(cut.source));
    const FormFactor found = exact_form_factor(scene, generate::receiver_of(cut), source, kBothEngines);
    ASSERT_EQ(answer_of(found), answer(plain)) << "seed " << seed_of(i) << '\n' << generate::to_obj(plain);
  }
  RecordProperty("joined", std::to_string(joined));
}

INSTANTIATE_TEST_SUITE_P(RandomScenes, PanelsOf, testing::ValuesIn(random_families()),
                         [](const auto& family) { return family.param.name; });
INSTANTIATE_TEST_SUITE_P(RandomMeshes, PanelsOf, testing::ValuesIn(mesh_families()),
                         [](const auto& family) { return family.param.name; });

// Walls in slanted planes, each a grid of squares cut in two. Some triangles are gone, turned over, repeated or cut
// again, some are transparent; the source is a wall or one of its faces; the receiver lies on a face of a wall, as near
// as doubles come to it, or anywhere.
class WallScene {
 public:
  explicit WallScene(Random& random) : random_(random) {
    for (const char* name : {"source", "near", "between", "other"}) add_wall(name);
  }

  [[nodiscard]] const PlainScene& plain() const { return plain_; }

 private:
  void add_wall(const char* name) {
    const bool is_source = std::string(name) == "source", is_near = std::string(name) == "near";
    const Vec3 corner{-1, -1, is_source ? 2.0 : is_near ? -0.5 : random_.integer(-2, 12) / 8.0};
    const double slope = random_.integer(-2, 2) / 16.0, twist = random_.integer(-2, 2) / 16.0;
    const Vec3 u{is_source ? -0.5 : 0.5, 0, slope}, v{0, 0.5, twist};
    const Vec3 from = is_source ? corner + Vec3{2, 0, 0} : corner;
    std::vector<std::vector<Vec3>> faces;
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) {
        const auto at = [&](int a, int b) { return from + (1.0 * (i + a)) * u + (1.0 * (j + b)) * v; };
        faces.push_back({at(0, 0), at(1, 0), at(1, 1)});
        faces.push_back({at(0, 0), at(1, 1), at(0, 1)});
      }
    }
    spoil(faces);
    for (const auto& face : faces) plain_.add_ring(plain_.patch(name), face);
  }

  void spoil(std::vector<std::vector<Vec3>>& faces) {
    const bool whole = random_.one_in(3);
    std::vector<std::vector<Vec3>> result;
    for (const auto& face : faces) {
      if (!whole && random_.one_in(6)) continue;
      result.push_back(face);
      if (whole) continue;
      if (random_.one_in(16)) std::swap(result.back()[0], result.back()[1]);
      if (random_.one_in(16)) result.push_back(face);
      if (random_.one_in(12)) {  // cut, whatever its neighbour is
        const Vec3 middle = 0.5 * face[0] + 0.5 * face[1];
        result.back() = {face[0], middle, face[2]};
        result.push_back({middle, face[1], face[2]});
      }
    }
    if (!result.empty()) faces = std::move(result);
  }

  Random& random_;
  PlainScene plain_;
};

// On a face of the wall `near`, and as far from it as rounding goes; or anywhere.
Receiver receiver_by(const Scene& scene, Random& random) {
  const Patch& near = scene.patch(scene.select("near").patch);
  const FaceId own = near.faces[random.below(near.faces.size())];
  const auto& ring = scene.face(own).rings.front();
  Vec3 point;
  for (const std::uint32_t corner : ring) point = point + (1.0 / 3.0) * scene.vertices()[corner];
  Receiver receiver{.point = point, .normal = {0, 0, 1}, .on = {own}, .id = {}};
  if (random.one_in(3)) receiver.on.clear();
  if (random.one_in(4)) receiver.point.z += random.one_in(2) ? 0.25 : -0.25;
  return receiver;
}

TEST(Panels, OfSpoiltWallsHideWhatTheirPiecesHide) {
  std::uint64_t joined = 0, partly = 0;
  for (std::uint64_t i = 0; i < scaled_count(60); ++i) {
    SCOPED_TRACE("seed " + std::to_string(seed_of(i)));
    Random random(seed_of(i));
    const WallScene walls(random);
    Scene scene = generate::build(walls.plain());
    if (random.one_in(3)) {
      const std::vector<Selection> glass{scene.select("between:1"), scene.select("other:2")};
      scene = scene.with_transparent(glass);
    }
    if (random.one_in(4)) scene = scene.with_flipped(scene.select("between"));
    joined += has_sheets(scene) ? 1 : 0;
    const Selection source = scene.select(random.one_in(4) ? "source:3" : "source");
    const ExactSource prepared(scene, source);
    Workspace workspace;
    for (int k = 0; k < 3; ++k) {
      const Receiver receiver = receiver_by(scene, random);
      FormFactor found;
      exact_form_factor(scene, receiver, prepared, kBothEngines, found, workspace);
      partly += found.visible_part == VisiblePart::kSome ? 1 : 0;
      ExactOptions without_culling = kBothEngines;
      without_culling.culling = ShaftCulling::kNone;
      std::vector<FaceId> only;
      for (std::uint32_t f = 0; f < scene.faces().size(); ++f) {
        if (!random.one_in(3)) only.push_back(FaceId{f});
      }
      EXPECT_EQ(answer_of(exact_form_factor(scene, receiver, prepared, without_culling)), answer_of(found));
      ExactOptions with_some = kBothEngines;
      with_some.only_occluders = &only;
      exact_form_factor(scene, receiver, prepared, with_some, found, workspace);
    }
    if (HasFailure()) return;
  }
  EXPECT_GT(joined, 0U);
  EXPECT_GT(partly, 0U);
}

}  // namespace
}  // namespace exactff::validation
