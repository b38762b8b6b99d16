// From what a command throws to what the user reads, and the exit code.
#pragma once

#include <functional>

namespace exactff::cli {

inline constexpr int kBadInput = 2;
inline constexpr int kNotCertified = 3;  // a value is not, within the cap on precision
inline constexpr int kInternalFailure = 4;

// What the command returns; 2 or 4 where it throws, after telling why.
[[nodiscard]] int exit_code_of(const std::function<int()>& command);

}  // namespace exactff::cli
