#include "files/apart.h"

#include <algorithm>
#include <system_error>

#include "files/file.h"
#include "text/phrases.h"
#include "text/refuse.h"
#include "text/text_lines.h"

namespace exactff::files {

namespace fs = std::filesystem;

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
