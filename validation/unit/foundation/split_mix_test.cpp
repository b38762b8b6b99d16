#include "kernel/split_mix.h"

#include <gtest/gtest.h>

namespace exactff::kernel {
namespace {

// The first outputs for the seed 1234567, as published with the generator.
TEST(SplitMix, GivesThePublishedNumbers) {
  constexpr std::uint64_t kNumbers[] = {6457827717110365317U, 3203168211198807973U, 9817491932198370423U,
                                        4593380528125082431U, 16408922859458223821U};
  for (std::uint64_t i = 0; i < 5; ++i) EXPECT_EQ(split_mix(1234567, i), kNumbers[i]);
}

TEST(SplitMix, FractionsAreBelowOne) {
  EXPECT_EQ(unit_fraction(0), 0.0);
  EXPECT_EQ(unit_fraction(~std::uint64_t{0}), 1.0 - 0x1p-53);
}

}  // namespace
}  // namespace exactff::kernel
