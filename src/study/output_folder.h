// A folder that appears whole or not at all.
#pragma once

#include <filesystem>
#include <optional>

#include "study/work_folder.h"

namespace exactff::study {

inline constexpr const char* kReportFile = "report.html";

// A hidden sibling of the target in which files are prepared; removed again, with the folders made on the way to it,
// unless commit() was called. What killed processes left there is removed first.
class StagedFolder {
 public:
  // Throws InputError where check_output_folder does, or where nothing can be written.
  explicit StagedFolder(const std::filesystem::path& target);
  ~StagedFolder();
  StagedFolder(const StagedFolder&) = delete;
  StagedFolder& operator=(const StagedFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return work_->path(); }

  // Whether there is one anywhere in the program; safe to ask in a signal handler.
  [[nodiscard]] static bool any();

  // Puts the prepared folder in the target's place; an earlier study there is removed.
  void commit();

 private:
  void remove_made();

  std::filesystem::path target_;
  std::filesystem::path outermost_made_;  // the target or the highest folder above it that did not exist before
  std::optional<WorkFolder> work_;
};

}  // namespace exactff::study
