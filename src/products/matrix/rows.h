// Rows of a matrix: what is said of them, and how they come into files.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "exactff/matrix.h"
#include "jobs/team.h"
#include "matrix/columns.h"

namespace exactff::matrix {

// Relative error of an area as a double; as in view_factors/pairs.cpp.
inline constexpr double kRoundedAreas = 0x1p-44;

// The weakest one of all factors between patches; and of back and open, too, if `with_rest`.
[[nodiscard]] Claim claim_of(const Matrix& matrix, bool with_rest);

// The area of a row's patch. Requires a column, or back, open or buried.
[[nodiscard]] double area_of_row(const Matrix& matrix, std::size_t row);

// row_sums(), but not above 1 where that is proved: a ray meets the front of one patch, a back or nothing first, so the
// shares of different columns do not overlap, unless fronts do, faces are transparent or rows are bent.
[[nodiscard]] std::vector<Sum> clipped_row_sums(const Scene& scene, const Matrix& matrix);

// reasons_against_one(), if `known` of the two is known besides the factors.
[[nodiscard]] std::vector<std::string> reasons_against_one(const Scene& scene, const Factors& factors,
                                                           Surroundings known);

// Whether an entry of the row, or its back or open, is estimated.
[[nodiscard]] bool has_estimates(const Matrix& matrix, std::size_t row);

// --- By several processes ---

// As write() of exactff/matrix.h, by rank 0 of a team. jobs::dismiss() must follow, whatever is thrown. Null: alone.
jobs::Summary write(const Request& request, const std::filesystem::path& file, jobs::Existing existing,
                    const jobs::RowHooks& hooks, jobs::Team* team);

// Runs a follower of a team, as truth::follow does.
int follow(jobs::Team& team, const std::function<Request()>& request, const jobs::RowHooks& hooks);

}  // namespace exactff::matrix
