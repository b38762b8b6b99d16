// Arbitrary bytes as a small degenerate scene: compares the exact solver with the oracle and with itself.
//
// A failure is printed, shrunk into the folder EXACTFF_TEST_KEEP if that is set, and ends the process.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

#include "fuzz/checks.h"
#include "fuzz/scene_bytes.h"
#include "fuzz/shrink.h"

namespace exactff::validation {
namespace {

std::string fnv1a(std::span<const std::uint8_t> bytes) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const std::uint8_t byte : bytes) hash = (hash ^ byte) * 0x100000001b3u;
  char text[20];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
  return text;
}

void print(const FuzzCase& fuzz_case, const std::string& wrong) {
  std::fprintf(stderr, "%s (identity: %s, seed %d)\n", wrong.c_str(), name_of(fuzz_case.identity).c_str(),
               static_cast<int>(fuzz_case.seed));
  try {
    std::fprintf(stderr, "%s", generate::to_obj(fuzz_case.scene).c_str());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "no OBJ text: %s\n", error.what());
  }
}

void shrink_and_keep(const FuzzCase& fuzz_case, const std::string& name) {
  const char* folder = std::getenv("EXACTFF_TEST_KEEP");
  if (folder == nullptr) return;
  const auto shrunk = shrink(fuzz_case);
  if (shrunk) std::fprintf(stderr, "shrunk: %s\n", keep(*shrunk, "fuzz_" + name, folder).c_str());
}

}  // namespace
}  // namespace exactff::validation

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace exactff::validation;
  constexpr int kNotForTheCorpus = -1;
  const std::span<const std::uint8_t> bytes(data, size);
  const auto fuzz_case = decode(bytes);
  if (!fuzz_case) return kNotForTheCorpus;
  const std::string wrong = problem(*fuzz_case);
  if (wrong.empty()) return 0;
  print(*fuzz_case, wrong);
  shrink_and_keep(*fuzz_case, fnv1a(bytes));
  std::abort();
}
