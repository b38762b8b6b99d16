// Random command lines made of the program's own option tables: an option that is added is fuzzed from then on. A value
// is drawn by what the table says that it is, mostly a usable one, so that most commands do some work, and little of
// it.
#pragma once

#include <string>
#include <vector>

#include "cli/option_table.h"
#include "fuzz/odd_files.h"
#include "generate/random.h"

namespace exactff::validation {

using Words = std::vector<std::string>;  // without the program

// What the program says of itself.
[[nodiscard]] cli::ProgramTable own_table();

// To be run one after the other; all but the last make files for it.
[[nodiscard]] std::vector<Words> odd_commands(const cli::ProgramTable& program, const OddInputs& inputs,
                                              generate::Random& random);

}  // namespace exactff::validation
