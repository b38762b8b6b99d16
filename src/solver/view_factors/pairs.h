// The entries of a matrix of view factors, pair by pair: each pair is an independent job.
//
// An entry depends on the scene, its two patches and the options alone, not on what else is computed, nor on the order.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "exactff/view_factors.h"
#include "kernel/disc.h"
#include "view_factors/prepared_patch.h"

namespace exactff::view_factors {

class Pairs {
 public:
  // Throws what view_factor throws. Keeps a reference to the scene. `kinds`, of each column: by default, all are
  // patches of the scene.
  Pairs(const Scene& scene, std::span<const Selection> from, std::span<const Selection> to,
        const ViewFactorOptions& options, std::span<const Columns> kinds = {});
  ~Pairs();
  Pairs(const Pairs&) = delete;
  Pairs& operator=(const Pairs&) = delete;

  [[nodiscard]] std::size_t count() const { return entries_.size(); }
  // The entries that a pair gives, numbered row by row, in ascending order: equal ones, and transposes.
  [[nodiscard]] const std::vector<std::size_t>& entries_of(std::size_t pair) const { return entries_[pair]; }
  // That gives the entry.
  [[nodiscard]] std::size_t pair_of(std::size_t entry) const { return pair_of_[entry]; }
  [[nodiscard]] double area_from(std::size_t row) const;
  [[nodiscard]] double area_to(std::size_t column) const;
  // The share of the area of a row's patch that is not buried: exactly 1 if nothing is, exactly 0 if all is.
  [[nodiscard]] kernel::Disc exposed_share(std::size_t row) const;
  // Whether closed surfaces stand around all that the row's patch sees (seen_parts.h), if that can be proved.
  [[nodiscard]] bool is_enclosed(std::size_t row) const;
  // At most this is open to the row's patch, as is proved by surfaces that are almost closed.
  [[nodiscard]] double open_at_most(std::size_t row) const;
  // Whether all that the row's patch sees lies within this one of the scene's closed surfaces, by edges that are cut at
  // T-junctions, or beyond its holes, if that can be proved.
  [[nodiscard]] bool is_within(std::size_t row, std::size_t surface) const;
  // Whether a point of the row's patch may see some of the column's: false proves that the entry is 0.
  [[nodiscard]] bool may_see(std::size_t row, std::size_t column) const;
  // About what the row's patch would see of the column's if nothing were hidden, or more; at most 1.
  [[nodiscard]] double unhidden(std::size_t row, std::size_t column) const;
  // In the order of entries_of. From any thread. `finer`: the accuracy is divided by this.
  void compute(std::size_t pair, const std::function<void(std::size_t entry, const ViewFactor& factor)>& take,
               double finer = 1.0) const;

 private:
  struct Patches;
  // What is computed for an entry: F of these, or, if they are turned, its transpose.
  struct Ends {
    const PreparedPatch *from, *to;
    bool turned;
  };
  [[nodiscard]] Ends ends_of(std::size_t entry) const;

  const ViewFactorOptions options_;
  std::unique_ptr<const Patches> patches_;
  std::vector<std::vector<std::size_t>> entries_;  // by pair
  std::vector<std::size_t> pair_of_;               // by entry
};

// --- View factor ---

// One view factor between two patches that are prepared.

// Whether A_i F_ij = A_j F_ji holds for the factors of this column, and may be used.
[[nodiscard]] bool is_symmetric(const PreparedPatch& column, const ViewFactorOptions& options);

// F_ji, from f = F_ij. Requires A_i F_ij = A_j F_ji.
[[nodiscard]] ViewFactor transpose(const ViewFactor& f, const PreparedPatch& from, const PreparedPatch& to);

}  // namespace exactff::view_factors
