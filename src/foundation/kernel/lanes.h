// Operations on four doubles at a time, in the vector extension that GCC and Clang share.
//
// Functions marked EXACTFF_CLONES are compiled three times: for any processor, for AVX2 and for AVX-512. The version is
// chosen at load time. The functions that they call are inlined into all versions. Products and sums are never
// contracted (-ffp-contract=off), so every version gives the same bits.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

// AVX changes how a function returns a vector of four doubles. A function that is compiled with and without AVX must
// therefore not call any function that returns one. So all functions on such vectors are inlined, at every optimisation
// level.
#define EXACTFF_INLINE [[gnu::always_inline]] inline

#if defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) && !defined(__clang__)
#define EXACTFF_CLONES __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define EXACTFF_CLONES
#endif

namespace exactff::kernel::lanes {

using Four = double __attribute__((vector_size(32)));
using FourMask = std::int64_t __attribute__((vector_size(32)));  // 0 or -1 in each lane
using FourInts = std::int32_t __attribute__((vector_size(16)));
using FourShorts = std::int16_t __attribute__((vector_size(8)));
using EightShorts = std::int16_t __attribute__((vector_size(16)));

// True if a <= b in every lane.
EXACTFF_INLINE bool nowhere_larger(const EightShorts& a, const EightShorts& b) {
#if defined(__SSE2__)
  return _mm_movemask_epi8(__m128i(a > b)) == 0;
#else
  bool result = true;
  for (int lane = 0; lane < 8; ++lane) result = result && a[lane] <= b[lane];
  return result;
#endif
}

EXACTFF_INLINE Four load(const double* p) {
  Four v;
  std::memcpy(&v, p, sizeof v);
  return v;
}

EXACTFF_INLINE void store(const Four& v, double* p) { std::memcpy(p, &v, sizeof v); }

EXACTFF_INLINE Four four(double a) { return Four{a, a, a, a}; }

EXACTFF_INLINE FourMask four_whole(std::int64_t a) { return FourMask{a, a, a, a}; }
EXACTFF_INLINE Four next_lane(const Four& v) { return Four{v[1], v[2], v[3], v[0]}; }
EXACTFF_INLINE FourMask next_lane(const FourMask& v) { return FourMask{v[1], v[2], v[3], v[0]}; }
EXACTFF_INLINE Four absolute(const Four& v) { return Four(FourMask(v) & 0x7FFFFFFFFFFFFFFF); }
EXACTFF_INLINE Four larger(const Four& a, const Four& b) { return a < b ? b : a; }
EXACTFF_INLINE Four smaller(const Four& a, const Four& b) { return b < a ? b : a; }

// Lane by lane: `a` where the mask is negative, else `b`.
EXACTFF_INLINE Four pick(const FourMask& mask, const Four& a, const Four& b) { return mask < 0 ? a : b; }
EXACTFF_INLINE FourMask pick(const FourMask& mask, const FourMask& a, const FourMask& b) { return mask < 0 ? a : b; }

EXACTFF_INLINE double lowest(const Four& v) { return std::min(std::min(v[0], v[1]), std::min(v[2], v[3])); }
EXACTFF_INLINE double highest(const Four& v) { return std::max(std::max(v[0], v[1]), std::max(v[2], v[3])); }
EXACTFF_INLINE double lane_sum(const Four& v) { return (v[0] + v[1]) + (v[2] + v[3]); }
#if defined(__SSE2__)
EXACTFF_INLINE unsigned lane_bits(const FourMask& m) {
  const __m128i low{m[0], m[1]}, high{m[2], m[3]};
  const __m128 halves = _mm_shuffle_ps(_mm_castsi128_ps(low), _mm_castsi128_ps(high), _MM_SHUFFLE(3, 1, 3, 1));
  return static_cast<unsigned>(_mm_movemask_ps(halves));
}
#else
EXACTFF_INLINE unsigned lane_bits(const FourMask& m) {
  return static_cast<unsigned>((m[0] & 1) | (m[1] & 2) | (m[2] & 4) | (m[3] & 8));
}
#endif
EXACTFF_INLINE bool all_lanes(const FourMask& m) { return lane_bits(m) == 15; }

}  // namespace exactff::kernel::lanes
