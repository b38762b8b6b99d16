// Files and folders that appear complete or not at all, in which every byte is accounted for, and that do not replace
// what is read. A failed write throws InputError with a message that says what is still safe.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <iosfwd>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "exactff/error.h"

namespace exactff::files {

// --- files ---

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

// Whether this process is writing something that must appear all at once. An object lives from before the first byte is
// written until the result is in its place or removed.
class Unfinished {
 public:
  Unfinished() { ++count_; }
  ~Unfinished() { --count_; }
  Unfinished(const Unfinished&) = delete;
  Unfinished& operator=(const Unfinished&) = delete;

  // If true, the process should not be ended now. Safe in signal handlers.
  [[nodiscard]] static bool any() { return count_ > 0; }

 private:
  inline static std::atomic<int> count_ = 0;
  static_assert(std::atomic<int>::is_always_lock_free);
};

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

// --- folders ---

// The lock file in every WorkFolder, locked by the process that owns it. In a folder that was not created here, it
// means that a process was killed just after it had put the folder in place.
inline constexpr const char* kLockFile = ".lock";

// A hidden folder in which a process prepares files that must appear all at once: a sibling of the target called
// .NAME.partial-PID-N. A lock on a file in it lasts as long as the process: process numbers are reused, and on a shared
// disk the number may be of another machine. What killed processes left for the same target is removed first; if the
// file system has no locks, it stays.
class WorkFolder {
 public:
  // `target` must be absolute, and its parent folder must exist. Throws filesystem_error or InputError.
  explicit WorkFolder(const std::filesystem::path& target);
  // Removes the folder, or what was put in its place by the exchange.
  ~WorkFolder();
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  // Renames it to the target and removes a folder that was there. The former content is never lost, even if the process
  // is killed.
  void put_in_place();

 private:
  [[nodiscard]] bool take(const std::filesystem::path& folder);

  std::filesystem::path target_;
  std::filesystem::path path_;
  std::optional<File> lock_;
};

// The folders on the way to a path. The constructor creates those that are missing, and the destructor removes what it
// created, as far as it is empty.
class MadeFolders {
 public:
  explicit MadeFolders(const std::filesystem::path& path);
  ~MadeFolders();
  MadeFolders(const MadeFolders&) = delete;
  MadeFolders& operator=(const MadeFolders&) = delete;

  [[nodiscard]] std::error_code error() const { return error_; }  // set if they cannot be created

 private:
  std::vector<std::filesystem::path> made_;  // innermost first
  std::error_code error_;
};

// --- no output replaces what is read, or another output ---

// What is read or written, and what it is called in messages: "SCENE", "--npz", "the journal of -o". Perhaps nothing.
struct NamedFile {
  std::string called;
  std::filesystem::path file;
};

// All throw an InputError that names both files. Links, symbolic and hard, and other spellings of a name are followed.
// Pipes and devices may have any number of uses.

void require_not_read(const NamedFile& output, std::span<const NamedFile> read);
void require_not_read(const std::filesystem::path& output, std::span<const std::filesystem::path> read);
void require_apart(std::span<const NamedFile> outputs);
// Of a folder that is replaced as a whole.
void require_none_inside(const NamedFile& folder, std::span<const NamedFile> read, std::span<const NamedFile> written);

}  // namespace exactff::files
