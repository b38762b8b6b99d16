#include "view_factors/refinement.h"

#include <algorithm>

#include "view_factors/pair_choice.h"

namespace exactff::view_factors {
namespace {

constexpr std::size_t kStepsBetweenSums = 4096;
constexpr double kShareOfRounding = 0x1p-8;                // of the accuracy
constexpr double kShareOfNegligible = 0x1p-24;             // of the error that is allowed
constexpr double kShareOfQuadrature = 0.0625;              // the same, of a cell as large as the patch
constexpr double kShareOfDim = 0.25;                       // the same, of a cell that is left undecided
constexpr double kShareOfCell = 0x1p-4;                    // the same, of a certified cell as large as the patch
constexpr std::size_t kMostPoints = std::size_t{1} << 20;  // of all pairs of parts: some 200 MB

Pair::Limits limits_of(const ViewFactorOptions& options, double target, double area, std::size_t parts_seen) {
  const double certified = options.certify ? target * kShareOfCell / static_cast<double>(parts_seen) : 0.0;
  return {.rounding = options.accuracy * kShareOfRounding,
          .negligible_area = target * kShareOfNegligible,
          .quadrature = target / area * kShareOfQuadrature,
          .enough = target * kShareOfDim,
          .certified = certified,
          .area = area};
}

}  // namespace

Refinement::Refinement(const ExactScene& scene, const SeenParts& seen, const PreparedPatch& from,
                       const PreparedPatch& to, const ViewFactorOptions& options, double target, PairMemory& memory)
    : area_(from.unit_area), budget_(options.budget), least_error_(target / (4.0 * static_cast<double>(budget_))) {
  const Pair::Limits limits = limits_of(options, target, area_, to.parts.size());
  PairChoice choice(scene, limits, memory, from.planar && to.planar && !options.both_directions);
  const SeenParts::Lists& seen_from = from.seen.lists(seen, from.parts);
  const std::vector<PairEnd> receivers = ends_of(scene.scene, from), sources = ends_of(scene.scene, to);
  std::size_t points = 0;
  for (std::size_t r = 0; r < receivers.size(); ++r) {
    for (const PairEnd& source : sources) {
      if (!sees(scene.scene, seen_from[r], source.part)) continue;
      std::unique_ptr<Pair> pair = choice.choose(seen_from[r].occluders, receivers[r], source);
      if (pair == nullptr) continue;
      points += pair->point_count();
      if (cost_ >= budget_ || points > kMostPoints) {
        give_up();
        return;
      }
      add_pair(std::move(pair));
    }
  }
}

void Refinement::add_pair(std::unique_ptr<Pair> pair) {
  pairs_.push_back(std::move(pair));
  const std::size_t made = made_;
  const std::size_t left = budget_ - cost_;
  work_on(pairs_.size() - 1, [&](Pair& p) { return p.cells(left); });
  if (made_ == made) pairs_.back().reset();
}

// Some pairs are left out, so the shares of the others tell nothing.
void Refinement::give_up() {
  waiting_.clear();
  settled_.clear();
  pairs_.clear();
  gave_up_ = true;
}

void Refinement::refine(double target) {
  for (std::size_t steps = 0; !waiting_.empty() && cost_ < budget_;) {
    if (running_error_ <= target || ++steps % kStepsBetweenSums == 0) {
      running_error_ = error();  // without the roundings of its updates
      if (running_error_ <= target) return;
    }
    if (!(waiting_.front().share.error >= least_error_)) return;
    cut_worst();
  }
}

void Refinement::cut_worst() {
  std::ranges::pop_heap(waiting_, is_less_urgent);
  Waiting worst = std::move(waiting_.back());
  waiting_.pop_back();
  running_error_ -= worst.share.error;
  work_on(worst.pair, [&](Pair& pair) { return pair.halves(std::move(worst.share)); });
}

// Adds the shares that the call makes of the pair.
template <class Call>
void Refinement::work_on(std::size_t id, const Call& call) {
  Pair& pair = *pairs_[id];
  const std::size_t cells = pair.cells_made(), cost = pair.cost();
  for (Share& share : call(pair)) add(std::move(share), id);
  cells_ += pair.cells_made() - cells;
  cost_ += pair.cost() - cost;
}

// No more than 4 * budget_ shares are ever made, so the worst of them has an error of at least least_error_ while they
// exceed the target: of others, only the numbers are needed.
void Refinement::add(Share share, std::size_t pair) {
  ++made_;
  running_error_ += share.error;
  if (share.error < least_error_) share.keep_numbers_only();
  if (share.narrow) {
    settled_.push_back(std::move(share));
    return;
  }
  waiting_.push_back({std::move(share), pair, made_});
  std::ranges::push_heap(waiting_, is_less_urgent);
}

double Refinement::error() const {
  if (gave_up_) return 0.5 * area_;
  double sum = 0.0;
  for (const Waiting& w : waiting_) sum += w.share.error;
  for (const Share& share : settled_) sum += share.error;
  return sum;
}

kernel::Disc Refinement::enclosure(const kernel::Disc& area) const {
  if (gave_up_) return widened(0.5 * area, 0.5 * magnitude(area));
  kernel::Disc sum;
  for (const Waiting& w : waiting_) sum = sum + kernel::Disc{w.share.integral, w.share.error};
  for (const Share& share : settled_) sum = sum + kernel::Disc{share.integral, share.error};
  return sum;
}

std::size_t Refinement::event_cells() const {
  const auto is_event = [](const Share& share) { return share.is_event; };
  return static_cast<std::size_t>(std::ranges::count_if(waiting_, is_event, &Waiting::share) +
                                  std::ranges::count_if(settled_, is_event));
}

}  // namespace exactff::view_factors
