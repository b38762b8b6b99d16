// The summary that `truth` and `merge` print at their end.
#pragma once

#include <iostream>
#include <string>

#include "cli/further_files.h"
#include "cli/output.h"
#include "cli/process.h"
#include "exactff/truth.h"
#include "text/escape.h"
#include "text/phrases.h"

namespace exactff::cli {

// Returns the exit code: 3, with a message, if a row is not certified.
inline int warn_of_uncertified(const truth::Summary& summary) {
  const std::uint64_t uncertified = summary.with(Status::kNotCertified);
  if (uncertified == 0) return 0;
  std::cerr << "exactff: " << text::counted(uncertified, "row")
            << " could not be certified within the precision cap (their bounds are valid, their values are estimates); "
               "look for the status 'not certified'\n";
  return kNotAsAsked;
}

// Prints the summary. Returns the exit code: 3 if a row is not certified.
inline int print_summary(const truth::Summary& summary, const std::string& file, const FurtherFiles& further) {
  std::cout << text::counted(summary.rows, "row") << ':';
  const char* separator = " ";
  for (const Status status : {Status::kCertified, Status::kZero, Status::kUnderflow, Status::kNotCertified}) {
    if (summary.with(status) == 0) continue;
    std::cout << separator << summary.with(status) << ' ' << to_string(status);
    separator = ", ";
  }
  std::cout << '\n';
  const std::uint64_t computed = summary.rows - summary.resumed;
  if (summary.seconds > 0.0 && computed > 0) {
    std::cout << "computed " << (summary.resumed > 0 ? text::counted(computed, "row") + " of them" : "them") << " in "
              << text::duration(summary.seconds) << ", "
              << text::rounded(static_cast<double>(computed) / summary.seconds) << " per second";
    if (summary.slow > 0) std::cout << "; " << text::counted(summary.slow, "slow row");
    std::cout << '\n';
  } else if (summary.resumed > 0) {
    std::cout << "all rows were already computed\n";
  }
  std::cout << "Truth file: " << text::printable(file) << '\n';
  print_further_files(further);
  check_output(std::cout);
  return warn_of_uncertified(summary);
}

}  // namespace exactff::cli
