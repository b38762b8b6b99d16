// The jobs of a matrix as rows of a journal: each row is one or two lines of the CSV file, the entry's number before
// each.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "exactff/matrix.h"
#include "jobs/rows.h"
#include "matrix/entry_jobs.h"

namespace exactff::matrix {

inline constexpr jobs::RowKind kKind = {"matrix", "a matrix", "pair", "pairs"};

class Rows : public jobs::Rows {
 public:
  // Throws what compute throws, and InputError if there is nothing to compute.
  explicit Rows(Request request);

  [[nodiscard]] const Request& request() const { return request_; }
  // The head of the finished file.
  [[nodiscard]] std::string csv_head() const;

  [[nodiscard]] std::string head() const override;
  [[nodiscard]] std::string name(std::uint64_t row) const override { return entries_.name(row); }
  [[nodiscard]] bool may_be_text_of(jobs::Range range, std::string_view text) const override;
  [[nodiscard]] std::unique_ptr<Computer> computer() const override;

 private:
  [[nodiscard]] std::string comments() const;

  Request request_;
  EntryJobs entries_;
};

// Lines of entries in any order, put in order.
class EntryLines {
 public:
  // Returns false if a line does not begin with a number.
  [[nodiscard]] bool add(std::string_view text);
  // Without the numbers. Empty if entries are missing or occur twice.
  [[nodiscard]] std::string in_order();

 private:
  std::vector<std::pair<std::uint64_t, std::string>> lines_;
};

// The head of the finished file, from that of its shards; empty if it is not one.
[[nodiscard]] std::string head_without_jobs(const std::string& head);

}  // namespace exactff::matrix
