// Arbitrary bytes as a small degenerate scene: all that its receiver sees, judged by the per-source solver, by rational
// numbers, by the Booleans, and by a reader of its pictures. The bytes are those of fuzz_solver (scene_bytes.h), so
// both share a corpus.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>

#include "fuzz/scene_bytes.h"
#include "support/oracle_check.h"
#include "support/region_judge.h"
#include "support/view_judge.h"

namespace exactff::validation {
namespace {

void judge(const generate::PlainScene& plain) {
  const Scene scene = generate::build(plain);
  const Receiver receiver = receiver_in(scene, plain);
  expect_patches_as_the_solver(scene, receiver);
  expect_shares_to_add_up(scene, receiver);
  expect_sides_as_rational_numbers_find(scene, receiver);
  expect_picture_of_shares(scene, receiver);
  expect_regions_as_booleans_find(scene, receiver);
}

}  // namespace
}  // namespace exactff::validation

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  GTEST_FLAG_SET(throw_on_failure, true);
  if (const auto fuzz_case = exactff::validation::decode({data, size})) {
    exactff::validation::judge(fuzz_case->scene);
  }
  return 0;
}
