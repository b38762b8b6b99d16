// The program: parse, call, print. Exit codes: 0 done, 1 a check failed, 2 bad input, 3 not certified, 4 internal.
#include <CLI/CLI.hpp>
#include <array>
#include <exception>
#include <iostream>

#include "cli/command.h"
#include "exactff/error.h"
#include "exactff/version.h"

namespace {

constexpr int kBadInput = 2;
constexpr int kInternalFailure = 4;

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
    std::cerr << "exactff: out of memory; nothing was written\n";
  } catch (const std::exception& error) {
    std::cerr << "exactff: internal failure: " << error.what()
              << " (this is a fault of the program); please report it with the scene and the command line\n";
  }
  return kInternalFailure;
}

}  // namespace

int main(int argc, char** argv) {
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
