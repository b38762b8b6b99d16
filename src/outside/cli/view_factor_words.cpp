#include "cli/view_factor_words.h"

#include <algorithm>

#include "cli/output.h"
#include "exactff/slips.h"
#include "flags/lists.h"
#include "text/phrases.h"

namespace exactff::cli {

namespace {

void warn_of_width(const matrix::Matrix& matrix, double accuracy, const std::string& spent, const std::string& more) {
  const auto wide_of = [](const std::vector<ViewFactor>& list) {
    return std::ranges::count_if(list, [](const ViewFactor& f) { return !f.accurate; });
  };
  const auto wide = wide_of(matrix.factors.entries) + wide_of(matrix.back) + wide_of(matrix.open);
  if (wide == 0) return;
  print_warnings(std::vector<Problem>{{.what = text::counted(static_cast<std::uint64_t>(wide), "entry", "entries") +
                                               (wide == 1 ? " is" : " are") + " wider than the accuracy " +
                                               text::shortest(accuracy),
                                       .why = spent + "; their bounds are as strong as their claims",
                                       .suggestion = more + ", or ask for less by --accuracy"}});
}

}  // namespace

Scene load(const flags::SceneArguments& args, const std::vector<std::string>& two_sided) {
  Scene scene = args.load();
  print_warnings(scene.warnings());
  if (two_sided.empty()) return scene;
  return matrix::with_two_sided(scene, flags::selections_named(scene, two_sided));
}

std::optional<Problem> problem_of_overlaps(const Scene& scene, std::span<const Selection> columns) {
  std::vector<slips::Overlap> overlaps = slips::overlapping_fronts(scene, columns);
  std::erase_if(overlaps, [](const slips::Overlap& one) { return one.apart > 0.0; });
  if (overlaps.empty()) return std::nullopt;
  return slips::warning_of_overlaps(scene, overlaps);
}

ClaimOptions add_claim(CLI::App& command, bool& certify) {
  ClaimOptions options;
  options.certify = command.add_flag("--certify", certify, "The same as --claim certified");
  options.claim =
      command
          .add_option_function<std::string>(
              "--claim", [&certify](const std::string& claim) { certify = claim == "certified"; },
              "What to claim of entries: estimated (the default), or certified, which proves the quadrature, too")
          ->type_name("CLAIM")
          ->check(CLI::IsMember({"estimated", "certified"}))
          ->excludes(options.certify);
  return options;
}

void warn_of_width(const matrix::Matrix& matrix, const ViewFactorOptions& options) {
  warn_of_width(matrix, options.accuracy,
                "the budget of " + std::to_string(options.budget) + " cells, or points, is used up",
                "give more by --budget");
}

void warn_of_width(const matrix::Matrix& draft, const matrix::DraftOptions& options) {
  warn_of_width(draft, options.accuracy, "a row has some " + std::to_string(options.views) + " views",
                "give more views by --views");
}

}  // namespace exactff::cli
