// exactff truth: writes a file of certified values, for comparison with other programs.
#include "exactff/truth.h"

#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <memory>

#include "cli/commands.h"
#include "cli/output.h"
#include "cli/process.h"
#include "exactff/matrix.h"
#include "exactff/slips.h"
#include "flags/scene.h"
#include "flags/values.h"
#include "text/escape.h"
#include "text/phrases.h"
#include "text/refuse.h"
#include "text/text_lines.h"
#include "truth/rows.h"

namespace exactff::cli {
namespace {

// --- The summary that `truth` and `merge` print at their end ---

// Returns the exit code: 3, with a message, if a row is not certified.
int warn_of_uncertified(const truth::Summary& summary) {
  const std::uint64_t uncertified = summary.with(Status::kNotCertified);
  if (uncertified == 0) return 0;
  std::cerr << "exactff: " << text::counted(uncertified, "row")
            << " could not be certified within the precision cap (their bounds are valid, their values are estimates); "
               "look for the status 'not certified'\n";
  return kNotAsAsked;
}

// Prints the summary. Returns the exit code: 3 if a row is not certified.
int print_summary(const truth::Summary& summary, const std::string& file, const FurtherFiles& further) {
  std::cout << text::counted(summary.rows, "row") << ':';
  const char* separator = " ";
  for (const Status status : {Status::kCertified, Status::kZero, Status::kUnderflow, Status::kNotCertified}) {
    if (summary.with(status) == 0) continue;
    std::cout << separator << summary.with(status) << ' ' << to_string(status);
    separator = ", ";
  }
  std::cout << '\n';
  const std::uint64_t computed = summary.rows - summary.resumed;
  if (summary.seconds > 0.0 && computed > 0) {
    std::cout << "computed " << (summary.resumed > 0 ? text::counted(computed, "row") + " of them" : "them") << " in "
              << text::duration(summary.seconds) << ", "
              << text::rounded(static_cast<double>(computed) / summary.seconds) << " per second";
    if (summary.slow > 0) std::cout << "; " << text::counted(summary.slow, "slow row");
    std::cout << '\n';
  } else if (summary.resumed > 0) {
    std::cout << "all rows were already computed\n";
  }
  std::cout << "Truth file: " << text::printable(file) << '\n';
  print_further_files(further);
  check_output(std::cout);
  return warn_of_uncertified(summary);
}

// --- Truth ---

constexpr const char* kTruthFooter =
    "FILE has one row per receiver and source: point, normal, the face on which the receiver lies, the certified form\n"
    "factor with its bounds, the radiosity received in each channel, and the status. A value is certified if it is\n"
    "proved to be the true form factor, rounded to the nearest double. The bytes of FILE depend only on the scene and\n"
    "the request, not on threads, machines, shards or interruptions.\n"
    "Until FILE is complete, finished rows are kept in FILE.part. After an interruption, the same command with\n"
    "--resume continues from there. Scripts can always give --resume; a complete FILE stays as it is.\n"
    "On several machines: run `mpirun -n 4 exactff truth ...` (every process reads the scene and computes; rank 0\n"
    "writes), or start separate jobs with --shard 1/4, 2/4, ... and join their files with `exactff merge`.\n"
    "With --radiosity FILE, totals (--total, otherwise irradiance) are of the light of all bounces: sums over all\n"
    "patches of form factor and radiosity, from FILE. total_lower_r ... total_upper_b bound this sum for all\n"
    "radiosities within their bounds; they do not bound the true light, which varies over a patch. Sources are those\n"
    "of the other columns. --npy, --npz, --vtk and --exr make their files from the finished FILE; --resume makes them\n"
    "again, also from a merged FILE.\n"
    "The visible points of another renderer's pixels: --receivers GBUFFER.exr --on auto, with layers for position (in\n"
    "world coordinates) and normal, 32-bit, one sample a pixel. --exr writes the exact values in the same pixels. In\n"
    "a pipe, `-` as SCENE or --receivers is standard input, and -o - is standard output.\n"
    "Exit codes: 0 done, 2 bad input, 3 done but some rows are not certified, 128 + signal when interrupted.\n"
    "\n"
    "Examples:\n"
    "  exactff truth data/scenes/cornell_box.obj --on floor --grid 200x200 -o truth.csv\n"
    "  exactff truth data/scenes/cornell_box.obj --receivers gbuffer.exr --on auto -o truth.csv --exr truth.exr";

struct TruthArguments : KeptRun {
  flags::SceneArguments scene;
  flags::ReceiverArguments receivers;
  flags::SourceArguments sources;
  flags::SolutionArgument solution;
  truth::Request columns;  // those that are wanted, and nothing else
  std::string measures;
  flags::ThreeNumbers up;
  std::string total, ke;
  std::string shard;
  double slow_seconds = 1.0;
  flags::EngineArgument engine;
  int threads = 0;
  std::string file;
  FurtherFiles further;

  [[nodiscard]] bool to_standard_output() const { return file == "-"; }
  [[nodiscard]] std::optional<Quantity> quantity() const {
    if (!total.empty()) return quantity_named(total);
    if (!further.exr.empty()) return Quantity::kRadiance;
    return solution.is_given() ? std::optional(Quantity::kIrradiance) : std::nullopt;
  }
};

// "sphere" stands for the form factor from a small sphere.
std::vector<Measure> measures_named(const TruthArguments& args) {
  std::vector<Measure> measures;
  if (args.measures.empty()) return measures;
  for (const std::string& name : flags::split_list(args.measures)) {
    Measure measure{.kind = measure_named(name).value_or(MeasureKind::kFormFactor), .sphere = name == "sphere"};
    if (flags::is_given(args.up)) measure.up = flags::vector_of(args.up, "--up");
    if (measure.is_form_factor()) {
      text::refuse("--measure: " + text::in_quotes(name) + " is no column", "every row has the form factor",
                   "choose solid-angle, overcast, sphere, or several, separated by commas");
    }
    measures.push_back(measure);
  }
  return measures;
}

// A request and the scene that it refers to.
struct Job {
  Scene scene;
  truth::Request request;
  std::optional<exr::Frame> frame = {};  // if the receivers are pixels
};

std::unique_ptr<Job> job_of(const TruthArguments& args, const jobs::Team* team) {
  const jobs::Shard shard = shard_of(args.shard);
  flags::check_receiver_options(args.receivers);
  flags::check_standard_input(args.scene, args.receivers);
  flags::LitScene lit = flags::load(args.scene, args.solution);
  auto job = std::make_unique<Job>(Job{std::move(lit.scene), args.columns});
  job->request.radiosities = std::move(lit.radiosities);
  print_warnings(job->scene.warnings());
  truth::Request& request = job->request;
  flags::ChosenReceivers receivers = flags::receivers_of(args.receivers, job->scene);
  print_warnings(flags::warnings_of_receivers(receivers));
  print_near_misses(job->scene, receivers.receivers);
  request.scene = &job->scene;
  request.scene_name = args.scene.file_name();
  request.receivers = std::move(receivers.receivers);
  request.receivers_name = std::move(receivers.description);
  job->frame = std::move(receivers.frame);
  flags::SourcesUnderSky sources = flags::sources_under_sky(args.sources, job->scene);
  request.sources = std::move(sources.sources);
  request.sky = sources.sky;
  request.measures = measures_named(args);
  request.total = args.quantity();
  request.ke = args.ke == "radiance" ? KeMeans::kRadiance : KeMeans::kRadiosity;
  request.engine = args.engine.engine();
  request.shard = shard;
  request.threads = args.threads > 0 || team == nullptr ? args.threads : jobs::fair_threads(*team);
  return job;
}

void tell_of_sources(const Job& job) {
  print_warnings(slips::warnings_of_dark_sources(job.scene, job.request.receivers, job.request.sources));
  print_warnings(slips::warnings_of_turned_surfaces(job.scene));
  if (job.request.radiosities) return;  // light counts as it is in the file
  const std::string note = flags::note_on_sources_without_emission(job.scene, job.request.sources);
  if (!note.empty()) std::cerr << "note: " << text::printable(note) << '\n';
}

void check_totals(const TruthArguments& args) {
  if (!args.ke.empty() && !args.quantity()) {
    text::refuse("--ke is given without --total", "only totals depend on it", "add --total radiance, or remove it");
  }
  if (!args.further.exr.empty() && !flags::are_pixels(args.receivers)) {
    text::refuse("--exr is given, but the receivers are not the pixels of an image",
                 "each pixel shows the value at its own point", "add --receivers FILE.exr, or use --npy or --vtk");
  }
}

// What a pipe cannot have.
void check_standard_output(const TruthArguments& args) {
  if (const std::vector<std::string> further = args.further.flags(); !further.empty()) {
    text::refuse(text::enumerate(further) + (further.size() == 1 ? " is" : " are") + " given with -o -",
                 "these files are made from the finished truth file", "name a file, for example -o truth.csv");
  }
  std::vector<std::string> flags;
  if (!args.shard.empty()) flags.emplace_back("--shard");
  if (args.resume) flags.emplace_back("--resume");
  if (args.force) flags.emplace_back("--force");
  if (flags.empty()) return;
  text::refuse(text::enumerate(flags) + (flags.size() == 1 ? " is" : " are") + " given with -o -",
               "standard output has no journal to continue from, no shards to merge and nothing to replace",
               "remove " + std::string(flags.size() == 1 ? "it" : "them") + ", or name a file");
}

int write_to_standard_output(const TruthArguments& args) {
  check_totals(args);
  check_standard_output(args);
  const auto compute = [&] {
    Narrator narrator("row");
    jobs::RowHooks hooks = narrator.hooks(args.slow_seconds);
    if (::isatty(STDOUT_FILENO) == 1) hooks.progress = {};  // the rows are to be seen
    const std::unique_ptr<Job> job = with_progress([&] { return job_of(args, nullptr); });
    tell_of_sources(*job);
    const truth::Summary summary = truth::write(std::move(job->request), std::cout, hooks);
    narrator.clear();
    return warn_of_uncertified(summary);
  };
  return unless_interrupted(compute, "exactff: interrupted; the printed rows are incomplete, and nothing is kept\n");
}

// Before anything that takes time.
void check_outputs(const TruthArguments& args) {
  check_totals(args);
  jobs::require_free(args.file, args.existing());
  const std::vector<std::string> further = args.further.flags();
  if (further.empty()) return;
  if (!args.shard.empty()) {
    const bool numpy = args.further.vtk.empty() && args.further.exr.empty();
    text::refuse(text::enumerate(further) + (further.size() == 1 ? " is" : " are") + " given with --shard",
                 "a shard has only a part of the rows",
                 numpy ? "give " + text::enumerate(further) + " to exactff merge"
                       : "after exactff merge, run this command without --shard, with --resume and "
                         "-o FILE for the merged file");
  }
  check_further_files(args.further, args.existing() != jobs::Existing::kRefuse);
}

// Returns 0, or the exit code of the signal that interrupted it.
int write_further_files(const TruthArguments& args, const Job& job, const jobs::RowHooks& hooks) {
  const auto write = [&] {
    if (!args.further.npy.empty()) truth::write_npy(args.file, args.further.npy, hooks);
    if (!args.further.npz.empty()) truth::write_npz(args.file, args.further.npz, hooks);
    if (!args.further.vtk.empty()) truth::write_vtk(job.request, args.file, args.further.vtk, hooks);
    if (!args.further.exr.empty()) truth::write_exr(*job.frame, args.file, args.further.exr, hooks);
    return 0;
  };
  return unless_interrupted(write, "exactff: interrupted; " + text::printable(args.file) +
                                       " is complete; for the other files, run the same command with --resume\n");
}

int write(const TruthArguments& args, jobs::Team* team) {
  check_outputs(args);
  Narrator narrator("row");
  truth::Summary summary;
  std::unique_ptr<Job> job;
  const bool done = narrator.is_done(args.file, [&] {
    job = with_progress([&] { return job_of(args, team); });
    tell_of_sources(*job);
    const InterruptWatch watch(words_of_interruption("row", args.file));
    truth::Request request = args.further.vtk.empty() ? std::move(job->request) : job->request;
    summary = truth::write(std::move(request), args.file, args.existing(), narrator.hooks(args.slow_seconds), team);
  });
  if (!done) return exit_code_of_interruption();
  const int interrupted = write_further_files(args, *job, narrator.hooks(args.slow_seconds));
  narrator.clear();
  return interrupted != 0 ? interrupted : print_summary(summary, args.file, args.further);
}

int follow(const TruthArguments& args, jobs::Team& team) {
  std::unique_ptr<Job> job;
  const auto request = [&] {
    job = job_of(args, &team);
    return std::move(job->request);
  };
  return truth::follow(team, request, {.cancelled = is_interrupted, .slow_seconds = args.slow_seconds});
}

// Under mpirun only rank 0 has the standard input, and every rank reads the scene.
void refuse_pipes_of_a_team(const TruthArguments& args) {
  const bool scene = args.scene.from_standard_input(), receivers = args.receivers.file == "-";
  if (!scene && !receivers && !args.to_standard_output()) return;
  text::refuse(std::string("- stands for ") + (scene || receivers ? "standard input" : "standard output"),
               "several processes under mpirun cannot share it", "name a file, or run exactff without mpirun");
}

int run(const TruthArguments& args) {
  return run_alone_or_in_team({.row = "row",
                               .refuse = [&] { refuse_pipes_of_a_team(args); },
                               .write =
                                   [&](jobs::Team* team) {
                                     return args.to_standard_output() ? write_to_standard_output(args)
                                                                      : write(args, team);
                                   },
                               .follow = [&](jobs::Team& team) { return follow(args, team); }});
}

}  // namespace

Command add_truth(CLI::App& app) {
  auto args = std::make_shared<TruthArguments>();
  CLI::App* command = app.add_subcommand("truth", "Write a file of certified values, to check other programs");
  args->scene.add_to(*command);
  args->scene.add_divide_to(*command);
  args->solution.add_to(*command);
  flags::add_receiver_options(*command, args->receivers);
  flags::add_source_options_under_sky(*command, args->sources);
  for (const truth::OptionalColumn& column : truth::optional_columns()) {
    command->add_flag("--" + std::string(column.name), args->columns.*column.wanted, std::string(column.help));
  }
  flags::add_value(*command, "--measure", args->measures, "NAME[,NAME]",
                   "Add a column for each: solid-angle (in sr), overcast (the sky component of a daylight factor, of "
                   "the sky behind the source), sphere (the form factor from a small sphere at the point). All are "
                   "correctly rounded");
  flags::add_vector_option(*command, "--up", args->up, "Of --measure overcast: where the zenith is (default: 0 0 1)");
  command
      ->add_option("--total", args->total,
                   "Add columns total_r,total_g,total_b: this quantity from all sources together, correctly rounded, "
                   "as exactff render shows it (with --exr: radiance; with --radiosity: irradiance)")
      ->check(CLI::IsMember({"radiance", "radiosity", "irradiance", "form-factor"}));
  command->add_option("--ke", args->ke, "What Ke means in the scene, for totals (default: radiosity)")
      ->check(CLI::IsMember({"radiosity", "radiance"}));
  flags::add_value(*command, "--shard", args->shard, "I/N",
                   "Compute only part I of N, for exactff merge: 1/4 is the first of four");
  args->add_to(*command, "Start again and replace existing files");
  flags::add_value(*command, "--slow", args->slow_seconds, "SECONDS",
                   "Report every row that takes at least this many seconds")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  args->engine.add_to(*command);
  flags::add_value(*command, "--threads", args->threads, "N",
                   "Number of threads (default: all; under mpirun: this rank's share of the machine)")
      ->check(CLI::Range(1, 4096));
  flags::add_written(*command, "-o,--output", args->file,
                     "CSV file to write; - writes to standard output, without journal, --resume or shards",
                     flags::Format::kCsv, flags::Beside::kJournal)
      ->required();
  args->further.add_numpy_to(*command);
  args->further.add_vtk_to(*command);
  args->further.add_exr_to(*command);
  command->footer(kTruthFooter);
  return {command, [args] { return run(*args); }};
}

// --- exactff merge: joins the shards of a truth file or of a matrix ---

namespace {

constexpr const char* kMergeFooter =
    "Shards are the files that `exactff truth` or `exactff matrix` wrote with --shard 1/N to --shard N/N and\n"
    "otherwise the same flags. They can be given in any order. merge stops if a shard is missing, given twice,\n"
    "damaged, unfinished or from a run with other flags. FILE has the same bytes as the result of one run without\n"
    "shards. It appears only when it is complete.\n"
    "\n"
    "Example:\n"
    "  exactff merge truth.*.csv -o truth.csv";

struct MergeArguments {
  std::vector<std::string> shards;
  bool force = false;
  std::string file;
  FurtherFiles further;
};

// Returns the exit code.
int warn_of_wide_entries(const matrix::NamedMatrix& table) {
  std::ptrdiff_t wide = 0;
  for (const auto* entries : {&table.entries, &table.back, &table.open}) {
    wide += std::ranges::count(*entries, false, &ViewFactor::accurate);
  }
  if (wide == 0) return 0;
  print_warning(text::counted(static_cast<std::uint64_t>(wide), "entry is", "entries are") + " wider than the accuracy",
                "the column 'limit' tells why; their bounds are as strong as their claims",
                "run exactff matrix with --resume and -o for the merged file");
  return kNotAsAsked;
}

int merge_matrix(const MergeArguments& args, const jobs::RowHooks& hooks, const ProgressBar& bar) {
  if (const std::vector<std::string> further = args.further.flags(); !further.empty()) {
    text::refuse(further.front() + " is given with shards of a matrix", "it writes the values of a truth file",
                 "run exactff matrix with --resume, -o for the merged file and --npz");
  }
  const jobs::Summary summary = jobs::merge({args.shards.begin(), args.shards.end()}, args.file,
                                            args.force ? jobs::Existing::kReplace : jobs::Existing::kRefuse, hooks);
  bar.clear();
  std::cout << text::counted(summary.rows, "pair") << "\nMatrix: " << text::printable(args.file) << '\n';
  check_output(std::cout);
  return warn_of_wide_entries(matrix::read_named(args.file));
}

int run(const MergeArguments& args) {
  check_further_files(args.further, args.force);
  std::string given_up = "exactff: interrupted; nothing was written\n";
  const InterruptWatch watch(given_up);
  ProgressBar bar;
  const jobs::RowHooks hooks{.progress = [&](const Progress& progress) { bar.show(progress); },
                             .cancelled = is_interrupted};
  truth::Summary summary;
  try {
    if (table::kind_of(args.shards.front()) == "matrix") {
      return merge_matrix(args, hooks, bar);
    }
    summary = truth::merge({args.shards.begin(), args.shards.end()}, args.file,
                           args.force ? jobs::Existing::kReplace : jobs::Existing::kRefuse, hooks);
    given_up = "exactff: interrupted; " + text::printable(args.file) + " is complete, a NumPy file was not written\n";
    if (!args.further.npy.empty()) truth::write_npy(args.file, args.further.npy, hooks);
    if (!args.further.npz.empty()) truth::write_npz(args.file, args.further.npz, hooks);
  } catch (const Cancelled&) {
    bar.clear();
    std::cerr << given_up;
    return 128 + interrupting_signal();
  }
  bar.clear();
  return print_summary(summary, args.file, args.further);
}

}  // namespace

Command add_merge(CLI::App& app) {
  auto args = std::make_shared<MergeArguments>();
  CLI::App* command = app.add_subcommand("merge", "Join the shards of a truth file or of a matrix");
  flags::add_read(*command, "SHARD", args->shards, "Files written by exactff truth --shard or exactff matrix --shard")
      ->required();
  command->add_flag("--force", args->force, "Replace an existing file");
  flags::add_written(*command, "-o,--output", args->file, "CSV file to write", flags::Format::kCsv)->required();
  args->further.add_numpy_to(*command);
  command->footer(kMergeFooter);
  return {command, [args] { return run(*args); }};
}

}  // namespace exactff::cli
