// An artificial failure is reduced to a small case with the true value.
#include "support/minimise.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "generate/families.h"
#include "support/oracle.h"
#include "support/program.h"
#include "support/random_scenes.h"

namespace exactff::validation {
namespace {

using generate::PlainPatch;
using generate::PlainScene;

bool has_patch(const PlainScene& scene, const std::string& name) {
  return std::ranges::any_of(scene.patches, [&](const PlainPatch& patch) { return patch.name == name; });
}

PlainScene frame_and_plate() {
  PlainScene scene;
  scene.point = {0.1, 0.2, 0};
  scene.add_ring(scene.patch("source"), {{-1, 1, 2}, {1, 1, 2}, {1, -1, 2}, {-1, -1, 2}});
  scene.add_rings(scene.patch("frame"), {{{-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}},
                                         {{-0.3, -0.3, 1}, {0.3, -0.3, 1}, {0.3, 0.3, 1}, {-0.3, 0.3, 1}}});
  scene.add_ring(scene.patch("plate"), {{0, 0, 0.7}, {1.0 / 3.0, 0, 0.7}, {0, 1.0 / 3.0, 0.7}});
  return scene;
}

TEST(Minimise, KeepsWhatTheFailureNeeds) {
  const auto fails = [](const PlainScene& scene) { return has_patch(scene, "plate"); };
  const PlainScene small = minimised(frame_and_plate(), fails);
  EXPECT_TRUE(fails(small));
  EXPECT_EQ(small.patches.size(), 2u);  // the source is never dropped
  EXPECT_EQ(small.vertices.size(), 6u) << "of two triangles";
  EXPECT_EQ(small.point, Vec3{});
}

// A failure that every change would remove, including one by an exception.
TEST(Minimise, NeverLeavesTheScenesThatCanBeBuilt) {
  for (std::uint64_t i = 0; i < scaled_count(10); ++i) {
    generate::Random random(seed_of(i));
    const auto fails = [](const PlainScene& scene) {
      try {
        (void)generate::build(scene);
        return true;
      } catch (const InputError&) {
        return true;
      }
    };
    const PlainScene small = minimised(degenerate_scene(random), fails);
    EXPECT_NO_THROW((void)generate::build(small)) << "seed " << seed_of(i);
    EXPECT_NE(small.normal, Vec3{});
  }
}

// Every shrunk case can be written and read, and has the oracle's value; also for a source of many polygons.
TEST(Minimise, EveryCaseFileReadsBack) {
  const TemporaryDirectory directory;
  for (std::uint64_t i = 0; i < scaled_count(30); ++i) {
    generate::Random random(seed_of(i));
    const PlainScene scene = degenerate_scene(random);
    const CaseFile written = as_case("case", scene);
    const CaseFile read = read_case(directory.write("case.json", to_json(written, "for a test")));
    ASSERT_EQ(read.scene.vertices, written.scene.vertices);
    ASSERT_EQ(read.expected.nearest, written.expected.nearest);
    const Scene built = generate::build(read.scene), original = generate::build(scene);
    EXPECT_EQ(oracle(built, generate::receiver_of(read.scene), built.select("source")).value,
              oracle(original, generate::receiver_of(scene), original.select("source")).value)
        << "seed " << seed_of(i);
  }
}

}  // namespace
}  // namespace exactff::validation
