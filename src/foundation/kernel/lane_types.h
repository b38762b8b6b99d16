// Vectors of four numbers, in the vector extension that GCC and Clang share: the part of lanes.h that headers need.
#pragma once

#include <cstdint>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

// AVX changes how a function returns a vector of four doubles. A function that is compiled with and without AVX must
// therefore not call any function that returns one. So all functions on such vectors are inlined, at every optimisation
// level.
#define EXACTFF_INLINE [[gnu::always_inline]] inline

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

}  // namespace exactff::kernel::lanes
