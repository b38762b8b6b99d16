// Objects that are documented as safe to share between threads are used by several threads at once from the first
// moment, before anything that they build on demand exists. The results must equal those of one thread.
// validation/thread_sanitizer.sh looks for races.
#include <gtest/gtest.h>

#include <cstdint>
#include <latch>
#include <thread>
#include <vector>

#include "exactff/adaptive.h"
#include "exactff/exact.h"
#include "generate/families.h"
#include "scene/closed_surfaces.h"
#include "scene/scene.h"
#include "unit/rivals/methods_support.h"

namespace exactff {
namespace {

constexpr int kThreads = 4;

// All threads start at once. Returns the results by thread.
template <class Work>
auto at_once(const Work& work) {
  std::vector<decltype(work())> results(kThreads);
  std::latch ready(kThreads);
  {
    std::vector<std::jthread> threads;
    for (auto& result : results) {
      threads.emplace_back([&] {
        ready.arrive_and_wait();
        result = work();
      });
    }
  }
  return results;
}

// On a scene that has not been used, and on another one by a single thread.
template <class Work>
void expect_same_at_once(const Work& work) {
  const Scene alone = validation::furnished_room(), shared = validation::furnished_room();
  const auto expected = work(alone);
  for (const auto& found : at_once([&] { return work(shared); })) EXPECT_EQ(found, expected);
}

TEST(Threads, ShareWhatASceneBuildsOnDemand) {
  expect_same_at_once([](const Scene& scene) {
    const auto ids = places(scene);
    return std::vector<std::uint32_t>(ids.begin(), ids.end());
  });
  expect_same_at_once([](const Scene& scene) { return closed_surfaces(scene).surfaces().size(); });
  expect_same_at_once([](const Scene& scene) { return scene.open_edge_count(); });
  expect_same_at_once([](const Scene& scene) { return scene.hash(); });
}

TEST(Threads, ShareASceneAndASourceForExactValues) {
  expect_same_at_once([](const Scene& scene) {
    const ExactSource source(scene, scene.select("lamp"));
    std::vector<double> values;
    for (const Receiver& receiver : validation::room_receivers(scene)) {
      const FormFactor f =
          exact_form_factor(scene, receiver, source, {.engine = Engine::kBoth, .visible_fraction = true});
      values.insert(values.end(), {f.value, f.visible_fraction.value()});
    }
    return values;
  });
}

TEST(Threads, ShareASceneForDrawings) {
  expect_same_at_once([](const Scene& scene) {
    const ExactSource source(scene, scene.select("lamp"));
    std::vector<std::size_t> corners;
    for (const Receiver& receiver : validation::room_receivers(scene)) {
      for (const PlaneDrawing& plane : draw_visibility(scene, receiver, source)) {
        for (const auto& loop : plane.visible) corners.push_back(loop.corners.size());
      }
    }
    return corners;
  });
}

// Long lists of candidates: the first thread that needs the ray structure builds it.
TEST(Threads, ShareAnAdaptiveSolver) {
  const generate::PlainScene plain = generate::karkanis({.n = 60});
  const Scene scene = generate::build(plain);
  const AdaptiveSolver alone(scene), shared(scene);
  const auto estimate = [&](const AdaptiveSolver& solver) {
    return solver.form_factor(generate::receiver_of(plain), scene.select(plain.source), 1.0, {.eps_b = 0.01, .rays = 4})
        .form_factor;
  };
  const double expected = estimate(alone);
  for (const double found : at_once([&] { return estimate(shared); })) EXPECT_EQ(found, expected);
}

}  // namespace
}  // namespace exactff
