// What arithmetic that is written once for one double and for four at a time (lanes.h) asks of its numbers. Each lane
// does what the double does, operation by operation: it gets the same bits whatever the other lanes hold. Hence no
// branches: what may be wrong in some lane is computed all the same and then replaced, by `where`.
#pragma once

#include <cmath>

// Warns of vectors passed between functions: those here are all inlined. Whoever uses four lanes turns it off as well.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"

#include "kernel/lanes.h"

// std::fma is a function of the library in a clone (lanes.h) for any processor, one instruction in the others; they
// give the same bits. With four lanes, GCC makes one instruction of four only where it may take the rounding to be to
// nearest and need not set errno: -fno-rounding-math -fno-math-errno.

namespace exactff::kernel::reals {

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
#pragma GCC unroll 1  // one instruction is made of a loop, of four calls in a row not always
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

// --- Conditions: as comparisons give them ---

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

EXACTFF_INLINE bool in_some_lane(const FourMask& condition) { return lanes::lane_bits(condition) != 0; }
EXACTFF_INLINE bool in_every_lane(const FourMask& condition) { return lanes::all_lanes(condition); }

}  // namespace exactff::kernel::reals

#pragma GCC diagnostic pop
