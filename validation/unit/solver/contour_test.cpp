// Eq. (4) over boundary pieces.
#include "contour/contour.h"

#include <gtest/gtest.h>

#include <vector>

#include "exactff/enclosure.h"

namespace exactff::contour {
namespace {

using kernel::ExactVec3;
using visibility::BoundaryPiece;
using visibility::EdgeParameter;

const ExactVec3 kUp{0, 0, 1};

// The unit square (0,1)^2 at z = 1, counter-clockwise as seen from the origin below.
std::vector<ExactVec3> square() { return {{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}}; }

Enclosure integrate(const std::vector<BoundaryPiece>& pieces, long bits, const ExactVec3& normal = kUp) {
  ContourIntegral contour(normal);
  for (const BoundaryPiece& piece : pieces) contour.add(piece);
  return EnclosureInside::of(contour.evaluate(bits));
}

std::vector<BoundaryPiece> loop_of(const std::vector<ExactVec3>& corners) {
  std::vector<BoundaryPiece> pieces;
  for (std::size_t i = 0; i < corners.size(); ++i) pieces.push_back({corners[i], corners[(i + 1) % corners.size()]});
  return pieces;
}

TEST(Contour, AgreesWithTheClosedFormBelowACorner) {
  // J. R. Howell, configuration B-3 with a = b = c = 1.
  const Enclosure f = integrate(loop_of(square()), 200);
  EXPECT_EQ(f.decimals(30), "0.138531605994892996780769708634");
}

TEST(Contour, RadiusShrinksWithThePrecision) {
  const Enclosure coarse = integrate(loop_of(square()), 64);
  const Enclosure fine = integrate(loop_of(square()), 2000);
  EXPECT_TRUE(coarse.overlaps(fine));
  EXPECT_TRUE(coarse.decimals(15).has_value());
  EXPECT_FALSE(coarse.decimals(25).has_value());
  EXPECT_TRUE(fine.decimals(590).has_value());
}

TEST(Contour, AReversedLoopIsTheNegative) {
  std::vector<BoundaryPiece> forward = loop_of(square());
  std::vector<BoundaryPiece> both = forward;
  for (BoundaryPiece piece : forward) {
    std::swap(piece.begin, piece.end);  // same supporting edge, opposite direction
    both.push_back(piece);
  }
  const Enclosure sum = integrate(both, 100);
  EXPECT_TRUE(sum.contains(0.0));
  EXPECT_LT(sum.upper(), 0x1p-90);
}

TEST(Contour, PiecesOfOneSupportingEdgeAddUp) {
  const EdgeParameter start{1, 0};
  const EdgeParameter third{2, 1};  // (2 a + b): a third of the way
  const EdgeParameter half{5, 5};
  std::vector<BoundaryPiece> whole = loop_of(square());
  std::vector<BoundaryPiece> split;
  for (const BoundaryPiece& piece : whole) {
    split.push_back({piece.a, piece.b, start, third});
    split.push_back({piece.a, piece.b, third, half});
    split.push_back({piece.b, piece.a, half, start});  // the other half, on the reversed edge, up to its `a`
  }
  EXPECT_TRUE(integrate(split, 300).overlaps(integrate(whole, 300)));
  EXPECT_EQ(integrate(split, 300).decimals(60), integrate(whole, 300).decimals(60));
}

TEST(Contour, ScalesOfNormalAndCornersMeanNothing) {
  std::vector<ExactVec3> scaled = square();
  scaled[1] = scaled[1] * kernel::Integer(12345);
  scaled[3] = scaled[3] * (kernel::Integer(1) << 4000);
  const Enclosure a = integrate(loop_of(square()), 200);
  const Enclosure b = integrate(loop_of(scaled), 200, kUp * (kernel::Integer(7) << 900));
  EXPECT_EQ(a.decimals(50), b.decimals(50));
}

TEST(Contour, APieceWithoutLengthAddsNothing) {
  std::vector<BoundaryPiece> pieces = loop_of(square());
  pieces.push_back({{0, 0, 1}, {1, 1, 1}, {1, 3}, {2, 6}});
  EXPECT_EQ(integrate(pieces, 100).decimals(20), integrate(loop_of(square()), 100).decimals(20));
}

}  // namespace
}  // namespace exactff::contour
