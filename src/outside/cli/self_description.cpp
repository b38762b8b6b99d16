// exactff completion, exactff manual: the program's description of itself, for shells and for man(1). Hidden from
// --help, since only the installation calls them.
#include <iostream>
#include <memory>
#include <string>

#include "cli/command.h"
#include "cli/completion.h"
#include "cli/manual.h"
#include "cli/output.h"
#include "flags/file_options.h"

namespace exactff::cli {
namespace {

int print(const std::string& text, const std::string& file) {
  if (!file.empty()) {
    write_whole_file(file, text);
    return 0;
  }
  std::cout << text;
  check_output(std::cout);
  return 0;
}

std::string completion_for(const std::string& shell, const ProgramTable& program) {
  if (shell == "bash") return bash_completion(program);
  return shell == "zsh" ? zsh_completion(program) : fish_completion(program);
}

struct DescriptionArguments {
  std::string shell;
  std::string file;
};

void add_file(CLI::App& command, DescriptionArguments& args) {
  command.add_option("-o,--output", args.file, "File to write instead of standard output")
      ->type_name("FILE")
      ->check(flags::is_written(flags::Format::kAny));
}

}  // namespace

Command add_completion(CLI::App& app) {
  auto args = std::make_shared<DescriptionArguments>();
  CLI::App* command =
      app.add_subcommand("completion", "Print the script for command-line completion in a shell")->group("");
  command->add_option("SHELL", args->shell, "bash, zsh or fish")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish"}));
  add_file(*command, *args);
  return {command, [args, &app] { return print(completion_for(args->shell, program_table(app)), args->file); }};
}

Command add_manual(CLI::App& app) {
  auto args = std::make_shared<DescriptionArguments>();
  CLI::App* command = app.add_subcommand("manual", "Print the manual page in the format of man(7)")->group("");
  add_file(*command, *args);
  return {command, [args, &app] { return print(manual_page(program_table(app)), args->file); }};
}

}  // namespace exactff::cli
