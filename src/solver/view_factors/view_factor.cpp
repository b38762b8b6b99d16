#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "exactff/view_factors.h"
#include "kernel/float_environment.h"
#include "kernel/poll.h"
#include "text/phrases.h"
#include "text/refuse.h"
#include "view_factors/disc_space.h"
#include "view_factors/near_planes.h"
#include "view_factors/pair.h"
#include "view_factors/pairs.h"
#include "view_factors/patch_parts.h"
#include "view_factors/sampled_factor.h"
#include "view_factors/seen_parts.h"

namespace exactff {
namespace view_factors {
namespace {

constexpr std::size_t kStepsBetweenSums = 4096;
constexpr std::size_t kCellsOfAPoint = 4;                  // that cost about as much as a point factor in a crowd
constexpr double kShareOfRounding = 0x1p-10;               // of the accuracy
constexpr double kShareOfNegligible = 0x1p-24;             // of the error that is allowed
constexpr double kShareOfQuadrature = 0.0625;              // the same, of a cell as large as the patch
constexpr double kShareOfDim = 0.25;                       // the same, of a cell that is left undecided
constexpr std::size_t kMostPoints = std::size_t{1} << 20;  // of all pairs of parts: some 200 MB
constexpr double kShareOfCell = 0x1p-4;  // of the error allowed, a certified cell as large as the patch
constexpr double kShareOfTarget = 0.99;  // certified: leaves room for the roundings of sums
constexpr double kRounding = 0x1p-44;    // relative: more than the roundings of formula and sums in usual scenes

struct Waiting {
  Share share;
  std::size_t pair;
  std::size_t number;  // ties: the older one first
};

bool is_less_urgent(const Waiting& a, const Waiting& b) {
  return a.share.error != b.share.error ? a.share.error < b.share.error : a.number > b.number;
}

// A patch, prepared once.
struct Prepared {
  Selection patch;
  std::vector<Part> parts;
  double area = 0.0;       // in the scene's unit of length, squared
  double unit_area = 0.0;  // in squares of the unit of Point::at
  bool planar = true;
  SeenParts::OfPatch seen;
};

Prepared prepare(const ExactScene& scene, const Selection& patch) {
  Prepared result{patch, parts_of(scene, patch), 0.0, 0.0, is_planar(scene.scene, patch), {}};
  std::tie(result.unit_area, result.area) = areas_of(scene, patch, result.parts);
  return result;
}

// All pairs of parts of two patches, refined together until the sum of their errors is small enough.
class Integral {
 public:
  Integral(const ExactScene& scene, const SeenParts& seen, const Prepared& from, const Prepared& to,
           const ViewFactorOptions& options, double target, PairMemory& memory)
      : area_(from.unit_area),
        budget_(options.budget),
        least_error_(target / (4.0 * static_cast<double>(budget_))),
        memory_(memory) {
    const double certified = options.certify ? target * kShareOfCell / static_cast<double>(to.parts.size()) : 0.0;
    limits_ = {.rounding = options.accuracy * kShareOfRounding,
               .negligible_area = target * kShareOfNegligible,
               .quadrature = target / area_ * kShareOfQuadrature,
               .enough = target * kShareOfDim,
               .certified = certified,
               .area = area_};
    const SeenParts::Lists& seen_from = from.seen.lists(seen, from.parts);
    const bool either = from.planar && to.planar && !options.both_directions;
    const std::vector<End> receivers = ends_of(scene.scene, from), sources = ends_of(scene.scene, to);
    for (std::size_t r = 0; r < receivers.size(); ++r) {
      for (const End& source : sources) {
        if (!sees(scene.scene, seen_from[r], source.part)) continue;
        std::unique_ptr<Pair> pair = better_pair(scene, seen_from[r].occluders, receivers[r], source, either);
        if (pair == nullptr) continue;
        points_ += pair->point_count();
        if (cost_ >= budget_ || points_ > kMostPoints) {
          give_up();
          return;
        }
        add_pair(std::move(pair));
      }
    }
  }

  // error <= target, or the budget is used up.
  void refine(double target) {
    for (std::size_t steps = 0; !waiting_.empty() && cost_ < budget_;) {
      if (running_error_ <= target || ++steps % kStepsBetweenSums == 0) {
        running_error_ = error();  // without the roundings of its updates
        if (running_error_ <= target) return;
      }
      if (!(waiting_.front().share.error >= least_error_)) return;
      std::ranges::pop_heap(waiting_, is_less_urgent);
      Waiting worst = std::move(waiting_.back());
      waiting_.pop_back();
      running_error_ -= worst.share.error;
      work_on(worst.pair, [&](Pair& pair) { return pair.halves(std::move(worst.share)); });
    }
  }

  [[nodiscard]] double integral() const { return gave_up_ ? 0.5 * area_ : sum_of(&Share::integral); }
  [[nodiscard]] double error() const { return gave_up_ ? 0.5 * area_ : sum_of(&Share::error); }
  // The integral, certified; requires Limits::certified. Given up, F lies in [0, 1].
  [[nodiscard]] Disc enclosure(const Disc& area) const {
    if (gave_up_) return widened(0.5 * area, 0.5 * magnitude(area));
    Disc sum;
    for (const Waiting& w : waiting_) sum = sum + Disc{w.share.integral, w.share.error};
    for (const Share& share : settled_) sum = sum + Disc{share.integral, share.error};
    return sum;
  }
  [[nodiscard]] bool is_zero() const { return waiting_.empty() && settled_.empty() && !gave_up_; }
  [[nodiscard]] std::size_t cells() const { return cells_; }
  [[nodiscard]] std::size_t event_cells() const {
    const auto is_event = [](const Share& share) { return share.is_event; };
    return static_cast<std::size_t>(std::ranges::count_if(waiting_, is_event, &Waiting::share) +
                                    std::ranges::count_if(settled_, is_event));
  }

 private:
  // A part, and the source that checks the cells which see it if it is a whole face.
  struct End {
    const Part& part;
    std::shared_ptr<const ExactSource> whole;
  };

  static std::vector<End> ends_of(const Scene& scene, const Prepared& patch) {
    std::vector<End> ends;
    for (const Part& part : patch.parts) {
      const bool whole = part.is_piece && scene.pieces_of(part.face).size() == 1;
      Selection face = patch.patch;
      face.face = part.face;
      ends.push_back({part, whole ? std::make_shared<const ExactSource>(scene, face) : nullptr});
    }
    return ends;
  }

  // Null if the two do not see each other. A_i F_ij = A_j F_ji: `either` side may be the one that is cut.
  std::unique_ptr<Pair> better_pair(const ExactScene& scene, std::span<const std::uint32_t> pieces, const End& from,
                                    const End& to, bool either) {
    std::unique_ptr<Pair> pair = make_pair(scene, pieces, from, to);
    if (pair == nullptr || !either || pair->is_dim()) return pair;
    const std::size_t events = pair->events();
    if (events == 0) return pair;
    std::unique_ptr<Pair> other = make_pair(scene, pieces, to, from);
    return other->events() < events ? std::move(other) : std::move(pair);
  }

  std::unique_ptr<Pair> make_pair(const ExactScene& scene, std::span<const std::uint32_t> pieces, const End& receiver,
                                  const End& source) {
    std::optional<Sight> sight = sight_of(scene, pieces, receiver.part, source.part, receiver.part.face);
    if (!sight) return nullptr;
    return std::make_unique<Pair>(scene.scene, std::move(*sight), receiver.part.face, source.whole, limits_, memory_,
                                  pairs_made_++);
  }

  void add_pair(std::unique_ptr<Pair> pair) {
    pairs_.push_back(std::move(pair));
    const std::size_t made = made_;
    const std::size_t left = budget_ - cost_;
    work_on(pairs_.size() - 1, [&](Pair& p) { return p.cells(left); });
    if (made_ == made) pairs_.back().reset();
  }

  // With the number of pairs at hand alone, nothing but 0 <= F <= 1 is known.
  void give_up() {
    waiting_.clear();
    settled_.clear();
    pairs_.clear();
    gave_up_ = true;
  }

  // Takes the shares that the call makes of the pair. No more than 4 * budget_ are ever made, so the worst of them has
  // an error of at least least_error_ while they exceed the target: of others, only the numbers are needed.
  template <class Call>
  void work_on(std::size_t id, const Call& call) {
    Pair& pair = *pairs_[id];
    const std::size_t cells = pair.cells_made(), cost = pair.cost();
    for (Share& share : call(pair)) {
      ++made_;
      running_error_ += share.error;
      if (share.error < least_error_) share.keep_numbers_only();
      if (share.narrow) {
        settled_.push_back(std::move(share));
        continue;
      }
      waiting_.push_back({std::move(share), id, made_});
      std::ranges::push_heap(waiting_, is_less_urgent);
    }
    cells_ += pair.cells_made() - cells;
    cost_ += pair.cost() - cost;
  }

  [[nodiscard]] double sum_of(double Share::*member) const {
    double sum = 0.0;
    for (const Waiting& w : waiting_) sum += w.share.*member;
    for (const Share& share : settled_) sum += share.*member;
    return sum;
  }

  double area_;
  std::size_t budget_;
  double least_error_;
  PairMemory& memory_;
  Pair::Limits limits_;
  std::size_t pairs_made_ = 0;
  std::vector<std::unique_ptr<Pair>> pairs_;  // null: sees nothing
  std::vector<Waiting> waiting_;              // a heap
  std::vector<Share> settled_;                // narrow ones
  double running_error_ = 0.0;
  std::size_t made_ = 0;  // shares
  std::size_t cells_ = 0, cost_ = 0;
  std::size_t points_ = 0;  // of all sights
  bool gave_up_ = false;
};

void check_accuracy(double accuracy) {
  if (accuracy > 0.0 && std::isfinite(accuracy)) return;
  text::refuse("the accuracy of a view factor is " + text::shortest(accuracy), "it bounds an error",
               "give a positive number; the default is 1e-6");
}

// If the cells of a crowd tell less than statistics.
void sample_if_better(const ExactScene& scene, const Prepared& from, const Prepared& to,
                      const ViewFactorOptions& options, double target, ViewFactor& result) {
  const SampledIntegral sampled =
      sampled_integral(scene, from.parts, to.patch, options.budget / kCellsOfAPoint, target);
  const double value = sampled.value / from.unit_area, error = sampled.error / from.unit_area + kRoundedPoints;
  const double lower = std::max(0.0, value - error), upper = std::min(1.0, value + error);
  if (!(upper - lower < result.upper - result.lower)) return;
  result.claim = Claim::kStatistical;
  result.value = std::clamp(value, 0.0, 1.0);
  result.lower = lower;
  result.upper = upper;
  result.accurate = error * from.unit_area <= target;
}

bool is_within(double accuracy, const ViewFactor& f, const Prepared& from, const Prepared& to) {
  const double width = f.upper - f.lower;
  return std::max(width, width * from.unit_area / to.unit_area) <= accuracy;
}

void take_enclosure(const ExactScene& scene, const Integral& integral, const Prepared& from, ViewFactor& result) {
  const Disc area = enclosed_area_of(from.parts, scene.units);
  const Disc f = integral.enclosure(area) / area;
  result.claim = Claim::kCertified;
  result.lower = is_finite(f) ? std::clamp(lower_end(f), 0.0, 1.0) : 0.0;
  result.upper = is_finite(f) ? std::clamp(upper_end(f), 0.0, 1.0) : 1.0;
  result.value = is_finite(f) ? std::clamp(f.centre, result.lower, result.upper) : 0.5;
}

ViewFactor factor(const ExactScene& scene, const SeenParts& seen, const Prepared& from, const Prepared& to,
                  const ViewFactorOptions& options, PairMemory& memory) {
  ViewFactor result;
  result.area_from = from.area;
  result.area_to = to.area;
  const double target = 0.5 * options.accuracy * std::min(from.unit_area, to.unit_area);
  Integral integral(scene, seen, from, to, options, target, memory);
  result.cells = integral.cells();
  if (integral.is_zero()) return result;
  integral.refine(options.certify ? kShareOfTarget * target : target);
  if (options.certify) {
    take_enclosure(scene, integral, from, result);
    result.accurate = is_within(options.accuracy, result, from, to);
    result.cells = integral.cells();
    result.event_cells = integral.event_cells();
    return result;
  }
  result.claim = Claim::kTopologyProved;
  result.value = std::clamp(integral.integral() / from.unit_area, 0.0, 1.0);
  const double error = integral.error() / from.unit_area + kRounding * result.value;
  result.lower = std::max(0.0, result.value - error);
  result.upper = std::min(1.0, result.value + error);
  result.accurate = integral.error() <= target;
  result.cells = integral.cells();
  result.event_cells = integral.event_cells();
  if (!result.accurate && options.sample_crowds) sample_if_better(scene, from, to, options, target, result);
  return result;
}

// By A_i F_ij = A_j F_ji.
ViewFactor reversed(const ExactScene& scene, const ViewFactor& f, const Prepared& from, const Prepared& to) {
  ViewFactor result = f;
  std::swap(result.area_from, result.area_to);
  if (f.claim == Claim::kCertified) {
    const Disc exact = enclosed_area_of(from.parts, scene.units) / enclosed_area_of(to.parts, scene.units);
    result.lower = std::clamp(lower_end(f.lower * exact), 0.0, 1.0);
    result.upper = std::clamp(upper_end(f.upper * exact), 0.0, 1.0);
    result.value = std::clamp(f.value * exact.centre, result.lower, result.upper);
    return result;
  }
  const double ratio = from.unit_area / to.unit_area;
  result.value = std::min(1.0, f.value * ratio);
  result.lower = std::min(1.0, f.lower * ratio * (1.0 - kRounding));
  result.upper = std::min(1.0, f.upper * ratio * (1.0 + kRounding));
  return result;
}

// The entries that are computed, each with those that are its transposes.
std::vector<std::vector<std::size_t>> pairs_of(const std::vector<Prepared>& from, const std::vector<Prepared>& to,
                                               bool both_directions) {
  std::map<std::pair<std::pair<PatchId, std::optional<FaceId>>, std::pair<PatchId, std::optional<FaceId>>>, std::size_t>
      known;
  const auto key = [](const Prepared& p) { return std::pair(p.patch.patch, p.patch.face); };
  std::vector<std::vector<std::size_t>> result;
  for (std::size_t e = 0; e < from.size() * to.size(); ++e) {
    const Prepared &i = from[e / to.size()], &j = to[e % to.size()];
    const bool once = i.planar && j.planar && !both_directions;
    if (const auto other = once ? known.find({key(j), key(i)}) : known.end(); other != known.end()) {
      result[other->second].push_back(e);
    } else {
      if (once) known.emplace(std::pair(key(i), key(j)), result.size());
      result.push_back({e});
    }
  }
  return result;
}

std::vector<Prepared> prepared(const ExactScene& scene, std::span<const Selection> patches) {
  std::vector<Prepared> result;
  for (const Selection& patch : patches) result.push_back(prepare(scene, patch));
  return result;
}

}  // namespace

struct Pairs::Patches {
  Patches(const Scene& given, std::span<const Selection> from, std::span<const Selection> to)
      : scene(given), seen(scene), rows(prepared(scene, from)), columns(prepared(scene, to)) {}

  ExactScene scene;
  SeenParts seen;
  std::vector<Prepared> rows, columns;
  mutable PairMemories memories;
};

Pairs::Pairs(const Scene& scene, std::span<const Selection> from, std::span<const Selection> to,
             const ViewFactorOptions& options)
    : options_(options) {
  check_accuracy(options.accuracy);
  patches_ = std::make_unique<const Patches>(scene, from, to);
  entries_ = pairs_of(patches_->rows, patches_->columns, options.both_directions);
}
Pairs::~Pairs() = default;

double Pairs::area_from(std::size_t row) const { return patches_->rows[row].area; }

void Pairs::compute(std::size_t pair, const std::function<void(std::size_t, const ViewFactor&)>& take) const {
  const kernel::StandardArithmetic of_thread;
  const std::vector<std::size_t>& entries = entries_[pair];
  const std::size_t columns = patches_->columns.size(), first = entries.front();
  const Prepared &from = patches_->rows[first / columns], &to = patches_->columns[first % columns];
  std::unique_ptr<PairMemory> memory = patches_->memories.take();
  const ViewFactor computed = factor(patches_->scene, patches_->seen, from, to, options_, *memory);
  patches_->memories.give_back(std::move(memory));
  take(first, computed);
  for (const std::size_t entry : std::span(entries).subspan(1))
    take(entry, reversed(patches_->scene, computed, from, to));
}

}  // namespace view_factors

std::string_view to_string(Claim claim) {
  switch (claim) {
    case Claim::kStatistical:
      return "statistical";
    case Claim::kTopologyProved:
      return "topology-proved";
    case Claim::kCertified:
      return "certified";
    case Claim::kZero:
      return "zero";
  }
  return {};
}

ViewFactor view_factor(const Scene& scene, const Selection& from, const Selection& to,
                       const ViewFactorOptions& options) {
  const kernel::StandardArithmetic arithmetic;
  const view_factors::Pairs pair(scene, {&from, 1}, {&to, 1}, options);
  kernel::poll();
  ViewFactor result;
  pair.compute(0, [&](std::size_t, const ViewFactor& f) { result = f; });
  return result;
}

}  // namespace exactff
