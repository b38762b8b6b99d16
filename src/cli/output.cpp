#include "cli/output.h"

#include <fstream>
#include <system_error>

#include "scene/number_text.h"
#include "study/text.h"

namespace exactff::cli {

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

[[noreturn]] void cannot_write(const std::filesystem::path& path, const std::string& reason) {
  throw InputError({.file = path.string(),
                    .what = "cannot write the file: " + reason,
                    .why = "nothing was written",
                    .suggestion = "name a file in a folder that exists, is writable and has room"});
}

}  // namespace

void write_whole_file(const std::filesystem::path& path, const std::string& text) {
  std::filesystem::path partial = path;
  partial += ".partial";
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) cannot_write(path, "it is a folder");
  std::ofstream file(partial, std::ios::binary);
  file << text;
  file.close();
  if (file) std::filesystem::rename(partial, path, error);
  if (file && !error) return;
  const std::string reason = error ? error.message() : "opening or writing failed";
  std::filesystem::remove(partial, error);
  cannot_write(path, reason);
}

void check_output(std::ostream& out) {
  out.flush();
  if (out) return;
  throw InputError({.what = "the result could not be written to standard output",
                    .why = "what was printed is incomplete",
                    .suggestion = "make room on the disk, or send the output elsewhere"});
}

}  // namespace exactff::cli
