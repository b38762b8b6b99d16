// The processes that mpirun or srun has started together.
#pragma once

#include <memory>

#include "truth/team.h"

namespace exactff::cli {

// This process's rank as its launcher tells it in the environment: 0 alone.
[[nodiscard]] int launched_rank();

// Null where this process was started alone; only else is MPI loaded, which the program neither needs nor waits for.
// Throws InputError where several were started and MPI cannot be had: each would do all the work. Call it once, before
// the first thread is started.
[[nodiscard]] std::unique_ptr<truth::Team> join_team();

}  // namespace exactff::cli
