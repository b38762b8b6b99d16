#include "cli/view_factor_words.h"

#include <algorithm>
#include <vector>

#include "cli/output.h"
#include "text/phrases.h"

namespace exactff::cli {

void warn_of_width(const matrix::Matrix& matrix, const ViewFactorOptions& options) {
  const auto wide_of = [](const std::vector<ViewFactor>& list) {
    return std::ranges::count_if(list, [](const ViewFactor& f) { return !f.accurate; });
  };
  const auto wide = wide_of(matrix.factors.entries) + wide_of(matrix.back) + wide_of(matrix.open);
  if (wide == 0) return;
  print_warnings(std::vector<Problem>{{.what = text::counted(static_cast<std::uint64_t>(wide), "entry", "entries") +
                                               (wide == 1 ? " is" : " are") + " wider than the accuracy " +
                                               text::shortest(options.accuracy),
                                       .why = "the budget of " + std::to_string(options.budget) +
                                              " cells is used up; their bounds are as strong as their claims",
                                       .suggestion = "give more cells by --budget, or ask for less by --accuracy"}});
}

std::string interval_text(const matrix::Sum& interval) {
  return text::rounded(0.5 * interval.lower + 0.5 * interval.upper, 6) + " +- " +
         text::rounded(0.5 * interval.upper - 0.5 * interval.lower, 1);
}

}  // namespace exactff::cli
