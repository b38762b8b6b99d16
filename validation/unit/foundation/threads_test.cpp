// Worker pools and loops. Then objects that are documented as safe to share between threads are used by several threads
// at once from the first moment, before anything that they build on demand exists. The results must equal those of one
// thread.
// validation/thread_sanitizer.sh looks for races.
#include <atomic>
#include <chrono>
#include <latch>
#include <stdexcept>
#include <thread>

#include "files/parallel.h"
#include "generate/families.h"
#include "scene/closed_surfaces.h"
#include "scene/scene.h"
#include "support/test.h"
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

}  // namespace
}  // namespace exactff
