// SplitMix64 (Steele, Lea and Flood 2014): random numbers that depend on a key alone, the same on every machine.
#pragma once

#include <cstdint>

namespace exactff::kernel {

inline constexpr std::uint64_t kGoldenGamma = 0x9e3779b97f4a7c15U;

// A bijective mix of 64 bits: the finaliser of SplitMix64.
inline std::uint64_t mixed(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
  return z ^ (z >> 31);
}

// Number `index`, from 0, of the stream `key`. Also the key of another stream; keys with different `index` are
// practically independent.
inline std::uint64_t split_mix(std::uint64_t key, std::uint64_t index) {
  return mixed(key + (index + 1) * kGoldenGamma);
}

// A multiple of 2^-53 in [0, 1).
inline double unit_fraction(std::uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1p-53; }

}  // namespace exactff::kernel
