// exactff_fuzz_seed FOLDER CASE.json...
//
// Writes each case file as an input of fuzz_solver, so that a run starts from the reference and regression cases.
// Cases beyond the decoder's limits are skipped.
#include <cstddef>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <vector>

#include "fuzz/scene_bytes.h"
#include "support/case_file.h"

namespace exactff::validation {
namespace {

void write_seed(const CaseFile& file, const std::filesystem::path& folder, std::size_t number) {
  std::vector<std::uint8_t> bytes;
  try {
    bytes = encode(file.scene, static_cast<Identity>(number % kIdentityCount));
  } catch (const std::invalid_argument&) {  // too large
    return;
  }
  std::ofstream out(folder / test_name(file.name), std::ios::binary);
  for (const std::uint8_t byte : bytes) out.put(static_cast<char>(byte));
  if (!out.flush()) throw std::runtime_error("cannot write to " + folder.string());
}

}  // namespace
}  // namespace exactff::validation

int main(int argc, char** argv) {
  using namespace exactff::validation;
  try {
    if (argc < 3) throw std::runtime_error("usage: exactff_fuzz_seed FOLDER CASE.json...");
    std::filesystem::create_directories(argv[1]);
    for (int i = 2; i < argc; ++i) write_seed(read_case(argv[i]), argv[1], static_cast<std::size_t>(i));
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 2;
  }
}
