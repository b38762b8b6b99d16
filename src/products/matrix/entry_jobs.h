// A matrix, job by job. Entries are numbered row by row, as in the CSV file: to patches, then (back), (open), (buried).
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "exactff/matrix.h"
#include "matrix/back_factors.h"
#include "matrix/columns.h"
#include "matrix/open_factors.h"
#include "view_factors/pairs.h"

namespace exactff::matrix {

class EntryJobs {
 public:
  // Throws what compute throws. Keeps a reference to the scene.
  EntryJobs(const Scene& scene, std::span<const Selection> from, std::span<const Selection> to, const Options& options);

  [[nodiscard]] std::size_t count() const;
  [[nodiscard]] std::size_t width() const { return width_; }     // entries of a row
  [[nodiscard]] bool has_buried() const { return has_buried_; }  // a part of some row is
  // The entries that a job gives.
  [[nodiscard]] std::vector<std::size_t> entries_of(std::size_t job) const;
  // In the order of entries_of. From any thread.
  void compute(std::size_t job, const std::function<void(std::size_t entry, const ViewFactor& factor)>& take) const;
  // "from 'floor' to 'light'", for messages.
  [[nodiscard]] std::string name(std::size_t job) const;
  // Sets all but the factor.
  void describe(std::size_t number, Entry& entry) const;

 private:
  enum class Column { kOfPatch, kOfBacks, kOfSky, kOfBuried };
  [[nodiscard]] Column kind_of(std::size_t column) const;
  [[nodiscard]] std::string name_of_column(std::size_t column) const;
  [[nodiscard]] ViewFactor computed(Column column, std::size_t row) const;

  const Scene& scene_;
  const std::vector<Selection> from_, to_;
  view_factors::Pairs pairs_;
  bool has_buried_;
  std::size_t width_;
  std::optional<BackFactors> to_backs_;
  std::optional<OpenFactors> to_sky_;
};

}  // namespace exactff::matrix
