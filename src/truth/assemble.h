// The last step: puts the finished blocks in order and writes the file.
#pragma once

#include <filesystem>
#include <functional>

#include "truth/journal.h"
#include "truth/rows.h"

namespace exactff::truth {

// Writes the truth file, or the shard, then removes the journal. Requires every row to be in the journal.
void assemble(const Rows& rows, RowJournal& journal, const std::filesystem::path& file, const Hooks& hooks,
              Summary& summary);

// Reports progress in rows. Throws Cancelled if the hooks request it.
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
