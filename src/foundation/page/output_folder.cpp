#include "page/output_folder.h"

#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <system_error>

#include "files/file.h"
#include "text/refuse.h"

namespace exactff::page {
namespace {

namespace fs = std::filesystem;
using text::refuse;

// The absolute path without a trailing separator, so that it has a parent and a name.
fs::path normalised(const fs::path& folder) {
  if (folder.empty()) return {};
  fs::path path = fs::absolute(folder).lexically_normal();
  return path.has_filename() ? path : path.parent_path();
}

// A table or a scoreboard. The first lines say which program wrote it.
bool says_it_is_ours(const fs::path& file) {
  std::ifstream in(file);
  std::string line;
  if (file.filename() == kScoreFile) {
    return std::getline(in, line) && std::getline(in, line) && line.starts_with("  \"program\": \"exactff ");
  }
  return file.extension() == ".csv" && std::getline(in, line) &&
         (line.starts_with("# exactff ") || line.starts_with("# {\"exactff\""));
}

// Pages, a lock, and what goes with pages.
bool may_be_ours(const fs::path& path) {
  const fs::path name = path.filename();
  return name == kReportFile || name == files::kLockFile || name == "index.html" || name == "junit.xml";
}

void require_replaceable(const fs::path& folder) {
  std::error_code error;
  bool empty = true, any_table = false;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    empty = false;
    std::error_code ignored;
    const bool ours = entry->is_regular_file(ignored) && says_it_is_ours(entry->path());
    any_table = any_table || ours;
    if (ours || (entry->is_regular_file(ignored) && may_be_ours(entry->path()))) continue;
    refuse(folder, "the folder holds '" + entry->path().filename().string() + "', which exactff did not write",
           "the whole folder would be replaced", "name a new folder");
  }
  if (error)
    refuse(folder, "the folder cannot be read: " + error.message(), "its content would be replaced",
           "name another folder");
  if (!empty && !any_table) {
    refuse(folder, "the folder holds a report page, but no table that exactff wrote",
           "the whole folder would be replaced", "name a new folder");
  }
}

// The folder will be created in the nearest ancestor that exists.
void require_writable_place(const fs::path& folder, const fs::path& target) {
  fs::path place = target.parent_path();
  while (place.has_relative_path() && !files::is_there(place)) place = place.parent_path();
  std::error_code ignored;
  if (fs::is_directory(place, ignored) && ::access(place.c_str(), W_OK | X_OK) == 0) return;
  refuse(folder, "cannot be made: '" + place.string() + "' is not a folder that can be written to",
         "the results need a place", "name another folder");
}

// A shell whose current folder is replaced would be left in a deleted folder.
void require_elsewhere(const fs::path& folder, const fs::path& target) {
  std::error_code error;
  const fs::path here = fs::current_path(error);
  const auto [end, ignored] = std::mismatch(target.begin(), target.end(), here.begin(), here.end());
  if (error || end != target.end()) return;
  refuse(folder, "is the current folder or contains it", "the whole folder would be replaced",
         "name a folder inside it");
}

void require_free_or_ours(const fs::path& folder, const fs::path& target) {
  if (target.empty()) refuse(folder, "the name of the output folder is empty", "the results need a place", "name one");
  require_writable_place(folder, target);
  std::error_code ignored;
  const fs::file_status status = fs::symlink_status(target, ignored);
  if (!fs::exists(status)) return;
  if (fs::is_symlink(status)) {
    refuse(folder, "is a symbolic link", "the link itself would be replaced, not its target",
           "name the folder itself, or a new one");
  }
  if (!fs::is_directory(status)) {
    refuse(folder, "is not a folder", "the results are several files in one folder", "name a new folder");
  }
  require_elsewhere(folder, target);
  require_replaceable(target);
}

}  // namespace

void check_output_folder(const fs::path& folder) { const StagedFolder attempt(folder); }

void remove_result(const fs::path& folder) {
  std::error_code ignored;
  if (!fs::is_directory(fs::symlink_status(folder, ignored))) return;
  try {
    require_replaceable(folder);
  } catch (const InputError&) {
    return;
  }
  fs::remove_all(folder, ignored);
}

StagedFolder::StagedFolder(const fs::path& target) : target_(normalised(target)) {
  require_free_or_ours(target, target_);
  unfinished_.emplace();
  const auto cannot_be_made = [&](const std::error_code& error) {
    refuse(target, "cannot be made: " + error.message(), "the results need a place", "name another folder");
  };
  made_.emplace(target_);
  if (made_->error()) cannot_be_made(made_->error());
  try {
    work_.emplace(target_);
  } catch (const fs::filesystem_error& error) {
    cannot_be_made(error.code());
  }
}

void StagedFolder::commit() {
  require_free_or_ours(target_, target_);
  try {
    work_->put_in_place();
  } catch (const fs::filesystem_error& error) {
    refuse(target_, "cannot be put in place: " + error.code().message(), "the results need a place",
           "name another folder");
  }
  work_.reset();
  unfinished_.reset();
}

}  // namespace exactff::page
