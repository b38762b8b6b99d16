// Worker pools and loops. Then objects that are documented as safe to share between threads are used by several threads
// at once from the first moment, before anything that they build on demand exists. The results must equal those of one
// thread.
// validation/thread_sanitizer.sh looks for races.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <latch>
#include <optional>
#include <stdexcept>
#include <thread>
#include <vector>

#include "exactff/adaptive.h"
#include "exactff/exact.h"
#include "exactff/jobs.h"
#include "files/parallel.h"
#include "generate/families.h"
#include "scene/closed_surfaces.h"
#include "scene/scene.h"
#include "unit/rivals/methods_support.h"

namespace exactff {
namespace {

constexpr int kThreads = 4;

TEST(WorkerPool, KnowsTheStepThatBeganFirst) {
  std::latch first_began(1), both_began(2), may_end(1);
  std::atomic<int> started = 0;
  files::WorkerPool pool(2, {}, [&](files::WorkerPool::Worker& worker) {
    const bool is_first = started++ == 0;
    if (!is_first) first_began.wait();
    worker.begin(is_first ? 7 : 8);
    if (is_first) first_began.count_down();
    both_began.count_down();
    may_end.wait();
  });
  both_began.wait();
  EXPECT_EQ(pool.slow_step(std::chrono::milliseconds(0)), 7U);
  EXPECT_EQ(pool.slow_step(std::chrono::hours(1)), std::nullopt);
  may_end.count_down();
  EXPECT_TRUE(pool.wait_for(std::chrono::hours(1)));
  EXPECT_EQ(pool.slow_step(std::chrono::milliseconds(0)), std::nullopt);
}

TEST(WorkerPool, EndsAllThreadsAtTheFirstException) {
  std::atomic<int> started = 0;
  files::WorkerPool pool(3, {}, [&](files::WorkerPool::Worker& worker) {
    if (started++ == 1) throw std::out_of_range("the first");
    while (!worker.must_stop()) std::this_thread::yield();
  });
  EXPECT_TRUE(pool.wait_for(std::chrono::hours(1)));
  EXPECT_THROW(pool.rethrow(), std::out_of_range);
}

TEST(Loops, TakeEveryStepOnceWithTheMemoryOfTheirThread) {
  for (const std::size_t block : {1U, 7U}) {
    for (const int threads : {1, 3}) {
      std::vector<int> taken(100);
      std::atomic<std::size_t> bodies = 0;
      std::size_t done = 0;
      const Hooks hooks{[&](const Progress& at) { done = at.done; }, {}};
      files::parallel_for({.count = taken.size(), .threads = threads, .stage = "steps", .largest_block = block}, hooks,
                          [&] {
                            ++bodies;
                            return [&](std::size_t i) { ++taken[i]; };
                          });
      EXPECT_EQ(taken, std::vector<int>(100, 1));
      EXPECT_EQ(bodies, static_cast<std::size_t>(threads));
      EXPECT_EQ(done, taken.size());
    }
  }
}

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
