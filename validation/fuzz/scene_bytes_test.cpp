// A fuzzer learns nothing from bytes that give no scene, or from trivial scenes.
#include "fuzz/scene_bytes.h"

#include <gtest/gtest.h>

#include <set>

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

void expect_same(const PlainScene& decoded, const PlainScene& scene) {
  EXPECT_EQ(decoded.point, scene.point);
  EXPECT_EQ(decoded.normal, scene.normal);
  const Scene a = generate::build(decoded);
  const Scene b = generate::build(scene);
  EXPECT_EQ(oracle(a, generate::receiver_of(decoded), a.select(decoded.source)).decimals,
            oracle(b, generate::receiver_of(scene), b.select(scene.source)).decimals);
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
