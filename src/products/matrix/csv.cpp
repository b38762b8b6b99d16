#include "matrix/csv.h"

#include <cstdint>
#include <utility>

#include "exactff/version.h"
#include "text/csv_row.h"
#include "text/fnv1a.h"
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

std::string first_comments(const Scene& scene, std::span<const Selection> from, std::span<const Selection> to,
                           const std::string& effort) {
  text::Fnv1a patches;
  add(patches, from);
  add(patches, to);
  return "# exactff " + std::string(kVersion) +
         " matrix: view factors from patch to patch, areas in the scene's unit squared\n# scene hash " + scene.hash() +
         "; " + effort + "\n# " + text::counted(from.size(), "row") + ", " + text::counted(to.size(), "column") +
         ", hash of the patches " + patches.digits();
}

std::string names_beside(Surroundings surroundings) {
  return std::string(surroundings.back ? ", " : "") + std::string(surroundings.back ? kBack : "") +
         (surroundings.open ? ", " : "") + std::string(surroundings.open ? kOpen : "");
}

Surroundings surroundings_of(const Matrix& matrix) { return {!matrix.back.empty(), !matrix.open.empty()}; }

std::string with_rows(std::string text, const Scene& scene, const Matrix& matrix) {
  const Factors& all = matrix.factors;
  text += std::string(kColumns) + '\n';
  for (std::size_t i = 0; i < all.from.size(); ++i) {
    const std::string from = scene.name_of(all.from[i]);
    for (std::size_t j = 0; j < all.to.size(); ++j) {
      add_csv_row(text, from, scene.name_of(all.to[j]), all.at(i, j), all.at(i, j).area_to);
    }
    if (!matrix.back.empty()) add_csv_row(text, from, kBack, matrix.back[i], matrix.back[i].area_to);
    if (!matrix.open.empty()) add_csv_row(text, from, kOpen, matrix.open[i], std::nullopt);
  }
  return text;
}

}  // namespace

std::string csv_comments(const Scene& scene, std::span<const Selection> from, std::span<const Selection> to,
                         const ViewFactorOptions& options, Surroundings surroundings) {
  std::string text = first_comments(
      scene, from, to,
      "accuracy " + text::shortest(options.accuracy) + ", budget " + std::to_string(options.budget) + " cells");
  if (options.certify) text += ", certify";
  if (options.both_directions) text += ", both directions";
  if (!options.sample_crowds) text += ", no entry by points";
  return text + names_beside(surroundings) + '\n';
}

void add_csv_row(std::string& text, const std::string& from, std::string_view to, const ViewFactor& f,
                 std::optional<double> area_to) {
  text::CsvRow(text) << from << to << f.value << f.lower << f.upper << to_string(f.claim) << to_string(f.way)
                     << std::string_view(f.accurate ? "yes" : "no") << f.area_from << area_to << f.cells
                     << f.event_cells << to_string(f.limit);
}

std::string csv_text(const Scene& scene, const Matrix& matrix, const ViewFactorOptions& options) {
  const Factors& all = matrix.factors;
  return with_rows(csv_comments(scene, all.from, all.to, options, surroundings_of(matrix)), scene, matrix);
}

std::string csv_text(const Scene& scene, const Matrix& draft, const DraftOptions& options) {
  const std::string effort = "accuracy " + text::shortest(options.accuracy) + ", a draft of at least " +
                             text::counted(options.views, "view") + " in each row";
  return with_rows(
      first_comments(scene, draft.factors.from, draft.factors.to, effort) + names_beside(surroundings_of(draft)) + '\n',
      scene, draft);
}

}  // namespace exactff::matrix
