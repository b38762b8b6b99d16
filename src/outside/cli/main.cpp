// The program: parse, call, print. Exit codes: 0 done, 1 a check failed, 2 bad input, 3 not as accurate or certified as
// asked, 4 internal.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <iostream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/exit_code.h"
#include "cli/launch.h"
#include "cli/long_run.h"
#include "cli/memory.h"
#include "cli/misused_flags.h"
#include "cli/output.h"
#include "cli/streams.h"
#include "exactff/error.h"
#include "exactff/version.h"
#include "flags/file_options.h"
#include "text/escape.h"

namespace {

constexpr const char* kDescription =
    "exactff: exact form factors from a point to a polygonal source, with occluders\n"
    "\n"
    "The form factor F from a point x to a patch s is the share of the diffuse light leaving x that reaches s\n"
    "directly:\n"
    "  F = integral over the part of s visible from x of  max(0, cos th_r) max(0, cos th_s) / (pi r^2) dA\n"
    "r is the distance, th_r and th_s are the angles to the normals at x and on s. A receiver is a point x with its\n"
    "normal. A source is a patch s. An occluder is a face between them that hides part of s. A value is certified if\n"
    "it is proved to be F rounded to the nearest double.\n"
    "\n"
    "`exactff help COMMAND` explains a command and its flags. Start with `exactff info SCENE`, which lists the names\n"
    "of the patches. Then, for example:\n"
    "  exactff point SCENE --at X Y Z --normal NX NY NZ --source NAME\n"
    "  exactff compare SCENE --on NAME --grid 32x32 -o DIR\n"
    "  exactff truth SCENE --on NAME --grid 32x32 -o truth.csv\n"
    "  exactff check truth.csv CANDIDATE.csv --max-abs 1e-4";

void prepare_for_the_worst() {
  exactff::cli::occupy_closed_streams();
  exactff::cli::throw_when_out_of_memory();
  std::signal(SIGXFSZ, SIG_IGN);  // writing beyond a limit on file sizes then fails, as on a full disk
}

int end_of_parsing(const CLI::App& app, const CLI::ParseError& error) {
  if (exactff::cli::launched_rank() > 0) return 0;  // under mpirun only rank 0 prints it
  std::ostringstream out, err;
  const bool done = app.exit(error, out, err) == 0;  // --help, --version
  std::cerr << exactff::text::printable(err.str(), "\n");
  std::cout << out.str();
  return done ? 0 : exactff::cli::kBadInput;
}

// The exit code, if there is nothing to run.
std::optional<int> parse(CLI::App& app, int argc, char** argv) {
  const std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  if (argc > 1 && *argv[1] != '-') exactff::cli::require_command(app, argv[1]);
  exactff::cli::refuse_flags_without_values(app, words);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) exactff::cli::refuse_misused_flags(app, words);
    return end_of_parsing(app, error);
  }
  for (const CLI::App* command : app.get_subcommands()) exactff::flags::require_outputs_apart(*command);
  return std::nullopt;
}

// Under mpirun, every process finds the same mistake, and only rank 0 tells it.
std::optional<int> parse_and_tell_once(CLI::App& app, int argc, char** argv) {
  try {
    return parse(app, argc, argv);
  } catch (const exactff::InputError&) {
    if (exactff::cli::launched_rank() > 0) return 0;
    throw;
  }
}

int parse_and_run(int argc, char** argv) {
  CLI::App app(kDescription, "exactff");
  app.formatter(exactff::cli::help_formatter());
  app.set_version_flag("--version", std::string("exactff ") + exactff::kVersion);
  app.require_subcommand(0, 1);
  const std::vector<exactff::cli::Command> commands = exactff::cli::add_commands(app);
  if (const std::optional<int> exit_code = parse_and_tell_once(app, argc, argv)) return *exit_code;
  for (const exactff::cli::Command& command : commands) {
    if (command.app->parsed()) return exactff::cli::unless_interrupted(command.run);
  }
  std::cerr << app.help() << "\nGive one of the commands.\n";
  return exactff::cli::kBadInput;
}

}  // namespace

int main(int argc, char** argv) {
  prepare_for_the_worst();
  return exactff::cli::exit_code_of([&] {
    const int exit_code = parse_and_run(argc, argv);
    exactff::cli::check_output(std::cout);
    return exit_code;
  });
}
