// exactff compare: compares approximate methods with the exact values, as tables and a report.
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/engine_option.h"
#include "cli/lists.h"
#include "cli/long_run.h"
#include "cli/output.h"
#include "cli/receiver_options.h"
#include "cli/refuse.h"
#include "cli/scene_options.h"
#include "cli/source_options.h"
#include "cli/study_file.h"
#include "exactff/study.h"
#include "experiments/experiment.h"
#include "scene/number_text.h"
#include "scene/text_lines.h"
#include "study/parallel.h"
#include "study/report.h"
#include "study/text.h"
#include "study/verdicts.h"
#include "text/escape.h"

namespace exactff::cli {
namespace {

constexpr int kMostRays = 1 << 20;

constexpr const char* kCompareFooter =
    "The ray-sampled adaptive algorithm: every combination of the lists is run if there are at most 40; else every\n"
    "--eps-b with every --rays, and each other list on its own around the base (the middle --eps-b and --rays, the\n"
    "first of every other list).\n"
    "A METHOD is its name and settings, one of which may have several values: hemicube:resolution=64|128|256. Names:\n"
    "exact, adaptive, adaptive-exact-visibility, hemicube, nettle, wallace, area-sampling.\n"
    "A .study file in the place of SCENE describes several scenes, one a line with these very flags, and experiments:\n"
    "  title Rooms\n"
    "  scene cornell_box.obj --on floor --grid 32x32 --title \"Cornell box\"\n"
    "  experiment karkanis-times\n"
    "What a scene gives no work to is left out, and the report says what and why.\n"
    "Times are measured after all values, on one thread.\n"
    "DIR is written whole or not at all; an earlier result of this command there is replaced. While it works, "
    "finished\n"
    "values are in DIR.part, whatever happens: the same command with --resume goes on from there.\n"
    "\n"
    "Examples:\n"
    "  exactff compare data/scenes/cornell_box.obj --on floor --grid 32x32 -o cornell-report\n"
    "  exactff compare data/studies/default.study --abridged -o report";

// The arguments of a scene line in a study file, or of the command itself if it is about one scene.
struct SceneWords {
  SceneArguments scene;
  ReceiverArguments receivers;
  SourceArguments sources;
  std::string eps_b, eps_a, rays, seeds, pattern, variant;
  std::vector<std::string> methods;
  bool no_methods = false;
  std::string method_seeds, method_receivers, method_budget, sweep_budget;
  EngineArgument engine;
  std::string title;
  bool unless_abridged = false;
};

struct CompareArguments {
  SceneWords scene;
  std::vector<std::string> experiments;
  bool abridged = false;
  int threads = 0;
  std::string folder;
  bool resume = false;
  bool force = false;

  [[nodiscard]] study::Journal::Existing existing() const {
    return resume  ? study::Journal::Existing::kResume
           : force ? study::Journal::Existing::kReplace
                   : study::Journal::Existing::kRefuse;
  }
};

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

// The text of an option that was not given is empty, and so is its list, which stands for the default.
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

study::Sweeps sweeps_of(const SceneWords& words) {
  study::Sweeps sweeps;
  sweeps.eps_b = list_of<double>(words.eps_b, "--eps-b", to_tolerance);
  sweeps.eps_a = list_of<double>(words.eps_a, "--eps-a", to_tolerance);
  sweeps.rays = list_of<int>(words.rays, "--rays", to_rays);
  sweeps.seeds = list_of<std::uint64_t>(words.seeds, "--seeds", to_whole<std::uint64_t>);
  sweeps.patterns = list_of<SamplePattern>(words.pattern, "--pattern", to_pattern);
  sweeps.variants = list_of<Variant>(words.variant, "--variant", to_variant);
  return sweeps;
}

template <class Number>
Number within(Number value, Number lowest, Number highest, const std::string& flag, const std::string& meaning) {
  if (value >= lowest && value <= highest) return value;
  refuse(flag + " is not within " + study::shortest(static_cast<double>(lowest)) + " to " +
             study::shortest(static_cast<double>(highest)),
         meaning, "give a number within these");
}

study::MethodSweep methods_of(const SceneWords& words) {
  study::MethodSweep sweep;
  sweep.enabled = !words.no_methods;
  for (const std::string& text : words.methods) sweep.ladders.push_back(study::parse_ladder(text));
  if (!words.method_seeds.empty()) {
    sweep.seeds = within<std::size_t>(to_whole<std::size_t>(words.method_seeds, "--method-seeds"), 1, 10000,
                                      "--method-seeds", "every stochastic method is run with so many seeds");
  }
  if (!words.method_receivers.empty()) {
    sweep.receivers = within<std::size_t>(to_whole<std::size_t>(words.method_receivers, "--method-receivers"), 1,
                                          100000, "--method-receivers", "methods are compared at so many receivers");
  }
  if (!words.method_budget.empty()) {
    sweep.budget = within(to_tolerance(words.method_budget, "--method-budget"), 0.0, 1e9, "--method-budget",
                          "so many seconds of counted work may a method take on a scene");
  }
  return sweep;
}

std::string words_of(const SceneWords& words) {
  std::string line;
  const auto add = [&](const char* flag, const std::string& value) {
    if (!value.empty()) line += std::string(" ") + flag + ' ' + text::shell_word(value);
  };
  if (words.scene.patches != "groups") add("--patches", words.scene.patches);
  if (words.scene.skip_bad_faces) line += " --skip-bad-faces";
  line += command_words(words.receivers) + command_words(words.sources);
  add("--eps-b", words.eps_b);
  add("--eps-a", words.eps_a);
  add("--rays", words.rays);
  add("--seeds", words.seeds);
  add("--pattern", words.pattern);
  add("--variant", words.variant);
  for (const std::string& method : words.methods) add("--method", method);
  if (words.no_methods) line += " --no-methods";
  add("--method-seeds", words.method_seeds);
  add("--method-receivers", words.method_receivers);
  add("--method-budget", words.method_budget);
  add("--sweep-budget", words.sweep_budget);
  if (words.engine.engine() != Engine::kEdges) add("--engine", words.engine.name);
  add("--title", words.title);
  if (words.unless_abridged) line += " --unless-abridged";
  return line;
}

std::string command_line(const CompareArguments& args) {
  std::string line = "exactff compare " + text::shell_word(args.scene.scene.path) + words_of(args.scene);
  for (const std::string& name : args.experiments) line += " --experiment " + text::shell_word(name);
  if (args.abridged) line += " --abridged";
  if (args.threads > 0) line += " --threads " + std::to_string(args.threads);
  return line + " -o " + text::shell_word(args.folder);
}

void add_scene_flags(CLI::App& app, SceneWords& words) {
  words.scene.add_to(app);
  add_receiver_options(app, words.receivers);
  add_source_options(app, words.sources);
  app.add_option("--eps-b", words.eps_b, "Tolerances, radiosity (default: max(rho B) times 1e-1,...,1e-5)")
      ->type_name("LIST");
  app.add_option("--eps-a", words.eps_a, "Smallest areas (default: 0 and the mean source face times 1e-1,...,1e-4)")
      ->type_name("LIST");
  app.add_option("--rays", words.rays, "Shadow rays per undecided leaf (default: 1,4,16,64,256)")->type_name("LIST");
  app.add_option("--seeds", words.seeds, "Seeds of the shadow rays (default: 1,...,10)")->type_name("LIST");
  app.add_option("--pattern", words.pattern,
                 "Where rays end: jittered, centre, regular, low-discrepancy (default: all)")
      ->type_name("LIST");
  app.add_option("--variant", words.variant, "mended, literal (default: both)")->type_name("LIST");
  CLI::Option* method =
      app.add_option("--method", words.methods, "A method to hold against the others, may be repeated (default: all)")
          ->type_name("METHOD")
          ->take_all();
  app.add_flag("--no-methods", words.no_methods, "Only the ray-sampled adaptive algorithm")->excludes(method);
  app.add_option("--method-seeds", words.method_seeds, "Seeds of stochastic methods, 1 to N (default: 30)")
      ->type_name("N");
  app.add_option("--method-receivers", words.method_receivers, "Receivers at which methods are compared (default: 48)")
      ->type_name("N");
  app.add_option("--method-budget", words.method_budget,
                 "Seconds that a method may take on a scene, by its counted work at fixed prices, so that what is run "
                 "does not depend on the machine (default: 2)")
      ->type_name("SECONDS");
  app.add_option("--sweep-budget", words.sweep_budget,
                 "The same for all settings of the adaptive algorithm together (default: 15)")
      ->type_name("SECONDS");
  words.engine.add_to(app);
  app.add_option("--title", words.title, "What the report calls the scene")->type_name("TEXT");
  app.add_flag("--unless-abridged", words.unless_abridged, "Leave the scene out with --abridged");
}

// The most cells along a side.
constexpr int kAbridgedGrid = 12;

std::string abridged_grid(const std::string& grid) {
  const std::size_t cross = grid.find('x');
  const auto u = whole_number<int>(std::string_view(grid).substr(0, cross));
  const auto v =
      cross == std::string::npos ? std::nullopt : whole_number<int>(std::string_view(grid).substr(cross + 1));
  if (!u || !v) return grid;  // refused later
  return std::to_string(std::min(*u, kAbridgedGrid)) + 'x' + std::to_string(std::min(*v, kAbridgedGrid));
}

// Reduces settings that the user did not give.
void abridge(study::Request& request) {
  if (request.sweeps.rays.empty()) request.sweeps.rays = {1, 16, 64};
  if (request.sweeps.seeds.empty()) request.sweeps.seeds = {1, 2, 3};
  if (request.sweeps.patterns.empty()) request.sweeps.patterns = {SamplePattern::kJittered};
  if (request.sweeps.variants.empty()) request.sweeps.variants = {Variant::kMended};
  request.methods.receivers = std::min<std::size_t>(request.methods.receivers, 12);
  request.methods.budget = std::min(request.methods.budget, 0.2);
  request.sweep_budget = std::min(request.sweep_budget, 1.0);
  request.seconds_for_a_time = 0.02;
}

// A scene and everything requested for it. The address of the scene does not change.
struct SceneWork {
  std::string name;  // used for files; empty if there is only one scene
  std::string title;
  std::unique_ptr<Scene> scene;
  study::Request request;
};

std::string short_name(const std::string& path) {
  return path.starts_with('@') ? path.substr(1) : std::filesystem::path(path).filename().string();
}

SceneWork work_of(SceneWords words, bool abridged, int threads) {
  if (abridged && !words.receivers.grid.empty()) words.receivers.grid = abridged_grid(words.receivers.grid);
  check_receiver_options(words.receivers);
  SceneWork work;
  study::Request& request = work.request;
  request.sweeps = sweeps_of(words);
  request.methods = methods_of(words);
  if (!words.sweep_budget.empty()) request.sweep_budget = to_tolerance(words.sweep_budget, "--sweep-budget");
  work.scene = std::make_unique<Scene>(words.scene.load());
  request.scene = work.scene.get();
  request.scene_name = short_name(words.scene.path);
  request.sources = sources_of(words.sources, *work.scene);
  request.engine = words.engine.engine();
  request.threads = threads;
  ChosenReceivers chosen = receivers_of(words.receivers, *work.scene);
  request.receivers = std::move(chosen.receivers);
  request.receivers_name = std::move(chosen.description);
  if (abridged) abridge(request);
  work.title = words.title.empty() ? request.scene_name : words.title;
  return work;
}

// Lower-case letters, digits and hyphens. A number is appended if two names would be the same.
std::string file_word(const std::string& title, const std::vector<SceneWork>& others) {
  std::string word;
  for (const char c : title) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 && static_cast<unsigned char>(c) < 128;
    if (plain) word += static_cast<char>(std::tolower(c));
    if (!plain && !word.empty() && word.back() != '-') word += '-';
  }
  while (!word.empty() && word.back() == '-') word.pop_back();
  if (word.empty()) word = "scene";
  const auto taken = [&](const std::string& name) {
    return std::any_of(others.begin(), others.end(), [&](const SceneWork& work) { return work.name == name; });
  };
  if (!taken(word)) return word;
  for (int k = 2;; ++k) {
    const std::string numbered = word + '-' + std::to_string(k);
    if (!taken(numbered)) return numbered;
  }
}

// Everything that a run has to do.
struct Plan {
  std::string title;
  std::vector<SceneWork> scenes;
  std::vector<const experiments::Experiment*> experiments;
  std::vector<study::LeftOut> left_out;
};

// Drops repetitions.
void add_experiments(Plan& plan, const std::vector<std::string>& names) {
  const auto add = [&](const experiments::Experiment& one) {
    if (std::ranges::find(plan.experiments, &one) == plan.experiments.end()) plan.experiments.push_back(&one);
  };
  for (const std::string& name : names) {
    if (name == "all") {
      std::ranges::for_each(experiments::all_experiments(), add);
    } else {
      add(experiments::experiment_named(name));
    }
  }
}

SceneWords scene_words(const StudyLine& line, const std::string& file) {
  SceneWords words;
  CLI::App app;
  app.set_help_flag();
  add_scene_flags(app, words);
  try {
    std::vector<std::string> reversed(line.words.rbegin(), line.words.rend());
    app.parse(std::move(reversed));
  } catch (const CLI::ParseError& error) {
    throw InputError(Problem{file, line.number, error.what(), "the line says what is done with a scene",
                             "see exactff compare --help for the flags of a scene"});
  }
  const std::string& path = words.scene.path;
  if (!path.starts_with('@')) words.scene.path = (std::filesystem::path(file).parent_path() / path).string();
  if (!words.receivers.file.empty()) {
    words.receivers.file = (std::filesystem::path(file).parent_path() / words.receivers.file).string();
  }
  return words;
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

Plan plan_of_study(const CompareArguments& args) {
  const std::string& file = args.scene.scene.path;
  if (!words_of(args.scene).empty()) {
    refuse("the flags" + words_of(args.scene) + " are given beside a study file", "they are about one scene",
           "write them in the scene's line of the file");
  }
  const StudyFile study = read_study_file(file);
  Plan plan;
  plan.title = study.title.empty() ? short_name(file) : study.title;
  for (const StudyLine& line : study.scenes) {
    at_line(file, line.number, [&] {
      SceneWords words = scene_words(line, file);
      if (args.abridged && words.unless_abridged) {
        const std::string name = words.title.empty() ? short_name(words.scene.path) : words.title;
        plan.left_out.push_back({name, "this report is abridged"});
        return;
      }
      SceneWork work = work_of(std::move(words), args.abridged, args.threads);
      work.name = file_word(work.title, plan.scenes);
      plan.scenes.push_back(std::move(work));
    });
  }
  for (const StudyLine& line : study.experiments) {
    at_line(file, line.number, [&] { add_experiments(plan, line.words); });
  }
  return plan;
}

Plan plan_of(const CompareArguments& args) {
  Plan plan;
  if (is_study_file(args.scene.scene.path)) {
    plan = plan_of_study(args);
  } else {
    plan.scenes.push_back(work_of(args.scene, args.abridged, args.threads));
    plan.title = args.experiments.empty() ? std::string() : plan.scenes.front().title;
    if (!args.experiments.empty()) plan.scenes.front().name = file_word(plan.title, {});
  }
  add_experiments(plan, args.experiments);
  if (plan.scenes.empty() && plan.experiments.empty()) {
    refuse("every scene of the study is left out", "an abridged report leaves out those marked --unless-abridged",
           "leave --abridged out, or mark fewer");
  }
  return plan;
}

study::Chapter run_experiment(const experiments::Experiment& experiment, const CompareArguments& args,
                              study::Journal& journal, const study::Hooks& hooks) {
  const std::string key = "experiment/" + std::string(experiment.name) + (args.abridged ? "-abridged" : "");
  if (const auto bytes = journal.find(key)) {
    if (auto chapter = study::chapter_of(*bytes)) return std::move(*chapter);
  }
  const int threads = args.threads > 0 ? args.threads : study::usable_threads();
  study::Chapter chapter = experiment.run({args.abridged, threads}, hooks);
  journal.add(key, study::to_bytes(chapter));
  return chapter;
}

study::Report carry_out(Plan plan, const CompareArguments& args, study::Journal& journal, const study::Hooks& hooks) {
  study::Report report;
  report.title = plan.title;
  report.command_line = command_line(args);
  report.left_out = std::move(plan.left_out);
  for (SceneWork& work : plan.scenes) {
    const study::Hooks titled{[&](const study::Progress& progress) {
                                const std::string stage = work.name.empty()
                                                              ? std::string(progress.stage)
                                                              : work.title + ": " + std::string(progress.stage);
                                if (hooks.progress) hooks.progress({stage, progress.done, progress.total});
                              },
                              hooks.cancelled};
    report.scenes.push_back({work.name, work.title, study::run(std::move(work.request), titled, &journal)});
  }
  for (const experiments::Experiment* experiment : plan.experiments) {
    report.chapters.push_back(run_experiment(*experiment, args, journal, hooks));
  }
  return report;
}

void print(const study::Report& report) {
  for (const study::SceneChapter& scene : report.scenes) {
    if (report.scenes.size() > 1) std::cout << text::printable(scene.title) << '\n';
    std::vector<std::string> sentences = study::method_sentences(scene.study);
    if (report.scenes.size() == 1) {
      for (std::string& sentence : study::headlines(scene.study)) sentences.push_back(std::move(sentence));
    }
    for (const std::string& sentence : sentences) {
      std::cout << (report.scenes.size() > 1 ? "  " : "") << text::printable(sentence) << '\n';
    }
  }
}

int run(const CompareArguments& args) {
  study::check_output_folder(args.folder);
  Plan plan = plan_of(args);
  study::Journal journal(study::journal_of_folder(args.folder), args.existing());
  const std::string kept = "what was finished is in " + text::printable(journal.path().string()) +
                           ", and the same command with --resume goes on\n";
  const InterruptWatch watch("exactff: interrupted; " + kept);
  ProgressBar bar;
  const study::Hooks hooks{[&](const study::Progress& progress) { bar.show(progress); }, is_interrupted};
  const std::size_t resumed = journal.size();
  std::vector<std::unique_ptr<Scene>> scenes;  // studies hold pointers to them
  for (SceneWork& work : plan.scenes) scenes.push_back(std::move(work.scene));
  try {
    const study::Report report = carry_out(std::move(plan), args, journal, hooks);
    const std::vector<std::string> messages = study::write(report, args.folder, hooks);
    bar.clear();
    journal.remove();
    if (resumed > 0) std::cerr << "note: " << resumed << " pieces of work were taken from the interrupted run\n";
    for (const std::string& message : messages) std::cerr << "note: " << text::printable(message) << '\n';
    print(report);
  } catch (const study::Cancelled&) {
    bar.clear();
    std::cerr << "exactff: interrupted; " << (journal.size() > 0 ? kept : "nothing was written\n");
    return 128 + interrupting_signal();
  } catch (const InputError&) {  // for example a full disk
    bar.clear();
    if (journal.size() > 0) std::cerr << "note: " << kept;
    throw;
  }
  std::cout << "Report: " << text::printable((std::filesystem::path(args.folder) / "report.html").string()) << '\n';
  check_output(std::cout);
  return 0;
}

}  // namespace

namespace {

std::string experiment_names() {
  std::string names;
  for (const experiments::Experiment& one : experiments::all_experiments()) {
    names += (names.empty() ? "" : ", ") + std::string(one.name);
  }
  return names;
}

}  // namespace

Command add_compare(CLI::App& app) {
  auto args = std::make_shared<CompareArguments>();
  CLI::App* command = app.add_subcommand("compare", "Error and time of approximate methods against the exact values");
  add_scene_flags(*command, args->scene);
  command->get_option("SCENE")->description("Wavefront OBJ file, @MODEL, or a .study file of several");
  command
      ->add_option("--experiment", args->experiments,
                   "Add an experiment to the report, may be repeated: " + experiment_names() + ", or all")
      ->type_name("NAME")
      ->delimiter(',')
      ->take_all();
  command->add_flag("--abridged", args->abridged,
                    "A first look: grids of at most 12x12, fewer settings and receivers, short experiments");
  command->add_option("--threads", args->threads, "Threads (default: all); values do not depend on it")
      ->check(CLI::Range(1, 4096))
      ->type_name("N");
  command->add_option("-o,--output", args->folder, "Folder for the tables and the report")
      ->required()
      ->type_name("DIR");
  CLI::Option* resume = command->add_flag("--resume", args->resume, "Go on with an interrupted run, if there is one");
  command->add_flag("--force", args->force, "Begin anew, whatever an interrupted run has left")->excludes(resume);
  command->footer(kCompareFooter);
  return {command, [args] { return run(*args); }};
}

}  // namespace exactff::cli
