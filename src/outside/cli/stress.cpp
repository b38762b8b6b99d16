// exactff stress: makes scenes more and more extreme and shows where each method stops being usable.
#include "stress/stress.h"

#include <iostream>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/output.h"
#include "cli/process.h"
#include "flags/values.h"
#include "report/plan.h"
#include "text/escape.h"
#include "text/phrases.h"

namespace exactff::cli {
namespace {

constexpr const char* kStressFooter =
    "A family is a scene with one number, its stiffness, that makes the scene more and more extreme. Without\n"
    "--family, all families are run; --list prints their names. A table shows the largest stiffness up to which each\n"
    "method's error stays below 1e-3, 1e-6 and 1e-12; Tampieri's algorithm is judged by the tolerance that it was "
    "given,\n"
    "1e-4 of the unoccluded form factor. With --all, a table for each family shows the relative errors at\n"
    "each stiffness. With -o, all tables are written as CSV, with a report and figures. After an interruption "
    "(Ctrl-C),\n"
    "the finished families are shown, and with -o they are written to DIR.part.\n"
    "acos, atan2, atan2-difference: Tampieri's contour formula, Eq. (4), in double over the exact visible region.\n"
    "tampieri, tampieri-literal: his ray-sampled algorithm, mended and as printed.\n"
    "Use --threads 1 for the most reliable times.\n"
    "The exit code is 1 if an exact value differs from the independent true value rounded to a double.\n"
    "\n"
    "Example:\n"
    "  exactff stress -o stress-report";

struct StressArguments {
  std::vector<std::string> families;
  int threads = 0;
  std::string folder;
  bool list = false;
  bool all = false;
};

void print_list() {
  TextTable table;
  table.add_columns({"family", "stiffness", "what happens"});
  for (const stress::FamilyInfo& family : stress::families()) {
    table.add_row({std::string(family.name), std::string(family.stiffness), std::string(family.title)});
  }
  table.print(std::cout);
}

void print_family(const stress::FamilyResult& result) {
  std::cout << result.family.title << " (" << result.family.name << ")\n"
            << "stiffness: " << result.family.stiffness << "; truth: " << to_string(result.family.evidence) << '\n';
  TextTable table;
  table.add_columns({"stiffness", "form factor", "exact bits", "exact time"}, Align::kRight);
  for (stress::Method method : stress::kMethods) table.add_column(std::string(short_name_of(method)), Align::kRight);
  for (const stress::Row& row : result.rows) {
    const stress::Answer& exact = row.of(stress::Method::kExact);
    std::vector<std::string> cells = {stress::stiffness_text(row.stiffness), text::rounded(exact.value, 6),
                                      std::to_string(row.precision_bits), text::duration(exact.seconds)};
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
    std::vector<std::string> cells = {std::string(family.family.name),
                                      stress::stiffness_text(family.rows.back().stiffness)};
    for (stress::Method method : stress::kMethods) cells.push_back(stress::reaches_text(family, method));
    table.add_row(std::move(cells));
  }
  table.print(std::cout);
  std::cout << '\n';
}

std::string command_line(const StressArguments& args) {
  std::string line = "exactff stress";
  for (std::size_t i = 0; i < args.families.size(); ++i) line += (i == 0 ? " --family " : ",") + args.families[i];
  if (args.threads > 0) line += " --threads " + std::to_string(args.threads);
  return line + " -o " + text::shell_word(args.folder);
}

void print(const StressArguments& args, const stress::Report& report) {
  if (args.all) {
    for (const stress::FamilyResult& family : report.families) print_family(family);
  }
  print_stress_summary(report);
  for (const std::string& sentence : stress::headlines(report)) std::cout << sentence << '\n';
  if (!args.all) std::cout << "--all prints every error.\n";
}

std::string page_in(const std::filesystem::path& folder) { return text::printable((folder / "report.html").string()); }

// Leaves what is finished in DIR.part, and says so.
int end_early(const StressArguments& args, const stress::Report& report) {
  const std::size_t whole = report.families.size() + report.unfinished.size();
  if (!args.folder.empty()) stress::write_part(report, args.folder);
  print(args, report);
  check_output(std::cout);
  std::cerr << "exactff: interrupted; finished families: " << report.families.size() << " of " << whole;
  if (!args.folder.empty()) std::cerr << ", kept in " << page_in(stress::part_of(args.folder));
  std::cerr << "; --family runs single ones\n";
  return 128 + interrupting_signal();
}

int run(const StressArguments& args) {
  if (args.list) {
    print_list();
    check_output(std::cout);
    return 0;
  }
  if (!args.folder.empty()) check_output_folder(args.folder);
  const std::string given_up = "exactff: interrupted; no family is finished, and nothing was written\n";
  const InterruptWatch watch(given_up);
  ProgressBar bar;
  const Hooks hooks{[&](const Progress& progress) { bar.show(progress); }, is_interrupted};
  stress::Report report;
  std::vector<std::string> messages;
  bool complete = false;
  try {
    report =
        stress::run({args.families, args.threads, args.folder.empty() ? std::string() : command_line(args)}, hooks);
    complete = report.unfinished.empty();
    if (complete && !args.folder.empty()) messages = stress::write(report, args.folder, hooks);
  } catch (const Cancelled&) {
    bar.clear();
    if (complete) return end_early(args, report);
    std::cerr << given_up;
    return 128 + interrupting_signal();
  }
  bar.clear();
  if (!complete) return end_early(args, report);
  for (const std::string& message : messages) std::cerr << "note: " << text::printable(message) << '\n';
  print(args, report);
  if (!args.folder.empty()) std::cout << "Report: " << page_in(args.folder) << '\n';
  check_output(std::cout);
  return report.sound() ? 0 : 1;
}

}  // namespace

Command add_stress(CLI::App& app) {
  auto args = std::make_shared<StressArguments>();
  CLI::App* command =
      app.add_subcommand("stress", "Show how the methods behave as scenes become more and more extreme");
  command->add_option("--family", args->families, "Families, separated by commas (default: all)")
      ->delimiter(',')
      ->type_name("FAMILY");
  command->add_flag("--list", args->list, "List the families and what their stiffness means");
  command->add_flag("--all", args->all, "Also print the errors at each stiffness, about a thousand lines");
  flags::add_threads(*command, args->threads);
  command->add_option("-o,--output", args->folder, "Folder for the report and the tables")
      ->type_name("DIR")
      ->check(flags::is_written_folder());
  command->footer(kStressFooter);
  return {command, [args] { return run(*args); }};
}

}  // namespace exactff::cli
