// The pictures of a scene's chapter.
#include <gtest/gtest.h>

#include "exactff/models.h"
#include "report/report.h"
#include "unit/reports/study_support.h"

namespace exactff::report {
namespace {

study::Study room_study(const Scene& scene, int threads, const char* method, const char* source = "lamp") {
  study::Request request;
  request.scene = &scene;
  request.scene_name = "room";
  request.receivers = grid_receivers(scene, scene.select("floor"), {3, 3});
  request.receivers_name = "floor, grid 3x3";
  request.sources = {scene.select(source)};
  request.sweeps.enabled = false;
  request.methods.ladders = {study::parse_ladder("exact"), study::parse_ladder(method)};
  request.methods.seeds = 2;
  request.threads = threads;
  request.seconds_for_a_time = 0.001;
  return study::run(std::move(request));
}

TEST(Strip, HasTheSameBytesForAnyNumberOfThreads) {
  const Scene scene = validation::small_room(true);
  std::vector<Strip> strips;
  for (const int threads : {1, 2}) {
    std::vector<LeftOut> left_out;
    const auto strip = strip_of(room_study(scene, threads, "area-sampling:samples=4"), left_out, {});
    ASSERT_TRUE(strip) << left_out.front().why;
    EXPECT_TRUE(left_out.empty());
    strips.push_back(*strip);
  }
  EXPECT_EQ(strips[0].exact, strips[1].exact);
  EXPECT_EQ(strips[0].method, strips[1].method);
  EXPECT_EQ(strips[0].error, strips[1].error);
  EXPECT_NE(strips[0].exact, strips[0].method);
  EXPECT_GT(strips[0].rms, 0.0);
  EXPECT_EQ(strips[0].outlined, "floor");
}

// From outside, the default camera sees the back of the source and the unlit sides of the triangles.
TEST(Strip, ShowsReceiversFromTheirFrontWhereTheDefaultCameraDoesNot) {
  const Scene scene = models::make_scene("karkanis:n=20");
  std::vector<LeftOut> left_out;
  const auto strip = strip_of(room_study(scene, 1, "area-sampling:samples=4", "source"), left_out, {});
  ASSERT_TRUE(strip) << left_out.front().why;
  EXPECT_EQ(strip->outlined, "floor");
  EXPECT_GT(strip->rms, 0.0);
}

TEST(Strip, OfAMethodThatTakesTooLongIsLeftOutAndSaysWhy) {
  const Scene scene = validation::small_room(true);
  std::vector<LeftOut> left_out;
  EXPECT_FALSE(strip_of(room_study(scene, 1, "hemicube:resolution=2048"), left_out, {}));
  ASSERT_EQ(left_out.size(), 1U);
  EXPECT_NE(left_out.front().why.find("they would take too long"), std::string::npos) << left_out.front().why;
}

TEST(Strip, IsSeenByTheCameraThatIsAskedFor) {
  const Scene scene = validation::small_room(true);
  const auto strip_by = [&](const std::optional<render::Camera>& camera) {
    study::Study study = room_study(scene, 1, "area-sampling:samples=4");
    study.request.camera = camera;
    std::vector<LeftOut> left_out;
    return strip_of(study, left_out, {});
  };
  const auto by_default = strip_by({});
  const render::Camera same = render::default_camera(scene, {.up = {0, 0, 1}}, {192, 144});
  const auto given = strip_by(same);
  ASSERT_TRUE(by_default && given);
  EXPECT_EQ(given->exact, by_default->exact);
  render::Camera nearer = same;
  nearer.fov = 0.7 * same.fov;
  const auto other = strip_by(nearer);
  ASSERT_TRUE(other);
  EXPECT_NE(other->exact, given->exact);
  render::Camera away = same;  // what it sees is not replaced by another view
  away.look = {2 * same.eye.x - same.look.x, 2 * same.eye.y - same.look.y, 2 * same.eye.z - same.look.z};
  EXPECT_FALSE(strip_by(away));
}

}  // namespace
}  // namespace exactff::report
