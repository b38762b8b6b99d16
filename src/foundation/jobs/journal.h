// The journal of an unfinished file of rows. Every finished block is appended, in any order, so that no finished row is
// lost or waits in memory for a slower one. The journal is a CSV file with comment lines between the blocks.
#pragma once

#include <filesystem>
#include <mutex>
#include <string>
#include <vector>

#include "exactff/jobs.h"
#include "files/file.h"
#include "jobs/blocks.h"
#include "jobs/rows.h"

namespace exactff::jobs {

class RowJournal {
 public:
  // Opens and locks the journal of `file` for rows under this head. Throws InputError if another process is using the
  // journal, if it holds rows of another request, or if it holds rows and `existing` allows neither to continue with
  // them nor to replace them.
  RowJournal(const std::filesystem::path& file, const Rows& rows, Existing existing, const RowHooks& hooks);
  // Removes a journal without rows, since it has no use.
  ~RowJournal();
  RowJournal(const RowJournal&) = delete;
  RowJournal& operator=(const RowJournal&) = delete;

  // From any thread. Appends the whole block or nothing of it. Throws InputError if the disk is full.
  void append(Range range, std::string_view lines);
  // Makes everything that was appended before durable, even if the machine crashes. Called by one thread while others
  // append.
  void sync();

  // In the order of their first rows. They do not overlap.
  [[nodiscard]] std::vector<Block> blocks() const;
  [[nodiscard]] std::string read(const Block& block) const { return read_lines(file_, block); }
  [[nodiscard]] const std::filesystem::path& path() const { return file_.path(); }

  // Removes the journal. Called when the file is complete.
  void remove() { file_.remove(); }

 private:
  void take_over(const Rows& rows, Existing existing, const RowHooks& hooks);
  void begin(const std::string& head);
  void keep_usable(std::vector<Block> found, const Rows& rows, const RowHooks& hooks);

  File file_;
  std::mutex mutex_;
  std::vector<Block> blocks_;
  std::uint64_t end_ = 0;
  std::uint64_t synced_ = 0;
};

// Reports progress in rows. Throws Cancelled if the hooks request it.
class Pace {
 public:
  Pace(std::string_view stage, std::uint64_t total, const RowHooks& hooks)
      : stage_(stage), total_(total), hooks_(hooks) {}
  void add(std::uint64_t rows);

 private:
  std::string_view stage_;
  std::uint64_t total_;
  const RowHooks& hooks_;
  std::uint64_t done_ = 0;
};

}  // namespace exactff::jobs
