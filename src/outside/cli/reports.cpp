// exactff compare: compares approximate methods with the exact values, as tables and a report.
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/output.h"
#include "cli/process.h"
#include "exactff/slips.h"
#include "exactff/study.h"
#include "files/file.h"
#include "flags/comparison.h"
#include "flags/scene.h"
#include "flags/values.h"
#include "report/plan.h"
#include "stress/stress.h"
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
    "Instead of SCENE, a .study file describes several scenes, one per line with the same flags:\n"
    "  title Rooms\n"
    "  scene cornell_box.obj --on floor --grid 32x32 --title \"Cornell box\"\n"
    "Settings that cannot affect a scene are left out, and the report says which and why.\n"
    "Times are measured after all values, on one thread.\n"
    "DIR appears only when it is complete. Until then, finished values are kept in DIR.part. After an interruption,\n"
    "the same command with --resume continues from there. A finished DIR is never replaced without --force; with\n"
    "--resume, a finished DIR of the same request stays as it is, so that scripts can always give --resume.\n"
    "\n"
    "Examples:\n"
    "  exactff compare data/scenes/cornell_box.obj --on floor --grid 32x32 -o cornell-report\n"
    "  exactff compare data/studies/quick.study -o report";

struct CompareArguments : KeptRun {
  flags::ComparisonArguments scene;
  int threads = 0;
  std::string folder;
  FurtherFiles further;
};

std::string command_line(const CompareArguments& args) {
  std::string line = "exactff compare";
  line += ' ' + text::shell_word(args.scene.scene.path);
  line += flags::command_words(*args.scene.scene.command, {"--resume", "--force", "--output"});
  return line + " -o " + text::shell_word(args.folder);
}

// A finished folder holds hours of work, as a truth file does. Checked before anything that takes time.
void require_free(const CompareArguments& args) {
  if (args.folder == "-") {
    text::refuse("-o - names no folder", "a report is a page and several tables, which no pipe can carry",
                 "name a folder, or ./- for one of that name");
  }
  if (args.force || args.resume || !report::has_report(args.folder)) return;
  text::refuse(args.folder, "holds a finished report", "a finished result is not replaced by accident",
               "name another folder, keep it with --resume if it is of the same request, or replace it with --force");
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
    text::refuse(args.folder, "holds the finished report of another request, or of another version of exactff",
                 "--resume continues the same request and replaces nothing",
                 "use the same flags as before, name another folder, or replace it with --force");
  }
  return finished == report::Finished::kOfThis;
}

report::Plan plan_of(const CompareArguments& args) {
  const std::string& path = args.scene.scene.path;
  const std::string flags =
      flags::command_words(*args.scene.scene.command, {"--threads", "--output", "--vtk", "--resume", "--force"});
  report::Plan plan;
  if (flags::is_study_file(path)) {
    if (!flags.empty()) {
      text::refuse("flags of a scene are given with a study file:" + flags,
                   "a study file has several scenes, each with its own flags",
                   "write them on the scene's line in the file");
    }
    plan = flags::read_study_file(path, args.threads);
    plan.flags = text::read_text_file(path, "a study file");
  } else {
    flags::Comparison one = flags::comparison_of(args.scene, args.threads);
    plan.add_scene(one.title, std::move(one.scene), std::move(one.request), std::move(one.warnings));
    plan.scenes.front().name.clear();
    plan.flags = flags;
  }
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
  const Hooks hooks = bar.hooks();
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

}  // namespace

Command add_compare(CLI::App& app) {
  auto args = std::make_shared<CompareArguments>();
  CLI::App* command =
      app.add_subcommand("compare", "Compare approximate methods with the exact values: error and run time");
  args->scene.add_to(*command);
  command->get_option("SCENE")->description(
      "Scene file (OBJ, glTF, PLY, STL, OFF, View3D), @MODEL for a generated scene, or a .study file with several "
      "scenes");
  flags::add_threads(*command, args->threads);
  flags::add_value(*command, "-o,--output", args->folder, "DIR", "Folder for the report and the tables")
      ->required()
      ->check(flags::is_written_folder());
  args->further.add_vtk_to(*command);
  args->add_to(*command, "Start again: discard the work of an interrupted run, replace a finished DIR");
  command->footer(kCompareFooter);
  return {command, [command, args] { return run(*command, *args); }};
}

// --- Stress ---

// exactff stress: makes scenes more and more extreme and shows where each method stops being usable.

namespace {

constexpr const char* kStressFooter =
    "A family is a scene with one number, its stiffness, that makes the scene more and more extreme. Without\n"
    "--family, all families are run; --list prints their names. A table shows the largest stiffness up to which each\n"
    "method's error stays below 1e-3, 1e-6 and 1e-12; Tampieri's algorithm is judged by the tolerance that it was\n"
    "given, 1e-4 of the unoccluded form factor. With --all, a table for each family shows the relative errors at\n"
    "each stiffness. With -o, all values are written as a table. After an interruption (Ctrl-C), the finished\n"
    "families are shown, and no file is written.\n"
    "acos, atan2, atan2-difference: Tampieri's contour formula, Eq. (4), in double over the exact visible region.\n"
    "tampieri, tampieri-literal: his ray-sampled algorithm, mended and as printed.\n"
    "Use --threads 1 for the most reliable times.\n"
    "The exit code is 1 if an exact value differs from the independent true value rounded to a double.\n"
    "\n"
    "Example:\n"
    "  exactff stress -o stress.csv";

struct StressArguments {
  std::vector<std::string> families;
  int threads = 0;
  std::string file;
  bool list = false;
  bool all = false;
};

void print_list() {
  for (const stress::Family& family : stress::all_families()) {
    std::cout << family.name << ": " << family.title << "; stiffness: " << family.stiffness << "\n  " << family.about
              << '\n';
  }
}

void print_family(const stress::FamilyResult& result) {
  std::cout << result.family->title << " (" << result.family->name << ")\n"
            << "stiffness: " << result.family->stiffness << "; truth: " << to_string(result.family->evidence) << '\n';
  TextTable table;
  table.add_columns({"stiffness", "form factor", "exact bits", "exact time"}, Align::kRight);
  for (stress::Method method : stress::kMethods) table.add_column(std::string(short_name_of(method)), Align::kRight);
  for (const stress::Row& row : result.rows) {
    const stress::Answer& exact = row.of(stress::Method::kExact);
    std::vector<std::string> cells = {stress::stiffness_text(row.stiffness), text::rounded(exact.value, 6),
                                      std::to_string(row.precision_bits), text::duration(row.exact_seconds)};
    for (stress::Method method : stress::kMethods) cells.push_back(stress::error_text(row.of(method)));
    if (!row.agrees) cells.back() += "  DISAGREES with the truth";
    table.add_row(std::move(cells));
  }
  table.print(std::cout);
  std::cout << '\n';
}

void print_stress_summary(const stress::Report& report) {
  std::cout << "Largest stiffness with an error below 1e-3, 1e-6, 1e-12, or of tampieri within the tolerance that it "
               "was given\n(all: to the end; –: not even at the start)\n";
  TextTable table;
  table.add_column("family");
  table.add_column("ends at", Align::kRight);
  for (stress::Method method : stress::kMethods) table.add_column(std::string(short_name_of(method)));
  for (const stress::FamilyResult& family : report.families) {
    std::vector<std::string> cells = {std::string(family.family->name),
                                      stress::stiffness_text(family.rows.back().stiffness)};
    for (stress::Method method : stress::kMethods) cells.push_back(stress::reaches_text(family, method));
    table.add_row(std::move(cells));
  }
  table.print(std::cout);
  std::cout << '\n';
}

void print(const StressArguments& args, const stress::Report& report) {
  if (args.all) {
    for (const stress::FamilyResult& family : report.families) print_family(family);
  }
  print_stress_summary(report);
  for (const std::string& sentence : stress::headlines(report)) std::cout << sentence << '\n';
  if (!args.all) std::cout << "--all prints every error.\n";
}

int run(const StressArguments& args) {
  if (args.list) {
    print_list();
    check_output(std::cout);
    return 0;
  }
  if (!args.file.empty()) require_table_file(args.file);
  const std::string given_up = "exactff: interrupted; no family is finished, and nothing was written\n";
  const InterruptWatch watch(given_up);
  ProgressBar bar;
  const Hooks hooks = bar.hooks();
  stress::Report report;
  try {
    report = stress::run({args.families, args.threads}, hooks);
  } catch (const Cancelled&) {
    bar.clear();
    std::cerr << given_up;
    return 128 + interrupting_signal();
  }
  bar.clear();
  if (report.unfinished == 0 && !args.file.empty()) table::write(stress::table_of(report), args.file);
  print(args, report);
  if (report.unfinished == 0 && !args.file.empty()) std::cout << "Values: " << text::printable(args.file) << '\n';
  check_output(std::cout);
  if (report.unfinished == 0) return report.sound() ? 0 : 1;
  std::cerr << "exactff: interrupted; finished families: " << report.families.size() << " of "
            << report.families.size() + report.unfinished << "; --family runs single ones\n";
  return 128 + interrupting_signal();
}

}  // namespace

Command add_stress(CLI::App& app) {
  auto args = std::make_shared<StressArguments>();
  CLI::App* command =
      app.add_subcommand("stress", "Show how the methods behave as scenes become more and more extreme");
  flags::add_value(*command, "--family", args->families, "FAMILY", "Families, separated by commas (default: all)")
      ->delimiter(',');
  command->add_flag("--list", args->list, "List the families and what their stiffness means");
  command->add_flag("--all", args->all, "Also print the errors at each stiffness, about a thousand lines");
  flags::add_threads(*command, args->threads);
  flags::add_written(*command, "-o,--output", args->file,
                     "File for all values: .csv, .npz or .jsonl; an existing one is replaced", flags::Format::kTable);
  command->footer(kStressFooter);
  return {command, [args] { return run(*args); }};
}

}  // namespace exactff::cli
