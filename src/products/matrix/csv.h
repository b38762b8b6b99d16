// The CSV file of a matrix: its head and its rows.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "exactff/matrix.h"

namespace exactff::matrix {

inline constexpr std::string_view kColumns =
    "from,to,factor,lower,upper,claim,way,accurate,area_from,area_to,cells,event_cells,limit";

// The columns besides patches.
struct Surroundings {
  bool back = false, open = false, buried = false;
};

// Comment lines with everything that the entries depend on, without the line of column names.
[[nodiscard]] std::string csv_comments(const Scene& scene, std::span<const Selection> from,
                                       std::span<const Selection> to, const ViewFactorOptions& options,
                                       Surroundings surroundings);

// `area_to`: nothing for what is open or buried.
void add_csv_row(std::string& text, const std::string& from, std::string_view to, const ViewFactor& f,
                 std::optional<double> area_to);

}  // namespace exactff::matrix
