#include "cli/view_factor_words.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <iostream>

#include "cli/output.h"
#include "exactff/slips.h"
#include "flags/values.h"
#include "text/escape.h"
#include "text/names.h"
#include "text/phrases.h"
#include "text/refuse.h"
#include "text/text_lines.h"

namespace exactff::cli {
namespace {

struct Wide {
  std::size_t row = 0;
  std::string to;
  double width = 0.0, back = 0.0;  // of this direction, and of the other one

  [[nodiscard]] double widest() const { return std::max(width, back); }
};

std::vector<Wide> wide_entries(const Scene& scene, const matrix::Matrix& matrix, Limit limit) {
  std::vector<Wide> wide;
  const matrix::Factors& all = matrix.factors;
  const auto look_at = [&](std::size_t row, const auto& name, const ViewFactor& f, double area_to) {
    if (f.accurate || f.limit != limit) return;
    const double width = f.upper - f.lower;
    wide.push_back({row, name(), width, area_to > 0.0 ? width * (f.area_from / area_to) : 0.0});
  };
  for (std::size_t i = 0; i < all.from.size(); ++i) {
    for (std::size_t j = 0; j < all.to.size(); ++j) {
      look_at(
          i, [&] { return text::in_quotes(scene.name_of(all.to[j])); }, all.at(i, j), all.at(i, j).area_to);
    }
    if (!matrix.back.empty())
      look_at(
          i, [] { return std::string(matrix::kBack); }, matrix.back[i], matrix.back[i].area_to);
    if (!matrix.open.empty())
      look_at(
          i, [] { return std::string(matrix::kOpen); }, matrix.open[i], 0.0);
  }
  std::ranges::stable_sort(wide, std::ranges::greater(), &Wide::widest);
  return wide;
}

// Its width or, if only the other direction is wider than the accuracy, that one's.
std::string words_of(const Wide& one, double accuracy) {
  if (one.width > accuracy || one.back <= accuracy) return text::short_number(one.width, 2);
  return text::short_number(one.back, 2) + " from there";
}

// "2 entries are wider than the accuracy 0.001: 'floor' to 'light' (0.004), 'floor' to 'plant' (0.002 from there)"
std::string words_of_wide(const Scene& scene, const matrix::Matrix& matrix, const std::vector<Wide>& wide,
                          double accuracy) {
  constexpr std::size_t kMostNamed = 3;
  std::vector<std::string> named;
  for (const Wide& one : wide) {
    if (named.size() == kMostNamed) break;
    named.push_back(fmt::format("{} to {} ({})", text::in_quotes(scene.name_of(matrix.factors.from[one.row])), one.to,
                                words_of(one, accuracy)));
  }
  if (wide.size() > kMostNamed) named.emplace_back("...");
  return fmt::format("{} wider than the accuracy {}: {}",
                     text::counted(static_cast<std::uint64_t>(wide.size()), "entry is", "entries are"),
                     text::shortest(accuracy), text::joined(named, ", "));
}

std::string why(Limit limit, std::size_t budget) {
  switch (limit) {
    case Limit::kBudget:
      return "the limit of work for an entry, " + text::counted(budget, "cell") +
             " and four points for each, is reached";
    case Limit::kCrowd:
      return "so much stands between that its cells would not fit into memory";
    case Limit::kRounding:
      return "what is left of their errors are roundings of doubles";
    case Limit::kNone:
      break;
  }
  return "the file does not tell why";
}

std::string what_helps(Limit limit, bool certify) {
  const std::string estimates = ", or take estimates instead of --certify";
  switch (limit) {
    case Limit::kBudget:
    case Limit::kNone:
      return fmt::format("give more by --budget, ask for less by --accuracy, {}divide patches by --divide{}",
                         certify ? "" : "or ", certify ? estimates : "");
    case Limit::kCrowd:
      return "divide patches by --divide" + (certify ? estimates : "");
    case Limit::kRounding:
      return "ask for less by --accuracy" + (certify ? estimates : "");
  }
  return {};
}

}  // namespace

Scene load(const flags::SceneArguments& args, const std::vector<std::string>& two_sided) {
  flags::SceneArguments undivided = args;
  const std::optional<double> length = std::exchange(undivided.divide, {});
  Scene scene = undivided.load();
  const auto with_backs = [&] { return matrix::with_two_sided(scene, flags::selections_named(scene, two_sided)); };
  // Of a divided scene, names may be those of cells.
  if (two_sided.empty()) {
    print_warnings(slips::warnings_of_fronts(scene));
  } else if (!length) {
    print_warnings(slips::warnings_of_fronts(with_backs()));
  }
  if (length) scene = flags::divided_with_note(scene, *length);
  print_warnings(scene.warnings());
  if (!two_sided.empty()) scene = with_backs();
  print_hidden_faces(scene);
  return scene;
}

std::optional<Problem> problem_of_overlaps(const Scene& scene, std::span<const Selection> columns) {
  std::vector<slips::Overlap> overlaps = slips::overlapping_fronts(scene, columns);
  std::erase_if(overlaps, [](const slips::Overlap& one) { return one.apart > 0.0; });
  if (overlaps.empty()) return std::nullopt;
  return slips::warning_of_overlaps(scene, overlaps);
}

matrix::Matrix matrix_in_file(const std::string& file, const Scene& scene, const std::vector<Selection>& from,
                              const std::vector<Selection>& to, ViewFactorOptions& options) {
  matrix::NamedMatrix named = matrix::read_named(file);
  if (named.head.text("scene_hash") != scene.hash()) {
    text::refuse(named.file, "holds the view factors of another scene", "its head has another hash",
                 "give the same scene, with the same --divide, --two-sided and --patches");
  }
  options = matrix::options_of(named.head);
  const matrix::Options as_there{.factors = options, .backs = !named.back.empty(), .open = !named.open.empty()};
  return matrix::matrix_of({.scene = &scene, .from = from, .to = to, .options = as_there, .shard = {}},
                           std::move(named));
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

std::vector<Problem> problems_of_width(const Scene& scene, const matrix::Matrix& matrix,
                                       const ViewFactorOptions& options) {
  std::vector<Problem> problems;
  for (const Limit limit : {Limit::kBudget, Limit::kCrowd, Limit::kRounding, Limit::kNone}) {
    const std::vector<Wide> wide = wide_entries(scene, matrix, limit);
    if (wide.empty()) continue;
    problems.push_back({.what = words_of_wide(scene, matrix, wide, options.accuracy),
                        .why = why(limit, options.budget) + "; their bounds are as strong as their claims",
                        .suggestion = what_helps(limit, options.certify)});
  }
  return problems;
}

void LateNote::follow(const Progress& progress) {
  if (!done_before_) done_before_ = progress.done;
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
  if (told_ || elapsed.count() < kLate || progress.total <= *done_before_) return;
  const double share_done =
      static_cast<double>(progress.done - *done_before_) / static_cast<double>(progress.total - *done_before_);
  const double left = elapsed.count() * (1.0 - share_done) / share_done;  // infinite as long as nothing is done
  if (left < kLate || (progress.slow.empty() && elapsed.count() < kNameable)) return;
  told_ = true;
  const std::string what = progress.slow.empty() ? "" : "It is slow " + text::printable(progress.slow) + ". ";
  const std::string clear_line = ::isatty(STDERR_FILENO) == 1 ? "\r\033[K" : "";
  std::cerr << clear_line + "note: this takes more than " + text::short_number(kLate) + " s. " + what + text_() + '\n';
}

std::string words_on_speed(const matrix::Request& request) {
  const ViewFactorOptions& factors = request.options.factors;
  constexpr double kCoarse = 1e-3;
  constexpr double kFine = 1e-9;  // below, certified entries cost less (validation/measurements.md)
  std::vector<std::string> ways;
  if (factors.certify && factors.accuracy >= kFine) ways.emplace_back("no --certify, so that errors are estimated");
  if (!factors.certify && factors.accuracy < kFine)
    ways.emplace_back("--certify, which needs fewer cells for so little");
  if (factors.both_directions) ways.emplace_back("no --both-directions");
  if (factors.accuracy < kCoarse) {
    ways.push_back(
        fmt::format("--accuracy {} instead of {}", text::short_number(kCoarse), text::shortest(factors.accuracy)));
  }
  ways.push_back(fmt::format("a smaller --budget than {}, for wider entries", factors.budget));
  if (request.options.backs) ways.emplace_back("no --backs");
  if (request.from.size() > 1) {
    ways.push_back(fmt::format("fewer rows than {} by --from", request.from.size()));
  }
  return "Faster: " + text::joined(ways, "; ");
}

}  // namespace exactff::cli
