// The refinement of an integral over one patch of what it sees of another.
//
// A share is a cell with its part of the integral and an error (pair.h).
//
// 1. Cut one part of each pair of parts that may see each other into cells, and integrate over each.
// 2. Keep the shares that can be improved in a heap, that of the largest error on top.
// 3. Replace the top one by its two halves, until the sum of all errors is small enough, the budget is used up, or no
//    share is worth a cut.
//
// At any time the shares make up the whole integral, and their errors its error.
#pragma once

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
  // Step 1. `target`: of the integral's error, in squares of the unit of Point::at. Keeps a reference to the memory.
  Refinement(const ExactScene& scene, const SeenParts& seen, const PreparedPatch& from, const PreparedPatch& to,
             const ViewFactorOptions& options, double target, PairMemory& memory);

  // Steps 2 and 3: then error() <= target, if it can be.
  void refine(double target);

  [[nodiscard]] double error() const;
  // The integral with its error, and the roundings of the sums. `area`: of the patch `from`.
  [[nodiscard]] kernel::Disc enclosure(const kernel::Disc& area) const;
  [[nodiscard]] bool is_zero() const { return waiting_.empty() && settled_.empty() && !gave_up_; }
  [[nodiscard]] std::size_t cells() const { return cells_; }
  [[nodiscard]] std::size_t event_cells() const;

 private:
  struct Waiting {
    Share share;
    std::size_t pair;
    std::size_t number;  // ties: the older one first
  };
  [[nodiscard]] static bool is_less_urgent(const Waiting& a, const Waiting& b) {
    return a.share.error != b.share.error ? a.share.error < b.share.error : a.number > b.number;
  }

  void add_pair(std::unique_ptr<Pair> pair);
  void give_up();
  void cut_worst();
  template <class Call>
  void work_on(std::size_t id, const Call& call);
  void add(Share share, std::size_t pair);

  double area_;
  std::size_t budget_;
  double least_error_;
  std::vector<std::unique_ptr<Pair>> pairs_;  // null: sees nothing
  std::vector<Waiting> waiting_;              // a heap
  std::vector<Share> settled_;                // not worth a cut
  double running_error_ = 0.0;
  std::size_t made_ = 0;  // shares
  std::size_t cells_ = 0, cost_ = 0;
  bool gave_up_ = false;  // nothing but 0 <= F <= 1 is known
};

}  // namespace exactff::view_factors
