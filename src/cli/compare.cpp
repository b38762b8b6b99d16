// exactff compare: the ray-sampled adaptive algorithm held against the exact values, as tables and a report.
#include <algorithm>
#include <charconv>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/engine_option.h"
#include "cli/long_run.h"
#include "cli/output.h"
#include "cli/scene_options.h"
#include "exactff/study.h"
#include "scene/number_text.h"
#include "scene/printable.h"
#include "scene/text_lines.h"
#include "study/text.h"

namespace exactff::cli {
namespace {

constexpr int kMostRays = 1 << 20;

constexpr const char* kFooter =
    "Every combination of the lists is run if there are at most 40; else every --eps-b with every --rays, and each\n"
    "other list on its own around the base (the middle --eps-b and --rays, the first of every other list).\n"
    "What the scene gives no work to is left out, and the report says what and why.\n"
    "Times are those of single calls; --threads 1 keeps them undisturbed.\n"
    "DIR is written whole or not at all; an earlier result of this command there is replaced.\n"
    "\n"
    "Example:\n"
    "  exactff compare data/scenes/cornell_box.obj --on floor --grid 32x32 -o cornell-report";

struct CompareArguments {
  SceneArguments scene;
  std::string on;
  std::string grid;
  std::string receivers;
  std::vector<std::string> sources;
  std::string eps_b, eps_a, rays, seeds, pattern, variant;
  EngineArgument engine;
  int threads = 0;
  std::string folder;
};

[[noreturn]] void refuse(std::string what, std::string why, std::string suggestion) {
  throw InputError(Problem{{}, 0, std::move(what), std::move(why), std::move(suggestion)});
}

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t comma = std::min(text.find(',', at), text.size());
    parts.push_back(text.substr(at, comma - at));
    at = comma + 1;
  }
  return parts;
}

double to_tolerance(const std::string& text, const std::string& flag) {
  const ParsedNumber number = parse_number(text);
  if (number.fault == NumberFault::kNone && number.value < 0.0) {
    refuse(flag + ": " + in_quotes(text) + " is negative", "a tolerance is not", "give 0 or more");
  }
  if (number.fault == NumberFault::kNone) return number.value;
  refuse(flag + ": " + describe(number.fault, text), "the list holds decimal numbers",
         "separate them by commas only, such as " + flag + " 1e-2,1e-3");
}

template <class Whole>
Whole to_whole(const std::string& text, const std::string& flag) {
  Whole value{};
  const auto end = std::from_chars(text.data(), text.data() + text.size(), value);
  if (!text.empty() && end.ec == std::errc{} && end.ptr == text.data() + text.size()) return value;
  refuse(flag + ": " + in_quotes(text) + " is not a whole number in range", "it counts or numbers something",
         "separate several by commas only, such as " + flag + " 1,4,16");
}

// An option that was not given is an empty list, which stands for the default.
template <class T, class Convert>
std::vector<T> list_of(const std::string& text, const std::string& flag, const Convert& convert) {
  std::vector<T> values;
  if (text.empty()) return values;
  constexpr std::size_t kMostValues = 1000;
  for (const std::string& part : split(text)) values.push_back(convert(part, flag));
  if (values.size() > kMostValues) {
    refuse(flag + " has " + std::to_string(values.size()) + " values", "every setting is run for every receiver",
           "give at most 1000, better a dozen");
  }
  return values;
}

int to_rays(const std::string& text, const std::string& flag) {
  const int rays = to_whole<int>(text, flag);
  if (rays >= 1 && rays <= kMostRays) return rays;
  refuse(flag + ": " + in_quotes(text) + " is not within 1 to " + std::to_string(kMostRays),
         "so many shadow rays are sent to every undecided leaf", "give numbers such as 1,4,16");
}

SamplePattern to_pattern(const std::string& text, const std::string& flag) {
  if (const auto pattern = study::pattern_named(text)) return *pattern;
  refuse(flag + ": there is no pattern " + in_quotes(text), "it says where rays end",
         "use centre, regular, jittered or low-discrepancy");
}

Variant to_variant(const std::string& text, const std::string& flag) {
  if (const auto variant = study::variant_named(text)) return *variant;
  refuse(flag + ": there is no variant " + in_quotes(text), "it says which algorithm is run", "use mended or literal");
}

study::Sweeps sweeps_of(const CompareArguments& args) {
  study::Sweeps sweeps;
  sweeps.eps_b = list_of<double>(args.eps_b, "--eps-b", to_tolerance);
  sweeps.eps_a = list_of<double>(args.eps_a, "--eps-a", to_tolerance);
  sweeps.rays = list_of<int>(args.rays, "--rays", to_rays);
  sweeps.seeds = list_of<std::uint64_t>(args.seeds, "--seeds", to_whole<std::uint64_t>);
  sweeps.patterns = list_of<SamplePattern>(args.pattern, "--pattern", to_pattern);
  sweeps.variants = list_of<Variant>(args.variant, "--variant", to_variant);
  return sweeps;
}

int to_cells(std::string_view text, const std::string& grid) {
  int count = 0;
  const auto end = std::from_chars(text.data(), text.data() + text.size(), count);
  if (!text.empty() && end.ec == std::errc{} && end.ptr == text.data() + text.size()) return count;
  refuse("--grid: " + in_quotes(grid) + " is no grid", "it is made of two whole numbers",
         "write columns x rows: --grid 32x32");
}

GridSize grid_of(const std::string& text) {
  const std::string_view view = text;
  const std::size_t cross = std::min(view.find('x'), view.size());
  return {to_cells(view.substr(0, cross), text), to_cells(view.substr(std::min(cross + 1, view.size())), text)};
}

// A name may hold a comma: the whole text is tried first.
void add_sources(const Scene& scene, const std::string& text, std::vector<Selection>& sources) {
  const std::vector<std::string> parts = split(text);
  if (parts.size() > 1) {
    try {
      sources.push_back(scene.select(text));
      return;
    } catch (const InputError&) {
      // Not one name, hence a list of them.
    }
  }
  for (const std::string& name : parts) sources.push_back(scene.select(name));
}

std::vector<Selection> sources_of(const CompareArguments& args, const Scene& scene) {
  std::vector<Selection> sources;
  for (const std::string& text : args.sources) add_sources(scene, text, sources);
  for (std::size_t i = 0; i < sources.size(); ++i) {
    if (std::find(sources.begin(), sources.begin() + static_cast<std::ptrdiff_t>(i), sources[i]) ==
        sources.begin() + static_cast<std::ptrdiff_t>(i)) {
      continue;
    }
    refuse("--source: '" + scene.name_of(sources[i]) + "' is named twice", "its light would count twice",
           "name it once");
  }
  return sources;
}

std::string command_line(const CompareArguments& args) {
  std::string line = "exactff compare " + shell_word(args.scene.path);
  const auto add = [&](const char* flag, const std::string& value) {
    if (!value.empty()) line += std::string(" ") + flag + ' ' + shell_word(value);
  };
  if (args.scene.patches != "groups") add("--patches", args.scene.patches);
  if (args.scene.skip_bad_faces) line += " --skip-bad-faces";
  add("--on", args.on);
  add("--grid", args.grid);
  add("--receivers", args.receivers);
  for (const std::string& source : args.sources) add("--source", source);
  add("--eps-b", args.eps_b);
  add("--eps-a", args.eps_a);
  add("--rays", args.rays);
  add("--seeds", args.seeds);
  add("--pattern", args.pattern);
  add("--variant", args.variant);
  if (args.engine.engine() != Engine::kEdges) add("--engine", args.engine.name);
  if (args.threads > 0) add("--threads", std::to_string(args.threads));
  add("-o", args.folder);
  return line;
}

study::Request request_of(const CompareArguments& args, const Scene& scene) {
  study::Request request;
  request.scene = &scene;
  request.scene_name = std::filesystem::path(args.scene.path).filename().string();
  request.sweeps = sweeps_of(args);
  request.sources = sources_of(args, scene);
  request.engine = args.engine.engine();
  request.threads = args.threads;
  request.command_line = command_line(args);
  if (!args.receivers.empty()) {
    request.receivers = read_receivers(args.receivers, scene);
    request.receivers_name = std::filesystem::path(args.receivers).filename().string();
  } else {
    request.receivers = grid_receivers(scene, scene.select(args.on), grid_of(args.grid));
    request.receivers_name = args.on + ", grid " + args.grid;
  }
  return request;
}

void check_flags(const CompareArguments& args) {
  if (args.receivers.empty() && (args.on.empty() || args.grid.empty())) {
    refuse("there are no receivers", "values are compared at points",
           "give --on NAME with --grid 32x32, or --receivers FILE.csv");
  }
  if (!args.receivers.empty() && !(args.on.empty() && args.grid.empty())) {
    refuse("--receivers comes with --on or --grid", "the receivers are those of the file, or those of the grid",
           "leave one of them out");
  }
}

int run(const CompareArguments& args) {
  check_flags(args);
  study::check_output_folder(args.folder);
  const Scene scene = args.scene.load();
  study::Request request = request_of(args, scene);
  const InterruptWatch watch;
  ProgressBar bar;
  const study::Hooks hooks{[&](const study::Progress& progress) { bar.show(progress); }, is_interrupted};
  std::vector<std::string> messages, sentences;
  try {
    const study::Study study = study::run(std::move(request), hooks);
    messages = study::write(study, args.folder, hooks);
    sentences = study::headlines(study);
  } catch (const study::Cancelled&) {
    bar.clear();
    std::cerr << "exactff: interrupted; nothing was written\n";
    return 128 + interrupting_signal();
  }
  bar.clear();
  for (const std::string& message : messages) std::cerr << "note: " << printable(message) << '\n';
  for (const std::string& sentence : sentences) std::cout << printable(sentence) << '\n';
  std::cout << "Report: " << (std::filesystem::path(args.folder) / "report.html").string() << '\n';
  check_output(std::cout);
  return 0;
}

}  // namespace

Command add_compare(CLI::App& app) {
  auto args = std::make_shared<CompareArguments>();
  CLI::App* command =
      app.add_subcommand("compare", "Error and time of the ray-sampled algorithm against the exact values");
  args->scene.add_to(*command);
  command->add_option("--on", args->on, "Patch or face (NAME or NAME:K) that carries the grid of receivers");
  command->add_option("--grid", args->grid, "Columns x rows of the grid, such as 32x32");
  command->add_option("--receivers", args->receivers, "CSV file with the columns id,x,y,z,nx,ny,nz,on");
  command
      ->add_option("--source", args->sources,
                   "Source patch; repeat it or separate names by commas (default: all that emit)")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command->add_option("--eps-b", args->eps_b, "Tolerances, radiosity (default: max(rho B) times 1e-1,...,1e-5)");
  command->add_option("--eps-a", args->eps_a,
                      "Smallest areas (default: 0 and the mean source face times 1e-1,...,1e-4)");
  command->add_option("--rays", args->rays, "Shadow rays per undecided leaf (default: 1,4,16,64,256)");
  command->add_option("--seeds", args->seeds, "Seeds (default: 1,...,10)");
  command->add_option("--pattern", args->pattern,
                      "Where rays end: jittered, centre, regular, low-discrepancy (default: all)");
  command->add_option("--variant", args->variant, "mended, literal (default: both)");
  args->engine.add_to(*command);
  command->add_option("--threads", args->threads, "Threads (default: all); values do not depend on it")
      ->check(CLI::Range(1, 4096));
  command->add_option("-o,--output", args->folder, "Folder for the tables and the report")->required();
  command->footer(kFooter);
  return {command, [args] { return run(*args); }};
}

}  // namespace exactff::cli
