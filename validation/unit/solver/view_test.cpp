// The whole view by hand: scenes where what is seen is known, each judged in full (support/view_judge.h).
#include "exactff/view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "exactff/scene_files.h"
#include "generate/plain_scene.h"
#include "support/view_judge.h"

namespace exactff {
namespace {

using generate::PlainScene;
using Ring = std::vector<Vec3>;

// Patches of one face each, in this order. Counter-clockwise as seen from below looks down.
struct Named {
  const char* name;
  Ring ring;
};

PlainScene plain_of(const std::vector<Named>& faces, double scale = 1.0) {
  PlainScene plain;
  for (const Named& face : faces) {
    Ring ring = face.ring;
    for (Vec3& v : ring) v = {v.x * scale, v.y * scale, v.z * scale};
    plain.add_ring(plain.patch(face.name), ring);
  }
  return plain;
}

Ring square(double low_x, double low_y, double high_x, double high_y, double z) {  // looks down
  return {{low_x, low_y, z}, {low_x, high_y, z}, {high_x, high_y, z}, {high_x, low_y, z}};
}

Ring reversed(Ring ring) {
  std::reverse(ring.begin(), ring.end());
  return ring;
}

Receiver looking_up(const Vec3& x = {0, 0, 0}) { return {.point = x, .normal = {0, 0, 1}, .on = {}, .id = {}}; }

void judge(const Scene& scene, const Receiver& receiver) {
  validation::expect_patches_as_the_solver(scene, receiver);
  validation::expect_shares_to_add_up(scene, receiver);
  validation::expect_shares_of_unions(scene, receiver);
  validation::expect_sides_as_rational_numbers_find(scene, receiver);
}

WholeView judged(const Scene& scene, const Receiver& receiver) {
  judge(scene, receiver);
  return view(scene, receiver);
}

const SeenPatch& patch_of(const WholeView& seen, const Scene& scene, const char* name) {
  const SeenPatch* patch = validation::find_patch(seen, index_of(scene.select(name).patch));
  if (patch == nullptr) throw std::runtime_error(std::string(name) + " is not seen");
  return *patch;
}

bool is_seen(const WholeView& seen, const Scene& scene, const std::string& name) {
  return validation::find_patch(seen, index_of(scene.select(name).patch)) != nullptr;
}

TEST(View, FromInsideASolidIsItsBacks) {
  PlainScene plain;
  const Ring lid = reversed(square(-1, -1, 1, 1, 1));
  plain.add_ring(plain.patch("box"), lid);
  for (const Ring& side :
       {Ring{{-1, -1, -1}, {1, -1, -1}, {1, -1, 1}, {-1, -1, 1}}, Ring{{1, -1, -1}, {1, 1, -1}, {1, 1, 1}, {1, -1, 1}},
        Ring{{1, 1, -1}, {-1, 1, -1}, {-1, 1, 1}, {1, 1, 1}}, Ring{{-1, 1, -1}, {-1, -1, -1}, {-1, -1, 1}, {-1, 1, 1}},
        square(-1, -1, 1, 1, -1)}) {
    plain.add_ring(plain.patch("box"), side);
  }
  const Scene scene = generate::build(plain);
  const WholeView seen = judged(scene, looking_up({0.25, 0.5, -0.125}));
  EXPECT_TRUE(seen.patches.empty());
  EXPECT_EQ(seen.back.value, 1.0);
  EXPECT_EQ(seen.open.status, Status::kZero);
}

TEST(View, OfThreePlanesThroughOneLineHasItOnce) {
  const Scene scene = generate::build(plain_of({{"rising", {{-1, -1, 1}, {-1, 1, 1}, {1, 1, 3}, {1, -1, 3}}},
                                                {"falling", {{-1, -1, 3}, {-1, 1, 3}, {1, 1, 1}, {1, -1, 1}}},
                                                {"level", square(-1, -1, 1, 1, 2)},
                                                {"half", square(0, -1, 1, 1, 2)}}));
  judge(scene, looking_up());
  judge(scene, looking_up({0.25, 0.125, 0}));
}

// A thin lamp of two faces with opposite fronts, of one patch or of two.
TEST(View, OfADoubledFaceIsItsFrontWhateverComesFirst) {
  const Ring down = square(-1, -1, 1, 1, 1), up = reversed(down);
  const Scene alone = generate::build(plain_of({{"down", down}}));
  const WholeView single = judged(alone, looking_up());
  const std::vector<std::vector<Named>> orders = {{{"down", down}, {"up", up}},
                                                  {{"up", up}, {"down", down}},
                                                  {{"down", down}, {"down", up}},
                                                  {{"down", up}, {"down", down}}};
  for (const std::vector<Named>& faces : orders) {
    const Scene scene = generate::build(plain_of(faces));
    const WholeView seen = judged(scene, looking_up());
    ASSERT_EQ(seen.patches.size(), 1U);
    const SeenPatch& lamp = patch_of(seen, scene, "down");
    validation::expect_same_bits(lamp.share, single.patches.front().share, "down");
    EXPECT_FALSE(lamp.stacked);
    EXPECT_EQ(seen.back.status, Status::kZero);
    validation::expect_same_bits(seen.open, single.open, "open");
  }
}

// Both have an edge in the plane x = 0, at different depths.
TEST(View, OfAlignedEdgesAtDifferentDepthsHasOneArc) {
  for (const bool near_first : {true, false}) {
    std::vector<Named> faces = {{"near", square(0, -1, 1, 1, 1)}, {"far", square(-4, -4, 0, 4, 2)}};
    if (!near_first) std::swap(faces[0], faces[1]);
    const Scene scene = generate::build(plain_of(faces));
    judge(scene, looking_up());
    const WholeView seen = view(scene, looking_up(), {.arcs = true});
    EXPECT_EQ(std::ranges::count_if(seen.arcs, [](const ViewArc& arc) { return arc.right.has_value(); }), 1);
  }
}

Scene room() {
  const double s = 4;
  return generate::build(plain_of({{"floor", reversed(square(0, 0, s, s, 0))},
                                   {"ceiling", square(0, 0, s, s, s)},
                                   {"south", {{0, 0, 0}, {0, 0, s}, {s, 0, s}, {s, 0, 0}}},
                                   {"north", {{0, s, 0}, {s, s, 0}, {s, s, s}, {0, s, s}}},
                                   {"west", {{0, 0, 0}, {0, s, 0}, {0, s, s}, {0, 0, s}}},
                                   {"east", {{s, 0, 0}, {s, 0, s}, {s, s, s}, {s, s, 0}}},
                                   {"table", square(1, 1, 3, 3, 1)}}));
}

TEST(View, FromEdgesAndCornersOfARoomAddsUpToOne) {
  const Scene scene = room();
  const std::vector<Vec3> points = {{0, 0, 0}, {0, 0, 2}, {4, 4, 4}, {2, 0, 4},
                                    {1, 1, 1}, {2, 1, 1}, {1, 2, 0}, {4, 2, 1}};
  for (const Vec3& x : points) {
    for (const Vec3& n : {Vec3{0, 0, 1}, Vec3{1, 1, 1}, Vec3{-1, -2, -3}, Vec3{1, 0, 0}, Vec3{0.125, -1, 0.5}}) {
      SCOPED_TRACE(testing::Message() << x.x << ' ' << x.y << ' ' << x.z << " / " << n.x << ' ' << n.y << ' ' << n.z);
      judge(scene, {.point = x, .normal = n, .on = {}, .id = {}});
    }
  }
}

TEST(View, LeavesOutOwnAndTransparentFaces) {
  const Scene scene = room();
  Receiver below_table = looking_up({2, 2, 1});
  below_table.on = scene.faces_of(scene.select("table"));
  const WholeView seen = judged(scene, below_table);
  EXPECT_FALSE(is_seen(seen, scene, "table"));
  EXPECT_EQ(seen.back.status, Status::kZero);
  EXPECT_EQ(seen.open.status, Status::kZero);
  const std::vector<Selection> glass{scene.select("ceiling"), scene.select("table")};
  const Scene through = scene.with_transparent(glass);
  const WholeView open = view(through, looking_up({2, 2, 0.5}));
  EXPECT_FALSE(is_seen(open, through, "ceiling"));
  const WholeView roofed = view(scene, below_table);
  EXPECT_NEAR(open.open.value + patch_of(open, through, "east").share.value * 4, 1.0, 1e-12);
  EXPECT_GT(open.open.value, 0.25);
  EXPECT_EQ(roofed.patches.size(), 5U);
}

TEST(View, KeepsItsBitsWhenScaledByPowersOfTwo) {
  const std::vector<Named> faces = {{"near", square(-0.5, -0.25, 1, 0.75, 1)},
                                    {"far", {{-3, -3, 2}, {-3, 3, 2.5}, {4, -1, 2}}},
                                    {"wall", {{1, -1, -1}, {1, -1, 3}, {1, 2, 3}, {1, 2, -1}}}};
  const WholeView one = judged(generate::build(plain_of(faces)), looking_up());
  for (const int power : {-1000, -500, 500, 1000}) {
    SCOPED_TRACE(power);
    const Scene scene = generate::build(plain_of(faces, std::ldexp(1.0, power)));
    const WholeView seen = judged(scene, looking_up());
    ASSERT_EQ(seen.patches.size(), one.patches.size());
    for (std::size_t i = 0; i < seen.patches.size(); ++i) {
      validation::expect_same_bits(seen.patches[i].share, one.patches[i].share, "patch");
    }
    validation::expect_same_bits(seen.open, one.open, "open");
  }
}

TEST(View, OfDistancesFarApartIsExact) {
  judge(generate::build(plain_of({{"tiny", square(-0x1p-700, -0x1p-700, 0x1p-700, 0x1p-701, 0x1p-700)},
                                  {"usual", square(-2, -1, 3, 1, 1)},
                                  {"huge", square(-0x1p800, -0x1p800, 0x1p800, 0x1p800, 0x1p800)},
                                  {"wall", {{0.5, -1, -1}, {0.5, -1, 3}, {0.5, 2, 3}, {0.5, 2, -1}}}})),
        looking_up());
}

TEST(View, RefusesWhatHasNoView) {
  const Scene scene = room(), other = room();
  EXPECT_THROW((void)view(scene, {.point = {0, 0, NAN}, .normal = {0, 0, 1}, .on = {}, .id = {}}), InputError);
  EXPECT_THROW((void)view(scene, {.point = {0, 0, 1}, .normal = {0, 0, 0}, .on = {}, .id = {}}), InputError);
  EXPECT_THROW((void)view(scene, looking_up(), {.precision_cap = 0}), InputError);
  EXPECT_THROW((void)view(scene, {.point = {0, 0, 1}, .normal = {0, 0, 1}, .on = {FaceId{99}}, .id = {}}),
               std::invalid_argument);
}

}  // namespace
}  // namespace exactff
