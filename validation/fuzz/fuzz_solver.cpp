// Arbitrary bytes as a small degenerate scene: compares the exact solver with the oracle. A failure is printed and ends
// the process; exactff_minimise shrinks it.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

#include "fuzz/scene_bytes.h"
#include "support/oracle_check.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace exactff;
  constexpr int kNotForTheCorpus = -1;
  const auto fuzz_case = validation::decode({data, size});
  if (!fuzz_case) return kNotForTheCorpus;
  const std::string wrong = validation::disagreement(fuzz_case->scene);
  if (wrong.empty()) return 0;
  std::fprintf(stderr, "%s\n", wrong.c_str());
  try {
    std::fprintf(stderr, "%s", generate::to_obj(fuzz_case->scene).c_str());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "no OBJ text: %s\n", error.what());
  }
  std::abort();
}
