#include "files/file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

#include "exactff/error.h"
#include "text/phrases.h"
#include "text/refuse.h"
#include "text/text_lines.h"

namespace exactff::files {

namespace fs = std::filesystem;

// --- files ---

File::File(fs::path path, Mode mode, FailureAdvice advice, fs::path called)
    : path_(std::move(path)), called_(called.empty() ? path_ : std::move(called)), advice_(std::move(advice)) {
  const int flags = mode == Mode::kRead ? O_RDONLY : O_RDWR | O_CREAT;
  descriptor_ = ::open(path_.c_str(), flags | O_CLOEXEC, 0666);
  if (descriptor_ >= 0) {
    require_regular();
    return;
  }
  if (mode == Mode::kReadWrite) fail(errno);
  text::refuse(path_, std::string("cannot be read: ") + std::strerror(errno), {},
               "check the name and the file's permissions");
}

// A pipe has no offsets, and a device may never end.
void File::require_regular() {
  struct stat status {};
  if (::fstat(descriptor_, &status) != 0 || S_ISREG(status.st_mode)) return;
  ::close(std::exchange(descriptor_, -1));
  text::refuse(path_, "is not a regular file", "exactff reads and writes it at arbitrary positions",
               "name a file on a disk");
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
  text::refuse(called_, std::string("cannot be written: ") + std::strerror(error), advice_.why, advice_.suggestion);
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
      text::refuse(path_, std::string("cannot be read: ") + std::strerror(errno),
                   "the disk or the network may be failing", "check them and try again");
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
  text::refuse(file, "cannot be written", "the disk may be full or read-only; no incomplete file was left",
               "free some space, or name a folder on another disk");
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

// --- folders ---

namespace {

constexpr std::string_view kPartial = "partial";
constexpr std::string_view kOld = "old";  // the former content of the target, where two folders cannot be exchanged

std::string prefix(const fs::path& target, std::string_view kind) {
  return '.' + target.filename().string() + '.' + std::string(kind) + '-';
}

fs::path sibling(const fs::path& target, std::string_view kind, int attempt) {
  return target.parent_path() / (prefix(target, kind) + std::to_string(::getpid()) + '-' + std::to_string(attempt));
}

// Whether anything has this name, including a broken symbolic link.
bool is_taken(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(fs::symlink_status(path, ignored));
}

bool is_own_folder(const fs::path& path) {
  struct stat status {};
  return ::lstat(path.c_str(), &status) == 0 && S_ISDIR(status.st_mode) && status.st_uid == ::geteuid();
}

// Folders of that kind beside the target, of any process.
std::vector<fs::path> siblings(const fs::path& target, std::string_view kind) {
  std::vector<fs::path> found;
  const std::string beginning = prefix(target, kind);
  std::error_code error;
  for (fs::directory_iterator entry(target.parent_path(), error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    const bool ours = name.starts_with(beginning) && name.size() > beginning.size() &&
                      name.find_first_not_of("0123456789-", beginning.size()) == std::string::npos;
    if (ours && is_own_folder(entry->path())) found.push_back(entry->path());
  }
  return found;
}

// Removes only files, since we put nothing else there. If the folder holds anything else, both stay.
void remove_files_and_folder(const fs::path& folder) {
  std::error_code error, ignored;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    if (entry->is_regular_file(ignored)) fs::remove(entry->path(), ignored);
  }
  fs::remove(folder, ignored);
}

// The lock is held while the folder is removed: a process that creates one of the same name then sees that its file is
// not in place.
void remove_if_abandoned(const fs::path& folder) {
  try {
    File lock(folder / kLockFile, File::Mode::kReadWrite);
    if (lock.lock() == File::Lock::kTaken && lock.is_in_place()) remove_files_and_folder(folder);
  } catch (const InputError&) {  // gone meanwhile, or not ours to write to
  }
}

void clear_abandoned(const fs::path& target) {
  for (const fs::path& folder : siblings(target, kPartial)) remove_if_abandoned(folder);
  for (const fs::path& folder : siblings(target, kOld)) {
    std::error_code ignored;
    if (is_taken(target)) {
      remove_files_and_folder(folder);
    } else {
      fs::rename(folder, target, ignored);
    }
  }
}

bool exchange(const fs::path& one, const fs::path& other) {
#ifdef RENAME_EXCHANGE
  return ::renameat2(AT_FDCWD, one.c_str(), AT_FDCWD, other.c_str(), RENAME_EXCHANGE) == 0;
#else
  return false;
#endif
}

// For file systems without an exchange. If the process is killed in between, the former content remains, and the next
// run restores it.
void replace_in_two_steps(const fs::path& folder, const fs::path& target) {
  const fs::path old = sibling(target, kOld, 0);
  fs::rename(target, old);
  std::error_code error, ignored;
  fs::rename(folder, target, error);
  if (error) {
    fs::rename(old, target, ignored);
    throw fs::filesystem_error("cannot be renamed", target, error);
  }
  fs::remove_all(old, ignored);
}

}  // namespace

WorkFolder::WorkFolder(const fs::path& target) : target_(target) {
  constexpr int kMostAttempts = 100;
  clear_abandoned(target);
  for (int attempt = 0; attempt < kMostAttempts; ++attempt) {
    if (take(sibling(target, kPartial, attempt))) return;
  }
  throw fs::filesystem_error("no free name", target, std::make_error_code(std::errc::file_exists));
}

// False if the name belongs to another process, or if another process cleared the folder before it was locked.
bool WorkFolder::take(const fs::path& folder) {
  if (!fs::create_directory(folder)) return false;
  try {
    lock_.emplace(folder / kLockFile, File::Mode::kReadWrite);
  } catch (const InputError&) {
    std::error_code ignored;
    if (fs::remove(folder, ignored)) throw;
    return false;
  }
  if (lock_->lock() == File::Lock::kInUse || !lock_->is_in_place()) return false;
  path_ = folder;
  return true;
}

WorkFolder::~WorkFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

void WorkFolder::put_in_place() {
  if (!is_taken(target_)) {
    fs::rename(path_, target_);
  } else if (!exchange(path_, target_)) {
    replace_in_two_steps(path_, target_);
  }
  std::error_code ignored;
  fs::remove(target_ / kLockFile, ignored);
}

MadeFolders::MadeFolders(const fs::path& path) {
  const fs::path last = fs::absolute(path).parent_path();
  std::error_code ignored;
  for (fs::path folder = last; folder.has_relative_path() && !fs::exists(folder, ignored);) {
    made_.push_back(folder);
    folder = folder.parent_path();
  }
  fs::create_directories(last, error_);
}

MadeFolders::~MadeFolders() {
  std::error_code ignored;
  for (const fs::path& folder : made_) fs::remove(folder, ignored);
}

// --- no output replaces what is read, or another output ---

namespace {

// The place itself, also of a file that does not exist yet.
fs::path place_of(const fs::path& path) {
  std::error_code error;
  fs::path place = fs::weakly_canonical(fs::absolute(destination(path), error), error);
  if (error) return path.lexically_normal();
  return place.has_filename() ? place : place.parent_path();
}

bool is_stream(const fs::path& path) {
  std::error_code ignored;
  return fs::is_other(path, ignored);
}

// Whether both names lead to one file, or to one place where there is no file yet.
bool is_same_file(const fs::path& a, const fs::path& b) {
  std::error_code ignored;
  return place_of(a) == place_of(b) || fs::equivalent(a, b, ignored);
}

bool lies_in(const fs::path& file, const fs::path& folder) {
  const fs::path place = place_of(file), whole = place_of(folder);
  const auto [end, ignored] = std::mismatch(whole.begin(), whole.end(), place.begin(), place.end());
  return end == whole.end();
}

std::string in_parentheses(const std::string& called) { return called.empty() ? "" : " (" + called + ')'; }

// "is read (SCENE)" or, if it is reached by another name, "is the same file as 's.obj', which is read (SCENE),".
std::string words_of(const NamedFile& output, const NamedFile& read) {
  const std::string called = in_parentheses(read.called);
  if (output.file == read.file) return "is read" + called;
  return "is the same file as " + text::in_quotes(read.file.string()) + ", which is read" + called + ',';
}

}  // namespace

void require_not_read(const NamedFile& output, std::span<const NamedFile> read) {
  for (const NamedFile& one : read) {
    if (!is_there(one.file) || is_stream(one.file) || !is_same_file(output.file, one.file)) continue;
    text::refuse(output.file, words_of(output, one) + " and would be replaced" + in_parentheses(output.called),
                 "its contents would be lost", "name another file for the result");
  }
}

void require_not_read(const fs::path& output, std::span<const fs::path> read) {
  for (const fs::path& one : read) {
    const NamedFile unnamed{"", one};
    require_not_read(NamedFile{"", output}, std::span(&unnamed, 1));
  }
}

void require_apart(std::span<const NamedFile> outputs) {
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    for (const NamedFile& before : outputs.first(i)) {
      if (is_stream(outputs[i].file) || !is_same_file(before.file, outputs[i].file)) continue;
      text::refuse(outputs[i].file, "is given for two outputs (" + before.called + " and " + outputs[i].called + ')',
                   "one would replace the other", "name another file");
    }
  }
}

void require_none_inside(const NamedFile& folder, std::span<const NamedFile> read, std::span<const NamedFile> written) {
  for (const NamedFile& one : read) {
    if (!is_there(one.file) || !lies_in(one.file, folder.file)) continue;
    text::refuse(one.file, "is read (" + one.called + ") and lies in the folder of the result (" + folder.called + ')',
                 "the folder appears as a whole and replaces the one before", "name another folder");
  }
  for (const NamedFile& one : written) {
    if (!lies_in(one.file, folder.file)) continue;
    text::refuse(one.file, "lies in the folder of the result (" + one.called + ')',
                 "the folder appears as a whole and replaces the one before", "name a file in another folder");
  }
}

}  // namespace exactff::files
