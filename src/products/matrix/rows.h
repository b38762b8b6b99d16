// The jobs of a matrix as rows: each gives one or two entries, that is, lines of the table.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "exactff/matrix.h"
#include "jobs/rows.h"
#include "matrix/entry_jobs.h"

namespace exactff::matrix {

class Rows : public jobs::Rows {
 public:
  // Throws what compute throws, and InputError if there is nothing to compute.
  explicit Rows(Request request);

  [[nodiscard]] const Request& request() const { return request_; }
  [[nodiscard]] std::string name(std::uint64_t row) const override { return entries_.name(row); }
  [[nodiscard]] std::vector<std::uint64_t> lines_of(std::uint64_t row) const override;
  [[nodiscard]] std::uint64_t line_count() const override { return request_.from.size() * entries_.width(); }
  [[nodiscard]] std::unique_ptr<Computer> computer() const override;

 private:
  Request request_;
  EntryJobs entries_;
};

}  // namespace exactff::matrix
