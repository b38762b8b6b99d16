// exactff merge: joins the shards of a truth file or of a matrix.
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/further_files.h"
#include "cli/process.h"
#include "cli/truth_summary.h"
#include "exactff/matrix.h"
#include "exactff/truth.h"
#include "flags/file_options.h"
#include "text/escape.h"
#include "text/phrases.h"
#include "text/refuse.h"

namespace exactff::cli {
namespace {

constexpr const char* kMergeFooter =
    "Shards are the files that `exactff truth` or `exactff matrix` wrote with --shard 1/N to --shard N/N and "
    "otherwise\n"
    "the same flags. They can be given in any order. merge stops if a shard is missing, given twice, damaged,\n"
    "unfinished or from a run with other flags. FILE has the same bytes as the result of one run without shards. It\n"
    "appears only when it is complete.\n"
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
  print_warnings(
      std::vector<Problem>{{.what = text::counted(static_cast<std::uint64_t>(wide), "entry", "entries") +
                                    (wide == 1 ? " is" : " are") + " wider than the accuracy",
                            .why = "the column 'limit' tells why; their bounds are as strong as their claims",
                            .suggestion = "run exactff matrix with --resume and -o for the merged file"}});
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
