// In the steady state, computing a pair of a receiver and a source allocates nothing, unless its value needs Arb.
//
// GMP, Arb and operator new all allocate by malloc: this program's own malloc counts every call.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "exact/quick_tier.h"
#include "exact/source_planes.h"
#include "exactff/exact.h"
#include "exactff/models.h"
#include "exactff/scene_files.h"
#include "exactff/view.h"
#include "generate/families.h"
#include "generate/plain_scene.h"
#include "generate/random.h"
#include "kernel/ball.h"
#include "support/random_scenes.h"

namespace {

constinit thread_local bool is_counting = false;
constinit thread_local std::uint64_t counted = 0;

void count_one() {
  if (is_counting) ++counted;
}

}  // namespace

// The functions of the C library, under their other names.
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
// What operator new of GCC 14 calls
int posix_memalign(void** memory, std::size_t alignment, std::size_t size) noexcept {
  count_one();
  void* made = __libc_memalign(alignment, size);
  if (made == nullptr) return ENOMEM;
  *memory = made;
  return 0;
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

// The counts of each pair, in the second pass over all pairs.
struct Second {
  Outcome outcome = Outcome::kBehind;
  int bits = 0;
  bool undecided = false;
  bool horizon_clipped = false;
  std::uint64_t allocations = 0;

  [[nodiscard]] bool takes_arb() const { return bits != 0 && bits != exact::QuickTier::kBits; }
};

std::vector<Second> ask_twice(const Scene& scene, const std::vector<Pair>& pairs) {
  std::vector<Second> seconds;
  FormFactor result;
  for (const Pair& pair : pairs) exact_form_factor(scene, pair.receiver, *pair.source, {}, result);
  for (const Pair& pair : pairs) {
    Second second;
    second.allocations = allocations_of([&] { exact_form_factor(scene, pair.receiver, *pair.source, {}, result); });
    if (!result.planes.empty()) second.outcome = result.planes.front().outcome;
    second.bits = result.precision_bits;
    for (const PlaneRecord& plane : result.planes) {
      second.undecided = second.undecided || plane.undecided_pairs > 0;
      second.horizon_clipped = second.horizon_clipped || plane.horizon_clipped;
    }
    seconds.push_back(second);
  }
  return seconds;
}

// Returns how many pairs need Arb.
std::size_t expect_none_but_by_arb(const std::vector<Second>& seconds) {
  std::size_t by_arb = 0;
  for (std::size_t i = 0; i < seconds.size(); ++i) {
    if (!seconds[i].takes_arb()) {
      EXPECT_EQ(seconds[i].allocations, 0U) << "pair " << i;
    }
    by_arb += seconds[i].takes_arb() ? 1 : 0;
  }
  return by_arb;
}

template <class Predicate>
std::size_t count_if(const std::vector<Second>& seconds, const Predicate& predicate) {
  return static_cast<std::size_t>(std::count_if(seconds.begin(), seconds.end(), predicate));
}
std::size_t undecided_count(const std::vector<Second>& seconds) {
  return count_if(seconds, [](const Second& second) { return second.undecided; });
}

// Rooms along the axes, whose edges line up: if the filter is uncertain, exact arithmetic decides.
TEST(Allocation, IsNotMadeBetweenThePatchesOfARoom) {
  for (const char* file : {EXACTFF_DATA_DIR "/scenes/cornell_box.obj", EXACTFF_DATA_DIR "/scenes/blinds_room.obj"}) {
    SCOPED_TRACE(file);
    const Scene scene = read_obj(file);
    std::deque<ExactSource> sources;
    std::vector<Receiver> receivers;
    for (const Patch& patch : scene.patches()) {
      const Selection selection = scene.select(patch.name);
      sources.emplace_back(scene, selection);
      for (const Receiver& receiver : grid_receivers(scene, selection, {2, 2})) receivers.push_back(receiver);
    }
    std::vector<Pair> pairs;
    for (const Receiver& receiver : receivers) {
      for (const ExactSource& source : sources) pairs.push_back({receiver, &source});
    }
    const std::vector<Second> seconds = ask_twice(scene, pairs);
    EXPECT_LE(100 * expect_none_but_by_arb(seconds), seconds.size());
    EXPECT_GE(10 * undecided_count(seconds), seconds.size());
  }
}

// Edges that line up, and edges that almost line up.
TEST(Allocation, IsNotMadeOnDegenerateScenes) {
  std::size_t count = 0, by_arb = 0, undecided = 0;
  for (std::uint64_t i = 0; i < validation::scaled_count(400); ++i) {
    SCOPED_TRACE("seed " + std::to_string(validation::seed_of(i)));
    Random random(validation::seed_of(i));
    const auto make = std::array{validation::degenerate_scene, validation::nudged_scene, validation::sheared_scene,
                                 validation::crowded_scene}[i % 4];
    const PlainScene plain = make(random);
    const Scene scene = generate::build(plain);
    const ExactSource source(scene, scene.select(plain.source));
    const std::vector<Second> seconds = ask_twice(scene, {{generate::receiver_of(plain), &source}});
    ++count;
    by_arb += expect_none_but_by_arb(seconds);
    undecided += undecided_count(seconds);
  }
  EXPECT_LE(5 * by_arb, count);
  EXPECT_GE(5 * undecided, count);
}

// By a few that are chosen for this receiver, and by those that hid the source from the one before.
TEST(Allocation, IsNotMadeToHideAllByAFew) {
  const PlainScene plain = generate::soup({.n = 300, .seed = 1, .cover = 50.0});
  const Scene scene = generate::build(plain);
  const ExactSource source(scene, scene.select(plain.source));
  for (const bool from_scratch : {true, false}) {
    const ExactOptions options{.from_scratch = from_scratch};
    Workspace workspace;
    FormFactor result;
    std::size_t few = 0, remembered = 0;
    for (const bool counts : {false, false, true}) {  // the second pass begins with what hid the source from the last
      Receiver receiver = generate::receiver_of(plain);
      for (int i = 0; i < 30; ++i) {
        receiver.point.x = 0.005 * i;
        const auto ask = [&] { exact_form_factor(scene, receiver, source, options, result, workspace); };
        const std::uint64_t allocations = allocations_of(ask);
        const PlaneRecord& plane = result.planes.at(0);
        few += plane.outcome == Outcome::kHiddenByUnion && plane.cover < 20 ? 1 : 0;
        remembered += plane.cover_remembered ? 1 : 0;
        if (counts && (result.precision_bits == 0 || result.precision_bits == exact::QuickTier::kBits)) {
          EXPECT_EQ(allocations, 0U) << "receiver " << i;
        }
      }
    }
    EXPECT_GT(few, 20U);
    EXPECT_EQ(remembered > 20, !from_scratch);
  }
}

// Piercing triangles, the clipped walls of a room, and a mesh that lines up with x.
TEST(Allocation, IsNotMadeForAWholeView) {
  std::vector<Scene> scenes;
  for (const char* name : {"karkanis:n=60,seed=2", "soup:n=200"}) scenes.push_back(models::make_scene(name));
  scenes.push_back(read_obj(EXACTFF_DATA_DIR "/scenes/cornell_box.obj"));
  Workspace workspace;
  WholeView seen;
  std::size_t count = 0, compared = 0, pierced = 0;
  for (const bool counts : {false, true}) {
    Random random(3);
    for (int i = 0; i < 30; ++i) {
      const Scene& scene = scenes[static_cast<std::size_t>(i) % scenes.size()];
      const double size = i % 3 == 2 ? 500.0 : 1.0;
      const Receiver receiver{.point = {size * random.between(0.1, 0.9), size * random.between(0.1, 0.9), 0.25 * size},
                              .normal = {random.between(-1, 1), random.between(-1, 1), 1.0},
                              .on = {},
                              .id = {}};
      const std::uint64_t allocations = allocations_of([&] { view(scene, receiver, {}, seen, workspace); });
      if (!counts) continue;
      ++count;
      pierced += seen.record.pierced;
      const auto took_arb = [](const ViewShare& share) { return share.precision_bits > exact::QuickTier::kBits; };
      if (took_arb(seen.back) || took_arb(seen.open) || std::ranges::any_of(seen.patches, [&](const SeenPatch& patch) {
            return patch.stacked || took_arb(patch.share);
          })) {
        continue;
      }
      ++compared;
      EXPECT_EQ(allocations, 0U) << "view " << i;
    }
  }
  EXPECT_GE(2 * compared, count);
  EXPECT_GT(pierced, 0U);
}

}  // namespace
}  // namespace exactff
