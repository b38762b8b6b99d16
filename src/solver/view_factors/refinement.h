// The refinement of an integral over one patch of what it sees of another.
//
// A share is a cell with its part of the integral and an error (pair.h).
//
// 1. Cut one part of each pair of parts that may see each other into a few cells, and integrate over each. In a
//    patch that is to see itself, each pair is there once and counts twice: A_i F_ij = A_j F_ji for parts as well.
// 2. Keep the shares that can be improved in a heap, that of the largest error on top. Once points may be cheaper,
//    those that points can tell more of count less.
// 3. Improve the top one, by a better rule or by its two halves, until the sum of all errors is small enough, the
//    budget is used up, or no share can be improved.
//
// At any time the shares make up the whole integral, and their errors its error.
//
// What is done next depends on the scene and the two patches alone, never on the accuracy that is wanted: this only
// decides when it is enough. Limits that must be small if the accuracy is small belong to stages, which follow one
// another. Shares that can never matter for the accuracy lose what they could be improved by, to save memory; if one
// of them is next, the work ends. So a smaller accuracy goes on where a larger one stopped, and since the narrowest
// interval so far is the result, it never yields a wider one.
//
// Where points may be cheaper, the refinement pauses, also within step 1: whenever it has done twice as much
// (pairs.cpp).
#pragma once

#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "exactff/view_factors.h"
#include "kernel/disc.h"
#include "view_factors/pair.h"
#include "view_factors/prepared_patch.h"

namespace exactff::view_factors {

class Refinement {
 public:
  // Step 1, up to a pause. Keeps references to the patches and the memory.
  Refinement(const ExactScene& scene, const SeenParts& seen, const PreparedPatch& from, const PreparedPatch& to,
             const ViewFactorOptions& options, PairMemory& memory);

  // Steps 2 and 3, up to a pause. Asks now and then whether the integral is known well enough.
  void refine(const std::function<bool(const kernel::Disc& integral)>& is_enough);
  // The next pause is at twice the effort. False if the budget is used up, or no share can be improved.
  [[nodiscard]] bool go_on();

  // The narrowest that has been found, in squares of the unit of Point::at, with the roundings of sums.
  [[nodiscard]] const kernel::Disc& enclosure() const { return narrowest_; }
  // Of the integral; in the enclosure but for roundings.
  [[nodiscard]] double estimate() const;
  // The shares apart: those that have a bound at every point (Share::bound), so that points can tell more, and the
  // integral of all others, as the enclosure. Neighbours follow one another, more often than not.
  struct Unknown {
    const Pair* pair;
    const Share* share;
  };
  struct Apart {
    std::vector<Unknown> unknown;
    kernel::Disc known;
    double times = 1.0;  // that each unknown share counts in the integral
  };
  [[nodiscard]] Apart apart() const;
  [[nodiscard]] bool is_zero() const { return waiting_.empty() && settled_.empty() && !gave_up_; }
  [[nodiscard]] std::size_t cells() const { return cells_; }
  [[nodiscard]] std::uint64_t effort() const { return effort_; }  // as Pair::effort
  [[nodiscard]] std::size_t event_cells() const;
  // What ended it, if the integral is not known well enough.
  [[nodiscard]] Limit limit() const {
    if (gave_up_) return Limit::kCrowd;
    return cost_ >= options_.budget && !is_at_roundings() ? Limit::kBudget : Limit::kRounding;
  }

 private:
  struct Waiting {
    Share share;
    std::size_t pair;
    std::size_t number;  // ties: the older one first
    double urgency = 0.0;
  };
  [[nodiscard]] static bool is_less_urgent(const Waiting& a, const Waiting& b) {
    return a.urgency != b.urgency ? a.urgency < b.urgency : a.number > b.number;
  }

  // Sums over all shares, each once.
  struct Errors {
    double waiting = 0.0;  // of shares in the heap
    double stuck = 0.0;    // of those that a later stage may improve
    double lasting = 0.0;  // of the others
    [[nodiscard]] double sum() const { return waiting + stuck + lasting; }
  };

  void look_at_pairs(const ExactScene& scene, const SeenParts& seen, PairMemory& memory);
  [[nodiscard]] bool add_pair(std::unique_ptr<Pair> pair);
  void give_up();
  [[nodiscard]] bool pauses() const { return options_.sample_crowds && !options_.certify; }
  [[nodiscard]] Pair::Budget budget_left() const;
  [[nodiscard]] bool may_work() const { return cost_ < options_.budget && effort_ < pause_; }
  [[nodiscard]] double accuracy_of_stage() const;
  [[nodiscard]] double target_of_stage() const;
  [[nodiscard]] Pair::Limits limits() const;
  [[nodiscard]] bool has_next_stage() const;
  [[nodiscard]] bool start_next_stage();
  [[nodiscard]] bool improve_some();
  void improve_worst();
  void narrow();
  [[nodiscard]] bool is_at_roundings() const;
  template <class Call>
  void work_on(std::size_t id, const Call& call);
  void add(Share share, std::size_t pair);
  [[nodiscard]] double& settled_errors(const Share& settled) {
    return settled.next == Share::Next::kNextStage ? errors_.stuck : errors_.lasting;
  }
  [[nodiscard]] bool suits_points(const Waiting& w) const;
  [[nodiscard]] double urgency(const Waiting& w) const;
  // Shares that are less urgent are never improved: all of them together matter little. Urgencies only fall.
  [[nodiscard]] double least_urgency() const { return (pauses() ? kOfPoints : 1.0) * least_error_; }
  void order_waiting();

  static constexpr double kOfPoints = 0.125;  // of the error of a share that points can tell more of

  const PreparedPatch& from_;
  const PreparedPatch& to_;
  ViewFactorOptions options_;
  std::uint64_t pause_;                       // the effort at the next one
  double smaller_area_;                       // of the two patches (counted_area)
  double times_;                              // that each pair of parts counts
  double least_error_;                        // shares of less need not be improved
  std::vector<std::unique_ptr<Pair>> pairs_;  // null: sees nothing
  std::vector<Waiting> waiting_;              // a heap
  std::vector<Waiting> settled_;              // cannot be improved in this stage
  std::size_t points_ = 0;                    // of all pairs of parts
  std::size_t stage_ = 0;
  Errors errors_;
  std::size_t made_ = 0;  // shares
  std::size_t cells_ = 0, cost_ = 0;
  std::uint64_t effort_ = 0;
  bool has_paused_ = false;
  bool gave_up_ = false;   // nothing but 0 <= F <= 1 is known
  bool is_spent_ = false;  // what may be improved is too little to matter
  kernel::Disc narrowest_;
  std::size_t cost_of_narrowest_ = 0;  // when it was found
};

}  // namespace exactff::view_factors
