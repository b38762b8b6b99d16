// The rows of a file, which are computed one by one in any order.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "exactff/jobs.h"

namespace exactff::jobs {

// Consecutive rows of one chunk, numbered from 0.
struct Range {
  std::uint64_t first = 0;
  std::uint32_t rows = 0;

  [[nodiscard]] std::uint64_t end() const { return first + rows; }
  friend bool operator==(const Range&, const Range&) = default;
};

// What is computed, for messages and for the lines of a head.
struct RowKind {
  std::string_view command;  // "truth": of exactff
  std::string_view file;     // "a truth file"
  std::string_view row;      // "row"
  std::string_view rows;     // "rows"
};

// How many rows there are, and how they are distributed.
struct Plan {
  RowKind kind;
  std::uint64_t count = 0;
  std::uint32_t chunk = 1;  // rows
  Shard shard;
  int threads = 1;

  [[nodiscard]] std::uint64_t chunks() const { return (count + chunk - 1) / chunk; }
  [[nodiscard]] std::uint64_t shard_chunks() const { return (chunks() + shard.count - shard.number) / shard.count; }
  // The number of rows that belong to the shard.
  [[nodiscard]] std::uint64_t shard_rows() const;
  // The rows of a chunk, counted among those of the shard.
  [[nodiscard]] Range chunk_of_shard(std::uint64_t index) const;
};

// Throws InputError if the shard does not exist.
void require_shard(const Shard& shard);

// Lines of a head: "# rows: 128", and "# shard: 2/4 in chunks of 64 rows, for exactff merge", empty for one shard.
[[nodiscard]] std::string rows_line(const Plan& plan);
[[nodiscard]] std::string shard_line(const Plan& plan);

// Threads may share it.
class Rows {
 public:
  virtual ~Rows() = default;
  Rows(const Rows&) = delete;
  Rows& operator=(const Rows&) = delete;

  [[nodiscard]] const Plan& plan() const { return plan_; }
  [[nodiscard]] std::uint64_t count() const { return plan_.count; }
  [[nodiscard]] std::uint64_t shard_rows() const { return plan_.shard_rows(); }
  // Whether these rows lie in one chunk that belongs to the shard.
  [[nodiscard]] bool may_be_one_block(Range range) const;

  // The comment lines and the column names: of the file, or of the shard's file. With everything that rows depend on,
  // rows_line and shard_line among it.
  [[nodiscard]] virtual std::string head() const = 0;
  // "receiver 'a' on floor:1, source 'light'", for messages.
  [[nodiscard]] virtual std::string name(std::uint64_t row) const = 0;
  // Whether this text may be that of these rows.
  [[nodiscard]] virtual bool may_be_text_of(Range range, std::string_view text) const = 0;

  // For one thread: keeps memory from row to row.
  class Computer {
   public:
    virtual ~Computer() = default;
    // Computes a row and appends its text: one line or several.
    virtual void append(std::uint64_t row, std::string& text) = 0;
  };
  [[nodiscard]] virtual std::unique_ptr<Computer> computer() const = 0;

 protected:
  Rows() = default;

  Plan plan_;
};

}  // namespace exactff::jobs
