// Arbitrary bytes as a truth file and, after the first byte 0x1e (ASCII's record separator), as the values of another
// program. The result is either an InputError with a message, or a report with consistent figures and valid texts. Both
// texts are also read as matrices of view factors, and the second one is held against a true one.
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "check/report.h"
#include "exactff/check.h"
#include "fuzz/complaints.h"
#include "support/program.h"

namespace exactff::validation {
namespace {

constexpr char kSeparator = '\x1e';

void check_order(const check::Distribution& d) {
  if (!(d.median <= d.p90 && d.p90 <= d.p99 && d.p99 <= d.p999 && d.p999 <= d.max)) fail("quantiles out of order");
  if (d.median < 0.0 || !(d.rms <= d.max * (1.0 + 1e-12))) fail("a figure that no errors have");
}

void check_report(const check::Report& report) {
  check_order(report.overall.absolute);
  check_order(report.overall.relative);
  for (const check::Statistics& statistics : report.by_source) check_order(statistics.absolute);
  if (!nlohmann::json::accept(check::json_text(report))) fail("not JSON");
  for (const char c : check::junit_xml(report)) {
    if (static_cast<unsigned char>(c) < 0x20 && c != '\n') fail("a control character in XML");
  }
  (void)check::github_annotations(report);
  (void)check::baseline_text(report);
}

void check_match(const check::Truth& truth, const std::filesystem::path& candidate, check::MatchBy by) {
  const check::MatchOptions options{.by = by, .tolerance = 0.125, .partial = true};
  const auto measured = check::match(truth, check::read_candidate(candidate, truth, {}, by), options);
  check_report(check::judge(truth, measured, {.max_abs = 1e-3, .quantiles = {{0.5, 1e-3}}, .per_source = true}));
}

constexpr const char* kMatrix =
    R"x(# {"exactff":"0","table":"matrix","further":["(open)"],"columns":[{"name":"from","type":"text","strength":"given","key":true},)x"
    R"x({"name":"to","type":"text","strength":"given","key":true},{"name":"factor","type":"number","strength":"stated"}]})x"
    "\nfrom,to,factor,lower,upper,claim,accurate,area_from\n"
    "a,a,0,0,0,zero,yes,1\na,b,0.5,0.4,0.6,estimated,no,1\na,(open),0.5,0.5,0.5,estimated,yes,1\n"
    "b,a,0.25,0.2,0.3,estimated,no,2\nb,b,0,0,0,zero,yes,2\nb,(open),0.7,0.7,0.7,estimated,yes,2\n";

void check_matrices(const std::filesystem::path& truth, const std::filesystem::path& candidate) {
  unless_refused([&] {
    const check::Options options{.match = {.partial = true}, .criteria = {.max_abs = 1e-3, .per_source = true}};
    const check::Report report = check::compare(truth, candidate, options);
    check_report(report);
    if (report.overall.rows > report.truth_rows) fail("more values than entries");
  });
}

// Every way of matching is tried, even if the others are refused.
void check_files(const std::string& truth_text, const std::string& candidate_text) {
  static const TemporaryDirectory directory;
  const auto truth_file = directory.write("truth.csv", truth_text);
  const auto candidate_file = directory.write("candidate.csv", candidate_text);
  static const auto matrix_file = directory.write("matrix.csv", kMatrix);
  check_matrices(matrix_file, candidate_file);
  check_matrices(truth_file, candidate_file);
  unless_refused([&] { (void)check::read_candidate(candidate_file, {}, {}, check::MatchBy::kPosition); });
  unless_refused([&] {
    const check::Truth truth = check::read_truth(truth_file);
    for (const check::TruthRow& row : truth.rows) {
      if (!std::isfinite(row.value) || !(row.lower <= row.upper)) fail("a truth that is none");
    }
    unless_refused([&] { check_match(truth, candidate_file, check::MatchBy::kReceiver); });
    unless_refused([&] { check_match(truth, candidate_file, check::MatchBy::kPosition); });
  });
}

}  // namespace
}  // namespace exactff::validation

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view input(reinterpret_cast<const char*>(data), size);
  const std::size_t end = std::min(input.find(exactff::validation::kSeparator), size);
  exactff::validation::check_files(std::string(input.substr(0, end)),
                                   std::string(input.substr(std::min(end + 1, size))));
  return 0;
}
