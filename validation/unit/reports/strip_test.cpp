// The pictures of a scene's chapter.
#include "report/report.h"
#include "support/test.h"
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
  const Scene scene = small_room(true);
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

}  // namespace
}  // namespace exactff::report
