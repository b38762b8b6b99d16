// The program: parse, call, print. Exit codes: 0 done, 1 a check failed, 2 bad input, 3 not certified, 4 internal.
#include <CLI/CLI.hpp>
#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <new>
#include <stdexcept>
#include <system_error>

#include "cli/command.h"
#include "cli/memory.h"
#include "exactff/error.h"
#include "exactff/version.h"

namespace {

constexpr int kBadInput = 2;
constexpr int kInternalFailure = 4;

constexpr const char* kOutOfMemory =
    "exactff: out of memory (the scene and what is asked of it need more than there is); nothing was written; use a "
    "smaller scene or grid or fewer --threads, or raise the limit\n";

constexpr const char* kDescription =
    "exactff: exact form factors from a point to a polygonal source, with occluders in between\n"
    "\n"
    "Start with `exactff info SCENE` to see what can be named, then\n"
    "  exactff point SCENE --at X Y Z --normal NX NY NZ --source NAME\n"
    "  exactff compare SCENE --on NAME --grid 32x32 -o DIR";

int run(const std::function<int()>& command) {
  try {
    return command();
  } catch (const exactff::InputError& error) {
    std::cerr << "exactff: " << error.what() << '\n';
    return kBadInput;
  } catch (const std::bad_alloc&) {
    std::cerr << kOutOfMemory;
  } catch (const std::length_error&) {  // more than any memory could hold
    std::cerr << kOutOfMemory;
  } catch (const std::system_error& error) {
    std::cerr << "exactff: the system refused: " << error.what()
              << " (a thread could not be started or a file not be reached); nothing was written; try --threads 1, or "
                 "raise the limits\n";
  } catch (const std::exception& error) {
    std::cerr << "exactff: internal failure: " << error.what()
              << " (this is a fault of the program); please report it with the scene and the command line\n";
  }
  return kInternalFailure;
}

// Memory may also end where no exception may pass.
[[noreturn]] void end_at_once() {
  std::fputs("exactff: ended by an error that nothing could handle, such as the end of memory; no result was written\n",
             stderr);
  std::_Exit(kInternalFailure);
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
  app.set_version_flag("--version", std::string("exactff ") + exactff::kVersion);
  app.require_subcommand(0, 1);
  const std::array commands = {exactff::cli::add_info(app), exactff::cli::add_point(app),
                               exactff::cli::add_compare(app), exactff::cli::add_stress(app)};
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error, std::cout, std::cerr) == 0 ? 0 : kBadInput;
  }
  for (const exactff::cli::Command& command : commands) {
    if (command.app->parsed()) return run(command.run);
  }
  std::cerr << app.help() << "\nName one of the commands.\n";
  return kBadInput;
}
