// The columns of a matrix file, and what its head says.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "exactff/matrix.h"
#include "table/fields.h"

namespace exactff::matrix {

struct Entry : ViewFactor {
  std::string from, to;  // names of patches, or of an additional column
  double balanced = 0.0;
  bool has_area_to = true;  // not of what is open or buried
};

[[nodiscard]] const table::Fields<Entry>& columns();

// The claim, way or limit of this text.
template <class Word>
std::optional<Word> named(std::string_view word) {
  for (int i = 0; !to_string(static_cast<Word>(i)).empty(); ++i) {
    if (word == to_string(static_cast<Word>(i))) return static_cast<Word>(i);
  }
  return std::nullopt;
}

// Of the additional columns of a table, those that are sums of groups.
[[nodiscard]] std::vector<std::string> sums_among(std::vector<std::string> further);

// The columns besides patches.
struct Surroundings {
  bool back = false, open = false, buried = false;
  std::vector<std::string> sums = {};  // names of columns
};

// Everything that the entries depend on.
[[nodiscard]] table::Head head_of(const Scene& scene, std::span<const Selection> from, std::span<const Selection> to,
                                  const ViewFactorOptions& options, Surroundings surroundings);
// The scene's hash, and its unit if it has one.
void set_scene(table::Head& head, const Scene& scene);
// The options of view factors, in the head of any table that depends on them.
void set_options(table::Head& head, const ViewFactorOptions& options);

}  // namespace exactff::matrix
