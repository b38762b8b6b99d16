// The whole view on scenes of every random family, judged by what shares no code of the sweep: the per-source solver,
// in every bit; the two sides of every arc, found again in rational numbers; what nothing hides, as the form factor of
// a box around everything; shares and backs, as what faces add to others in one source.
#include "support/oracle_check.h"
#include "support/test.h"
#include "support/view_judge.h"
#include "support/view_scenes.h"

namespace exactff::validation {
namespace {

class View : public testing::TestWithParam<RandomFamily> {
 protected:
  template <class Check>
  static void for_each_scene(std::uint64_t divisor, const Check& check) {
    for_each_scene_of(GetParam(), divisor, check);
  }
};

TEST_P(View, GivesEveryPatchTheBitsOfThePerSourceSolver) {
  for_each_scene(1, [](const PlainScene&, const Scene& scene, const Receiver& receiver) {
    expect_patches_as_the_solver(scene, receiver);
  });
}

TEST_P(View, GivesEveryFaceTheBitsOfThePerSourceSolver) {
  for_each_scene(2, [](const PlainScene&, const Scene& scene, const Receiver& receiver) {
    const WholeView seen = view(scene, receiver, {.faces = true});
    for (std::uint32_t k = 0; k < scene.faces().size(); ++k) {
      const Selection face{.patch = scene.faces()[k].patch, .face = FaceId{k}, .scene = scene.id()};
      const FormFactor f = exact_form_factor(scene, receiver, {scene, face});
      const auto found = std::ranges::find(seen.patches, std::optional(FaceId{k}), &SeenPatch::face);
      expect_same_bits(found == seen.patches.end() ? ViewShare{} : found->form_factor, f, scene.name_of(FaceId{k}));
    }
  });
}

TEST_P(View, SharesAddUpToOne) {
  for_each_scene(2, [](const PlainScene&, const Scene& scene, const Receiver& receiver) {
    expect_shares_to_add_up(scene, receiver);
  });
}

// A box around the scene that looks inward, if its corners are doubles.
std::optional<PlainScene> under_a_sky(const PlainScene& plain) {
  double size = 0.0;
  const auto include = [&](const Vec3& v) { size = std::max({size, std::abs(v.x), std::abs(v.y), std::abs(v.z)}); };
  for (const Vec3& vertex : plain.vertices) include(vertex);
  include(plain.point);
  const double far = std::ldexp(1.0, std::ilogb(size) + 2);
  if (!std::isfinite(far) || size == 0.0) return {};
  PlainScene result = plain;
  generate::PlainPatch& sky = result.patch("sky of the test");
  const double l = -far, h = far;
  const std::vector<std::vector<Vec3>> faces = {
      {{l, l, l}, {h, l, l}, {h, h, l}, {l, h, l}}, {{l, l, h}, {l, h, h}, {h, h, h}, {h, l, h}},
      {{l, l, l}, {l, l, h}, {h, l, h}, {h, l, l}}, {{l, h, l}, {h, h, l}, {h, h, h}, {l, h, h}},
      {{l, l, l}, {l, h, l}, {l, h, h}, {l, l, h}}, {{h, l, l}, {h, l, h}, {h, h, h}, {h, h, l}}};
  for (const std::vector<Vec3>& face : faces) result.add_ring(sky, face);
  return result;
}

TEST_P(View, LeavesOpenWhatABoxAroundEverythingReceives) {
  for_each_scene(2, [](const PlainScene& plain, const Scene& scene, const Receiver& receiver) {
    const std::optional<PlainScene> covered = under_a_sky(plain);
    if (!covered) return;
    const Scene below = generate::build(*covered);
    Receiver same = receiver;
    const FormFactor f = exact_form_factor(below, same, {below, below.select("sky of the test")});
    expect_same_bits(view(scene, receiver).open, f, "open");
    EXPECT_EQ(view(below, same).open.status, Status::kZero);
  });
}

TEST_P(View, IsAsOpenAsOfTheSceneTurnedRound) {
  for_each_scene(2, [](const PlainScene&, const Scene& scene, const Receiver& receiver) {
    std::vector<Selection> all;
    for (std::size_t p = 0; p < scene.patches().size(); ++p) {
      all.push_back({.patch = static_cast<PatchId>(p), .face = {}, .scene = scene.id()});
    }
    expect_same_bits(view(scene, receiver).open, view(scene.with_flipped(all), receiver).open, "open");
  });
}

TEST_P(View, SharesOutWhatFacesCoverTogether) {
  constexpr std::size_t kMostFaces = 30;
  for_each_scene(4, [](const PlainScene&, const Scene& scene, const Receiver& receiver) {
    if (scene.faces().size() <= kMostFaces) expect_shares_of_unions(scene, receiver);
  });
}

TEST_P(View, HasOnBothSidesOfEveryArcWhatRationalNumbersFindThere) {
  for_each_scene(2, [](const PlainScene&, const Scene& scene, const Receiver& receiver) {
    expect_sides_as_rational_numbers_find(scene, receiver);
  });
}

// --- Models ---

class ViewOfModel : public testing::TestWithParam<const char*> {};

// From points inside and outside, on lattices that the scenes' corners share, and in general position.
TEST_P(ViewOfModel, GivesEveryPatchAndFaceTheBitsOfThePerSourceSolver) {
  const Scene scene = models::make_scene(GetParam());
  Vec3 low = scene.vertices().front(), high = low;
  for (const Vec3& v : scene.vertices()) {
    low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
    high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
  }
  for (std::uint64_t i = 0; i < scaled_count(4); ++i) {
    SCOPED_TRACE("seed " + std::to_string(seed_of(i)));
    Random random(seed_of(i));
    const auto coordinate = [&](double from, double to) {
      const double x = random.between(from, to);
      return random.one_in(2) ? x : std::round(8.0 * x) / 8.0;
    };
    Receiver receiver{.point = {coordinate(low.x, high.x), coordinate(low.y, high.y), coordinate(low.z, high.z)},
                      .normal = {random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)},
                      .on = {},
                      .id = {}};
    if (random.one_in(3)) receiver.normal = {0, random.one_in(2) ? 1.0 : 0.0, -1.0};
    expect_patches_as_the_solver(scene, receiver);
    expect_shares_to_add_up(scene, receiver);
    const WholeView seen = view(scene, receiver, {.faces = true});
    auto next = seen.patches.begin();
    for (std::uint32_t k = 0; k < scene.faces().size(); ++k) {
      const bool is_seen = next != seen.patches.end() && next->face == FaceId{k};
      const Selection face{.patch = scene.faces()[k].patch, .face = FaceId{k}, .scene = scene.id()};
      const FormFactor f = exact_form_factor(scene, receiver, {scene, face});
      ASSERT_EQ(is_seen ? next->form_factor.value : 0.0, f.value) << scene.name_of(FaceId{k});
      ASSERT_EQ(is_seen ? next->form_factor.status : Status::kZero, f.status) << scene.name_of(FaceId{k});
      if (is_seen) ++next;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, ViewOfModel,
                         testing::Values("teapot:segments=3", "forest:n=300,trees=4", "closed-room:boxes=12",
                                         "closed-room:lamp=hanging", "emitters:n=16", "room:n=8", "karkanis:n=300",
                                         "karkanis:n=400,cover=8", "soup:n=150,cover=3", "blinds:n=20", "tiles:n=12",
                                         "tiles:n=9,drop=7", "mesh:n=300", "lattice:n=200,cover=4"));

INSTANTIATE_TEST_SUITE_P(RandomScenes, View, testing::ValuesIn(random_families()),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace exactff::validation
