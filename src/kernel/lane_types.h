// Vectors of four numbers, in the vector extension that GCC and Clang share: all that a header needs of lanes.h.
#pragma once

#include <cstdint>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace exactff::kernel::lanes {

using Four = double __attribute__((vector_size(32)));
using FourMask = std::int64_t __attribute__((vector_size(32)));  // 0 or -1 in each lane
using FourInts = std::int32_t __attribute__((vector_size(16)));
using FourShorts = std::int16_t __attribute__((vector_size(8)));
using EightShorts = std::int16_t __attribute__((vector_size(16)));

// Lane by lane.
inline bool nowhere_larger(const EightShorts& a, const EightShorts& b) {
#if defined(__SSE2__)
  return _mm_movemask_epi8(__m128i(a > b)) == 0;
#else
  bool result = true;
  for (int lane = 0; lane < 8; ++lane) result = result && a[lane] <= b[lane];
  return result;
#endif
}

}  // namespace exactff::kernel::lanes
