// What is said of single rows of a matrix.
#pragma once

#include <cstddef>

#include "exactff/matrix.h"

namespace exactff::matrix {

// The area of a row's patch. Requires a column, or back or open.
[[nodiscard]] double area_of_row(const Matrix& matrix, std::size_t row);

// The sum of the values of a row with its back and open, an estimate.
[[nodiscard]] double sum_of_values(const Matrix& matrix, std::size_t row);

// Whether an entry of the row, or its back or open, is statistical.
[[nodiscard]] bool has_statistical(const Matrix& matrix, std::size_t row);

}  // namespace exactff::matrix
