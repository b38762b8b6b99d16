#include "files/work_folder.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <string>
#include <string_view>

#include "exactff/error.h"

namespace exactff::files {

namespace {

namespace fs = std::filesystem;

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

}  // namespace exactff::files
