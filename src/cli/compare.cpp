// exactff compare: the ray-sampled adaptive algorithm held against the exact values, as tables and a report.
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/engine_option.h"
#include "cli/lists.h"
#include "cli/long_run.h"
#include "cli/output.h"
#include "cli/receiver_options.h"
#include "cli/scene_options.h"
#include "cli/source_options.h"
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
  ReceiverArguments receivers;
  SourceArguments sources;
  std::string eps_b, eps_a, rays, seeds, pattern, variant;
  EngineArgument engine;
  int threads = 0;
  std::string folder;
};

[[noreturn]] void refuse(std::string what, std::string why, std::string suggestion) {
  throw InputError(Problem{{}, 0, std::move(what), std::move(why), std::move(suggestion)});
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
  if (const auto value = whole_number<Whole>(text)) return *value;
  refuse(flag + ": " + in_quotes(text) + " is not a whole number in range", "it counts or numbers something",
         "separate several by commas only, such as " + flag + " 1,4,16");
}

// An option that was not given is an empty list, which stands for the default.
template <class T, class Convert>
std::vector<T> list_of(const std::string& text, const std::string& flag, const Convert& convert) {
  std::vector<T> values;
  if (text.empty()) return values;
  constexpr std::size_t kMostValues = 1000;
  for (const std::string& part : split_list(text)) values.push_back(convert(part, flag));
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

std::string command_line(const CompareArguments& args) {
  std::string line = "exactff compare " + shell_word(args.scene.path);
  const auto add = [&](const char* flag, const std::string& value) {
    if (!value.empty()) line += std::string(" ") + flag + ' ' + shell_word(value);
  };
  if (args.scene.patches != "groups") add("--patches", args.scene.patches);
  if (args.scene.skip_bad_faces) line += " --skip-bad-faces";
  line += command_words(args.receivers) + command_words(args.sources);
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
  request.sources = sources_of(args.sources, scene);
  request.engine = args.engine.engine();
  request.threads = args.threads;
  request.command_line = command_line(args);
  ChosenReceivers chosen = receivers_of(args.receivers, scene, GridIds::kCells);
  request.receivers = std::move(chosen.receivers);
  request.receivers_name = std::move(chosen.description);
  return request;
}

int run(const CompareArguments& args) {
  check_receiver_options(args.receivers);
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
  add_receiver_options(*command, args->receivers);
  add_source_options(*command, args->sources);
  command->add_option("--eps-b", args->eps_b, "Tolerances, radiosity (default: max(rho B) times 1e-1,...,1e-5)")
      ->type_name("LIST");
  command
      ->add_option("--eps-a", args->eps_a, "Smallest areas (default: 0 and the mean source face times 1e-1,...,1e-4)")
      ->type_name("LIST");
  command->add_option("--rays", args->rays, "Shadow rays per undecided leaf (default: 1,4,16,64,256)")
      ->type_name("LIST");
  command->add_option("--seeds", args->seeds, "Seeds of the shadow rays (default: 1,...,10)")->type_name("LIST");
  command
      ->add_option("--pattern", args->pattern,
                   "Where rays end: jittered, centre, regular, low-discrepancy (default: all)")
      ->type_name("LIST");
  command->add_option("--variant", args->variant, "mended, literal (default: both)")->type_name("LIST");
  args->engine.add_to(*command);
  command->add_option("--threads", args->threads, "Threads (default: all); values do not depend on it")
      ->check(CLI::Range(1, 4096))
      ->type_name("N");
  command->add_option("-o,--output", args->folder, "Folder for the tables and the report")
      ->required()
      ->type_name("DIR");
  command->footer(kFooter);
  return {command, [args] { return run(*args); }};
}

}  // namespace exactff::cli
