// Scenes of a random family with a receiver, for tests of whole views.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "support/oracle_check.h"
#include "support/random_scenes.h"

namespace exactff::validation {

// Calls check(plain, scene, receiver) for scenes of the family until one fails.
template <class Check>
void for_each_scene_of(const RandomFamily& family, std::uint64_t divisor, const Check& check) {
  for (std::uint64_t i = 0; i < scaled_count(1 + family.count / divisor); ++i) {
    SCOPED_TRACE("seed " + std::to_string(seed_of(i)));
    generate::Random random(seed_of(i));
    const generate::PlainScene plain = family.make(random);
    const Scene scene = generate::build(plain);
    check(plain, scene, receiver_in(scene, plain));
    if (testing::Test::HasFailure()) {
      ADD_FAILURE() << generate::to_obj(plain, {}, generate::Digits::kSeventeen);
      return;
    }
  }
}

}  // namespace exactff::validation
