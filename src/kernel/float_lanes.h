// Four floats at a time, in the vector extension that GCC and Clang share.
#pragma once

#include <cstdint>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace exactff::kernel::lanes {

using FourFloats = float __attribute__((vector_size(16)));
using FourFloatsMask = std::int32_t __attribute__((vector_size(16)));

inline bool all_lanes(const FourFloatsMask& m) {
#if defined(__SSE2__)
  return _mm_movemask_ps(_mm_castsi128_ps(__m128i(m))) == 15;
#else
  return (m[0] & m[1] & m[2] & m[3]) != 0;
#endif
}

}  // namespace exactff::kernel::lanes
