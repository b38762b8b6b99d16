// Arbitrary bytes as a small degenerate scene: the view factors between two of its patches, judged by their certified
// bounds and by the other direction. The bytes are those of fuzz_solver (scene_bytes.h), so both share a corpus.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>

#include "exactff/view_factors.h"
#include "fuzz/scene_bytes.h"
#include "generate/random.h"

namespace exactff::validation {
namespace {

bool meet(double lower, double upper, double other_lower, double other_upper) {
  return lower <= other_upper && other_lower <= upper;
}

void judge_factors(const Scene& scene, const Selection& from, const Selection& to) {
  const ViewFactorOptions quick{.accuracy = 1e-2, .budget = 8, .sample_crowds = false};
  const ViewFactorOptions certain{.accuracy = 1e-2, .budget = 4, .both_directions = true, .certify = true};
  try {
    const ViewFactor f = view_factor(scene, from, to, quick), proved = view_factor(scene, from, to, certain);
    EXPECT_TRUE(0.0 <= f.lower && f.lower <= f.value && f.value <= f.upper && f.upper <= 1.0);
    EXPECT_TRUE(meet(f.lower, f.upper, proved.lower, proved.upper));
    const ViewFactor back = view_factor(scene, to, from, certain);
    const double ratio = back.area_from / back.area_to, slack = 1.0 + 0x1p-30;
    if (!(ratio > 0x1p-300 && ratio < 0x1p300)) return;
    EXPECT_TRUE(meet(proved.lower, proved.upper, back.lower * ratio / slack, back.upper * ratio * slack));
  } catch (const InputError&) {  // a patch without an area that a double holds
  }
}

void judge(const generate::PlainScene& plain, std::uint64_t seed) {
  const Scene scene = generate::build(plain);
  generate::Random random(seed);
  const Selection other{static_cast<PatchId>(random.below(scene.patches().size())), {}, scene.id()};
  judge_factors(scene, other, scene.select(plain.source));
}

}  // namespace
}  // namespace exactff::validation

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  GTEST_FLAG_SET(throw_on_failure, true);
  if (const auto fuzz_case = exactff::validation::decode({data, size})) {
    exactff::validation::judge(fuzz_case->scene, fuzz_case->seed);
  }
  return 0;
}
