// exactff radiosity: the light that leaves each patch after all bounces.
#include "exactff/radiosity.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "cli/commands.h"
#include "cli/output.h"
#include "cli/process.h"
#include "cli/view_factor_words.h"
#include "exactff/jobs.h"
#include "exactff/version.h"
#include "files/file.h"
#include "flags/scene.h"
#include "flags/values.h"
#include "radiosity/narrowing.h"
#include "scene/selections.h"
#include "text/escape.h"
#include "text/number_text.h"
#include "text/phrases.h"
#include "text/refuse.h"
#include "text/text_lines.h"
#include "vtk/vtk.h"

namespace exactff::cli {
namespace {

using radiosity::BoundedValue;
using radiosity::Channel;
using radiosity::kChannelNames;
using radiosity::Solution;

constexpr const char* kRadiosityFooter =
    "Solves B = E + rho F B for the radiosity B of each patch: E is Ke, rho is Kd, F are the view factors between all\n"
    "patches. B lies between lower and upper. These bounds are as strong as the claim, the weakest of the view\n"
    "factors'. There is no upper bound where the bounds of the view factors do not prove that less light is reflected\n"
    "than arrives, as in a closed room of Kd 1. The output then says why, 'radiosity' is an estimate (unknown, if\n"
    "some Kd is 1).\n"
    "The exit code is 3 without an upper bound, and if view factors miss the accuracy or bounds miss the width.\n"
    "Emitted light must be absorbed, meet backs of faces, or leave; if the bounds contradict this, the exit code is\n"
    "1. 'variation' shows where patches are too large: by how much the light that leaves single points of a patch\n"
    "(its centre, and near its corners), by exact form factors, differs from its one radiosity. --divide LENGTH makes\n"
    "smaller patches. `exactff render --radiosity FILE` shows the light of the file that -o writes.\n"
    "--width W asks for bounds of at most W times the brightest radiosity of their channel. Only the view factors\n"
    "that widen some bounds too much are computed again, with the accuracy divided by a power of two. If --budget\n"
    "does not allow the width, a warning says how wide the bounds are, and why.\n"
    "--matrix FILE takes the view factors from a file of `exactff matrix SCENE -o FILE`. That run can be resumed, and\n"
    "shared out by --shard and mpirun. A file of another scene is refused.\n"
    "With -o FILE, finished view factors are kept until all is done: in FILE.factors.part, and those that --width\n"
    "computes again in FILE.again.part. After an interruption, --resume continues from there. A complete\n"
    "FILE stays as it is, and the file of --vtk is made from it.\n"
    "The balance is printed as bounds [lower, upper]; a number alone is rounded to six digits. Lost light meets backs\n"
    "or leaves (open). One of the two is known where the other is proved to be zero. Elsewhere --backs computes what\n"
    "meets backs; a matrix made with --backs --to all,sky has both.\n"
    "--temperatures FILE solves the exchange of sigma T^4 between gray surfaces of emissivity 1 - Kd. Each patch has\n"
    "a row with its T in K, or with the heat Q in W that it gives off, 0 for one that only reflects and emits again.\n"
    "The rows (back) and (open) may have a T, which is else 0 K. Values are by the balanced matrix, if there is one.\n"
    "\n"
    "Examples:\n"
    "  exactff radiosity data/scenes/cornell_box.obj --accuracy 1e-4\n"
    "  exactff radiosity data/scenes/cornell_box.obj --accuracy 1e-4 -o build/box.csv --vtk build/box.vtp\n"
    "  exactff radiosity data/scenes/cornell_box.obj --divide 140 --width 1e-3 -o build/cells.csv";

constexpr std::size_t kMostPatchesShown = 40;

struct RadiosityArguments : KeptRun {
  flags::SceneArguments scene;
  std::vector<std::string> two_sided;
  radiosity::Options options;
  std::optional<double> accuracy;
  bool plain = false, json = false, csv = false;
  std::string output, vtk;
  std::string matrix;        // a file
  std::string temperatures;  // likewise, of conditions

  // While they are computed, view factors are kept beside the file of -o. A pipe or a device has no journal.
  // Whether FILE is there, and nothing that belongs to an unfinished one.
  [[nodiscard]] bool is_complete() const {
    return files::is_there(output) && !files::is_there(kept_factors()) &&
           !files::is_there(jobs::journal_of(kept_factors())) && !files::is_there(jobs::journal_of(kept_again()));
  }
  [[nodiscard]] bool keeps_work() const {
    std::error_code ignored;
    return !output.empty() && matrix.empty() && temperatures.empty() && !std::filesystem::is_other(output, ignored);
  }
  [[nodiscard]] std::string kept_factors() const { return flags::kept_factors_of(output); }
  [[nodiscard]] std::string kept_again() const { return flags::kept_again_of(output); }
  [[nodiscard]] bool for_people() const { return !plain && !json && !csv; }
  [[nodiscard]] radiosity::Origin origin() const { return {scene.divide, two_sided}; }
};

// --- For people ---

bool is_grey(const Scene& scene) {
  return std::ranges::all_of(scene.faces(), [&](const Face& face) {
    const Material& m = scene.material(face.material);
    const Rgb &kd = m.reflectance, &ke = m.radiosity;
    return kd.r == kd.g && kd.g == kd.b && ke.r == ke.g && ke.g == ke.b;
  });
}

std::string estimate_text(double value, int digits = 6) {
  return std::isnan(value) ? "unknown" : text::rounded(value, digits);
}

void print_radiosities(const Scene& scene, const Solution& solution, std::size_t channels) {
  TextTable table;
  table.add_column("patch");
  if (channels > 1) table.add_column("channel");
  table.add_columns({"radiosity", "lower", "upper", "irradiance", "variation"});
  const std::size_t count = std::min(solution.patches.size(), kMostPatchesShown);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t c = 0; c < channels; ++c) {
      const BoundedValue &b = solution.channels[c].radiosity[i], &h = solution.channels[c].irradiance[i];
      std::vector<std::string> cells{c == 0 ? shown_name(scene, solution.patches[i]) : ""};
      if (channels > 1) cells.emplace_back(kChannelNames[c]);
      for (const std::string& cell : {estimate_text(b.value), text::shortest(b.lower), text::shortest(b.upper),
                                      estimate_text(h.value), estimate_text(solution.channels[c].variation[i], 3)}) {
        cells.push_back(cell);
      }
      table.add_row(std::move(cells));
    }
  }
  table.print(std::cout);
  if (count < solution.patches.size()) {
    std::cout << "\n(the first " << count << " of " << solution.patches.size()
              << " patches; --plain, --csv and -o have all)\n";
  }
}

// Where the inequalities of the balance hold, no end is shown above what is emitted.
std::string part_text(const matrix::Sum& part, const matrix::Sum& emitted) {
  if (!std::isfinite(part.upper)) {
    return std::isfinite(part.lower) ? "at least " + text::shortest(part.lower) : "unknown";
  }
  if (part.upper > emitted.upper) return text::interval(part.lower, part.upper);
  return text::interval(part.lower, part.upper, emitted.upper);
}

void print_balance(const Solution& solution, std::size_t channels) {
  std::cout << "\nWhere the light goes, in the unit of Ke times area:\n";
  TextTable table;
  if (channels > 1) table.add_column("channel");
  table.add_columns({"emitted", "absorbed", "lost", "(back)", "(open)"});
  for (std::size_t c = 0; c < channels; ++c) {
    const radiosity::Balance& balance = solution.channels[c].balance;
    std::vector<std::string> cells;
    if (channels > 1) cells.emplace_back(kChannelNames[c]);
    for (const matrix::Sum& part : {balance.emitted, balance.absorbed, balance.lost, balance.back, balance.open}) {
      cells.push_back(part_text(part, balance.emitted));
    }
    table.add_row(std::move(cells));
  }
  table.print(std::cout);
}

void print_claims(const Solution& solution, bool balanced) {
  if (solution.is_bounded()) {
    std::cout << "\nThe bounds hold if those of the view factors do: these are "
              << (solution.claim == Claim::kZero ? "all proved to be zero" : to_string(solution.claim)) << ".\n";
  }
  const std::vector<std::string>& reasons = solution.reasons_against_balance;
  if (!reasons.empty()) {
    std::cout << "What is emitted need not be what arrives: " << text::enumerate(reasons) << ".\n";
  } else if (balanced && solution.lost_is_rest) {
    std::cout
        << "What is lost is what the view factors of each patch leave of 1; within their bounds, no sum exceeds 1.\n";
  } else if (balanced) {
    std::cout << "Within the bounds, what is emitted is what is absorbed, meets backs or leaves.\n";
  }
}

// The patch over which radiosity varies most, if bounds do not leave as much open.
void print_variation(const Scene& scene, const Solution& solution, std::size_t channels) {
  double most = 0.0;
  std::string words;
  for (std::size_t c = 0; c < channels; ++c) {
    const Channel& channel = solution.channels[c];
    for (std::size_t i = 0; i < solution.patches.size(); ++i) {
      const BoundedValue& b = channel.radiosity[i];
      const bool is_within_bounds = channel.is_bounded() && channel.variation[i] <= b.upper - b.lower;
      if (!(channel.variation[i] > most) || is_within_bounds) continue;
      most = channel.variation[i];
      words = shown_name(scene, solution.patches[i]) +
              (channels > 1 ? ", " + std::string(kChannelNames[c]) : std::string());
    }
  }
  if (most == 0.0) return;
  std::cout << "\nWithin a patch, radiosity varies by up to " << text::rounded(most) << " (" << words
            << "): smaller patches, by --divide, come closer to the true light.\n";
}

// Grey scenes are shown by one channel.
std::size_t channels_of(const Scene& scene) { return is_grey(scene) ? 1 : kChannelNames.size(); }

void print_for_people(const Scene& scene, const Solution& solution, bool balanced) {
  const std::size_t channels = channels_of(scene);
  print_radiosities(scene, solution, channels);
  print_variation(scene, solution, channels);
  print_balance(solution, channels);
  print_claims(solution, balanced);
}

// --- For programs ---

void print_plain(const Scene& scene, const Solution& solution) {
  for (std::size_t i = 0; i < solution.patches.size(); ++i) {
    for (std::size_t c = 0; c < kChannelNames.size(); ++c) {
      const Channel& channel = solution.channels[c];
      const BoundedValue& b = channel.radiosity[i];
      std::cout << shown_name(scene, solution.patches[i]) << '\t' << kChannelNames[c] << '\t' << text::shortest(b.value)
                << '\t' << text::shortest(b.lower) << '\t' << text::shortest(b.upper) << '\t'
                << claim_text(solution, channel) << '\n';
    }
  }
}

// What is not known is left out.
nlohmann::ordered_json to_json(const BoundedValue& q) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  if (std::isfinite(q.value)) json["value"] = q.value;
  json["lower"] = q.lower;
  if (std::isfinite(q.upper)) json["upper"] = q.upper;
  return json;
}

nlohmann::ordered_json to_json(const matrix::Sum& sum) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  if (std::isfinite(sum.lower)) json["lower"] = sum.lower;
  if (std::isfinite(sum.upper)) json["upper"] = sum.upper;
  return json;
}

nlohmann::ordered_json channel_json(const Solution& solution, const Channel& channel) {
  const radiosity::Balance& balance = channel.balance;
  nlohmann::ordered_json json = {{"claim", claim_text(solution, channel)}};
  if (!channel.is_bounded()) json["no_bound"] = channel.no_bound;
  json["balance"] = {{"emitted", to_json(balance.emitted)},
                     {"absorbed", to_json(balance.absorbed)},
                     {"lost", to_json(balance.lost)},
                     {"back", to_json(balance.back)},
                     {"open", to_json(balance.open)}};
  return json;
}

void print_json(const RadiosityArguments& args, const Scene& scene, const Solution& solution) {
  nlohmann::ordered_json json = {{"program", "exactff"},
                                 {"version", kVersion},
                                 {"scene", args.scene.path},
                                 {"scene_hash", scene.hash()},
                                 {"accuracy", args.options.factors.accuracy},
                                 {"budget", args.options.factors.budget},
                                 {"claim_of_balance", to_string(solution.claim_of_balance)}};
  if (solution.width) {
    json["width"] = *solution.width;
    json["view_factors_computed_again"] = solution.computed_again;
  }
  json["reasons_against_balance"] = solution.reasons_against_balance;
  json["channels"] = nlohmann::ordered_json::object();
  for (std::size_t c = 0; c < kChannelNames.size(); ++c) {
    json["channels"][std::string(kChannelNames[c])] = channel_json(solution, solution.channels[c]);
  }
  json["patches"] = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < solution.patches.size(); ++i) {
    nlohmann::ordered_json patch = {{"patch", scene.name_of(solution.patches[i])}, {"area", solution.areas[i]}};
    for (std::size_t c = 0; c < kChannelNames.size(); ++c) {
      const Channel& channel = solution.channels[c];
      nlohmann::ordered_json& entry = patch[std::string(kChannelNames[c])];
      entry = {{"radiosity", to_json(channel.radiosity[i])}, {"irradiance", to_json(channel.irradiance[i])}};
      if (std::isfinite(channel.variation[i])) entry["variation"] = channel.variation[i];
    }
    json["patches"].push_back(std::move(patch));
  }
  std::cout << text::json_document(json) << '\n';
}

// --- The command ---

void check_outputs(const RadiosityArguments& args) {
  if (args.resume && args.output.empty()) {
    text::refuse("--resume is given without -o", "finished view factors are kept beside the file of -o",
                 "name a file, for example -o radiosities.csv");
  }
  const bool may_replace = args.existing() != jobs::Existing::kRefuse;
  if (!args.output.empty()) require_free_file(args.output, may_replace);
  if (args.keeps_work()) jobs::require_free(args.kept_factors(), args.existing());
  check_output_files({{"--vtk", args.vtk}}, may_replace);
}

// Before anything is computed.
void require_light(const RadiosityArguments& args, const Scene& scene, const std::vector<Selection>& patches) {
  const bool any_emits = std::ranges::any_of(patches, [&](const Selection& patch) { return emits(scene, patch); });
  if (any_emits) return;
  const auto says_nothing = [](const Material& m) { return m.reflectance == Rgb{1, 1, 1} && m.radiosity == Rgb{}; };
  text::refuse(
      args.scene.path, "no patch emits light", "every radiosity would be 0",
      std::ranges::all_of(scene.materials(), says_nothing)
          ? "the scene has no materials, so Kd is 1 everywhere: exactff convert writes an OBJ file with an MTL "
            "file, in which each material gets its Kd and some a Ke; for view factors alone, use exactff matrix"
          : "give some material a Ke; for view factors alone, use exactff matrix");
}

void warn_of_no_bound(const Solution& solution) {
  for (std::size_t c = 0; c < kChannelNames.size(); ++c) {
    const Channel& channel = solution.channels[c];
    if (channel.is_bounded()) continue;
    const bool is_estimated = std::ranges::none_of(
        channel.radiosity, [](double value) { return std::isnan(value); }, &BoundedValue::value);
    print_warning("there is no bound for " + std::string(kChannelNames[c]) +
                      (is_estimated ? ", and what is printed is an estimate" : ", nor an estimate"),
                  channel.no_bound, channel.remedy);
  }
}

// Whether the balance holds, or cannot be tested.
bool test_balance(const Solution& solution) {
  if (!solution.reasons_against_balance.empty() || is_balanced(solution)) return true;
  print_warning("what is emitted is not what is absorbed, meets backs and leaves",
                solution.claim_of_balance == Claim::kEstimated
                    ? "an estimated view factor misses its interval, or a bound does not hold"
                    : "it must be, so a bound of a view factor does not hold",
                "please report the scene");
  return false;
}

void print_files(const RadiosityArguments& args) {
  if (!args.output.empty()) std::cout << "Radiosities: " << text::printable(args.output) << '\n';
  if (!args.vtk.empty()) std::cout << "VTK file: " << text::printable(args.vtk) << '\n';
}

void print(const RadiosityArguments& args, const Scene& scene, const Solution& solution, bool balanced) {
  if (args.plain) {
    print_plain(scene, solution);
  } else if (args.json) {
    print_json(args, scene, solution);
  } else if (args.csv) {
    std::cout << table::csv_text(table_of(scene, solution, args.options.factors, args.origin()));
  } else {
    print_for_people(scene, solution, balanced);
    print_files(args);
  }
}

// Nothing if it was interrupted.
std::optional<matrix::Matrix> kept_view_factors(const RadiosityArguments& args, const matrix::Request& request) {
  const std::string file = args.kept_factors();
  Narrator narrator("pair");
  const bool done = narrator.is_done(file, [&] {
    const InterruptWatch watch(words_of_interruption("pair", file));
    (void)matrix::write(request, file, args.existing(), narrator.hooks(kNeverSlow));
  });
  if (!done) return std::nullopt;
  narrator.clear();
  return matrix::read(request, file);
}

// Computed, or of the file; `options` are then those of the file. Nothing if kept_view_factors were interrupted.
std::optional<matrix::Matrix> view_factors_of(const RadiosityArguments& args, const Scene& scene,
                                              const std::vector<Selection>& patches, const Hooks& hooks,
                                              ViewFactorOptions& options) {
  if (args.matrix.empty()) {
    const matrix::Options of_matrix = radiosity::matrix_options(args.options);
    if (!args.keeps_work()) return matrix::compute(scene, patches, patches, of_matrix, hooks);
    return kept_view_factors(args,
                             {.scene = &scene, .from = patches, .to = patches, .options = of_matrix, .shard = {}});
  }
  return matrix_in_file(args.matrix, scene, patches, patches, options);
}

// Solves, and computes view factors again where a width is wanted.
Solution solve(const RadiosityArguments& args, const Scene& scene, matrix::Matrix& matrix, const Hooks& hooks) {
  std::optional<jobs::Journal> journal;
  if (args.keeps_work() && args.options.width) {
    journal.emplace(jobs::journal_of(args.kept_again()), args.existing());
  }
  Solution solution = radiosity::solve_within(scene, matrix, args.options, journal ? &*journal : nullptr, hooks);
  radiosity::set_variation(scene, solution, args.options.threads, hooks);
  return solution;
}

Solution solve_or_tell_what_is_kept(const RadiosityArguments& args, const Scene& scene, matrix::Matrix& matrix,
                                    const Hooks& hooks) {
  try {
    return solve(args, scene, matrix, hooks);
  } catch (const Cancelled&) {
    if (args.keeps_work()) {
      std::cerr << "note: all finished view factors are kept beside " + text::printable(args.output) +
                       "; to continue, run the same command with --resume\n";
    }
    throw;
  }
}

// Whether the bounds are as narrow as is wanted.
bool are_wide_bounds(const Solution& solution) {
  return solution.width && solution.is_bounded() && radiosity::widest_bounds(solution).share > *solution.width;
}

void warn_of_wide_bounds(const RadiosityArguments& args, const Scene& scene, const Solution& solution,
                         const matrix::Matrix& matrix) {
  if (!are_wide_bounds(solution)) return;
  const radiosity::Widest widest = radiosity::widest_bounds(solution);
  const auto is_at_limit = [](const ViewFactor& f) { return f.limit != Limit::kNone; };
  const auto limited = static_cast<std::uint64_t>(std::ranges::count_if(matrix.factors.entries, is_at_limit));
  print_warning("the bounds of '" + scene.name_of(solution.patches[widest.patch]) + "' in " +
                    std::string(kChannelNames[widest.channel]) + " are " + text::short_number(widest.share, 2) +
                    " of the brightest radiosity wide, the widest of all, and not " + text::shortest(*solution.width),
                text::counted(limited, "view factor is", "view factors are") + " as narrow as " +
                    text::counted(args.options.factors.budget, "cell") + ", or roundings, allow",
                "give more by --budget, or ask for less by --width");
}

// A width decides alone.
int exit_code_of(const Solution& solution) {
  const bool is_wide = solution.width ? are_wide_bounds(solution) : solution.wide > 0;
  return solution.is_bounded() && !is_wide ? 0 : kNotAsAsked;
}

void require_same_request(const RadiosityArguments& args, const radiosity::SolutionFile& file) {
  ViewFactorOptions options = args.options.factors;
  if (!args.matrix.empty()) options = matrix::options_of(matrix::read_named(args.matrix).head);
  const bool is_same = file.options.accuracy == options.accuracy && file.options.budget == options.budget &&
                       file.width == args.options.width &&
                       (!options.certify || matrix::weaker(file.claim, Claim::kCertified) == Claim::kCertified);
  if (is_same) return;
  text::refuse(file.file, "holds radiosities by other view factors",
               "its head has another accuracy, budget, width or claim",
               "use the same flags as before, name another file, or compute it again with --force");
}

// FILE is complete and stays as it is. It has no balance.
int finish_again(const RadiosityArguments& args, const Scene& scene) {
  const std::filesystem::path path = args.output;
  if (args.json) {
    text::refuse(path, "is complete, and --json is given", "the balance is not in the file",
                 "leave out --json, or compute it again with --force");
  }
  const radiosity::SolutionFile file = radiosity::read_solution(path);
  const Solution solution = radiosity::solution_of(scene, file);
  require_same_request(args, file);
  if (!args.vtk.empty()) write_vtk(scene, solution, args.vtk);
  std::cerr << "note: " << text::printable(args.output) << " is complete and stays as it is; --force makes it anew\n";
  warn_of_no_bound(solution);
  if (args.plain) {
    print_plain(scene, solution);
  } else if (args.csv) {
    std::cout << text::read_text_file(path, "a CSV file");
  } else {
    print_radiosities(scene, solution, channels_of(scene));
    print_variation(scene, solution, channels_of(scene));
    print_files(args);
  }
  check_output(std::cout);
  return exit_code_of(solution);
}

// --- Temperatures ---

std::string bounded_text(const BoundedValue& q) {
  return q.lower == q.upper ? text::shortest(q.value) : text::interval(q.lower, q.upper);
}

void print_temperatures(const Scene& scene, const radiosity::Temperatures& found) {
  TextTable table;
  table.add_column("patch");
  table.add_columns({"T / K", "lower", "upper", "Q / W", "lower", "upper"});
  const std::size_t count = std::min(found.patches.size(), kMostPatchesShown);
  for (std::size_t i = 0; i < count; ++i) {
    const BoundedValue &t = found.temperatures[i], &q = found.heats[i];
    table.add_row({shown_name(scene, found.patches[i]), text::short_number(t.value, 6), text::shortest(t.lower),
                   text::shortest(t.upper), text::short_number(q.value, 6), text::shortest(q.lower),
                   text::shortest(q.upper)});
  }
  table.print(std::cout);
  if (count < found.patches.size()) {
    std::cout << "\n(the first " << count << " of " << found.patches.size() << " patches; --csv and -o have all)\n";
  }
  std::cout << "\nBalance: " << text::short_number(found.unbalanced.value, 2)
            << " W of all heat is unaccounted for, within " << bounded_text(found.unbalanced)
            << " by the bounds.\nHeat to (back): " << bounded_text(found.to_back)
            << " W, to (open): " << bounded_text(found.to_open)
            << " W. The bounds hold if those of the view factors do: " << to_string(found.claim) << ".\n";
  if (scene.unit() == Unit::kNone) std::cout << "Lengths count as metres; --unit states another unit.\n";
}

// Values by the balanced matrix, if there is one: then no heat is made.
void balance_if_possible(const Scene& scene, matrix::Matrix& matrix) {
  if (!reasons_against_one(scene, matrix).empty()) return;
  const matrix::Balanced balanced = matrix::balanced(scene, matrix);
  if (balanced.is_found()) matrix = with_values(std::move(matrix), balanced);
}

int run_temperatures(const RadiosityArguments& args, const Scene& scene) {
  if (!args.vtk.empty()) {
    text::refuse("--vtk is given with --temperatures", "that file shows radiosities", "write a table by -o");
  }
  const std::vector<Selection> patches = radiosity::patches_of(scene);
  const radiosity::ThermalConditions conditions = radiosity::read_conditions(scene, args.temperatures);
  ViewFactorOptions options = args.options.factors;
  ProgressBar bar;
  const Hooks hooks = bar.hooks();
  matrix::Matrix matrix =
      args.matrix.empty()
          ? matrix::compute(scene, patches, patches,
                            {.factors = options, .backs = true, .open = true, .threads = args.options.threads}, hooks)
          : matrix_in_file(args.matrix, scene, patches, patches, options);
  bar.clear();
  const std::vector<Problem> wide = problems_of_width(scene, matrix, options);
  print_warnings(wide);
  balance_if_possible(scene, matrix);
  const radiosity::Temperatures found = radiosity::temperatures(scene, matrix, conditions);
  if (!found.is_bounded()) {
    print_warning("temperatures have no bound, and none is printed", found.no_bound, found.remedy);
    return kNotAsAsked;
  }
  const table::Table table = table_of(scene, found, options);
  if (!args.output.empty()) write_whole_file(args.output, table::csv_text(table));
  if (args.csv) {
    std::cout << table::csv_text(table);
  } else {
    print_temperatures(scene, found);
    if (!args.output.empty()) std::cout << "Temperatures: " << text::printable(args.output) << '\n';
  }
  check_output(std::cout);
  return wide.empty() ? 0 : kNotAsAsked;
}

int run(const RadiosityArguments& given) {
  RadiosityArguments args = given;
  if (args.options.width) args.options.factors.accuracy = radiosity::accuracy_for(*args.options.width);
  if (args.accuracy) args.options.factors.accuracy = *args.accuracy;
  check_outputs(args);
  const Scene scene = load(args.scene, args.two_sided);
  if (!args.temperatures.empty()) return run_temperatures(args, scene);
  if (args.resume && args.is_complete()) return finish_again(args, scene);
  const std::vector<Selection> patches = radiosity::patches_of(scene);
  require_light(args, scene, patches);
  if (const auto overlaps = problem_of_overlaps(scene, patches)) print_warnings(std::span(&*overlaps, 1));
  ProgressBar bar;
  const Hooks hooks = bar.hooks();
  std::optional<matrix::Matrix> matrix = view_factors_of(args, scene, patches, hooks, args.options.factors);
  if (!matrix) return exit_code_of_interruption();
  const Solution solution = solve_or_tell_what_is_kept(args, scene, *matrix, hooks);
  bar.clear();
  if (solution.width) {
    warn_of_wide_bounds(args, scene, solution, *matrix);
  } else {
    matrix->back.clear();
    matrix->open.clear();
    print_warnings(problems_of_width(scene, *matrix, args.options.factors));
  }
  if (!args.output.empty())
    write_whole_file(args.output, table::csv_text(table_of(scene, solution, args.options.factors, args.origin())));
  if (args.keeps_work()) {
    std::filesystem::remove(args.kept_factors());
    std::filesystem::remove(jobs::journal_of(args.kept_again()));
  }
  if (!args.vtk.empty()) write_vtk(scene, solution, args.vtk);
  const bool balanced = test_balance(solution);
  warn_of_no_bound(solution);
  print(args, scene, solution, balanced);
  check_output(std::cout);
  return balanced ? exit_code_of(solution) : 1;
}

void add_outputs(CLI::App& command, RadiosityArguments& args) {
  auto* plain = command.add_flag(
      "--plain", args.plain,
      "Print a line for each patch and channel: PATCH, CHANNEL, RADIOSITY, LOWER, UPPER, CLAIM, with tabs");
  auto* json = command.add_flag("--json", args.json, "Print JSON");
  auto* csv = command.add_flag("--csv", args.csv, "Print CSV");
  plain->excludes(json)->excludes(csv);
  json->excludes(csv);
  flags::add_written(command, "-o,--output", args.output, "Write a CSV file", flags::Format::kCsv,
                     flags::Beside::kViewFactors);
  flags::add_written(command, "--vtk", args.vtk,
                     "Write the scene with its radiosities for ParaView, as NAME.vtp or NAME.vtu", flags::Format::kVtk);
  args.add_to(command, "Start again and replace existing files",
              "Continue an interrupted run with its kept view factors, or keep a complete file; needs -o");
}

}  // namespace

Command add_radiosity(CLI::App& app) {
  auto args = std::make_shared<RadiosityArguments>();
  CLI::App* command =
      app.add_subcommand("radiosity", "Compute the light that leaves each patch after all bounces, with bounds");
  command->footer(kRadiosityFooter);
  args->scene.add_to(*command);
  args->scene.add_divide_to(*command);
  flags::add_value(*command, "--two-sided", args->two_sided, "NAME", kTwoSidedHelp);
  CLI::Option* accuracy =
      command->add_option("--accuracy", args->accuracy, "Largest width of a view factor, for F_ij and for F_ji")
          ->default_str("1e-06, or four times --width");
  CLI::Option* budget = command->add_option("--budget", args->options.factors.budget, kBudgetHelp)
                            ->check(CLI::Range(std::size_t{1}, std::size_t{1} << 32))
                            ->capture_default_str();
  flags::add_value(*command, "--width", args->options.width, "FLOAT",
                   "Largest width of the bounds of a radiosity, as a share of the brightest of its channel")
      ->check(flags::is_positive);
  CLI::Option* backs =
      command->add_flag("--backs", args->options.backs, "Also compute what meets the backs of faces, for the balance");
  const ClaimOptions claims = add_claim(*command, args->options.factors.certify);
  flags::add_read(*command, "--matrix", args->matrix, "Take the view factors from this file of exactff matrix")
      ->excludes(accuracy)
      ->excludes(budget)
      ->excludes(backs)
      ->excludes(claims.claim)
      ->excludes(claims.certify);
  add_outputs(*command, *args);
  CLI::Option* temperatures = flags::add_read(
      *command, "--temperatures", args->temperatures,
      "Compute temperatures and heats instead: a CSV file with patch, T (in K) or Q (in W); the scene is in "
      "metres");
  for (const char* other : {"--width", "--json", "--plain", "--resume"}) {
    temperatures->excludes(command->get_option(other));
  }
  flags::add_threads(*command, args->options.threads);
  return {command, [args] { return run(*args); }};
}

}  // namespace exactff::cli
