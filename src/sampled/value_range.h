// Only this function clamps a sampled value to the range that its method promises.
#pragma once

namespace exactff::sampled {

enum class Formula {
  kUnit,         // all its values lie in [0, 1]; others are rounding errors
  kNotNegative,  // its values may exceed 1
  kAny,
};

// Requires a number, perhaps infinite: a formula may exceed the largest double. Returns the nearest finite double that
// the formula could have had without rounding errors.
[[nodiscard]] double settled(double value, Formula formula);

}  // namespace exactff::sampled
