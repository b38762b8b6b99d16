#include "files/file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>
#include <thread>
#include <utility>

#include "text/text_lines.h"

namespace exactff::files {

namespace fs = std::filesystem;

File::File(fs::path path, Mode mode, FailureAdvice advice, fs::path called)
    : path_(std::move(path)), called_(called.empty() ? path_ : std::move(called)), advice_(std::move(advice)) {
  const int flags = mode == Mode::kRead ? O_RDONLY : O_RDWR | O_CREAT;
  descriptor_ = ::open(path_.c_str(), flags | O_CLOEXEC, 0666);
  if (descriptor_ >= 0) {
    require_regular();
    return;
  }
  if (mode == Mode::kReadWrite) fail(errno);
  throw InputError({.file = path_.string(),
                    .what = std::string("cannot be read: ") + std::strerror(errno),
                    .suggestion = "check the name and the file's permissions"});
}

// A pipe has no offsets, and a device may never end.
void File::require_regular() {
  struct stat status {};
  if (::fstat(descriptor_, &status) != 0 || S_ISREG(status.st_mode)) return;
  ::close(std::exchange(descriptor_, -1));
  throw InputError({.file = path_.string(),
                    .what = "is not a regular file",
                    .why = "exactff reads and writes it at arbitrary positions",
                    .suggestion = "name a file on a disk"});
}

File::File(File&& other) noexcept
    : path_(std::move(other.path_)),
      called_(std::move(other.called_)),
      advice_(std::move(other.advice_)),
      descriptor_(std::exchange(other.descriptor_, -1)) {}

File::~File() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void File::fail(int error) const {
  throw InputError({.file = called_.string(),
                    .what = std::string("cannot be written: ") + std::strerror(error),
                    .why = advice_.why,
                    .suggestion = advice_.suggestion});
}

std::uint64_t File::size() const {
  struct stat status {};
  return ::fstat(descriptor_, &status) == 0 ? static_cast<std::uint64_t>(status.st_size) : 0;
}

std::string File::read(std::uint64_t offset, std::size_t count) const {
  std::string bytes(count, '\0');
  std::size_t have = 0;
  while (have < count) {
    const ssize_t got = ::pread(descriptor_, bytes.data() + have, count - have, static_cast<off_t>(offset + have));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) {
      throw InputError({.file = path_.string(),
                        .what = std::string("cannot be read: ") + std::strerror(errno),
                        .why = "the disk or the network may be failing",
                        .suggestion = "check them and try again"});
    }
    if (got == 0) break;
    have += static_cast<std::size_t>(got);
  }
  bytes.resize(have);
  return bytes;
}

void File::write(std::uint64_t offset, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t put = ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (put < 0 && errno == EINTR) continue;
    if (put < 0) fail(errno);
    bytes.remove_prefix(static_cast<std::size_t>(put));
    offset += static_cast<std::uint64_t>(put);
  }
}

void File::truncate(std::uint64_t size) {
  if (::ftruncate(descriptor_, static_cast<off_t>(size)) != 0) fail(errno);
}

void File::sync() {
  // EINVAL: the file cannot be synced at all, for example a special file.
  if (::fdatasync(descriptor_) != 0 && errno != EINVAL) fail(errno);
}

File::Lock File::lock() {
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return Lock::kTaken;
  return errno == EWOULDBLOCK ? Lock::kInUse : Lock::kUnsupported;
}

bool File::is_in_place() const {
  struct stat here {
  }, there{};
  return ::fstat(descriptor_, &here) == 0 && ::stat(path_.c_str(), &there) == 0 && here.st_ino == there.st_ino &&
         here.st_dev == there.st_dev;
}

void File::remove() {
  std::error_code ignored;
  if (is_in_place()) fs::remove(path_, ignored);
}

// The process that held the lock may meanwhile have renamed or removed the file: it is then the result of that process,
// or gone, so the file is opened again.
File open_locked(const fs::path& path, const FailureAdvice& advice, Problem in_use, std::chrono::seconds patience,
                 const fs::path& called) {
  constexpr auto kPause = std::chrono::milliseconds(5);
  const auto start = std::chrono::steady_clock::now();
  for (;;) {
    File file(path, File::Mode::kReadWrite, advice, called);
    const bool locked = file.lock() != File::Lock::kInUse;
    if (locked && file.is_in_place()) return file;
    if (locked) continue;
    if (std::chrono::steady_clock::now() - start >= patience) {
      in_use.file = (called.empty() ? path : called).string();
      throw InputError(std::move(in_use));
    }
    std::this_thread::sleep_for(kPause);
  }
}

void sync_folder_of(const fs::path& path) {
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

fs::path destination(const fs::path& path) {
  std::error_code error;
  const fs::path resolved = fs::canonical(path, error);
  if (!error) return resolved;
  const fs::path leads_to = fs::read_symlink(path, error);  // a dangling link
  return error ? path : path.parent_path() / leads_to;
}

void write_file(const fs::path& file, const std::function<void(std::ostream&)>& put) {
  std::ofstream out(file, std::ios::binary);
  put(out);
  out.close();
  if (out) return;
  throw InputError(Problem{file.string(), 0, "cannot be written",
                           "the disk may be full or read-only; no incomplete file was left",
                           "free some space, or name a folder on another disk"});
}

namespace {

fs::path with_suffix(fs::path path, const char* suffix) { return path += suffix; }

constexpr std::size_t kBufferBytes = 1 << 20;
constexpr auto kPatience = std::chrono::seconds(10);
const Problem kBeingWritten{.what = "another process is writing the file",
                            .why = "two processes would damage the file",
                            .suggestion = "wait for the other process, or name another file"};

}  // namespace

WholeFile::WholeFile(const fs::path& path, FailureAdvice advice, WhenBusy when_busy)
    : target_(destination(path)),
      file_(open_locked(with_suffix(target_, ".whole"), advice, kBeingWritten,
                        when_busy == WhenBusy::kWait ? kPatience : std::chrono::seconds(0), path)) {
  file_.truncate(0);
}

WholeFile::~WholeFile() { file_.remove(); }

void WholeFile::append(std::string_view bytes) {
  buffer_ += bytes;
  if (buffer_.size() >= kBufferBytes) flush();
}

void WholeFile::flush() {
  file_.write(written_, buffer_);
  written_ += buffer_.size();
  buffer_.clear();
}

void WholeFile::sync() {
  flush();
  file_.sync();
}

void WholeFile::commit() {
  sync();
  std::error_code error;
  fs::rename(file_.path(), target_, error);
  if (error) file_.fail(error.value());
  sync_folder_of(target_);
}

bool is_there(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(path, ignored);
}

}  // namespace exactff::files
