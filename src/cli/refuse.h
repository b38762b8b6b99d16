// Refuses flags that contradict each other or have no meaning.
#pragma once

#include <string>
#include <utility>

#include "exactff/error.h"

namespace exactff::cli {

[[noreturn]] inline void refuse(std::string what, std::string why, std::string suggestion) {
  throw InputError({.what = std::move(what), .why = std::move(why), .suggestion = std::move(suggestion)});
}

}  // namespace exactff::cli
