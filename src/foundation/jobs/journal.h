// Journals: finished work in a file, so that an interrupted run can continue; and the blocks of such files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "exactff/jobs.h"
#include "files/file.h"
#include "jobs/rows.h"

namespace exactff::jobs {

// --- Blocks ---

// The format of finished work in a journal and in a shard.
//
// After the head of the file come the blocks. Each is one comment line
//   # WORD NAME, BYTES bytes, crc CRC32
// and then BYTES bytes. All blocks of a file have the same word; names differ. The CRC-32 (in 8 hexadecimal digits)
// covers the comment line up to the word crc, and the bytes.
//
// The blocks of a shard, and of a journal of rows, are "rows FIRST+COUNT": the lines of COUNT rows, of which FIRST is
// the number of the first. Such a file is CSV with comment lines. A journal holds its blocks in the order in which they
// were finished. A shard holds each chunk as one block, in order.

using files::File;
using files::WholeFile;

// The head of a file: its comment lines and the line of column names. Nothing if the file ends before that.
[[nodiscard]] std::optional<std::string> read_head(const File& file);

// Where a block is in a file.
struct Block {
  std::string name;
  std::uint64_t offset = 0;  // of the bytes after the comment line
  std::uint64_t bytes = 0;
};

// Requires a name of less than 400 bytes without a line end.
[[nodiscard]] std::string block_text(std::string_view word, std::string_view name, std::string_view bytes);

// The sound blocks of a file, in the order of the file. Damaged parts between them are skipped.
struct Blocks {
  std::vector<Block> list;
  std::uint64_t end = 0;      // of the last sound block; of the head if there is none
  std::uint64_t damaged = 0;  // bytes before `end` that belong to no sound block
};
[[nodiscard]] Blocks find_blocks(const File& file, std::uint64_t head_bytes, std::string_view word);

[[nodiscard]] std::string read_bytes(const File& file, const Block& block);

inline constexpr std::string_view kRowsWord = "rows";

[[nodiscard]] std::string name_of(Range range);
[[nodiscard]] Range range_of(const Block& block);  // without rows if the name is that of no range
[[nodiscard]] std::string block_text(Range range, std::string_view lines);

// --- Journals ---

// What the blocks of a journal belong to.
struct JournalForm {
  std::string head;  // with everything that the finished work depends on
  std::string word;  // of its blocks
};

// A file of finished pieces of work, each of which has a name: a head and blocks. All functions but those
// that open, close and sync it may be called from any thread.
class JournalFile {
 public:
  // Opens and locks the file. Damaged blocks count as not done. Throws InputError, and leaves the file as it is, if it
  // cannot be written, if another process uses it, or if exactff did not write it; unless `existing` says to replace
  // it, also if it is of another version or request; and for kRefuse if it holds any work. `note`: notes for the user.
  JournalFile(const std::filesystem::path& path, JournalForm form, Existing existing,
              const std::function<void(const std::string&)>& note);
  // Removes a journal without blocks, since it has no use.
  ~JournalFile();
  JournalFile(const JournalFile&) = delete;
  JournalFile& operator=(const JournalFile&) = delete;

  // Appends the whole block or nothing of it. A block of the same name replaces the one before. Throws InputError if
  // the disk is full.
  void add(const std::string& name, std::string_view bytes);
  [[nodiscard]] std::optional<std::string> find(const std::string& name) const;
  void forget(const std::string& name);  // until the file is opened again
  // Makes everything that was appended before durable, even if the machine crashes. Called by one thread while others
  // append.
  void sync();

  [[nodiscard]] std::size_t size() const;  // number of blocks
  [[nodiscard]] std::vector<Block> blocks() const;
  [[nodiscard]] std::string read(const Block& block) const { return read_bytes(file_, block); }
  [[nodiscard]] const std::filesystem::path& path() const { return file_.path(); }

  void remove() { file_.remove(); }  // when all work is done

 private:
  void take_over(Existing existing, const std::function<void(const std::string&)>& note);
  void require_same(std::string_view beginning, Existing existing) const;
  void begin();

  const JournalForm form_;
  File file_;
  mutable std::mutex mutex_;
  std::map<std::string, Block> blocks_;
  std::uint64_t end_ = 0;
  std::uint64_t synced_ = 0;
};

// The journal of an unfinished file of rows. Finished rows are appended in any order, so that none is lost or waits in
// memory for a slower one.
class RowJournal {
 public:
  // Opens the journal of `file` for rows under this head. Blocks that cannot hold rows of this request count as not
  // done.
  RowJournal(const std::filesystem::path& file, const Rows& rows, Existing existing, const RowHooks& hooks);

  void append(Range range, std::string_view lines) { file_.add(name_of(range), lines); }  // from any thread
  void sync() { file_.sync(); }

  // In the order of their first rows. They do not overlap.
  [[nodiscard]] std::vector<Block> blocks() const;
  [[nodiscard]] std::string read(const Block& block) const { return file_.read(block); }
  [[nodiscard]] const std::filesystem::path& path() const { return file_.path(); }
  void remove() { file_.remove(); }

 private:
  JournalFile file_;
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
