// Matrices of view factors as other programs write them.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "exactff/table.h"

namespace exactff::matrix {

// The matrix that a file is compared with.
struct Order {
  std::array<std::string, 2> keys;  // the columns of a list of entries: "from" and "to"
  std::vector<std::string> rows, columns;
  std::vector<double> areas;  // of the rows; empty if they are not known
};

// A table with the columns receiver, source and value; nothing if the file is a list of entries, or was written by
// exactff. The file is recognised by its content. A matrix without names gets those of `order`, whose size (and areas,
// if it has areas) it must have. Throws InputError.
[[nodiscard]] std::optional<table::Table> read_other(const std::filesystem::path& file, const Order& order);

}  // namespace exactff::matrix
