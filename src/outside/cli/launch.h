// The processes that one mpirun or srun started together.
#pragma once

#include <memory>

#include "jobs/team.h"

namespace exactff::cli {

// The rank of this process, read from the environment that the launcher sets; 0 if it was started alone.
[[nodiscard]] int launched_rank();

// Returns null if this process was started alone; the program then neither needs MPI nor waits until it is loaded.
// Throws InputError if several processes were started and MPI is not available: each would do all the work. Call it
// once, before the first thread is started.
[[nodiscard]] std::unique_ptr<jobs::Team> join_team();

}  // namespace exactff::cli
