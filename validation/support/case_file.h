// Case files (format ffcase-1, see data/reference/README.md): a scene, a receiver and the expected value.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "exactff/receiver.h"
#include "generate/plain_scene.h"

namespace exactff::validation {

struct Expected {
  std::string decimals;  // of F, 30 significant digits; "0" if exact_zero
  bool exact_zero = false;
  double nearest = 0.0;
  std::vector<double> visible_fractions;  // one per source plane, each within 2 ulp
};

struct CaseFile {
  std::string name;
  generate::PlainScene scene;
  Expected expected;
};

// Throws std::runtime_error if the file is not a case file, or if its decimal and hexadecimal numbers differ.
[[nodiscard]] CaseFile read_case(const std::filesystem::path& path);

// The text of a case file.
[[nodiscard]] std::string to_json(const CaseFile& file, const std::string& description);

// Every .json file of a directory, sorted by name; none if there is no such directory.
[[nodiscard]] std::vector<std::filesystem::path> case_paths(const std::filesystem::path& directory);

// Converts `name` to a valid name for GoogleTest: letters, digits and underscores.
[[nodiscard]] std::string test_name(const std::string& name);

}  // namespace exactff::validation
