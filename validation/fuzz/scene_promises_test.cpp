#include "fuzz/scene_promises.h"

#include <gtest/gtest.h>

#include "generate/plain_scene.h"
#include "support/random_scenes.h"

namespace exactff::validation {
namespace {

TEST(ScenePromises, HoldForRandomScenes) {
  for (std::uint64_t i = 0; i < scaled_count(50); ++i) {
    generate::Random random(seed_of(i));
    EXPECT_EQ(broken_promise(generate::build(degenerate_scene(random))), "") << "seed " << seed_of(i);
  }
}

}  // namespace
}  // namespace exactff::validation
