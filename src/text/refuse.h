// Refuses input that no file and line belongs to, such as flags that contradict each other.
#pragma once

#include <string>
#include <utility>

#include "exactff/error.h"

namespace exactff::text {

[[noreturn]] inline void refuse(std::string what, std::string why, std::string suggestion) {
  throw InputError({.what = std::move(what), .why = std::move(why), .suggestion = std::move(suggestion)});
}

}  // namespace exactff::text
