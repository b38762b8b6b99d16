// In the steady state a pair of a receiver and a source allocates nothing, unless it needs what no double-double can
// tell.
//
// GMP and Arb allocate by malloc, operator new does too: this program's own counts them all.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <set>
#include <vector>

#include "exact/quick_tier.h"
#include "exact/source_planes.h"
#include "exactff/exact.h"
#include "exactff/obj.h"
#include "generate/plain_scene.h"
#include "generate/random.h"
#include "kernel/ball.h"

namespace {

constinit thread_local bool is_counting = false;
constinit thread_local std::uint64_t counted = 0;

void count_one() {
  if (is_counting) ++counted;
}

}  // namespace

// The C library's own, under their other names.
extern "C" {
void* __libc_malloc(std::size_t size) noexcept;
void* __libc_calloc(std::size_t count, std::size_t size) noexcept;
void* __libc_realloc(void* memory, std::size_t size) noexcept;
void* __libc_memalign(std::size_t alignment, std::size_t size) noexcept;

void* malloc(std::size_t size) noexcept {
  count_one();
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) noexcept {
  count_one();
  return __libc_calloc(count, size);
}
void* realloc(void* memory, std::size_t size) noexcept {
  count_one();
  return __libc_realloc(memory, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  count_one();
  return __libc_memalign(alignment, size);
}
}

namespace exactff {
namespace {

using generate::PlainScene;
using generate::Random;

// On this thread.
template <class Call>
std::uint64_t allocations_of(const Call& call) {
  counted = 0;
  is_counting = true;
  call();
  is_counting = false;
  return counted;
}

TEST(Allocation, IsCountedWhoeverMakesIt) {
  std::vector<int> numbers;
  EXPECT_EQ(allocations_of([&] { numbers.reserve(100); }), 1U);
  EXPECT_EQ(allocations_of([&] { numbers.assign(100, 1); }), 0U);
  struct alignas(256) Aligned {
    double number = 0.0;
  };
  std::unique_ptr<Aligned> aligned;
  EXPECT_EQ(allocations_of([&] { aligned = std::make_unique<Aligned>(); }), 1U);
  kernel::Integer integer = 1;
  EXPECT_GE(allocations_of([&] { integer <<= 1000; }), 1U);
  Ball ball;
  EXPECT_GE(allocations_of([&] { arb_const_pi(ball.get(), 500); }), 1U);
}

struct Pair {
  Receiver receiver;
  const ExactSource* source = nullptr;
};

// What a pair did when it was asked for with all others a second time.
struct Second {
  Outcome outcome = Outcome::kBehind;
  int bits = 0;
  std::uint64_t undecided = 0;
  bool horizon_clipped = false;
  std::uint64_t allocations = 0;

  [[nodiscard]] bool needs_only_doubles() const { return bits <= exact::QuickTier::kBits && undecided == 0; }
};

std::vector<Second> ask_twice(const Scene& scene, const std::vector<Pair>& pairs) {
  std::vector<Second> seconds;
  FormFactor result;
  for (const Pair& pair : pairs) exact_form_factor(scene, pair.receiver, *pair.source, {}, result);
  for (const Pair& pair : pairs) {
    Second second;
    second.allocations = allocations_of([&] { exact_form_factor(scene, pair.receiver, *pair.source, {}, result); });
    second.outcome = result.planes.front().outcome;
    second.bits = result.precision_bits;
    for (const PlaneRecord& plane : result.planes) {
      second.undecided += plane.undecided_pairs;
      second.horizon_clipped = second.horizon_clipped || plane.horizon_clipped;
    }
    seconds.push_back(second);
  }
  return seconds;
}

// Of all pairs that need but doubles; returns how many of all allocate nothing.
std::size_t expect_none(const std::vector<Second>& seconds) {
  std::size_t without = 0;
  for (std::size_t i = 0; i < seconds.size(); ++i) {
    if (seconds[i].needs_only_doubles()) {
      EXPECT_EQ(seconds[i].allocations, 0U) << "pair " << i;
    }
    without += seconds[i].allocations == 0 ? 1 : 0;
  }
  return without;
}

// Signs that exact predicates have to tell, where corners line up, allocate nothing either.
TEST(Allocation, IsNotMadeForTheFloorOfTheCornellBox) {
  const Scene scene = read_obj(EXACTFF_DATA_DIR "/scenes/cornell_box.obj");
  const ExactSource light(scene, scene.select("light"));
  std::vector<Pair> pairs;
  for (const Receiver& receiver : grid_receivers(scene, scene.select("floor"), {32, 32})) {
    pairs.push_back({receiver, &light});
  }
  const std::vector<Second> seconds = ask_twice(scene, pairs);
  EXPECT_EQ(expect_none(seconds), seconds.size());
  std::set<Outcome> outcomes;
  for (const Second& second : seconds) {
    if (second.needs_only_doubles()) outcomes.insert(second.outcome);
  }
  EXPECT_EQ(outcomes,
            (std::set{Outcome::kUnoccluded, Outcome::kHiddenByOne, Outcome::kPartlyHidden, Outcome::kHiddenByUnion}));
}

// Three sources in no special position: of one plane, of nine, and a round one; occluders before and through them.
PlainScene scene_of_three_sources() {
  PlainScene plain;
  Random random(1);
  const auto corner = [&](double low, double high) {
    return Vec3{random.between(-1, 1), random.between(-1, 1), random.between(low, high)};
  };
  const auto add = [&](const char* name, double low, double high) {
    plain.add_ring(plain.patch(name), {corner(low, high), corner(low, high), corner(low, high)});
  };
  add("one", 4, 5);
  for (int k = 0; k < 9; ++k) add("many", 3, 5);
  for (int k = 0; k < 12; ++k) add("occluder", 1, 4.5);
  constexpr int kCorners = 31;
  std::vector<Vec3> round;
  for (int k = 0; k < kCorners; ++k) round.push_back({std::cos(-0.2 * k) - 0.3, std::sin(-0.2 * k) + 0.1, 6.0});
  plain.add_ring(plain.patch("round"), round);
  return plain;
}

TEST(Allocation, IsNotMadeWhereSourcesTakeTurns) {
  const Scene scene = generate::build(scene_of_three_sources());
  const ExactSource one(scene, scene.select("one")), many(scene, scene.select("many")),
      round(scene, scene.select("round"));
  ASSERT_EQ(many.planes().planes.size(), 9U);
  Random random(2);
  std::vector<Pair> pairs;
  for (int i = 0; i < 100; ++i) {
    Receiver receiver;
    receiver.point = {random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
    receiver.normal = i % 2 == 0 ? Vec3{0.1, -0.2, 1.0} : Vec3{0.9, 0.3, random.between(-0.2, 0.2)};
    for (const ExactSource* source : {&one, &many, &round}) pairs.push_back({receiver, source});
  }
  const std::vector<Second> seconds = ask_twice(scene, pairs);
  EXPECT_GE(100 * expect_none(seconds), 95 * seconds.size());
  EXPECT_TRUE(std::any_of(seconds.begin(), seconds.end(),
                          [](const Second& second) { return second.outcome == Outcome::kPartlyHidden; }));
  EXPECT_TRUE(std::any_of(seconds.begin(), seconds.end(), [](const Second& second) {
    return second.horizon_clipped && second.outcome == Outcome::kPartlyHidden;
  }));
}

}  // namespace
}  // namespace exactff
