// Random command lines, generated from the program's own option tables, so that a new option is fuzzed at once. A value
// is chosen by its type in the table. Most values are usable, so that most commands do some work, but little.
#pragma once

#include <string>
#include <vector>

#include "cli/commands.h"
#include "fuzz/odd_files.h"
#include "generate/random.h"

namespace exactff::validation {

using Words = std::vector<std::string>;  // without the name of the program

// The option table of the program.
[[nodiscard]] cli::ProgramTable own_table();

// Commands to run one after the other. All but the last make input files for the last.
[[nodiscard]] std::vector<Words> odd_commands(const cli::ProgramTable& program, const OddInputs& inputs,
                                              generate::Random& random);

}  // namespace exactff::validation
