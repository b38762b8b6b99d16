// Where shadows end on a grid of receivers, and profiles across them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <variant>
#include <vector>

#include "exactff/study.h"
#include "study/settings.h"
#include "study/sight.h"
#include "unit/reports/study_support.h"

namespace exactff::study {
namespace {

using validation::small_room;

// A lamp [-1, 1]^2 at height 2 and half a plane at height 1, x > 0: the floor sees all of the lamp where x < -1 and
// nothing where x > 1.
Scene half_plane() {
  SceneBuilder builder("half plane");
  const MaterialId grey = builder.add_material({"grey", {0.5, 0.5, 0.5}, {}});
  const MaterialId lamp = builder.add_material({"lamp", {0, 0, 0}, {2, 2, 2}});
  const auto rectangle = [&](const char* name, MaterialId material, double x0, double x1, double y, double z,
                             bool down) {
    const std::uint32_t a = builder.add_vertex({x0, -y, z});
    builder.add_vertex({x1, -y, z});
    builder.add_vertex({x1, y, z});
    builder.add_vertex({x0, y, z});
    std::vector<std::uint32_t> ring = {a, a + 1, a + 2, a + 3};
    if (down) std::ranges::reverse(ring);
    builder.add_face(builder.patch(name), material, {ring});
  };
  rectangle("floor", grey, -4, 4, 1, 0, false);
  rectangle("lamp", lamp, -1, 1, 1, 2, true);
  rectangle("half", grey, 0, 50, 50, 1, false);
  return builder.build();
}

// A study up to its exact values, on a grid of the floor.
struct Begun {
  const Scene& scene;
  std::vector<ExactSource> sources;
  Study study;

  explicit Begun(const Scene& of, GridSize size = {8, 2}) : scene(of) {
    study.request.scene = &scene;
    study.request.receivers = grid_receivers(scene, scene.select("floor"), size);
    study.request.sources = scene.emitters();
    study.request.threads = 2;
    sources.emplace_back(scene, scene.select("lamp"));
    for (const Receiver& receiver : study.request.receivers) {
      study.exact.emplace_back().sight = sights(scene, receiver, sources).front();
    }
  }
};

TEST(ShadowEdges, AreWhereTheHalfPlaneCastsThem) {
  const Scene scene = half_plane();
  Begun begun(scene);
  const auto edges = std::get<ShadowEdges>(find_shadow_edges(begun.study.request, begun.sources, {}));
  ASSERT_EQ(edges.distance.size(), 16U);
  EXPECT_GT(edges.resolution, 0.0);
  EXPECT_LT(edges.resolution, 0.05);
  for (std::size_t i = 0; i < 16; ++i) {
    const double x = begun.study.request.receivers[i].point.x;
    const double distance = std::min(std::abs(x - 1), std::abs(x + 1));
    EXPECT_NEAR(edges.distance[i], distance, 0.75 * edges.resolution) << x;
  }
}

TEST(ShadowEdges, AreLeftOutWhereThereAreNone) {
  const auto why = [](const Scene& scene, const auto& change) {
    Begun begun(scene, {2, 2});
    change(begun.study.request.receivers);
    return std::get<LeftOut>(find_shadow_edges(begun.study.request, begun.sources, {})).why;
  };
  const auto nothing = [](const auto&) {};
  EXPECT_NE(why(small_room(false), nothing).find("of one kind all over the face"), std::string::npos);
  const Scene room = small_room(true);
  EXPECT_NE(why(room, [](auto& list) { list[1].cell.reset(); }).find("not one grid"), std::string::npos);
  EXPECT_NE(why(room, [](auto& list) { list[1].cell->lattice = std::make_shared<Lattice>(); }).find("not one grid"),
            std::string::npos);
}

TEST(Profiles, HaveTheirKinksWhereTheHalfPlaneCastsThem) {
  const Scene scene = half_plane();
  Begun begun(scene);
  begun.study.methods.ladders = {parse_ladder("exact"), parse_ladder("hemicube:resolution=8|16|32")};
  const auto profile = std::get<Profile>(find_profile(begun.study, begun.sources, {}));
  EXPECT_EQ(profile.where, "row 1 of floor");
  ASSERT_EQ(profile.receivers.size(), 256U);
  const double start = profile.receivers.front().point.x;
  EXPECT_EQ(start, -4 + 8.0 / 512);
  ASSERT_EQ(profile.kinks.size(), 2U);
  EXPECT_NEAR(profile.kinks[0], -1 - start, 1e-6);
  EXPECT_NEAR(profile.kinks[1], 1 - start, 1e-6);
  ASSERT_EQ(profile.others.size(), 1U);
  EXPECT_EQ(profile.others[0].name, "hemicube, resolution 16");
  for (std::size_t i = 0; i < 256; ++i) {
    EXPECT_NEAR(profile.position[i], profile.receivers[i].point.x - start, 1e-12);
    const double f = exact_form_factor(scene, profile.receivers[i], begun.sources.front()).value;
    EXPECT_DOUBLE_EQ(profile.exact[i], 0.5 * 2 * f);
    EXPECT_NEAR(profile.others[0].radiosity[i], profile.exact[i], 0.1);
  }
}

TEST(Profiles, AreLeftOutWithoutAPenumbra) {
  const Scene room = small_room(false);
  Begun begun(room);
  EXPECT_EQ(std::get<LeftOut>(find_profile(begun.study, begun.sources, {})).what, "penumbra profile");
}

}  // namespace
}  // namespace exactff::study
