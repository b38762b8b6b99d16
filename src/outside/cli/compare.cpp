// exactff compare: compares approximate methods with the exact values, as tables and a report.
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/output.h"
#include "cli/process.h"
#include "exactff/slips.h"
#include "exactff/study.h"
#include "files/file.h"
#include "flags/comparison.h"
#include "flags/receivers.h"
#include "flags/values.h"
#include "report/plan.h"
#include "text/escape.h"
#include "text/phrases.h"
#include "text/refuse.h"
#include "text/text_lines.h"

namespace exactff::cli {
namespace {

constexpr const char* kCompareFooter =
    "Tampieri's ray-sampled adaptive algorithm splits the source into parts until the tolerance is met: a part that\n"
    "is not split further is a leaf, and shadow rays estimate the visible fraction of an undecided leaf. If the lists\n"
    "make at most 40 combinations, all of them are run. Otherwise each --eps-b is run with each --rays, and the other\n"
    "lists are varied one at a time around a base setting (the middle --eps-b and --rays, the first value of the\n"
    "others).\n"
    "A METHOD is a name with settings; one setting may have several values: hemicube:resolution=64|128|256. Names:\n"
    "exact, adaptive, adaptive-exact-visibility, hemicube, nettle, wallace, area-sampling.\n"
    "Instead of SCENE, a .study file describes several scenes, one per line with the same flags, and experiments:\n"
    "  title Rooms\n"
    "  scene cornell_box.obj --on floor --grid 32x32 --title \"Cornell box\"\n"
    "  experiment karkanis-times\n"
    "Settings that cannot affect a scene are left out, and the report says which and why.\n"
    "Times are measured after all values, on one thread.\n"
    "DIR appears only when it is complete. Until then, finished values are kept in DIR.part. After an interruption, "
    "the\n"
    "same command with --resume continues from there. A finished DIR is never replaced without --force; with "
    "--resume,\n"
    "a finished DIR of the same request stays as it is, so that scripts can always give --resume.\n"
    "\n"
    "Examples:\n"
    "  exactff compare data/scenes/cornell_box.obj --on floor --grid 32x32 -o cornell-report\n"
    "  exactff compare data/studies/default.study --abridged -o report\n"
    "  exactff compare --experiment meshing -o cells";

struct CompareArguments {
  flags::ComparisonArguments scene;
  std::vector<std::string> experiments;
  bool abridged = false;
  int threads = 0;
  std::string folder;
  bool resume = false;
  bool force = false;
  FurtherFiles further;

  [[nodiscard]] jobs::Existing existing() const { return existing_of(resume, force); }
};

std::string command_line(const CompareArguments& args) {
  std::string line = "exactff compare";
  if (const std::string& path = args.scene.scene.path; !path.empty()) line += ' ' + text::shell_word(path);
  line += flags::command_words(*args.scene.scene.command, {"--resume", "--force", "--output"});
  return line + " -o " + text::shell_word(args.folder);
}

// Those that describe a scene.
std::string scene_flags(const CompareArguments& args) {
  return flags::command_words(*args.scene.scene.command,
                              {"--experiment", "--abridged", "--threads", "--output", "--vtk", "--resume", "--force"});
}

// A finished folder holds hours of work, as a truth file does. Checked before anything that takes time.
void require_free(const CompareArguments& args) {
  if (args.folder == "-") {
    text::refuse("-o - names no folder", "a report is a page and several tables, which no pipe can carry",
                 "name a folder, or ./- for one of that name");
  }
  if (args.force || args.resume || !report::has_report(args.folder)) return;
  throw InputError(
      {.file = args.folder,
       .what = "holds a finished report",
       .why = "a finished result is not replaced by accident",
       .suggestion =
           "name another folder, keep it with --resume if it is of the same request, or replace it with --force"});
}

void check_outputs(const CompareArguments& args) {
  require_free(args);
  check_output_folder(args.folder);
  if (!args.further.vtk.empty() && flags::is_study_file(args.scene.scene.path)) {
    text::refuse("--vtk is given with a study file", "a VTK file shows the receivers of one scene",
                 "compare each scene by itself, or leave out --vtk");
  }
  check_further_files(args.further, args.force || args.resume);
}

// A finished report has tables only, and the files of --vtk were made before it.
void require_vtk_of_finished(const CompareArguments& args) {
  const std::string& file = args.further.vtk;
  if (file.empty() || files::is_there(file)) return;
  text::refuse(args.folder, "holds the finished report, and " + text::in_quotes(file) + " is not there",
               "the report does not keep the values of every method at every receiver",
               "compute both again with --force");
}

// With --resume: true if the folder is the finished result of this very request.
bool is_done(const CompareArguments& args, const report::Plan& plan) {
  if (!args.resume || files::is_there(jobs::journal_of_folder(args.folder))) return false;
  const report::Finished finished = report::finished_report(plan, args.folder);
  if (finished == report::Finished::kOfAnother) {
    throw InputError({.file = args.folder,
                      .what = "holds the finished report of another request, or of another version of exactff",
                      .why = "--resume continues the same request and replaces nothing",
                      .suggestion = "use the same flags as before, name another folder, or replace it with --force"});
  }
  return finished == report::Finished::kOfThis;
}

report::Plan plan_of(const CompareArguments& args) {
  const report::Effort effort{args.abridged, args.threads};
  const std::string& path = args.scene.scene.path;
  report::Plan plan;
  if (path.empty()) {
    if (args.experiments.empty()) {
      text::refuse("SCENE is required", "there is nothing to compare",
                   "name a scene, a .study file or an --experiment");
    }
    const std::string flags = scene_flags(args);
    if (!flags.empty()) {
      text::refuse("flags of a scene are given without a scene:" + flags, "an experiment has scenes of its own",
                   "name the scene, or remove the flags");
    }
    plan.title = "Experiments";
    plan.effort = effort;
  } else if (flags::is_study_file(path)) {
    const std::string flags = scene_flags(args);
    if (!flags.empty()) {
      text::refuse("flags of a scene are given with a study file:" + flags,
                   "a study file has several scenes, each with its own flags",
                   "write them on the scene's line in the file");
    }
    plan = flags::read_study_file(path, effort);
  } else {
    if (args.scene.unless_abridged) {
      text::refuse("--unless-abridged has no effect on the command line", "it marks a scene in a study file",
                   "remove it, or write the scene into a .study file");
    }
    flags::Comparison one = flags::comparison_of(args.scene, effort.abridged, effort.threads);
    plan.effort = effort;
    plan.add_scene(one.title, std::move(one.scene), std::move(one.request), std::move(one.warnings));
    if (args.experiments.empty()) plan.scenes.front().name.clear();
    if (!args.experiments.empty()) plan.title = one.title;
  }
  plan.add_experiments(args.experiments);
  plan.command_line = command_line(args);
  plan.vtk = args.further.vtk;
  return plan;
}

void print(const report::Outcome& outcome) {
  const bool several = outcome.scenes.size() > 1;
  for (const report::Outcome::OfScene& scene : outcome.scenes) {
    if (several) std::cout << text::printable(scene.title) << '\n';
    for (const std::string& sentence : scene.sentences) {
      std::cout << (several ? "  " : "") << text::printable(sentence) << '\n';
    }
  }
}

int say_where(const CompareArguments& args) {
  std::cout << "Report: " << text::printable((std::filesystem::path(args.folder) / "report.html").string()) << '\n';
  print_further_files(args.further);
  check_output(std::cout);
  return 0;
}

void print_warnings_of(const report::PlannedScene& planned, bool several) {
  const study::Request& request = planned.request;
  print_warnings(planned.scene->warnings());
  print_warnings(planned.warnings);
  print_near_misses(*planned.scene, request.receivers);
  std::vector<Problem> dark = slips::warnings_of_dark_sources(*planned.scene, request.receivers, request.sources);
  std::ranges::move(slips::warnings_of_turned_surfaces(*planned.scene), std::back_inserter(dark));
  for (Problem& warning : dark) {
    if (several) warning.what = planned.title + ": " + warning.what;
  }
  print_warnings(dark);
  const std::string note = flags::note_on_sources_without_emission(*planned.scene, request.sources);
  if (!note.empty()) std::cerr << "note: " << text::printable((several ? planned.title + ": " : "") + note) << '\n';
}

int run(const CLI::App& command, const CompareArguments& args) {
  check_outputs(args);
  const report::Plan plan = with_progress([&] { return plan_of(args); });
  flags::require_not_written(command, plan.files_read);
  for (const report::PlannedScene& scene : plan.scenes) print_warnings_of(scene, plan.scenes.size() > 1);
  if (is_done(args, plan)) {
    require_vtk_of_finished(args);
    std::cerr
        << "note: the report is finished and of the same request, so it was left as it is; --force makes it anew\n";
    return say_where(args);
  }
  jobs::Journal journal(jobs::journal_of_folder(args.folder), args.existing());
  const std::string kept = "finished work is kept in " + text::printable(journal.path().string()) +
                           "; to continue, run the same command with --resume\n";
  const InterruptWatch watch("exactff: interrupted; " + kept);
  ProgressBar bar;
  const Hooks hooks{[&](const Progress& progress) { bar.show(progress); }, is_interrupted};
  const std::size_t resumed = journal.size();
  try {
    const report::Outcome outcome = report::carry_out(plan, args.folder, journal, hooks);
    bar.clear();
    journal.remove();
    if (resumed > 0)
      std::cerr << "note: " << resumed << " finished pieces of work were reused from the interrupted run\n";
    for (const std::string& note : outcome.notes) std::cerr << "note: " << text::printable(note) << '\n';
    print(outcome);
  } catch (const Cancelled&) {
    bar.clear();
    std::cerr << "exactff: interrupted; " << (journal.size() > 0 ? kept : "nothing was written\n");
    return 128 + interrupting_signal();
  } catch (const InputError&) {  // for example a full disk
    bar.clear();
    if (journal.size() > 0) std::cerr << "note: " << kept;
    throw;
  }
  return say_where(args);
}

std::string experiment_list() {
  std::string names;
  for (const std::string& name : report::experiment_names()) names += name + ", ";
  return names + "or all, which leaves out meshing-fine";
}

}  // namespace

Command add_compare(CLI::App& app) {
  auto args = std::make_shared<CompareArguments>();
  CLI::App* command =
      app.add_subcommand("compare", "Compare approximate methods with the exact values: error and run time");
  args->scene.add_to(*command);
  command->get_option("SCENE")
      ->description(
          "Scene file (OBJ, PLY, STL, OFF, View3D), @MODEL for a generated scene, or a .study file with several "
          "scenes; not needed with --experiment")
      ->required(false);
  command
      ->add_option("--experiment", args->experiments,
                   "Add an experiment to the report; can be repeated: " + experiment_list())
      ->type_name("EXPERIMENT")
      ->delimiter(',')
      ->take_all();
  command->add_flag("--abridged", args->abridged,
                    "Run a short version: grids of at most 12x12, fewer settings and receivers, short experiments");
  flags::add_threads(*command, args->threads);
  command->add_option("-o,--output", args->folder, "Folder for the report and the tables")
      ->required()
      ->type_name("DIR")
      ->check(flags::is_written_folder());
  args->further.add_vtk_to(*command);
  CLI::Option* resume = command->add_flag("--resume", args->resume, "Continue an interrupted run, if there is one");
  command
      ->add_flag("--force", args->force, "Start again: discard the work of an interrupted run, replace a finished DIR")
      ->excludes(resume);
  command->footer(kCompareFooter);
  return {command, [command, args] { return run(*command, *args); }};
}

}  // namespace exactff::cli
