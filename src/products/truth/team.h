// Truth files that several processes write together.
#pragma once

#include <filesystem>
#include <functional>

#include "exactff/truth.h"
#include "jobs/team.h"

namespace exactff::truth {

// As write() of exactff/truth.h, by rank 0 of a team. jobs::dismiss() must follow, whatever is thrown. Null: alone.
Summary write(Request request, const std::filesystem::path& file, jobs::Existing existing, const jobs::RowHooks& hooks,
              jobs::Team* team);

// Runs a follower of a team, that is, any other rank. `request` must make the same request as the leader's; what it
// throws is sent to the leader. Only the hooks `cancelled` and slow_seconds are used. Returns the exit code.
int follow(jobs::Team& team, const std::function<Request()>& request, const jobs::RowHooks& hooks);

}  // namespace exactff::truth
