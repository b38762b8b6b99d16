// What a row of a truth file is, and the head above the rows.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "exactff/truth.h"

namespace exactff::truth {

// Consecutive rows, counted from 0, all of one chunk.
struct Range {
  std::uint64_t first = 0;
  std::uint32_t rows = 0;

  [[nodiscard]] std::uint64_t end() const { return first + rows; }
  friend bool operator==(const Range&, const Range&) = default;
};

// A request that was found sound, with what depends on its sources alone computed once. Safe to share between threads.
class Rows {
 public:
  // Throws InputError where there is nothing to compute, or no such shard.
  explicit Rows(Request request);

  [[nodiscard]] const Request& request() const { return request_; }
  [[nodiscard]] std::uint64_t count() const { return request_.receivers.size() * request_.sources.size(); }

  // How many of them belong to the shard.
  [[nodiscard]] std::uint64_t shard_rows() const;
  // Whether these rows lie in one chunk, and that belongs to the shard.
  [[nodiscard]] bool may_be_one_block(Range range) const;

  // The comment lines and the column names of the truth file; of the shard's file, if it is one.
  [[nodiscard]] std::string head() const;

  // What a thread keeps from one row to the next, for its memory alone.
  struct Results {
    FormFactor exact, unoccluded;
  };
  // Computes a row and appends its line.
  void append(std::uint64_t row, std::string& lines, Results& results) const;

  // "receiver 'a' on floor:1, source 'light'", for people.
  [[nodiscard]] std::string name(std::uint64_t row) const;

 private:
  [[nodiscard]] std::string id(std::size_t receiver) const;
  [[nodiscard]] const FormFactor& without_occluders(const Receiver& receiver, const ExactSource& source,
                                                    Results& results) const;

  Request request_;
  std::vector<ExactSource> sources_;
  std::vector<std::string> source_names_;
  std::vector<Rgb> radiosities_;  // by source
  std::string receivers_hash_;
};

// Rows counted by their status, which is the last field of each.
class Tally {
 public:
  // Text that may begin and end anywhere.
  void add(std::string_view text);
  // The same for whole rows; false unless they are so many.
  bool add_rows(std::string_view text, std::uint64_t expected);

  [[nodiscard]] std::uint64_t rows() const;
  // All was rows of a truth file, and whole ones.
  [[nodiscard]] bool whole() const { return sound_ && !row_open_; }
  [[nodiscard]] const std::array<std::uint64_t, 4>& by_status() const { return by_status_; }

 private:
  void end_row(std::string_view status);

  std::array<std::uint64_t, 4> by_status_{};
  std::string field_;  // what earlier text held of the last field
  bool quoted_ = false;
  bool row_open_ = false;
  bool sound_ = true;
};

}  // namespace exactff::truth
