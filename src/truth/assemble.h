// The last step: finished blocks, put in order, become the file.
#pragma once

#include <filesystem>
#include <functional>

#include "truth/journal.h"
#include "truth/rows.h"

namespace exactff::truth {

// Writes the truth file, or the shard, of which every row is in the journal, and removes the journal.
void assemble(const Rows& rows, Journal& journal, const std::filesystem::path& file, const Hooks& hooks,
              Summary& summary);

// Tells progress in rows, and throws study::Cancelled where the hooks say so.
class Pace {
 public:
  Pace(std::string_view stage, std::uint64_t total, const Hooks& hooks) : stage_(stage), total_(total), hooks_(hooks) {}
  void add(std::uint64_t rows);

 private:
  std::string_view stage_;
  std::uint64_t total_;
  const Hooks& hooks_;
  std::uint64_t done_ = 0;
};

}  // namespace exactff::truth
