// A fuzzer learns nothing from bytes that give no scene, or from trivial scenes.
#include "fuzz/scene_bytes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <stdexcept>

#include "fuzz/checks.h"
#include "fuzz/shrink.h"
#include "support/case_file.h"
#include "support/oracle.h"
#include "support/program.h"
#include "support/random_scenes.h"

namespace exactff::validation {
namespace {

using generate::PlainScene;
using generate::Random;

std::vector<std::uint8_t> random_bytes(Random& random) {
  std::vector<std::uint8_t> bytes(20 + random.below(120));
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random.below(256));
  return bytes;
}

TEST(SceneBytes, AnyBytesAreReadToTheirEnd) {
  for (std::size_t length = 0; length < 40; ++length) {
    for (const int byte : {0, 1, 127, 128, 255}) {
      const std::vector<std::uint8_t> bytes(length, static_cast<std::uint8_t>(byte));
      EXPECT_NO_THROW((void)decode(bytes)) << length << " times " << byte;
    }
  }
}

TEST(SceneBytes, MostBytesMeanAScene) {
  constexpr int kCount = 300;
  int scenes = 0;
  std::set<Identity> identities;
  for (std::uint64_t i = 0; i < kCount; ++i) {
    Random random(seed_of(i));
    const auto decoded = decode(random_bytes(random));
    if (!decoded) continue;
    ++scenes;
    identities.insert(decoded->identity);
    EXPECT_NO_THROW((void)generate::build(decoded->scene)) << "seed " << seed_of(i);
  }
  EXPECT_GT(scenes, kCount * 3 / 4);
  EXPECT_EQ(identities.size(), kIdentityCount);
}

// Random bytes are not aimed at the receiver like the corpus; still, some scenes must show a part of their source.
TEST(SceneBytes, SomeScenesShowPartOfTheirSource) {
  constexpr int kCount = 80;
  int visible = 0;
  int partial = 0;
  for (std::uint64_t i = 0; i < kCount; ++i) {
    Random random(seed_of(i));
    const auto decoded = decode(random_bytes(random));
    if (!decoded) continue;
    const Scene scene = generate::build(decoded->scene);
    const OracleResult truth =
        oracle(scene, generate::receiver_of(decoded->scene), scene.select(decoded->scene.source));
    visible += truth.zero ? 0 : 1;
    partial += truth.visible_fraction > 0.0 && truth.visible_fraction < 1.0 ? 1 : 0;
  }
  EXPECT_GT(visible, kCount / 5);
  EXPECT_GT(partial, kCount / 20);
}

void expect_same(const PlainScene& decoded, const PlainScene& scene) {
  EXPECT_EQ(decoded.point, scene.point);
  EXPECT_EQ(decoded.normal, scene.normal);
  const Scene a = generate::build(decoded);
  const Scene b = generate::build(scene);
  EXPECT_EQ(oracle(a, generate::receiver_of(decoded), a.select(decoded.source)).decimals,
            oracle(b, generate::receiver_of(scene), b.select(scene.source)).decimals);
}

TEST(SceneBytes, KnownScenesCanBeWrittenAsBytes) {
  for (const char* name : {"A28_annulus_hole_cw", "B05_two_abutting_cover", "B20_interpenetrating", "C07_tiny_far",
                           "C28_occluder_1e-12_from_x", "C17_crack_1ulp", "C33_wall_0_through_x"}) {
    SCOPED_TRACE(name);
    const CaseFile file =
        read_case(std::filesystem::path(EXACTFF_DATA_DIR "/reference") / (std::string(name) + ".json"));
    for (const Identity identity : {Identity::kOrder, Identity::kDrawing}) {
      const auto decoded = decode(encode(file.scene, identity));
      ASSERT_TRUE(decoded.has_value()) << name;
      EXPECT_EQ(decoded->identity, identity);
      expect_same(decoded->scene, file.scene);
    }
  }
}

TEST(SceneBytes, SourcesOfSeveralFacesCanBeWrittenAsBytes) {
  Random random(seed_of(0));
  PlainScene scene = triangles_scene(random);
  scene.add_ring(scene.patch("source"), {{-2, 1, 3}, {1, 1, 3}, {1, -1, 3}});
  const auto decoded = decode(encode(scene, Identity::kOrder));
  ASSERT_TRUE(decoded.has_value());
  const auto source = std::ranges::find(decoded->scene.patches, "source", &generate::PlainPatch::name);
  ASSERT_NE(source, decoded->scene.patches.end());
  EXPECT_EQ(source->faces.size(), 2u);
  expect_same(decoded->scene, scene);
}

TEST(SceneBytes, ScenesBeyondTheLimitsAreRefused) {
  const CaseFile file = read_case(EXACTFF_DATA_DIR "/reference/C14_scaled_2p-300.json");  // 31 faces
  EXPECT_THROW((void)encode(file.scene, Identity::kOrder), std::invalid_argument);
}

// Runs every check on one scene.
TEST(FuzzChecks, FindNothingWhereNothingIsWrong) {
  Random random(seed_of(7));
  const PlainScene scene = triangles_scene(random);
  for (std::size_t i = 0; i < kIdentityCount; ++i) {
    EXPECT_EQ(problem({scene, static_cast<Identity>(i), 5}), "") << name_of(static_cast<Identity>(i));
  }
}

TEST(FuzzChecks, AnUnusableSceneIsAProblemAndNoCrash) {
  PlainScene scene;
  scene.add_ring(scene.patch("source"), {{-1, 1, 2}, {1, -1, 2}, {1, 1, 2}, {-1, -1, 2}});  // crosses itself
  EXPECT_NE(oracle_problem(scene), "");
  EXPECT_NE(identity_problem({scene, Identity::kCuttersAlone, 1}), "");
}

TEST(Shrink, LeavesWhatDoesNotFail) {
  Random random(seed_of(7));
  EXPECT_FALSE(shrink({triangles_scene(random), Identity::kOrder, 1}).has_value());
}

TEST(Shrink, WhatIsKeptReadsAsACase) {
  const TemporaryDirectory directory;
  Shrunk shrunk;
  Random random(seed_of(7));
  shrunk.scene = triangles_scene(random);
  shrunk.problem = "made up";
  const auto path = keep(shrunk, "made_up", directory.path() / "new");
  const CaseFile read = read_case(path);
  EXPECT_EQ(read.name, "made_up");
  expect_same(read.scene, shrunk.scene);
}

}  // namespace
}  // namespace exactff::validation
