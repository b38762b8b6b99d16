// What every file of a method defines.
#pragma once

#include <cstdint>
#include <memory>

#include "exactff/methods.h"
#include "kernel/float_environment.h"

namespace exactff::methods {

#define EXACTFF_METHOD(name) Method name##_method();
#include "methods/list.h"
#undef EXACTFF_METHOD

// Of one setting, so that a slip of the keyboard is told and not waited for.
inline constexpr std::int64_t kMostSplits = 4096;
inline constexpr std::int64_t kMostRays = 65536;

// Method::prepare, in the arithmetic that every method computes in, whatever the calling thread has set. look_from,
// form_factor and configure see to that themselves.
template <class OnScene>
std::unique_ptr<PreparedScene> prepare_as(const Scene& scene) {
  const kernel::StandardArithmetic arithmetic;
  return std::make_unique<OnScene>(scene);
}

}  // namespace exactff::methods
