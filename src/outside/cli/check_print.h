// What `exactff check` prints.
#pragma once

#include <string>

#include "exactff/check.h"

namespace exactff::cli {

// `baseline_to_tighten`: the file to suggest for improvements; empty if none is to be suggested.
void print_check(const check::Report& report, const std::string& baseline_to_tighten);

}  // namespace exactff::cli
