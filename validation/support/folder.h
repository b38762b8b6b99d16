// What is in a folder, and files with a given text.
#pragma once

#include <filesystem>
#include <fstream>
#include <set>
#include <string>

namespace exactff::validation {

[[nodiscard]] inline std::set<std::string> names_in(const std::filesystem::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) names.insert(entry.path().filename().string());
  return names;
}

// Replaces a file that exists.
inline void write_text(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

}  // namespace exactff::validation
