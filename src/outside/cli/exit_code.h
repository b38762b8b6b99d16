// Converts what a command throws into a message to the user and an exit code.
#pragma once

#include <functional>

namespace exactff::cli {

inline constexpr int kBadInput = 2;
inline constexpr int kNotAsAsked = 3;  // a value is not as accurate or certified as asked
inline constexpr int kInternalFailure = 4;

// The return value of the command. If it throws, prints why and returns 2 or 4.
[[nodiscard]] int exit_code_of(const std::function<int()>& command);

}  // namespace exactff::cli
