// Operations for arithmetic that is written once for one double and for four at a time (lanes.h). Each lane does the
// same operations as a single double, so it gets the same bits whatever the other lanes contain. Hence there are no
// branches: a value that may be invalid in some lane is computed all the same and then replaced by `where`.
#pragma once

#include <cmath>

// GCC warns of vectors passed between functions; the functions here are all inlined. Code that uses four lanes must
// disable the warning as well.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"

#include "kernel/lanes.h"

// In a clone (lanes.h) for any processor, std::fma is a library function; in the other clones it is one instruction.
// Both give the same bits. With four lanes, GCC makes a single instruction for all four only if it may assume rounding
// to nearest and need not set errno: -fno-rounding-math -fno-math-errno.

namespace exactff::kernel::double_double {

using lanes::Four;
using lanes::FourMask;

// The number in every lane.
template <class Real>
EXACTFF_INLINE Real uniform(double a) {
  return Real{} + a;
}

// a b + c, rounded once.
EXACTFF_INLINE double fused(double a, double b, double c) { return std::fma(a, b, c); }
EXACTFF_INLINE Four fused(const Four& a, const Four& b, const Four& c) {
  Four x = a, y = b, z = c;
#pragma GCC unroll 1  // GCC makes one instruction of a loop, but not always of four calls in a row
  for (int i = 0; i < 4; ++i) z[i] = std::fma(x[i], y[i], z[i]);
  return z;
}

EXACTFF_INLINE double root(double a) { return std::sqrt(a); }
EXACTFF_INLINE Four root(const Four& a) {
  return Four{std::sqrt(a[0]), std::sqrt(a[1]), std::sqrt(a[2]), std::sqrt(a[3])};
}

EXACTFF_INLINE double magnitude(double a) { return std::abs(a); }
EXACTFF_INLINE Four magnitude(const Four& a) { return lanes::absolute(a); }

using lanes::larger;

// --- Conditions, as comparisons return them ---

EXACTFF_INLINE bool both(bool a, bool b) { return a && b; }
EXACTFF_INLINE FourMask both(const FourMask& a, const FourMask& b) { return a & b; }
EXACTFF_INLINE bool either(bool a, bool b) { return a || b; }
EXACTFF_INLINE FourMask either(const FourMask& a, const FourMask& b) { return a | b; }
EXACTFF_INLINE bool differ(bool a, bool b) { return a != b; }
EXACTFF_INLINE FourMask differ(const FourMask& a, const FourMask& b) { return a ^ b; }

// a where the condition holds, else b.
EXACTFF_INLINE double where(bool condition, double a, double b) { return condition ? a : b; }
EXACTFF_INLINE Four where(const FourMask& condition, const Four& a, const Four& b) {
  return lanes::pick(condition, a, b);
}

EXACTFF_INLINE bool in_every_lane(bool condition) { return condition; }
EXACTFF_INLINE bool in_some_lane(const FourMask& condition) { return lanes::lane_bits(condition) != 0; }
EXACTFF_INLINE bool in_every_lane(const FourMask& condition) { return lanes::all_lanes(condition); }

}  // namespace exactff::kernel::double_double

#pragma GCC diagnostic pop
