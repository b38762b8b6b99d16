// Scenes read from text give the same text again, for any names and rings.
#include "fuzz/scene_promises.h"

#include <gtest/gtest.h>

#include <sstream>

#include "exactff/scene_files.h"
#include "generate/plain_scene.h"
#include "support/program.h"
#include "support/random_scenes.h"

namespace exactff::validation {
namespace {

Scene read(const TemporaryDirectory& directory, const SceneText& text) {
  (void)directory.write("m", text.mtl);
  std::istringstream in(text.obj);
  return read_obj(in, directory.path() / "scene.obj", {BadFaces::kSkip, PatchMode::kGroups});
}

constexpr const char* kSquare = "v -1 1 2\nv 1 1 2\nv 1 -1 2\nv -1 -1 2\n";

TEST(ScenePromises, TextGivesTheSceneBack) {
  const TemporaryDirectory directory;
  for (const char* faces :
       {"f 1 2 3 4\n", "o a b\nf 1 2 3\no\nf 1 3 4\n", "g \\ b\nf 1 2 3\n", "f 1 1 2 2 1\nf 1 2 3\n",
        "f\nf 1 2\nf 1 2 3\nf 1 3 2 4\n", "mtllib m\nusemtl lamp\nf 1 2 3\nusemtl x y\nf 1 2 4\n"}) {
    const SceneText text{std::string(kSquare) + faces, "newmtl lamp\nKd 0.1 0.2 0.3\nKe 1e300 4.9e-324 0\n"};
    const Scene scene = read(directory, text);
    EXPECT_EQ(broken_promise(scene), "") << faces;
    EXPECT_EQ(read(directory, text_of(scene, "m")).hash(), scene.hash()) << text_of(scene, "m").obj;
  }
}

TEST(ScenePromises, HoldForRandomScenes) {
  for (std::uint64_t i = 0; i < scaled_count(50); ++i) {
    generate::Random random(seed_of(i));
    EXPECT_EQ(broken_promise(generate::build(degenerate_scene(random))), "") << "seed " << seed_of(i);
  }
}

}  // namespace
}  // namespace exactff::validation
