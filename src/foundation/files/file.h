// Files in which every byte is accounted for. A failed write throws InputError with a message that says what is still
// safe.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <iosfwd>
#include <string>
#include <string_view>

#include "exactff/error.h"
#include "files/unfinished.h"

namespace exactff::files {

// What the message of a failed write says: what is kept, and what to do.
struct FailureAdvice {
  std::string why = "nothing was written";
  std::string suggestion = "name a file in a folder that exists, is writable and has free space";
};

// An open file; the destructor closes it. Offsets are bytes from the start of the file.
class File {
 public:
  enum class Mode { kRead, kReadWrite };  // kReadWrite creates a missing file

  // Throws InputError if the file cannot be opened or is not a regular file. Messages name `called`, if given, instead
  // of the path.
  File(std::filesystem::path path, Mode mode, FailureAdvice advice = {}, std::filesystem::path called = {});
  File(File&& other) noexcept;
  ~File();
  File& operator=(File&&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::uint64_t size() const;

  // Reads at most `count` bytes; fewer only at the end of the file.
  [[nodiscard]] std::string read(std::uint64_t offset, std::size_t count) const;
  void write(std::uint64_t offset, std::string_view bytes);
  void truncate(std::uint64_t size);
  void sync();

  enum class Lock { kTaken, kInUse, kUnsupported };  // kUnsupported: some network file systems have no locks
  // The lock lasts until the file is closed, even if the process dies.
  [[nodiscard]] Lock lock();
  // Whether the path still leads to this file: it may have been renamed, removed or replaced.
  [[nodiscard]] bool is_in_place() const;
  // Removes the file from its folder, if it is in place.
  void remove();

  [[noreturn]] void fail(int error) const;
  void set_failure_advice(FailureAdvice advice) { advice_ = std::move(advice); }

 private:
  void require_regular();

  std::filesystem::path path_;
  std::filesystem::path called_;
  FailureAdvice advice_;
  int descriptor_ = -1;
};

// Opens and locks a file that is read and written. While another process holds the lock, tries again until `patience`
// is over, then throws `in_use` with the name of the file.
[[nodiscard]] File open_locked(const std::filesystem::path& path, const FailureAdvice& advice, Problem in_use,
                               std::chrono::seconds patience = {}, const std::filesystem::path& called = {});

// Makes renames and removals in the folder of `path` durable, as far as the file system can.
void sync_folder_of(const std::filesystem::path& path);

// A file that appears complete or not at all. It is written from start to end.
class WholeFile {
 public:
  enum class WhenBusy { kRefuse, kWait };  // kWait: some seconds

  // Writes to `path`.whole first, and overwrites what a killed process left there. Throws InputError if another process
  // is writing the file. Follows a symbolic link.
  WholeFile(const std::filesystem::path& path, FailureAdvice advice = {}, WhenBusy when_busy = WhenBusy::kRefuse);
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  void append(std::string_view bytes);
  // Flushes what there is to disk. After that, commit() does not fail for lack of space.
  void sync();
  // Flushes the file to disk, then renames it to its final name.
  void commit();

 private:
  void flush();

  Unfinished unfinished_;
  std::filesystem::path target_;
  File file_;
  std::string buffer_;
  std::uint64_t written_ = 0;
};

// False also where the system does not say.
[[nodiscard]] bool is_there(const std::filesystem::path& path);

// The path at which to write a file that replaces `path`: the target of a symbolic link, otherwise the path itself.
[[nodiscard]] std::filesystem::path destination(const std::filesystem::path& path);

// Calls put(stream); throws InputError unless every byte was written. For a file in a folder that appears as a whole.
void write_file(const std::filesystem::path& file, const std::function<void(std::ostream&)>& put);

}  // namespace exactff::files
