// The tools around fuzzing: bytes give scenes, sound scenes keep promises, and a failure is reduced to a small case.
#include "fuzz/scene_bytes.h"
#include "fuzz/scene_promises.h"
#include "support/case_file.h"
#include "support/minimise.h"
#include "support/test.h"

namespace exactff::validation {
namespace {

using generate::PlainPatch;

std::vector<std::uint8_t> random_bytes(Random& random) {
  std::vector<std::uint8_t> bytes(20 + random.below(120));
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random.below(256));
  return bytes;
}

// A fuzzer learns nothing from bytes that give no scene.
TEST(SceneBytes, MostBytesMeanAScene) {
  constexpr int kCount = 300;
  int scenes = 0;
  for (std::uint64_t i = 0; i < kCount; ++i) {
    Random random(seed_of(i));
    const auto decoded = decode(random_bytes(random));
    if (!decoded) continue;
    ++scenes;
    EXPECT_NO_THROW((void)generate::build(decoded->scene)) << "seed " << seed_of(i);
  }
  EXPECT_GT(scenes, kCount * 3 / 4);
}

TEST(ScenePromises, HoldForRandomScenes) {
  for (std::uint64_t i = 0; i < scaled_count(50); ++i) {
    Random random(seed_of(i));
    EXPECT_EQ(broken_promise(generate::build(degenerate_scene(random))), "") << "seed " << seed_of(i);
  }
}

TEST(Minimise, KeepsWhatTheFailureNeeds) {
  PlainScene scene;
  scene.point = {0.1, 0.2, 0};
  scene.add_ring(scene.patch("source"), {{-1, 1, 2}, {1, 1, 2}, {1, -1, 2}, {-1, -1, 2}});
  scene.add_rings(scene.patch("frame"), {{{-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}},
                                         {{-0.3, -0.3, 1}, {0.3, -0.3, 1}, {0.3, 0.3, 1}, {-0.3, 0.3, 1}}});
  scene.add_ring(scene.patch("plate"), {{0, 0, 0.7}, {1.0 / 3.0, 0, 0.7}, {0, 1.0 / 3.0, 0.7}});
  const auto fails = [](const PlainScene& tried) {
    return std::ranges::any_of(tried.patches, [](const PlainPatch& patch) { return patch.name == "plate"; });
  };
  const PlainScene small = minimised(scene, fails);
  EXPECT_TRUE(fails(small));
  EXPECT_EQ(small.patches.size(), 2u);  // the source is never dropped
  EXPECT_EQ(small.vertices.size(), 6u) << "of two triangles";
  EXPECT_EQ(small.point, Vec3{});
}

TEST(Minimise, EveryCaseFileReadsBack) {
  const TemporaryDirectory directory;
  for (std::uint64_t i = 0; i < scaled_count(30); ++i) {
    Random random(seed_of(i));
    const CaseFile written = as_case("case", degenerate_scene(random));
    const CaseFile read = read_case(directory.write("case.json", to_json(written, "for a test")));
    ASSERT_EQ(read.scene.vertices, written.scene.vertices) << "seed " << seed_of(i);
    ASSERT_EQ(read.expected.nearest, written.expected.nearest) << "seed " << seed_of(i);
  }
}

}  // namespace
}  // namespace exactff::validation
