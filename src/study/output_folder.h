// A folder that appears whole or not at all.
#pragma once

#include <filesystem>

namespace exactff::study {

inline constexpr const char* kReportFile = "report.html";

// A hidden sibling of the target in which files are prepared; removed again unless commit() was called.
class StagedFolder {
 public:
  // Throws InputError where check_output_folder does, or where nothing can be written.
  explicit StagedFolder(const std::filesystem::path& target);
  ~StagedFolder();
  StagedFolder(const StagedFolder&) = delete;
  StagedFolder& operator=(const StagedFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return staged_; }

  // Puts the prepared folder in the target's place; an earlier study there is removed.
  void commit();

 private:
  std::filesystem::path target_;
  std::filesystem::path staged_;
};

}  // namespace exactff::study
