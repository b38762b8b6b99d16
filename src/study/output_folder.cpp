#include "study/output_folder.h"

#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <system_error>

#include "exactff/study.h"
#include "study/tables.h"

namespace exactff::study {
namespace {

namespace fs = std::filesystem;

// Absolute, without a trailing separator, so that it has a parent and a name.
fs::path normalised(const fs::path& folder) {
  fs::path path = fs::absolute(folder).lexically_normal();
  return path.has_filename() ? path : path.parent_path();
}

[[noreturn]] void refuse(const fs::path& folder, std::string what, std::string why, std::string suggestion) {
  throw InputError(Problem{folder.string(), 0, std::move(what), std::move(why), std::move(suggestion)});
}

bool is_our_file(const fs::path& path) {
  const std::string name = path.filename().string();
  return name == kReportFile ||
         std::any_of(tables().begin(), tables().end(), [&](const Table& table) { return name == table.file; });
}

bool begins_like_ours(const fs::path& file) {
  std::ifstream in(file);
  std::string line;
  return std::getline(in, line) && line.starts_with("# exactff ");
}

void require_replaceable(const fs::path& folder) {
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    if (entry.is_regular_file() && is_our_file(entry.path())) continue;
    refuse(folder, "the folder holds '" + entry.path().filename().string() + "', which is not of our making",
           "the whole folder would be replaced", "name a new one");
  }
  if (error)
    refuse(folder, "the folder cannot be read: " + error.message(), "it would be replaced", "name another one");
  if (!fs::is_empty(folder) && !begins_like_ours(folder / "summary.csv")) {
    refuse(folder, "the folder holds files, but no summary.csv of an earlier comparison",
           "the whole folder would be replaced", "name a new one");
  }
}

// The folder will be made in the nearest ancestor that exists.
void require_writable_place(const fs::path& folder, const fs::path& target) {
  fs::path place = target.parent_path();
  while (place.has_relative_path() && !fs::exists(place)) place = place.parent_path();
  if (fs::is_directory(place) && ::access(place.c_str(), W_OK | X_OK) == 0) return;
  refuse(folder, "cannot be made: '" + place.string() + "' is not a folder that can be written to",
         "the results need a place", "name another folder");
}

fs::path sibling(const fs::path& folder, const std::string& suffix) {
  std::string name = ".";
  name += folder.filename().string() + '.' + suffix + '-' + std::to_string(::getpid());
  return folder.parent_path() / name;
}

}  // namespace

void check_output_folder(const fs::path& folder) {
  const fs::path target = normalised(folder);
  require_writable_place(folder, target);
  if (!fs::exists(fs::symlink_status(target))) return;
  if (!fs::is_directory(fs::symlink_status(target))) {
    refuse(folder, "is not a folder", "the results are several files", "name a new folder");
  }
  require_replaceable(target);
}

StagedFolder::StagedFolder(const fs::path& target) : target_(normalised(target)), staged_(sibling(target_, "partial")) {
  check_output_folder(target);
  std::error_code error;
  fs::remove_all(staged_, error);
  fs::create_directories(staged_, error);
  if (error) refuse(target, "cannot be made: " + error.message(), "the results need a place", "name another folder");
}

StagedFolder::~StagedFolder() {
  std::error_code ignored;
  if (!staged_.empty()) fs::remove_all(staged_, ignored);
}

void StagedFolder::commit() {
  check_output_folder(target_);
  const fs::path old = sibling(target_, "old");
  const bool replace = fs::exists(target_);
  if (replace) fs::rename(target_, old);
  std::error_code error;
  fs::rename(staged_, target_, error);
  if (error) {
    if (replace) fs::rename(old, target_);
    refuse(target_, "cannot be put in place: " + error.message(), "the results need a place", "name another folder");
  }
  staged_.clear();
  std::error_code ignored;
  if (replace) fs::remove_all(old, ignored);
}

}  // namespace exactff::study
