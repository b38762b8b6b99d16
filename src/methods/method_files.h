// What every file of a method defines.
#pragma once

#include <cstdint>

#include "exactff/methods.h"

namespace exactff::methods {

#define EXACTFF_METHOD(name) Method name##_method();
#include "methods/list.h"
#undef EXACTFF_METHOD

// Of one setting, so that a slip of the keyboard is told and not waited for.
inline constexpr std::int64_t kMostSplits = 4096;
inline constexpr std::int64_t kMostRays = 65536;

}  // namespace exactff::methods
