// A hidden folder in which a process prepares files that must appear all at once.
#pragma once

#include <filesystem>
#include <optional>
#include <system_error>
#include <vector>

#include "files/file.h"

namespace exactff::files {

// The lock file in every such folder, locked by the process that owns it. In a folder that was not created here, it
// means that a process was killed just after it had put the folder in place.
inline constexpr const char* kLockFile = ".lock";

// A sibling of the target called .NAME.partial-PID-N. A lock on a file in it lasts as long as the process: process
// numbers are reused, and on a shared disk the number may be of another machine. What killed processes left for the
// same target is removed first; if the file system has no locks, it stays.
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

}  // namespace exactff::files
