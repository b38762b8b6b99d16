// Vectors of four numbers, in the vector extension that GCC and Clang share: all that a header needs of lanes.h.
#pragma once

#include <cstdint>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

// A vector of four doubles is returned in another way with AVX than without: a function that is compiled for both must
// call none that returns one, and so whatever works on such vectors is inlined, however little is optimised.
#define EXACTFF_INLINE [[gnu::always_inline]] inline

namespace exactff::kernel::lanes {

using Four = double __attribute__((vector_size(32)));
using FourMask = std::int64_t __attribute__((vector_size(32)));  // 0 or -1 in each lane
using FourInts = std::int32_t __attribute__((vector_size(16)));
using FourShorts = std::int16_t __attribute__((vector_size(8)));
using EightShorts = std::int16_t __attribute__((vector_size(16)));

// Lane by lane.
EXACTFF_INLINE bool nowhere_larger(const EightShorts& a, const EightShorts& b) {
#if defined(__SSE2__)
  return _mm_movemask_epi8(__m128i(a > b)) == 0;
#else
  bool result = true;
  for (int lane = 0; lane < 8; ++lane) result = result && a[lane] <= b[lane];
  return result;
#endif
}

}  // namespace exactff::kernel::lanes
