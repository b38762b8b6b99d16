// In the steady state, computing a pair of a receiver and a source allocates nothing, unless its value needs Arb.
//
// GMP, Arb and operator new all allocate by malloc: this program's own malloc counts every call.
#include <cerrno>
#include <deque>

#include "exact/quick_tier.h"
#include "support/test.h"

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

// On this thread.
template <class Call>
std::uint64_t allocations_of(const Call& call) {
  counted = 0;
  is_counting = true;
  call();
  is_counting = false;
  return counted;
}

struct Pair {
  Receiver receiver;
  const ExactSource* source = nullptr;
};

// The counts of each pair, in the second pass over all pairs.
struct Second {
  int bits = 0;
  bool undecided = false;
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
    second.bits = result.precision_bits;
    second.undecided = std::ranges::any_of(result.planes, [](const auto& plane) { return plane.undecided_pairs > 0; });
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
    EXPECT_GE(10 * static_cast<std::size_t>(std::ranges::count_if(seconds, &Second::undecided)), seconds.size());
  }
}

// Piercing triangles, the clipped walls of a room, and a mesh that lines up with x.
TEST(Allocation, IsNotMadeForAWholeView) {
  std::vector<Scene> scenes;
  for (const char* name : {"karkanis:n=60,seed=2", "soup:n=200"}) scenes.push_back(models::make_scene(name));
  scenes.push_back(read_obj(EXACTFF_DATA_DIR "/scenes/cornell_box.obj"));
  ViewWorkspace workspace;
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
