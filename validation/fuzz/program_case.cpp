#include "fuzz/program_case.h"

#include <array>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "support/program.h"
#include "text/escape.h"

namespace exactff::validation {

namespace fs = std::filesystem;

namespace {

constexpr std::array<const char*, kDisturbanceCount> kNames = {"none",          "twice",     "signal",
                                                               "little-memory", "full-disk", "full-output"};

// Printable ASCII stays unchanged; every other byte becomes \xNN.
std::string escaped(const std::string& word) {
  std::string text;
  for (const char c : word) {
    char hexadecimal[8];
    std::snprintf(hexadecimal, sizeof hexadecimal, "\\x%02x", static_cast<unsigned>(static_cast<unsigned char>(c)));
    text += c < ' ' || c > '~' || c == '\\' ? hexadecimal : std::string(1, c);
  }
  return text;
}

std::string unescaped(const std::string& text) {
  std::string word;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '\\' || i + 3 >= text.size()) {
      word += text[i];
    } else {
      word += static_cast<char>(std::stoi(text.substr(i + 2, 2), nullptr, 16));
      i += 3;
    }
  }
  return word;
}

Disturbance disturbance_named(const std::string& name) {
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if (name == kNames[i]) return static_cast<Disturbance>(i);
  }
  throw std::runtime_error("no disturbance is called " + name);
}

}  // namespace

void keep_case(const ProgramCase& one, const fs::path& folder) {
  fs::create_directories(folder / "in");
  for (const auto& [path, text] : one.files) std::ofstream(folder / path, std::ios::binary) << text;
  std::ofstream out(folder / "case");
  out << disturbance_words(one) << '\n';
  for (const Words& words : one.commands) {
    out << "exactff\n";
    for (const std::string& word : words) out << "  " << escaped(word) << '\n';
  }
}

ProgramCase read_case_folder(const fs::path& folder) {
  ProgramCase one;
  std::ifstream in(folder / "case");
  std::string line, name;
  std::getline(in, line);
  std::istringstream(line) >> name >> one.amount >> one.signal;
  one.disturbance = disturbance_named(name);
  while (std::getline(in, line)) {
    if (line == "exactff") {
      one.commands.emplace_back();
    } else if (!one.commands.empty()) {
      one.commands.back().push_back(unescaped(line.substr(2)));
    }
  }
  if (one.commands.empty()) throw std::runtime_error(folder.string() + " holds no command");
  for (const auto& entry : fs::directory_iterator(folder / "in")) {
    one.files["in/" + entry.path().filename().string()] = text_of(entry.path());
  }
  return one;
}

std::string disturbance_words(const ProgramCase& one) {
  return std::string(kNames[static_cast<std::size_t>(one.disturbance)]) + ' ' + std::to_string(one.amount) + ' ' +
         std::to_string(one.signal);
}

std::string command_line(const Words& words) {
  std::string line = "exactff";
  for (const std::string& word : words) line += ' ' + text::shell_word(word);
  return line;
}

}  // namespace exactff::validation
