// The journal of a truth file in the making: every finished block, appended whatever the order, so that nothing that
// was finished is lost or waits in memory for a slower row. It is a CSV of its own, with comment lines between the
// blocks.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "exactff/truth.h"
#include "study/file.h"
#include "truth/blocks.h"

namespace exactff::truth {

// Throws InputError where no truth file can be made of `file`: it is a folder or a device, or it is there already and
// only to be refused.
void require_free(const std::filesystem::path& file, Existing existing);

// Throws InputError that names the first line in which the head of `file` differs from another one.
void require_same_head(
    const std::filesystem::path& file, std::string_view head, std::string_view other,
    const std::string& whose = "now it would be",
    const std::string& suggestion = "ask for the same as then, name another file, or begin anew with --force");

class Journal {
 public:
  // Opens and locks the journal of `file` for rows under this head. Throws InputError where there are rows of another
  // request, where another process is at it, and, unless it may go on with them or replace them, where there are rows.
  Journal(const std::filesystem::path& file, const Rows& rows, Existing existing, const Hooks& hooks);
  // A journal without rows is of no use to anybody, and removed.
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  // From any thread. All or nothing of the block is in the journal; throws InputError where the disk is full.
  void append(Range range, std::string_view lines);
  // What was appended before survives the end of the machine, too. Called by one thread while others append.
  void sync();

  // By their first row; none overlap.
  [[nodiscard]] std::vector<Block> blocks() const;
  [[nodiscard]] std::string read(const Block& block) const { return read_lines(file_, block); }
  [[nodiscard]] const std::filesystem::path& path() const { return file_.path(); }

  // The truth file is complete: the journal is not needed any more.
  void remove();

 private:
  void take_over(const Rows& rows, Existing existing, const Hooks& hooks);
  void begin(const std::string& head);
  void keep_usable(std::vector<Block> found, const Rows& rows, const Hooks& hooks);

  File file_;
  std::mutex mutex_;
  std::vector<Block> blocks_;
  std::uint64_t end_ = 0;
  std::uint64_t synced_ = 0;
  bool removed_ = false;
};

}  // namespace exactff::truth
