// exactff_minimise [-o FOLDER] INPUT...
//
// Shrinks failing inputs and writes each as a regression case. If that case is moved into data/regression, it becomes a
// test. An input is a case file (.json), or a file for which fuzz_solver fails with a wrong value, a crash or a hang.
// Exit code 0: every input fails and was shrunk; 1: one does not fail (here); 2: bad input.
#include <cstdint>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "fuzz/scene_bytes.h"
#include "fuzz/shrink.h"
#include "support/case_file.h"

namespace exactff::validation {
namespace {

std::optional<FuzzCase> read_input(const std::filesystem::path& path) {
  if (path.extension() == ".json") return FuzzCase{read_case(path).scene, Identity::kOrder, 1};
  std::ifstream in(path, std::ios::binary);
  if (!in || std::filesystem::is_directory(path)) throw std::runtime_error("cannot read " + path.string());
  const std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(in), {}};
  return decode(bytes);
}

// True if the input fails.
bool minimise(const std::filesystem::path& path, const std::filesystem::path& folder) {
  const std::optional<FuzzCase> fuzz_case = read_input(path);
  const std::optional<Shrunk> shrunk = fuzz_case ? shrink(*fuzz_case) : std::nullopt;
  if (!shrunk) {
    std::cout << path.string() << ": does not fail\n";
    return false;
  }
  const std::filesystem::path kept = keep(*shrunk, test_name(path.stem().string()), folder);
  std::cout << path.string() << ": " << shrunk->problem << "; shrunk to " << kept.string() << std::endl;
  return true;
}

int run(const std::vector<std::string>& arguments) {
  std::filesystem::path folder = ".";
  std::vector<std::filesystem::path> inputs;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (arguments[i] != "-o") {
      inputs.emplace_back(arguments[i]);
    } else if (++i < arguments.size()) {
      folder = arguments[i];
    }
  }
  if (inputs.empty()) throw std::runtime_error("usage: exactff_minimise [-o FOLDER] INPUT...");
  bool all_fail = true;
  for (const std::filesystem::path& input : inputs) all_fail = minimise(input, folder) && all_fail;
  return all_fail ? 0 : 1;
}

}  // namespace
}  // namespace exactff::validation

int main(int argc, char** argv) {
  try {
    return exactff::validation::run({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 2;
  }
}
