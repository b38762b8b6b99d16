// The program: parse, call, print. Exit codes: 0 done, 1 a check failed, 2 bad input, 3 not certified, 4 internal.
#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <vector>

#include "cli/command.h"
#include "cli/exit_code.h"
#include "cli/help.h"
#include "cli/launch.h"
#include "cli/memory.h"
#include "exactff/version.h"

namespace {

constexpr const char* kDescription =
    "exactff: exact form factors from a point to a polygonal source, with occluders in between\n"
    "\n"
    "Start with `exactff info SCENE` to see what can be named, then\n"
    "  exactff point SCENE --at X Y Z --normal NX NY NZ --source NAME\n"
    "  exactff compare SCENE --on NAME --grid 32x32 -o DIR\n"
    "  exactff truth SCENE --on NAME --grid 32x32 -o truth.csv\n"
    "  exactff check truth.csv CANDIDATE.csv --max-abs 1e-4";

// Memory may also end where no exception may pass.
[[noreturn]] void end_at_once() {
  std::fputs("exactff: ended by an error that nothing could handle, such as the end of memory; no result was written\n",
             stderr);
  std::_Exit(exactff::cli::kInternalFailure);
}

void prepare_for_the_worst() {
  std::set_terminate(end_at_once);
  exactff::cli::throw_when_out_of_memory();
  std::signal(SIGXFSZ, SIG_IGN);  // writing beyond a limit on the size of files then fails, as on a full disk
}

}  // namespace

int main(int argc, char** argv) {
  prepare_for_the_worst();
  CLI::App app(kDescription, "exactff");
  app.formatter(exactff::cli::help_formatter());
  app.set_version_flag("--version", std::string("exactff ") + exactff::kVersion);
  app.require_subcommand(0, 1);
  const std::vector<exactff::cli::Command> commands = exactff::cli::add_commands(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (exactff::cli::launched_rank() > 0) return 0;  // under mpirun it is told once
    return app.exit(error, std::cout, std::cerr) == 0 ? 0 : exactff::cli::kBadInput;
  }
  for (const exactff::cli::Command& command : commands) {
    if (command.app->parsed()) return exactff::cli::exit_code_of(command.run);
  }
  std::cerr << app.help() << "\nName one of the commands.\n";
  return exactff::cli::kBadInput;
}
