// Threads that share a loop over receivers, while the calling thread waits, reports progress and asks whether to stop.
#pragma once

#include <cstddef>
#include <functional>

#include "exactff/batch.h"

namespace exactff::batch {

// What one thread does with one index; holds the thread's memory.
using Body = std::function<void(std::size_t)>;

// Calls make_body() once for each thread and its result for every index below count. A loop of few steps, or for one
// thread, runs on the calling thread.
void share(std::size_t count, std::size_t few, const char* stage, const Run& run,
           const std::function<Body()>& make_body);

}  // namespace exactff::batch
