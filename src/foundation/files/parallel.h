// The number of threads to use, and a parallel loop over independent indices.
#pragma once

#include <cstddef>
#include <functional>

#include "exactff/progress.h"

namespace exactff::files {

// The number of processors that this process may use. A batch system, taskset or mpirun may have given it fewer than
// the machine has.
[[nodiscard]] int usable_threads();

// Throws Cancelled if the hooks request it, these or those of the thread.
void require_not_cancelled(const Hooks& hooks);

// Calls body(i) once for every i below count. Progress is reported under a lock. When all threads have ended, the first
// exception of a body is rethrown; so is Cancelled. What the body calls asks hooks.cancelled, too, or else that of the
// calling thread's hooks.
void parallel_for(std::size_t count, int threads, std::string_view stage, const Hooks& hooks,
                  const std::function<void(std::size_t)>& body);

}  // namespace exactff::files
