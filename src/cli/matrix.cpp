// exactff matrix: view factors from patch to patch.
#include <algorithm>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/long_run.h"
#include "cli/output.h"
#include "cli/text_table.h"
#include "exactff/version.h"
#include "exactff/view_factors.h"
#include "flags/lists.h"
#include "flags/scene.h"
#include "text/csv_row.h"
#include "text/phrases.h"

namespace exactff::cli {
namespace {

constexpr const char* kMatrixFooter =
    "F_ij is the share of the light leaving patch i, in all directions, that reaches patch j: the mean over i of the\n"
    "form factor from a point to j. An entry is 'zero' if that is proved, else 'topology-proved': what is seen is "
    "proved\n"
    "on every cell of the patch, the error of the quadrature is estimated from two rules. An entry that needs more\n"
    "cells than --budget keeps its width, and a warning says so.\n"
    "\n"
    "Example:\n"
    "  exactff matrix data/scenes/cornell_box.obj --from light --to floor,ceiling --accuracy 1e-4";

constexpr std::size_t kMostShown = 12;  // rows and columns of the printed table

struct MatrixArguments {
  flags::SceneArguments scene;
  std::vector<std::string> from{"all"}, to{"all"};
  ViewFactorOptions options;
  bool plain = false;
  std::string csv;
  bool force = false;
  int threads = 0;
};

template <class Visit>
void for_each_entry(const ViewFactorMatrix& matrix, const Visit& visit) {
  for (std::size_t i = 0; i < matrix.from.size(); ++i) {
    for (std::size_t j = 0; j < matrix.to.size(); ++j) visit(matrix.from[i], matrix.to[j], matrix.at(i, j));
  }
}

void print_plain(const Scene& scene, const ViewFactorMatrix& matrix) {
  for_each_entry(matrix, [&](const Selection& from, const Selection& to, const ViewFactor& f) {
    std::cout << shown_name(scene, from) << '\t' << shown_name(scene, to) << '\t' << text::shortest(f.lower) << '\t'
              << text::shortest(f.upper) << '\t' << to_string(f.claim) << '\n';
  });
}

std::string csv_of(const MatrixArguments& args, const Scene& scene, const ViewFactorMatrix& matrix) {
  std::ostringstream out;
  out << "# exactff " << kVersion << " matrix: view factors from patch to patch, areas in the scene's unit squared\n"
      << "# scene hash " << scene.hash() << "; accuracy " << text::shortest(args.options.accuracy) << ", budget "
      << args.options.budget << " cells\n"
      << "from,to,factor,lower,upper,claim,accurate,area_from,area_to,cells,event_cells\n";
  for_each_entry(matrix, [&](const Selection& from, const Selection& to, const ViewFactor& f) {
    text::CsvRow(out) << scene.name_of(from) << scene.name_of(to) << f.value << f.lower << f.upper << to_string(f.claim)
                      << (f.accurate ? "yes" : "no") << f.area_from << f.area_to << f.cells << f.event_cells;
  });
  return std::move(out).str();
}

std::string factor_text(const ViewFactor& f) {
  if (f.claim == Claim::kZero) return "0";
  return text::rounded(f.value, 6) + (f.accurate ? "" : " *");
}

// A row's factors add up to 1 if its patch sees nothing else, no back of a face and nothing open.
void print_table(const Scene& scene, const ViewFactorMatrix& matrix) {
  TextTable table;
  table.add_column("from \\ to");
  const std::size_t columns = std::min(matrix.to.size(), kMostShown), rows = std::min(matrix.from.size(), kMostShown);
  for (std::size_t j = 0; j < columns; ++j) table.add_column(shown_name(scene, matrix.to[j]));
  table.add_column("sum of row");
  for (std::size_t i = 0; i < rows; ++i) {
    std::vector<std::string> cells{shown_name(scene, matrix.from[i])};
    double lower = 0.0, upper = 0.0;
    for (std::size_t j = 0; j < matrix.to.size(); ++j) {
      const ViewFactor& f = matrix.at(i, j);
      if (j < columns) cells.push_back(factor_text(f));
      lower += f.lower;
      upper += f.upper;
    }
    cells.push_back(text::rounded(0.5 * (lower + upper), 6) + " +- " + text::rounded(0.5 * (upper - lower), 1));
    table.add_row(std::move(cells));
  }
  table.print(std::cout);
  if (rows < matrix.from.size() || columns < matrix.to.size()) {
    std::cout << "\n(the first " << rows << " of " << matrix.from.size() << " rows and " << columns << " of "
              << matrix.to.size() << " columns; --plain and -o have all)\n";
  }
}

void warn_of_width(const MatrixArguments& args, const ViewFactorMatrix& matrix) {
  const auto wide = std::ranges::count_if(matrix.entries, [](const ViewFactor& f) { return !f.accurate; });
  if (wide == 0) return;
  print_warnings(std::vector<Problem>{
      {.what = text::counted(static_cast<std::uint64_t>(wide), "entry", "entries") + (wide == 1 ? " is" : " are") +
               " wider than the accuracy " + text::shortest(args.options.accuracy),
       .why =
           "the budget of " + std::to_string(args.options.budget) + " cells is used up; their bounds hold all the same",
       .suggestion = "give more cells by --budget, or ask for less by --accuracy"}});
}

int run(const MatrixArguments& args) {
  if (!args.csv.empty()) require_free_file(args.csv, args.force);
  const Scene scene = args.scene.load();
  print_warnings(scene.warnings());
  const std::vector<Selection> from = flags::selections_named(scene, args.from),
                               to = flags::selections_named(scene, args.to);
  ProgressBar bar;
  const Hooks hooks{[&](const Progress& progress) { bar.show(progress); }, is_interrupted};
  const ViewFactorMatrix matrix = view_factor_matrix(scene, from, to, args.options, args.threads, hooks);
  bar.clear();
  warn_of_width(args, matrix);
  if (!args.csv.empty()) write_whole_file(args.csv, csv_of(args, scene, matrix));
  if (args.plain) {
    print_plain(scene, matrix);
  } else {
    print_table(scene, matrix);
    if (!args.csv.empty()) std::cout << "\nMatrix: " << text::printable(args.csv) << '\n';
  }
  check_output(std::cout);
  return 0;
}

}  // namespace

Command add_matrix(CLI::App& app) {
  auto args = std::make_shared<MatrixArguments>();
  CLI::App* command = app.add_subcommand("matrix", "Compute view factors from patch to patch");
  command->footer(kMatrixFooter);
  args->scene.add_to(*command);
  command->add_option("--from", args->from, "Rows: patches or faces, a name, a comma list of names, or all")
      ->type_name("NAME")
      ->capture_default_str();
  command->add_option("--to", args->to, "Columns, in the same way")->type_name("NAME")->capture_default_str();
  command->add_option("--accuracy", args->options.accuracy, "Largest width of an entry, for F_ij and for F_ji")
      ->capture_default_str();
  command->add_option("--budget", args->options.budget, "Largest number of cells for an entry")
      ->check(CLI::Range(std::size_t{1}, std::size_t{1} << 32))
      ->capture_default_str();
  command->add_flag("--plain", args->plain, "Print a line for each entry: FROM, TO, LOWER, UPPER, CLAIM, with tabs");
  command->add_option("-o,--output", args->csv, "Write a CSV file")->type_name("FILE");
  command->add_flag("--force", args->force, "Replace an existing file");
  command->add_option("--threads", args->threads, "Number of threads (default: all); it does not affect the values")
      ->check(CLI::Range(0, 1024));
  return {command, [args] { return run(*args); }};
}

}  // namespace exactff::cli
