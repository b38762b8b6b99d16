// Eq. (4) over boundary pieces.
#include "contour/contour.h"

#include <gtest/gtest.h>

#include "exactff/enclosure.h"

namespace exactff::contour {
namespace {

// The unit square (0,1)^2 at z = 1, as seen from the origin below.
Enclosure of_square(long bits) {
  const kernel::ExactVec3 corners[] = {{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}};
  ContourIntegral contour({0, 0, 1});
  for (int i = 0; i < 4; ++i) contour.add({corners[i], corners[(i + 1) % 4]});
  return EnclosureInside::of(contour.evaluate(bits));
}

TEST(Contour, RadiusShrinksWithThePrecision) {
  const Enclosure coarse = of_square(64), fine = of_square(2000);
  EXPECT_TRUE(coarse.overlaps(fine));
  EXPECT_TRUE(coarse.decimals(15).has_value());
  EXPECT_FALSE(coarse.decimals(25).has_value());
  EXPECT_TRUE(fine.decimals(590).has_value());
}

}  // namespace
}  // namespace exactff::contour
