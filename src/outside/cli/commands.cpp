// All commands of the program, in the order of the help.
#include "cli/command.h"

namespace exactff::cli {

std::vector<Command> add_commands(CLI::App& app) {
  return {add_info(app),   add_point(app),   add_view(app),  add_matrix(app),     add_radiosity(app),
          add_render(app), add_compare(app), add_truth(app), add_merge(app),      add_check(app),
          add_stress(app), add_convert(app), add_help(app),  add_completion(app), add_manual(app)};
}

}  // namespace exactff::cli
