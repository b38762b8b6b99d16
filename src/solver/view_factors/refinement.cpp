#include "view_factors/refinement.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <optional>
#include <span>

#include "view_factors/pairs.h"

namespace exactff::view_factors {
namespace {

// --- Pair choice ---

// Pairs of parts: which of the two is cut into cells.

// A part, and the source that checks the cells which see it if it is a whole face or several.
struct PairEnd {
  const Part& part;
  std::shared_ptr<const ExactSource> whole;
};

class PairChoice {
 public:
  // Keeps references. `either`: A_i F_ij = A_j F_ji holds, so either of two parts may be cut.
  PairChoice(const ExactScene& scene, PairMemory& memory, bool either)
      : scene_(scene), memory_(memory), either_(either) {}

  // Cuts `from`, or the one that fewer lines seem to cut. `pieces`: all that may occlude, by ascending index. Null if
  // the two do not see each other.
  [[nodiscard]] std::unique_ptr<Pair> choose(std::span<const std::uint32_t> pieces, const PairEnd& from,
                                             const PairEnd& to);
  // What the pieces leave open of all directions; `whole`: a source all around the scene.
  [[nodiscard]] std::unique_ptr<Pair> of_open(std::span<const std::uint32_t> pieces, const Part& receiver,
                                              std::shared_ptr<const ExactSource> whole);

 private:
  [[nodiscard]] std::unique_ptr<Pair> make(std::span<const std::uint32_t> pieces, const PairEnd& receiver,
                                           const PairEnd& source);

  const ExactScene& scene_;
  PairMemory& memory_;
  bool either_;
  std::size_t made_ = 0;  // numbers the pairs in the memory
};

// The faces of the part's panel as a source, if they are nothing else.
std::shared_ptr<const ExactSource> source_of(const Scene& scene, const Selection& patch, const Part& part) {
  if (!part.is_piece) return nullptr;
  const Panels& all = panels(scene);
  Selection source = patch;
  if (all.is_joined(part.panel)) {
    const Sheet& sheet = all.sheet_of(part.panel);
    if (sheet.panel_count > 1 || faces_of(scene, part) != scene.faces_of(patch)) return nullptr;
  } else {
    if (scene.pieces_of(part.face).size() > 1) return nullptr;
    source.face = part.face;
  }
  return std::make_shared<const ExactSource>(scene, source);
}

// One for each part of the patch, to which they refer.
std::vector<PairEnd> ends_of(const Scene& scene, const PreparedPatch& patch) {
  std::vector<PairEnd> ends;
  for (const Part& part : patch.parts) ends.push_back({part, source_of(scene, patch.selection, part)});
  return ends;
}

std::unique_ptr<Pair> PairChoice::choose(std::span<const std::uint32_t> pieces, const PairEnd& from,
                                         const PairEnd& to) {
  std::unique_ptr<Pair> pair = make(pieces, from, to);
  if (pair == nullptr || !either_) return pair;
  const std::size_t events = pair->events();
  if (events == 0) return pair;
  std::unique_ptr<Pair> other = make(pieces, to, from);
  return other->events() < events ? std::move(other) : std::move(pair);
}

std::unique_ptr<Pair> PairChoice::of_open(std::span<const std::uint32_t> pieces, const Part& receiver,
                                          std::shared_ptr<const ExactSource> whole) {
  return std::make_unique<Pair>(scene_.scene, sight_of_open(scene_, pieces, receiver), receiver.face, std::move(whole),
                                memory_, made_++);
}

std::unique_ptr<Pair> PairChoice::make(std::span<const std::uint32_t> pieces, const PairEnd& receiver,
                                       const PairEnd& source) {
  std::optional<Sight> sight = sight_of(scene_, pieces, receiver.part, source.part);
  if (!sight) return nullptr;
  return std::make_unique<Pair>(scene_.scene, std::move(*sight), receiver.part.face, source.whole, memory_, made_++);
}

// What is below 2^-14 decides nothing between few and many cells. A stage's limits are those of its accuracy.
// --- Refinement ---

constexpr int kFirstStage = -10, kStep = -10;  // exponents of the stages' accuracies
constexpr std::uint64_t kFirstPause = std::uint64_t{1} << 20, kNoPause = std::uint64_t{1} << 62;
constexpr double kLeastAccuracy = 0x1p-50;                 // of a stage
constexpr double kShareOfRounding = 0x1p-4;                // of the accuracy
constexpr double kShareOfNegligible = 0x1p-24;             // of the error that is allowed
constexpr double kShareOfQuadrature = 0.0625;              // the same, of a cell as large as the patch
constexpr double kShareOfCell = 0x1p-12;                   // the same, of a certified cell as large as the patch
constexpr double kCoarse = 0x1p-7;                         // of the smaller area: the error of a cell of step 1
constexpr double kShareOfUnknown = 0x1p-24;                // of all errors: a smaller one matters to no point
constexpr double kShareOfTrifle = 0x1p-7;                  // of the error that is allowed, for all of the budget
constexpr double kMostStuck = 2.0;                         // of the error that waits, in a stage
constexpr double kAtRoundings = 0x1p-40;                   // of the area: sums of many cells have errors that large
constexpr std::size_t kSharesOfARound = 64;                // one of so many is improved before the error is summed
constexpr std::size_t kMostPoints = std::size_t{1} << 20;  // of all pairs of parts: some 200 MB

}  // namespace

Refinement::Refinement(const ExactScene& scene, const SeenParts& seen, const PreparedPatch& from,
                       const PreparedPatch& to, const ViewFactorOptions& options, PairMemory& memory)
    : from_(from),
      to_(to),
      options_(options),
      pause_(pauses() ? kFirstPause : kNoPause),
      smaller_area_(counted_area(from, to)),
      times_(&from == &to && is_symmetric(to, options) ? 2.0 : 1.0),
      least_error_(0.5 * options.accuracy * smaller_area_ / times_ * kShareOfTrifle /
                   static_cast<double>(options.budget)),
      narrowest_(widened(0.5 * from.enclosed_area, 0.5 * magnitude(from.enclosed_area))) {
  look_at_pairs(scene, seen, memory);
  narrow();
}

void Refinement::look_at_pairs(const ExactScene& scene, const SeenParts& seen, PairMemory& memory) {
  PairChoice choice(scene, memory, is_symmetric(to_, options_));
  const std::vector<PairEnd> receivers = ends_of(scene.scene, from_);
  const auto occluders = [&](std::size_t r) { return std::span(from_.seen.lists(seen, from_.parts)[r].occluders); };
  if (to_.surrounds()) {
    const auto whole = std::make_shared<const ExactSource>(scene.scene, to_.selection);
    for (std::size_t r = 0; r < receivers.size(); ++r) {
      if (!add_pair(choice.of_open(occluders(r), receivers[r].part, whole))) return;
    }
    return;
  }
  const std::vector<PairEnd> sources = ends_of(scene.scene, to_);
  for (std::size_t r = 0; r < receivers.size(); ++r) {
    for (std::size_t s = times_ > 1.0 ? r + 1 : 0; s < sources.size(); ++s) {
      const bool may_see = from_.seen.sees(seen, from_.parts, r, to_.parts[s]) &&
                           to_.seen.sees(seen, to_.parts, s, from_.parts[r]) && !are_separated(seen, from_, r, to_, s);
      if (may_see && !add_pair(choice.choose(occluders(r), receivers[r], sources[s]))) return;
    }
  }
}

// False if there are too many corners to go on.
bool Refinement::add_pair(std::unique_ptr<Pair> pair) {
  if (pair == nullptr) return true;
  points_ += pair->point_count();
  if (points_ > kMostPoints) {
    give_up();
    return false;
  }
  pair->set_limits(limits());
  pairs_.push_back(std::move(pair));
  const std::size_t made = made_;
  const Pair::Budget left = budget_left();
  work_on(pairs_.size() - 1,
          [&](Pair& p) { return may_work() ? p.cells(kCoarse * smaller_area_, left) : p.without_cells(); });
  if (made_ == made) pairs_.back().reset();
  return true;
}

// Some pairs are left out, so the shares of the others tell nothing.
void Refinement::give_up() {
  waiting_.clear();
  settled_.clear();
  pairs_.clear();
  gave_up_ = true;
}

Pair::Budget Refinement::budget_left() const {
  return {.cost = options_.budget - std::min(cost_, options_.budget), .effort = pause_ - std::min(effort_, pause_)};
}

double Refinement::accuracy_of_stage() const { return std::ldexp(1.0, kFirstStage + kStep * static_cast<int>(stage_)); }

double Refinement::target_of_stage() const { return 0.5 * accuracy_of_stage() * smaller_area_ / times_; }

Pair::Limits Refinement::limits() const {
  const double target = target_of_stage();
  const double certified = options_.certify ? target * kShareOfCell / static_cast<double>(to_.parts.size()) : 0.0;
  return {.stage = stage_,
          .rounding = accuracy_of_stage() * kShareOfRounding,
          .negligible_area = target * kShareOfNegligible,
          .quadrature = target / from_.unit_area * kShareOfQuadrature,
          .certified = certified,
          .area = from_.unit_area};
}

void Refinement::refine(const std::function<bool(const kernel::Disc&)>& is_enough) {
  while (!is_enough(narrowest_) && !is_at_roundings() && (improve_some() || start_next_stage())) narrow();
}

bool Refinement::go_on() {
  if (effort_ < pause_ || cost_ >= options_.budget) return false;
  pause_ *= 2;
  if (!std::exchange(has_paused_, true)) order_waiting();
  return true;
}

bool Refinement::has_next_stage() const { return accuracy_of_stage() >= kLeastAccuracy; }

bool Refinement::start_next_stage() {
  if (gave_up_ || is_spent_ || !has_next_stage() || !may_work()) return false;
  ++stage_;
  for (const std::unique_ptr<Pair>& pair : pairs_) {
    if (pair != nullptr) pair->set_limits(limits());
  }
  const auto waits = std::partition(settled_.begin(), settled_.end(),
                                    [](const Waiting& w) { return w.share.next == Share::Next::kNothing; });
  std::move(waits, settled_.end(), std::back_inserter(waiting_));
  settled_.erase(waits, settled_.end());
  order_waiting();
  return true;
}

bool Refinement::suits_points(const Waiting& w) const {
  return w.share.bound > 0.0 && pairs_[w.pair]->whole() != nullptr;
}

double Refinement::urgency(const Waiting& w) const {
  return has_paused_ && suits_points(w) ? kOfPoints * w.share.error : w.share.error;
}

void Refinement::order_waiting() {
  for (Waiting& w : waiting_) w.urgency = urgency(w);
  std::ranges::make_heap(waiting_, is_less_urgent);
}

// A part of the shares, so that sums over all of them cost little. False if nothing can or need be done in this stage.
bool Refinement::improve_some() {
  const std::size_t most = 1 + (waiting_.size() + settled_.size()) / kSharesOfARound;
  const auto is_stuck = [&] { return has_next_stage() && errors_.stuck > kMostStuck * errors_.waiting; };
  std::size_t improved = 0;
  while (improved < most && !waiting_.empty() && may_work() && errors_.sum() > target_of_stage() && !is_stuck()) {
    is_spent_ = waiting_.front().urgency < least_urgency();
    if (is_spent_) break;
    improve_worst();
    ++improved;
  }
  return improved > 0;
}

void Refinement::improve_worst() {
  std::ranges::pop_heap(waiting_, is_less_urgent);
  Waiting worst = std::move(waiting_.back());
  waiting_.pop_back();
  errors_.waiting -= worst.share.error;
  const Pair::Budget left = budget_left();
  work_on(worst.pair, [&](Pair& pair) { return pair.improve(std::move(worst.share), left); });
}

// Adds the shares that the call makes of the pair.
template <class Call>
void Refinement::work_on(std::size_t id, const Call& call) {
  Pair& pair = *pairs_[id];
  const std::size_t cells = pair.cells_made(), cost = pair.cost();
  const std::uint64_t effort = pair.effort();
  for (Share& share : call(pair)) add(std::move(share), id);
  cells_ += pair.cells_made() - cells;
  cost_ += pair.cost() - cost;
  effort_ += pair.effort() - effort;
}

// No more than 4 * budget shares are ever made. So if the most urgent one has less than the least error, then all that
// wait have little of the error that is allowed, and so have those that are stuck (improve_some): improving them would
// not make the integral accurate. Only their numbers are needed.
void Refinement::add(Share share, std::size_t pair) {
  ++made_;
  const bool waits = share.next == Share::Next::kCut || share.next == Share::Next::kMorePoints;
  (waits ? errors_.waiting : settled_errors(share)) += share.error;
  std::vector<Waiting>& shares = waits ? waiting_ : settled_;
  shares.push_back({std::move(share), pair, made_});
  Waiting& added = shares.back();
  added.urgency = urgency(added);
  if (added.urgency < least_urgency()) pauses() ? added.share.keep_for_points() : added.share.keep_numbers_only();
  if (waits) std::ranges::push_heap(waiting_, is_less_urgent);
}

// Sums up anew, without the roundings of updates.
void Refinement::narrow() {
  kernel::Disc sum;
  errors_ = {};
  for (const std::vector<Waiting>* shares : {&waiting_, &settled_}) {
    for (const Waiting& w : *shares) {
      sum = sum + times_ * kernel::Disc{w.share.integral, w.share.error};
      (shares == &waiting_ ? errors_.waiting : settled_errors(w.share)) += w.share.error;
    }
  }
  if (!(sum.radius < narrowest_.radius)) return;
  narrowest_ = sum;
  cost_of_narrowest_ = cost_;
}

// Half of the work was of no use, and what is left is as small as roundings are.
bool Refinement::is_at_roundings() const {
  return narrowest_.radius <= kAtRoundings * from_.unit_area && cost_ >= 2 * cost_of_narrowest_;
}

double Refinement::estimate() const {
  if (gave_up_) return narrowest_.centre;
  double sum = 0.0;
  for (const std::vector<Waiting>* shares : {&waiting_, &settled_}) {
    for (const Waiting& w : *shares) {
      sum += w.urgency < least_urgency() ? w.share.integral : pairs_[w.pair]->estimate(w.share);
    }
  }
  return times_ * sum;
}

Refinement::Apart Refinement::apart() const {
  if (gave_up_) return {.unknown = {}, .known = narrowest_};
  std::vector<const Waiting*> unknown;
  Apart result{.unknown = {}, .known = {}, .times = times_};
  for (const std::vector<Waiting>* shares : {&waiting_, &settled_}) {
    for (const Waiting& w : *shares) {
      const bool matters = w.share.error > kShareOfUnknown * errors_.sum();
      if (matters && suits_points(w) && area(w.share.cell) > 0.0) {
        unknown.push_back(&w);
      } else {
        result.known = result.known + times_ * kernel::Disc{w.share.integral, w.share.error};
      }
    }
  }
  std::ranges::sort(unknown, {}, &Waiting::number);
  for (const Waiting* w : unknown) result.unknown.push_back({pairs_[w->pair].get(), &w->share});
  return result;
}

std::size_t Refinement::event_cells() const {
  const auto is_event = [](const Waiting& w) { return w.share.is_event; };
  return static_cast<std::size_t>(std::ranges::count_if(waiting_, is_event) +
                                  std::ranges::count_if(settled_, is_event));
}

}  // namespace exactff::view_factors
