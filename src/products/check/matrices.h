// Matrices of view factors as truths and candidates: a row for each entry.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "exactff/check.h"

namespace exactff::check {

// What view factors must keep to, whatever the truth is: how far the candidate's entries are from it.
struct MatrixFacts {
  struct Largest {
    double by = 0.0;
    std::string from, to;
  };
  std::size_t negative = 0, above_one = 0;  // entries
  Largest least, largest;                   // the entries themselves
  std::optional<Largest> row_sum;      // the distance of a row's sum from the sum of the truth's bounds; of whole rows
  std::optional<Largest> reciprocity;  // |A_i F_ij - A_j F_ji| / min(A_i, A_j), if rows and columns are the same
};
// One sentence for each fact.
[[nodiscard]] std::vector<std::string> sentences(const MatrixFacts& facts);

// A file of `exactff matrix -o` and a matrix of another program, entry by entry.
struct Matrices {
  Truth truth;
  std::vector<Measured> values;  // in its order
  std::string candidate_file;
  MatrixFacts facts;
};
// The candidate is recognised by its content: CSV with the columns from, to and value (or factor), or a table with
// names above and beside it: matched by names; View3D's output, numbers only (CSV or blanks between) or a NumPy array:
// in the order of the truth, whose size they must have, and whose areas if the file has areas. What meets backs and
// what is open are judged if the candidate has these columns. Throws one InputError with file:line for every problem;
// entries may be missing only if `partial`.
[[nodiscard]] Matrices read_matrices(const std::filesystem::path& truth, const std::filesystem::path& candidate,
                                     const CandidateColumns& columns = {}, bool partial = false);

}  // namespace exactff::check
