// What a report was asked for, as a hash: a finished folder of the same request need not be computed again.
#pragma once

#include <string>

#include "report/plan.h"

namespace exactff::report {

// Of everything that the values and the words of the report depend on, and of the version; not of threads or the
// engine.
[[nodiscard]] std::string identity_of(const Plan& plan);

// The line of the page that holds it.
[[nodiscard]] std::string identity_line(const std::string& identity);

}  // namespace exactff::report
