// Files of which every byte is accounted for: what cannot be written is an InputError that says what is still safe.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace exactff::study {

// What to tell where writing fails: what is kept, and what to do.
struct Consolation {
  std::string why = "nothing was written";
  std::string suggestion = "name a file in a folder that exists, is writable and has room";
};

// An open file; closed by the destructor. Offsets are of bytes from the file's start.
class File {
 public:
  enum class Mode { kRead, kReadWrite };  // kReadWrite makes the file where there is none

  // Throws InputError where it cannot be opened, or is no regular file. Messages speak of `called`, where it is given,
  // instead of the path.
  File(std::filesystem::path path, Mode mode, Consolation consolation = {}, std::filesystem::path called = {});
  File(File&& other) noexcept;
  ~File();
  File& operator=(File&&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::uint64_t size() const;

  // At most `count` bytes, fewer only at the end of the file.
  [[nodiscard]] std::string read(std::uint64_t offset, std::size_t count) const;
  void write(std::uint64_t offset, std::string_view bytes);
  void truncate(std::uint64_t size);
  void sync();

  enum class Lock { kTaken, kInUse, kUnsupported };  // some network file systems have none
  // Until the file is closed, even if the process dies.
  [[nodiscard]] Lock lock();
  // Whether the path still leads to this file.
  [[nodiscard]] bool is_in_place() const;

  [[noreturn]] void fail(int error) const;
  void console(Consolation consolation) { consolation_ = std::move(consolation); }

 private:
  void require_regular();

  std::filesystem::path path_;
  std::filesystem::path called_;
  Consolation consolation_;
  int descriptor_ = -1;
};

// Makes renaming and removing in the folder of `path` last, as far as the file system can.
void sync_folder_of(const std::filesystem::path& path);

// A file that appears whole or not at all, written from start to end.
class WholeFile {
 public:
  enum class WhenBusy { kRefuse, kWait };  // kWait: some seconds

  // Written as `path`.whole; what a killed process left there is overwritten. Throws InputError where another process
  // is at it. A symbolic link is followed.
  WholeFile(const std::filesystem::path& path, Consolation consolation = {}, WhenBusy when_busy = WhenBusy::kRefuse);
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  void append(std::string_view bytes);
  // On the disk, then in its place.
  void commit();

  // Whether the process has such a file at hand: not a moment to end it. For signal handlers, too.
  [[nodiscard]] static bool any();

 private:
  void flush();

  // Before the file is made, and until it is renamed or removed.
  struct Counted {
    Counted();
    ~Counted();
  };

  Counted counted_;
  std::filesystem::path target_;
  File file_;
  std::string buffer_;
  std::uint64_t written_ = 0;
  bool committed_ = false;
};

}  // namespace exactff::study
