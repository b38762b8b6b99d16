// Arbitrary bytes as a study file. The result is either an InputError with a message, or lines with everything that the
// reader promises; writing these lines out and reading them again gives the same result.
#include <cstddef>
#include <cstdint>
#include <string>

#include "cli/process.h"
#include "flags/comparison.h"
#include "fuzz/complaints.h"
#include "support/program.h"

namespace exactff::validation {
namespace {

// Inside double quotes a word ends at the next double quote; for single quotes likewise.
bool can_be_quoted(const std::string& word) {
  return word.find('"') == std::string::npos && word.find_first_of("\n\r") == std::string::npos;
}

void check_words(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) {
    if (!can_be_quoted(word)) return;
    line += (line.empty() ? "\"" : " \"") + word + '"';
  }
  if (flags::split_words(line, "line", 1) != words) fail("words that are read in another way when they are quoted");
}

void check(const flags::StudyFile& study) {
  if (study.scenes.empty()) fail("a study of nothing is accepted");
  std::size_t before = 0;
  for (const flags::StudyLine& line : study.scenes) {
    if (line.words.empty() || line.number <= before) fail("a line without words, or out of order");
    before = line.number;
    check_words(line.words);
  }
}

}  // namespace
}  // namespace exactff::validation

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace exactff::validation;
  static const TemporaryDirectory directory;
  const std::string text(reinterpret_cast<const char*>(data), size);
  unless_refused([&] { check(exactff::flags::parse_study_file(directory.write("run.study", text))); });
  return 0;
}
