// The regions of a whole view on scenes of every random family and on models (support/region_judge.h): the areas of
// pictures are form factors, the areas of visible regions are those that CGAL's Booleans find face by face, and names
// lie on what they name.
#include "support/oracle_check.h"
#include "support/region_judge.h"
#include "support/test.h"
#include "support/view_scenes.h"

namespace exactff::validation {
namespace {

class ViewRegions : public testing::TestWithParam<RandomFamily> {
 protected:
  template <class Check>
  static void for_each_scene(std::uint64_t divisor, const Check& check) {
    for_each_scene_of(GetParam(), divisor,
                      [&](const PlainScene&, const Scene& scene, const Receiver& receiver) { check(scene, receiver); });
  }
};

TEST_P(ViewRegions, HaveTheSharesOfPatchesAsTheirAreasInPictures) { for_each_scene(2, expect_picture_of_shares); }

TEST_P(ViewRegions, HaveTheAreasThatTheBooleansFind) { for_each_scene(4, expect_regions_as_booleans_find); }

// Up is any direction that is far from the normal.
Vec3 upwards(const Receiver& receiver) {
  const Vec3& n = receiver.normal;
  const double x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
  return x <= y && x <= z ? Vec3{1, 0, 0} : y <= z ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
}

TEST_P(ViewRegions, HaveTheirNamesWhereTheyAreSeen) {
  for_each_scene(4, [](const Scene& scene, const Receiver& receiver) {
    expect_names_on_what_they_name(scene, receiver, upwards(receiver));
  });
}

TEST(NamesInViews, AreThoseOfAllThatIsLargeEnough) {
  const Scene box = read_obj(EXACTFF_DATA_DIR "/scenes/cornell_box.obj");
  const Receiver on_floor{
      .point = {240, 0, 300}, .normal = {0, 1, 0}, .on = box.faces_of(box.select("floor")), .id = {}};
  const std::set<std::string> all = {"(open)", "back",  "ceiling",     "left",
                                     "light",  "right", "short_block", "tall_block"};
  EXPECT_EQ(expect_names_on_what_they_name(box, on_floor, {0, 0, 1}), all);
}

class ViewRegionsOfModel : public testing::TestWithParam<const char*> {
 protected:
  // From points near a corner of the scene, some of them that corner.
  template <class Check>
  static void for_each_receiver(std::uint64_t count, const Check& check) {
    const Scene scene = models::make_scene(GetParam());
    for (std::uint64_t i = 0; i < scaled_count(count); ++i) {
      SCOPED_TRACE("seed " + std::to_string(seed_of(i)));
      Random random(seed_of(i));
      const int last = static_cast<int>(scene.vertices().size()) - 1;
      const Vec3& near = scene.vertices()[static_cast<std::size_t>(random.integer(0, last))];
      const double reach = random.one_in(3) ? 0.0 : 0.25;
      const auto off = [&] { return random.between(-reach, reach); };
      check(scene, Receiver{.point = {near.x + off(), near.y + off(), near.z + off()},
                            .normal = random.one_in(2) ? Vec3{0, 0, 1} : Vec3{random.between(-1, 1), -0.5, 0.25},
                            .on = {},
                            .id = {}});
    }
  }
};

TEST_P(ViewRegionsOfModel, HaveTheSharesOfPatchesAsTheirAreasInPictures) {
  for_each_receiver(4, expect_picture_of_shares);
}

TEST_P(ViewRegionsOfModel, HaveTheirNamesWhereTheyAreSeen) {
  for_each_receiver(4, [](const Scene& scene, const Receiver& receiver) {
    expect_names_on_what_they_name(scene, receiver, upwards(receiver));
  });
}

TEST_P(ViewRegionsOfModel, HaveTheAreasThatTheBooleansFind) { for_each_receiver(3, expect_regions_as_booleans_find); }

INSTANTIATE_TEST_SUITE_P(All, ViewRegionsOfModel,
                         testing::Values("teapot:segments=2", "forest:n=100,trees=2", "closed-room:boxes=4",
                                         "emitters:n=9", "karkanis:n=80", "soup:n=60,cover=3", "blinds:n=12",
                                         "tiles:n=6,drop=7", "mesh:n=100", "lattice:n=70,cover=4"));

INSTANTIATE_TEST_SUITE_P(RandomScenes, ViewRegions, testing::ValuesIn(random_families()),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace exactff::validation
