#include <optional>
#include <utility>

#include "exactff/matrix.h"
#include "exactff/version.h"
#include "text/csv_row.h"
#include "text/phrases.h"

namespace exactff::matrix {
namespace {

void add_row(std::string& text, const std::string& from, std::string_view to, const ViewFactor& f,
             std::optional<double> area_to) {
  text::CsvRow(text) << from << to << f.value << f.lower << f.upper << to_string(f.claim)
                     << std::string_view(f.accurate ? "yes" : "no") << f.area_from << area_to << f.cells
                     << f.event_cells;
}

}  // namespace

std::string csv_text(const Scene& scene, const Matrix& matrix, const ViewFactorOptions& options) {
  std::string text = "# exactff " + std::string(kVersion) +
                     " matrix: view factors from patch to patch, areas in the scene's unit squared\n# scene hash " +
                     scene.hash() + "; accuracy " + text::shortest(options.accuracy) + ", budget " +
                     std::to_string(options.budget) + " cells" + (options.certify ? "; certify" : "") +
                     "\nfrom,to,factor,lower,upper,claim,accurate,area_from,area_to,cells,event_cells\n";
  const ViewFactorMatrix& all = matrix.factors;
  for (std::size_t i = 0; i < all.from.size(); ++i) {
    const std::string from = scene.name_of(all.from[i]);
    for (std::size_t j = 0; j < all.to.size(); ++j) {
      add_row(text, from, scene.name_of(all.to[j]), all.at(i, j), all.at(i, j).area_to);
    }
    if (!matrix.back.empty()) add_row(text, from, kBack, matrix.back[i], matrix.back[i].area_to);
    if (!matrix.open.empty()) add_row(text, from, kOpen, matrix.open[i], std::nullopt);
  }
  return text;
}

}  // namespace exactff::matrix
