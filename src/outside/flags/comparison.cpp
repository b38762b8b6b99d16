#include "flags/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "flags/values.h"
#include "text/number_text.h"
#include "text/phrases.h"
#include "text/refuse.h"
#include "text/text_lines.h"

namespace exactff::flags {
namespace {

constexpr int kMostRays = 65536;  // as of the method

double to_tolerance(const std::string& text, const std::string& flag) {
  const text::ParsedNumber number = text::parse_number(text);
  if (number.fault == text::NumberFault::kNone && number.value < 0.0) {
    text::refuse(flag + ": " + text::in_quotes(text) + " is negative", "a tolerance cannot be negative",
                 "give 0 or more");
  }
  if (number.fault == text::NumberFault::kNone) return number.value;
  text::refuse(flag + ": " + describe(number.fault, text), "the list consists of decimal numbers",
               "separate them by commas without spaces, for example " + flag + " 1e-2,1e-3");
}

template <class Whole>
Whole to_whole(const std::string& text, const std::string& flag) {
  if (const auto value = whole_number<Whole>(text)) return *value;
  text::refuse(flag + ": " + text::in_quotes(text) + " is not a whole number in range",
               "this option counts or numbers something",
               "separate several numbers by commas without spaces, for example " + flag + " 1,4,16");
}

// The text of an option that was not given is empty, and so is its list, which stands for the default.
template <class T, class Convert>
std::vector<T> list_of(const std::string& text, const std::string& flag, const Convert& convert) {
  std::vector<T> values;
  if (text.empty()) return values;
  constexpr std::size_t kMostValues = 1000;
  for (const std::string& part : split_list(text)) values.push_back(convert(part, flag));
  if (values.size() > kMostValues) {
    text::refuse(fmt::format("{} has {} values", flag, values.size()), "every setting is run at every receiver",
                 "give at most 1000; a dozen is usually enough");
  }
  return values;
}

int to_rays(const std::string& text, const std::string& flag) {
  const int rays = to_whole<int>(text, flag);
  if (rays >= 1 && rays <= kMostRays) return rays;
  text::refuse(fmt::format("{}: {} is not between 1 and {}", flag, text::in_quotes(text), kMostRays),
               "it is the number of shadow rays for every undecided leaf", "give numbers, for example 1,4,16");
}

SamplePattern to_pattern(const std::string& text, const std::string& flag) {
  if (const auto pattern = pattern_named(text)) return *pattern;
  text::refuse(flag + ": there is no pattern " + text::in_quotes(text), "the pattern says where rays end",
               "use centre, regular, jittered or low-discrepancy");
}

Variant to_variant(const std::string& text, const std::string& flag) {
  if (const auto variant = variant_named(text)) return *variant;
  text::refuse(flag + ": there is no variant " + text::in_quotes(text), "the variant says which algorithm is run",
               "use mended or literal");
}

// A flag whose text is kept as it was given.
struct TextFlag {
  const char* name;
  std::string ComparisonArguments::*text;
  const char* type;
  const char* help;
};
using Arguments = ComparisonArguments;

// Of the sweep.
constexpr std::array<TextFlag, 6> kLists = {
    {{"--eps-b", &Arguments::eps_b, "LIST",
      "Values of eps_B, the tolerance of the adaptive algorithm: a radiosity for each leaf (default: max(rho B) times "
      "1e-1,...,1e-5)"},
     {"--eps-a", &Arguments::eps_a, "LIST",
      "Values of eps_A, the area below which nothing is split (default: 0 and the mean area of a source face times "
      "1e-1,...,1e-4)"},
     {"--rays", &Arguments::rays, "LIST", "Numbers of shadow rays per undecided leaf (default: 1,4,16,64,256)"},
     {"--seeds", &Arguments::seeds, "LIST", "Seeds of the shadow rays (default: 1,...,10)"},
     {"--pattern", &Arguments::pattern, "LIST",
      "Where rays end: jittered, centre, regular, low-discrepancy (default: all)"},
     {"--variant", &Arguments::variant, "LIST",
      "literal: the algorithm as printed in 1992; mended: with its faults corrected (default: both)"}}};

void refuse_idle(const std::vector<std::string>& flags, const std::string& beside, const std::string& why,
                 const std::string& suggestion) {
  if (flags.empty()) return;
  const bool one = flags.size() == 1;
  text::refuse(text::enumerate(flags) + (one ? " has" : " have") + " no effect " + beside, why,
               suggestion + (one ? ", or remove it" : ", or remove them"));
}

void check_effects(const ComparisonArguments& args) {
  if (args.methods.empty() || args.sweep) return;
  std::vector<std::string> given;
  for (const TextFlag& flag : kLists) {
    if (!(args.*flag.text).empty()) given.emplace_back(flag.name);
  }
  if (args.sweep_budget) given.emplace_back("--sweep-budget");
  refuse_idle(given, "beside --method",
              "with --method, the sweep of Tampieri's algorithm over these values does not run",
              "add --sweep, or write a setting of the method, such as --method adaptive:eps_B=0.1|0.01,rays=16");
}

study::Sweeps sweeps_of(const ComparisonArguments& args) {
  study::Sweeps sweeps;
  sweeps.eps_b = list_of<double>(args.eps_b, "--eps-b", to_tolerance);
  sweeps.eps_a = list_of<double>(args.eps_a, "--eps-a", to_tolerance);
  sweeps.rays = list_of<int>(args.rays, "--rays", to_rays);
  sweeps.seeds = list_of<std::uint64_t>(args.seeds, "--seeds", to_whole<std::uint64_t>);
  sweeps.patterns = list_of<SamplePattern>(args.pattern, "--pattern", to_pattern);
  sweeps.variants = list_of<Variant>(args.variant, "--variant", to_variant);
  sweeps.enabled = args.sweep || args.methods.empty();
  return sweeps;
}

// Of the named methods, and of the exact method, with which they are compared. Empty if none is named.
std::vector<study::Ladder> ladders_of(const ComparisonArguments& args) {
  std::vector<study::Ladder> ladders;
  for (const std::string& text : args.methods) ladders.push_back(study::parse_ladder(text));
  if (ladders.empty()) return ladders;
  const auto is_stochastic = [](const study::Ladder& ladder) {
    return std::ranges::any_of(ladder.rungs, [](const methods::Choice& c) { return c.method->stochastic(c.settings); });
  };
  if (args.method_seeds && std::ranges::none_of(ladders, is_stochastic)) {
    refuse_idle({"--method-seeds"}, "here", "none of the named methods uses random numbers",
                "name a method that does, such as --method area-sampling");
  }
  const auto is_exact = [](const study::Ladder& ladder) { return ladder.rungs.front().method->name == "exact"; };
  if (std::ranges::none_of(ladders, is_exact)) ladders.insert(ladders.begin(), study::parse_ladder("exact"));
  return ladders;
}

study::MethodSweep methods_of(const ComparisonArguments& args) {
  study::MethodSweep sweep;
  sweep.enabled = !args.no_methods;
  sweep.ladders = ladders_of(args);
  sweep.seeds = args.method_seeds.value_or(sweep.seeds);
  sweep.receivers = args.method_receivers.value_or(sweep.receivers);
  sweep.budget = args.method_budget.value_or(sweep.budget);
  return sweep;
}

// Refused before anything is computed, not when the pictures are made.
std::optional<render::Camera> camera_of(const CameraArguments& args, const Scene& scene) {
  if (!args.is_placed()) return std::nullopt;
  const render::Camera camera = args.camera(scene);
  (void)render::View(camera, {4, 3});
  return camera;
}

}  // namespace

std::string short_name(const std::string& path) {
  if (path == "-") return kStandardInput;
  return path.starts_with('@') ? path.substr(1) : std::filesystem::path(path).filename().string();
}

Comparison comparison_of(const ComparisonArguments& args, int threads) {
  check_receiver_options(args.receivers);
  check_effects(args);
  check_standard_input(args.scene, args.receivers);
  Comparison comparison;
  study::Request& request = comparison.request;
  request.sweeps = sweeps_of(args);
  request.methods = methods_of(args);
  request.sweep_budget = args.sweep_budget.value_or(request.sweep_budget);
  request.seconds_for_a_time = std::min(request.seconds_for_a_time, request.methods.budget / 10.0);
  comparison.scene = std::make_shared<const Scene>(args.scene.load());
  request.scene = comparison.scene.get();
  request.scene_name = short_name(args.scene.path);
  request.sources = sources_of(args.sources, *comparison.scene);
  request.engine = args.engine.engine();
  request.threads = threads;
  request.camera = camera_of(args.camera, *comparison.scene);
  if (!request.camera && is_given(args.camera.up)) request.up = args.camera.wishes().up;
  ChosenReceivers chosen = receivers_of(args.receivers, *comparison.scene);
  comparison.warnings = warnings_of_receivers(chosen);
  request.receivers = std::move(chosen.receivers);
  request.receivers_name = std::move(chosen.description);
  comparison.title = args.title.empty() ? request.scene_name : args.title;
  return comparison;
}

void ComparisonArguments::add_to(CLI::App& app) {
  scene.add_to(app);
  add_receiver_options(app, receivers);
  add_source_options(app, sources);
  const auto add = [&](const TextFlag& flag) { add_value(app, flag.name, this->*flag.text, flag.type, flag.help); };
  std::ranges::for_each(kLists, add);
  CLI::Option* method =
      add_value(app, "--method", methods, "METHOD",
                "A method to compare with the exact values; can be repeated (default: all, and the sweep)")
          ->take_all();
  app.add_flag("--no-methods", no_methods,
               "Run only the exact method and the sweep of the ray-sampled adaptive algorithm")
      ->excludes(method);
  app.add_flag("--sweep", sweep,
               "Also run the ray-sampled adaptive algorithm over --eps-b, --eps-a, --rays, --seeds, --pattern and "
               "--variant, as is done if no --method is given");
  add_value(app, "--method-seeds", method_seeds, "N", "Run stochastic methods with seeds 1 to N (default: 30)")
      ->check(CLI::Range(1, 10000));
  add_value(app, "--method-receivers", method_receivers, "N",
            "Number of receivers at which methods are compared (default: 48)")
      ->check(CLI::Range(1, 100000));
  add_value(app, "--method-budget", method_budget, "SECONDS",
            "Time limit for each method on a scene. The time is estimated from counted work at fixed prices, so "
            "that the settings that run do not depend on the machine (default: 2)")
      ->check(is_not_negative);
  add_value(app, "--sweep-budget", sweep_budget, "SECONDS",
            "The same limit for all settings of the adaptive algorithm together (default: 25)")
      ->check(is_not_negative);
  engine.add_to(app);
  camera.add_to(app, "Pictures in the report: where the camera stands (default: where it shows the whole scene)",
                "The point that it looks at");
  app.get_option("--fov")->needs(app.get_option("--eye"));
  add_value(app, "--title", title, "TEXT", "Name of the scene in the report");
}

// --- the study file ---

bool is_study_file(const std::string& path) { return std::filesystem::path(path).extension() == ".study"; }

std::vector<std::string> split_words(std::string_view line, const std::string& file, std::size_t number) {
  std::vector<std::string> words;
  bool in_word = false;
  char quote = '\0';
  for (const char c : line) {
    if (quote == '\0' && (c == ' ' || c == '\t')) {
      in_word = false;
      continue;
    }
    if (!in_word) words.emplace_back();
    in_word = true;
    if (c == quote) {
      quote = '\0';
    } else if (quote == '\0' && (c == '"' || c == '\'')) {
      quote = c;
    } else {
      words.back() += c;
    }
  }
  if (quote != '\0') {
    throw InputError(Problem{file, number, "a quote is not closed", "the end of the word is unknown",
                             std::string("close it with ") + quote});
  }
  return words;
}

namespace {

void add_line(const text::TextLine& line, const std::string& file, StudyFile& study) {
  std::vector<std::string> words = split_words(line.text, file, line.number);
  const std::string kind = words.front();
  words.erase(words.begin());
  if (kind != "scene" && kind != "title") {
    throw InputError(Problem{file, line.number, "a line begins with " + text::in_quotes(kind),
                             "the first word says what the line is",
                             "begin it with title or scene, or with # for a comment"});
  }
  if (words.empty()) {
    throw InputError(Problem{file, line.number, "nothing follows " + text::in_quotes(kind), "the line is incomplete",
                             "complete the line or remove it"});
  }
  if (kind == "scene") {
    study.scenes.push_back({line.number, std::move(words)});
  } else {
    study.title = std::string(text::trimmed(line.text.substr(kind.size())));
  }
}

}  // namespace

StudyFile parse_study_file(const std::filesystem::path& path) {
  const std::string text = text::read_text_file(path, "a study file");
  const std::string file = path.string();
  StudyFile study;
  text::ProblemList problems;
  text::TextLines lines(text);
  for (text::TextLine line; lines.next(line);) {
    if (line.text.empty()) continue;
    try {
      add_line(line, file, study);
    } catch (const InputError& error) {
      for (const Problem& problem : error.problems()) problems.add(problem);
    }
  }
  if (problems.empty() && study.scenes.empty()) {
    problems.add({file, 0, "the study has no scene", "there is nothing to do",
                  "add a line, for example: scene room.obj --on floor --grid 16x16"});
  }
  problems.throw_if_any();
  return study;
}

namespace {

ComparisonArguments arguments_of(const StudyLine& line, const std::string& file) {
  ComparisonArguments args;
  CLI::App app;
  app.set_help_flag();
  args.add_to(app);
  try {
    std::vector<std::string> reversed(line.words.rbegin(), line.words.rend());
    app.parse(std::move(reversed));
  } catch (const CLI::ParseError& error) {
    throw InputError(Problem{file, line.number, error.what(), "the line has the flags of a scene",
                             "exactff compare --help explains these flags"});
  }
  args.scene.command = nullptr;  // the line has no outputs
  const std::filesystem::path folder = std::filesystem::path(file).parent_path();
  std::string& path = args.scene.path;
  if (!path.starts_with('@')) {
    path = (folder / path).string();
    if (!std::filesystem::exists(path)) {  // perhaps several files
      const std::string inner = '+' + (folder / "").string();
      for (std::size_t at = 0; (at = path.find('+', at)) != std::string::npos; at += inner.size())
        path.replace(at, 1, inner);
    }
  }
  if (!args.receivers.file.empty()) {
    args.receivers.file = (std::filesystem::path(file).parent_path() / args.receivers.file).string();
  }
  return args;
}

// Problems with a line, or with the files that it names, are reported with the place of the line.
template <class Do>
void at_line(const std::string& file, std::size_t number, const Do& act) {
  try {
    act();
  } catch (const InputError& error) {
    std::vector<Problem> problems = error.problems();
    for (Problem& problem : problems) {
      if (problem.file == file) continue;
      if (!problem.file.empty()) {
        const std::string line = problem.line > 0 ? ':' + std::to_string(problem.line) : std::string();
        problem.what = problem.file + line + ": " + problem.what;
      }
      problem.file = file;
      problem.line = number;
    }
    throw InputError(std::move(problems));
  }
}

void add_scene(const StudyLine& line, const std::string& file, int threads, report::Plan& plan) {
  const ComparisonArguments args = arguments_of(line, file);
  if (!args.receivers.file.empty()) plan.files_read.emplace_back(args.receivers.file);
  Comparison comparison = comparison_of(args, threads);
  std::ranges::copy(comparison.scene->files(), std::back_inserter(plan.files_read));
  plan.add_scene(std::move(comparison.title), std::move(comparison.scene), std::move(comparison.request),
                 std::move(comparison.warnings));
}

}  // namespace

report::Plan read_study_file(const std::filesystem::path& file, int threads) {
  const StudyFile study = parse_study_file(file);
  report::Plan plan;
  plan.title = study.title.empty() ? short_name(file.string()) : study.title;
  for (const StudyLine& line : study.scenes) {
    at_line(file.string(), line.number, [&] { add_scene(line, file.string(), threads, plan); });
  }
  return plan;
}

}  // namespace exactff::flags
