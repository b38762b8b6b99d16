// What every fuzz target of a reader checks if a file is refused.
#pragma once

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "exactff/error.h"

namespace exactff::validation {

[[noreturn]] inline void fail(const std::string& what) {
  std::fprintf(stderr, "%s\n", what.c_str());
  std::abort();
}

inline void require_words(const InputError& error) {
  const auto silent = [](const Problem& problem) { return problem.what.empty(); };
  if (error.problems().empty() || std::ranges::any_of(error.problems(), silent)) fail("an error that says nothing");
}

template <class Use>
void unless_refused(const Use& use) {
  try {
    use();
  } catch (const InputError& error) {
    require_words(error);
  }
}

}  // namespace exactff::validation
