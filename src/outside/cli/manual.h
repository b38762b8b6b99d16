// The manual page, generated from the program's own options.
#pragma once

#include <string>

#include "cli/option_table.h"

namespace exactff::cli {

// A page in the language of man(7).
[[nodiscard]] std::string manual_page(const ProgramTable& program);

}  // namespace exactff::cli
