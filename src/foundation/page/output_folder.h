// A folder that appears complete or not at all.
#pragma once

#include <filesystem>
#include <optional>

#include "files/file.h"

namespace exactff::page {

inline constexpr const char* kReportFile = "report.html";
inline constexpr const char* kScoreFile = "scoreboard.json";  // beside index.html and junit.xml

// Throws InputError unless `folder` can be written and replaced: it does not exist, is empty, or contains only files of
// an earlier result.
void check_output_folder(const std::filesystem::path& folder);

// Removes a folder that contains only files of a result. Anything else, and what cannot be removed, stays.
void remove_result(const std::filesystem::path& folder);

// A hidden sibling of the target, in which files are prepared. Unless commit() was called, the destructor removes it
// together with the folders that were created on the way to it. The constructor first removes what killed processes
// left there.
class StagedFolder {
 public:
  // Throws InputError if check_output_folder does, or if nothing can be written.
  explicit StagedFolder(const std::filesystem::path& target);
  StagedFolder(const StagedFolder&) = delete;
  StagedFolder& operator=(const StagedFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return work_->path(); }

  // Puts the prepared folder in the place of the target. Removes an earlier study there.
  void commit();

 private:
  std::optional<files::Unfinished> unfinished_;
  std::filesystem::path target_;
  std::optional<files::MadeFolders> made_;
  std::optional<files::WorkFolder> work_;
};

}  // namespace exactff::page
