// How many threads to use, and a loop over independent indices on several of them.
#pragma once

#include <cstddef>
#include <functional>

#include "exactff/study.h"

namespace exactff::study {

// Processors that this process may use: a batch system, taskset or mpirun may have given it fewer than the machine has.
[[nodiscard]] int usable_threads();

// Calls body(i) once for every i below count. Progress is told under a lock; the first exception of a body is
// thrown again when all threads have ended; so is Cancelled.
void parallel_for(std::size_t count, int threads, std::string_view stage, const Hooks& hooks,
                  const std::function<void(std::size_t)>& body);

}  // namespace exactff::study
