// Entries of a square matrix that are computed again, with a smaller accuracy.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "exactff/jobs.h"
#include "exactff/matrix.h"

namespace exactff::matrix {

struct Again {
  ViewFactorOptions factors;
  std::vector<std::size_t> entries;  // row by row, of the factors between all of from = to
};

// Replaces the entries by those that view_factor gives with the options, and those that follow from them (transposes)
// as well. Calls take(entry), of all that are replaced, from any thread. If there is a journal, entries that it holds
// are not computed, and others are added as soon as they are known. Progress counts entries from `done` on.
struct AgainHooks {
  const Hooks& hooks;
  jobs::Journal* journal = nullptr;
  std::size_t done = 0, total = 0;  // of all calls
  int threads = 0;
};
void compute_again(const Scene& scene, const Again& again, const AgainHooks& with, Factors& factors,
                   const std::function<void(std::size_t entry)>& take);

}  // namespace exactff::matrix
