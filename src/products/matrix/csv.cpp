#include "matrix/csv.h"

#include <cstdint>

#include "exactff/version.h"
#include "text/csv_row.h"
#include "text/hashes.h"
#include "text/phrases.h"

namespace exactff::matrix {
namespace {

void add(text::Fnv1a& hash, std::span<const Selection> patches) {
  hash.add(std::uint64_t{patches.size()});
  for (const Selection& patch : patches) {
    hash.add(std::uint64_t{index_of(patch.patch)});
    hash.add(patch.face ? std::uint64_t{index_of(*patch.face)} : ~std::uint64_t{0});
  }
}

}  // namespace

std::string csv_comments(const Scene& scene, std::span<const Selection> from, std::span<const Selection> to,
                         const ViewFactorOptions& options, Surroundings surroundings) {
  text::Fnv1a patches;
  add(patches, from);
  add(patches, to);
  std::string text = "# exactff " + std::string(kVersion) +
                     " matrix: view factors from patch to patch, areas in the scene's unit squared\n# scene hash " +
                     scene.hash() + "; accuracy " + text::shortest(options.accuracy) + ", budget " +
                     std::to_string(options.budget) + " cells\n# " + text::counted(from.size(), "row") + ", " +
                     text::counted(to.size(), "column") + ", hash of the patches " + patches.digits();
  if (options.certify) text += ", certify";
  if (options.both_directions) text += ", both directions";
  if (!options.sample_crowds) text += ", no entry by points";
  if (surroundings.back) text += ", " + std::string(kBack);
  if (surroundings.open) text += ", " + std::string(kOpen);
  if (surroundings.buried) text += ", " + std::string(kBuried);
  return text + '\n';
}

void add_csv_row(std::string& text, const std::string& from, std::string_view to, const ViewFactor& f,
                 std::optional<double> area_to) {
  text::CsvRow(text) << from << to << f.value << f.lower << f.upper << to_string(f.claim) << to_string(f.way)
                     << std::string_view(f.accurate ? "yes" : "no") << f.area_from << area_to << f.cells
                     << f.event_cells << to_string(f.limit);
}

std::string csv_text(const Scene& scene, const Matrix& matrix, const ViewFactorOptions& options) {
  const Factors& all = matrix.factors;
  std::string text = csv_comments(scene, all.from, all.to, options,
                                  {!matrix.back.empty(), !matrix.open.empty(), !matrix.buried.empty()});
  text += std::string(kColumns) + '\n';
  for (std::size_t i = 0; i < all.from.size(); ++i) {
    const std::string from = scene.name_of(all.from[i]);
    for (std::size_t j = 0; j < all.to.size(); ++j) {
      add_csv_row(text, from, scene.name_of(all.to[j]), all.at(i, j), all.at(i, j).area_to);
    }
    if (!matrix.back.empty()) add_csv_row(text, from, kBack, matrix.back[i], matrix.back[i].area_to);
    if (!matrix.open.empty()) add_csv_row(text, from, kOpen, matrix.open[i], std::nullopt);
    if (!matrix.buried.empty()) add_csv_row(text, from, kBuried, matrix.buried[i], std::nullopt);
  }
  return text;
}

}  // namespace exactff::matrix
