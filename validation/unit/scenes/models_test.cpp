#include "models/registry.h"
#include "support/test.h"

namespace exactff::validation {
namespace {

using models::make_scene;

// Each model, small.
const std::vector<std::string> kSmall = {"teapot:segments=2",
                                         "forest:n=50,trees=3",
                                         "forest:n=50,trees=3,light=sun",
                                         "closed-room:boxes=3",
                                         "closed-room:lamp=hanging",
                                         "emitters:n=5",
                                         "room:n=3",
                                         "karkanis:n=20",
                                         "soup:n=20",
                                         "blinds:n=4",
                                         "tiles:n=3",
                                         "mesh:n=30",
                                         "lattice:n=20"};

TEST(Models, TheFileReadsBackToTheSameScene) {
  const TemporaryDirectory directory;
  for (const std::string& text : kSmall) {
    (void)directory.write("scene.mtl", models::make_mtl(text));
    const Scene read = read_obj(directory.write("scene.obj", models::make_obj(text, "scene.mtl")));
    EXPECT_EQ(read.hash(), make_scene(text).hash()) << text;
  }
}

// These bits cannot be derived in advance. The test checks that they are the same on every machine.
TEST(Models, BitsAreTheSameOnEveryMachine) {
  const std::map<std::string, std::string> hashes = {{"teapot:segments=3", "39a0f0f183acde91"},
                                                     {"forest:n=100", "61fe630f2369489b"},
                                                     {"forest:n=100,light=sun", "b1903b1eb3fa870e"},
                                                     {"closed-room", "f059258cc9a42927"},
                                                     {"emitters", "4ceb02fae85e5271"},
                                                     {"karkanis:n=200,seed=3", "b07491c610f656b9"}};
  for (const auto& [text, hash] : hashes) EXPECT_EQ(make_scene(text).hash(), hash) << text;
}

TEST(Models, TheFirstCommentMakesTheSceneAgain) {
  const std::string obj = models::make_obj(" tiles : n = 3 ");
  const std::string start = "# exactff model ";
  ASSERT_TRUE(obj.starts_with(start));
  const std::string text = obj.substr(start.size(), obj.find('\n') - start.size());
  EXPECT_EQ(text, "tiles:n=3,drop=0,floor=1");
  EXPECT_EQ(make_scene(text).hash(), make_scene("tiles:n=3").hash());
}

}  // namespace
}  // namespace exactff::validation
