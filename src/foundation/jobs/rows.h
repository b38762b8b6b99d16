// The rows of a table, which are computed one by one in any order.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "exactff/jobs.h"
#include "exactff/table.h"

namespace exactff::jobs {

// Consecutive rows of one chunk, numbered from 0.
struct Range {
  std::uint64_t first = 0;
  std::uint32_t rows = 0;

  [[nodiscard]] std::uint64_t end() const { return first + rows; }
  friend bool operator==(const Range&, const Range&) = default;
};

// What is computed, for messages and for heads.
struct RowKind {
  std::string command;  // "truth": of exactff, and the kind of the table
  std::string row = "row";
  std::string rows = "rows";
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

// Which lines above the rows: of the complete table, of the file of a shard, or of a journal.
enum class HeadOf { kTable, kShard, kJournal };

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

  // The head of the table and the names of its columns, as CSV. That of a shard and of a journal also has the number of
  // rows, the shard and, if the lines are numbered, their number as the first column.
  [[nodiscard]] std::string head(HeadOf of) const;
  // Of this shard, or of the table if there is one shard only.
  [[nodiscard]] std::string head() const { return head(plan_.shard.count > 1 ? HeadOf::kShard : HeadOf::kTable); }
  // "receiver 'a' on floor:1, source 'light'", for messages.
  [[nodiscard]] virtual std::string name(std::uint64_t row) const = 0;
  // Whether this text may be that of these rows.
  [[nodiscard]] bool may_be_text_of(Range range, std::string_view text) const;
  // The lines of the table that this row makes, if lines are numbered: a row then makes one line or several, and the
  // table is in another order than the rows. Otherwise a row is the line of its number.
  [[nodiscard]] virtual std::vector<std::uint64_t> lines_of(std::uint64_t row) const { return {row}; }
  [[nodiscard]] virtual std::uint64_t line_count() const { return count(); }  // of the table
  [[nodiscard]] bool are_numbered() const { return numbered_; }

  // For one thread: keeps memory from row to row.
  class Computer {
   public:
    virtual ~Computer() = default;
    // Computes a row and appends its text: one line, or several with their numbers before them.
    virtual void append(std::uint64_t row, std::string& text) = 0;
  };
  [[nodiscard]] virtual std::unique_ptr<Computer> computer() const = 0;

 protected:
  Rows() = default;

  Plan plan_;
  bool numbered_ = false;
  // Everything that the rows depend on.
  table::Head about_;
  std::vector<table::Column> columns_;
};

// A line with its number before it.
struct NumberedLine {
  std::uint64_t number = 0;
  std::string_view line;  // with its end
};
// Takes the first line off the text. Nothing if it has no number or no end.
[[nodiscard]] std::optional<NumberedLine> take_line(std::string_view& text);

// Numbered lines in any order, put in order.
class LinesInOrder {
 public:
  // Returns false if a line does not begin with a number.
  [[nodiscard]] bool add(std::string_view text);
  // Without the numbers. Empty if lines are missing or occur twice.
  [[nodiscard]] std::string take();

 private:
  std::vector<std::pair<std::uint64_t, std::string>> lines_;
};

// What the head of a shard or a journal says of the rows, besides the head of the table.
struct ShardHead {
  Plan plan;          // without threads
  std::string table;  // the lines above the rows of the table
  bool numbered = false;
  bool unfinished = false;  // of a journal
};
// Nothing unless Rows::head has written it.
[[nodiscard]] std::optional<ShardHead> parse_shard_head(std::string_view lines);

// Throws an InputError that says in what the head of `file` differs from the expected one. `whose`: "this request has".
void require_same_head(
    const std::filesystem::path& file, std::string_view head, std::string_view other,
    const std::string& whose = "this request has",
    const std::string& suggestion = "use the same flags as before, name another file, or start again with --force");

}  // namespace exactff::jobs
