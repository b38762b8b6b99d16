#include "cli/output.h"

#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>
#include <system_error>

#include "cli/long_run.h"
#include "scene/number_text.h"
#include "scene/text_file.h"
#include "study/file.h"
#include "study/text.h"

namespace exactff::cli {

namespace fs = std::filesystem;

std::string percent(double share) { return study::rounded(100.0 * share, 4) + " %"; }

std::string pad(const std::string& text, std::size_t width) {
  return text + std::string(text.size() < width ? width - text.size() : 1, ' ');
}

double parse_finite(const std::string& text, const std::string& flag) {
  const ParsedNumber number = parse_number(text);
  if (number.fault == NumberFault::kNone) return number.value;
  throw InputError({.what = flag + ": " + describe(number.fault, text),
                    .why = "coordinates are finite decimal numbers",
                    .suggestion = "give three numbers, such as " + flag + " 0 0.5 -1e-3"});
}

FaceId select_face(const Scene& scene, const std::string& name) {
  const Selection selection = scene.select(name);
  if (selection.face) return *selection.face;
  const Patch& patch = scene.patch(selection.patch);
  if (patch.faces.size() == 1) return patch.faces.front();
  throw InputError(
      {.what = "--on " + name + ": the patch has " + std::to_string(patch.faces.size()) + " faces",
       .why = "a receiver lies on one face",
       .suggestion = "name one of them: " + name + ":1 to " + name + ":" + std::to_string(patch.faces.size())});
}

namespace {

[[noreturn]] void cannot_write(const fs::path& path, const std::string& reason) {
  throw InputError({.file = path.string(),
                    .what = "cannot be written: " + reason,
                    .why = "nothing was written",
                    .suggestion = "name a file in a folder that exists, is writable and has room"});
}

// A pipe or device cannot be replaced by a file, so it is written directly.
void write_through(const fs::path& path, const std::string& text) {
  errno = 0;
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) cannot_write(path, errno != 0 ? std::strerror(errno) : "opening or writing failed");
}

void replace_file(const fs::path& path, const std::string& text) {
  study::WholeFile file(path, {}, study::WholeFile::WhenBusy::kWait);
  file.append(text);
  file.commit();
}

}  // namespace

void write_whole_file(const fs::path& path, const std::string& text) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) cannot_write(path, "it is a folder");
  if (fs::is_other(path, ignored)) return write_through(path, text);
  {
    const InterruptWatch watch;  // signals wait for a moment, so that no partial file is left behind
    replace_file(path, text);
  }
  if (is_interrupted()) ::raise(interrupting_signal());
}

void check_output(std::ostream& out) {
  out.flush();
  if (out) return;
  throw InputError({.what = "the result could not be written to standard output",
                    .why = "what was printed is incomplete",
                    .suggestion = "make room on the disk, or send the output elsewhere"});
}

}  // namespace exactff::cli
