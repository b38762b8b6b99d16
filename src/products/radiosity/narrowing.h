// Bounds of radiosities that are as narrow as is wanted: the view factors that widen them most are computed again, more
// accurately.
//
// Method, for one channel. Let v <= B <= w be the bounds (system.h), d = w - v, and W_ij = U_ij - L_ij. Then
//   d = rho (U w - L v) = r + rho L d,   r_i = rho_i sum_j W_ij w_j:
// r_i is what the widths of row i add to its own bounds; the rest comes from other rows. d_i <= t is wanted everywhere.
// 1. Take the largest d' with d' = min(t, r + rho F d'), by iteration from d' = t. Row i may add d'_i - rho_i (F d')_i.
//    That is r_i unless d'_i = t: then some entries of the row must be narrower.
// 2. Entry j adds c_j = rho_i W_ij B_j. If half the width takes twice the work, here counted in cells, a sum of c_j is
//    reached with the least work where each is min(c_j, l sqrt(work_j c_j)) with the same l.
// 3. The accuracy of an entry is that of the first computation, halved until it is at most the width found in 2, for
//    every row and channel. What cannot be narrower, because of its budget or roundings, is left out.
// 4. Compute these entries again, and repeat all, until all bounds are narrow enough or no entry can be narrower.
// 1 and 2 use the solver's estimates of B. What is reached is judged by bounds alone. Entries come out narrower than
// they are asked to be, so t is four times what is wanted at first, and halved when no entry is found.
#pragma once

#include "exactff/jobs.h"
#include "exactff/matrix.h"
#include "exactff/radiosity.h"
#include "radiosity/system.h"

namespace exactff::radiosity {

struct Narrowed {
  std::vector<std::uint8_t> halvings;  // of the accuracy, for each entry, row by row
  std::size_t entries = 0;             // computed again
};

void require_width(double width);  // throws InputError unless it is positive and finite

// Of a matrix with the accuracy and the other options in options.factors. The entries that are computed again are kept
// in the journal, if there is one. The result depends on the scene, the matrix and the options alone.
Narrowed narrow(const Scene& scene, matrix::Matrix& matrix, const Options& options, jobs::Journal* journal,
                const Hooks& hooks);

// narrow(), if a width is wanted, and solve().
[[nodiscard]] Solution solve_within(const Scene& scene, matrix::Matrix& matrix, const Options& options,
                                    jobs::Journal* journal, const Hooks& hooks);

}  // namespace exactff::radiosity
