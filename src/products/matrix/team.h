// Matrices that several processes write together.
#pragma once

#include <filesystem>
#include <functional>

#include "exactff/matrix.h"
#include "jobs/team.h"

namespace exactff::matrix {

// As write() of exactff/matrix.h, by rank 0 of a team. jobs::dismiss() must follow, whatever is thrown. Null: alone.
jobs::Summary write(const Request& request, const std::filesystem::path& file, jobs::Existing existing,
                    const jobs::RowHooks& hooks, jobs::Team* team);

// Runs a follower of a team, as truth::follow does.
int follow(jobs::Team& team, const std::function<Request()>& request, const jobs::RowHooks& hooks);

}  // namespace exactff::matrix
