// A hidden folder in which a process prepares what is to appear whole.
#pragma once

#include <filesystem>
#include <optional>

#include "study/file.h"

namespace exactff::study {

// Held in every such folder by the process that it belongs to. Where it is found without the folder having been made
// here, a process was killed just after it had put the folder in place.
inline constexpr const char* kLockFile = ".lock";

// A sibling of the target called .NAME.partial-PID-N. A lock on a file in it lasts as long as the process: numbers of
// processes are given again, and on a shared disk may be another machine's. What killed processes left for the same
// target is removed first; where the file system has no locks, it stays.
class WorkFolder {
 public:
  // `target` is absolute; the folder that it is in exists. Throws filesystem_error or InputError.
  explicit WorkFolder(const std::filesystem::path& target);
  // Removes the folder, or what was put in its place.
  ~WorkFolder();
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  // Renames it to the target. A folder that was there is removed; it is lost at no time, even if the process is killed.
  void put_in_place();

 private:
  [[nodiscard]] bool take(const std::filesystem::path& folder);

  std::filesystem::path target_;
  std::filesystem::path path_;
  std::optional<File> lock_;
};

}  // namespace exactff::study
