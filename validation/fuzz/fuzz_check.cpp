// Arbitrary bytes as a truth file and, after the first byte 0x1e (ASCII's record separator), as the values of another
// program. The result is either an InputError with a message, or a report with consistent figures and valid texts.
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

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
  const check::CandidateColumns columns;
  const check::MatchOptions options{.by = by, .tolerance = 0.125, .partial = true};
  const auto measured = check::match(truth, check::read_candidate(candidate, columns, by), options);
  check_report(check::judge(truth, measured, {.max_abs = 1e-3, .quantiles = {{0.5, 1e-3}}, .per_source = true}));
}

// Tries every way of matching, even if the others are refused.
template <class Work>
void attempt(const Work& work) {
  try {
    work();
  } catch (const InputError& error) {
    require_words(error);
  }
}

void check_files(const std::string& truth_text, const std::string& candidate_text) {
  static const TemporaryDirectory directory;
  const auto truth_file = directory.write("truth.csv", truth_text);
  const auto candidate_file = directory.write("candidate.csv", candidate_text);
  attempt([&] { (void)check::read_candidate(candidate_file, {}, check::MatchBy::kPosition); });
  attempt([&] {
    const check::Truth truth = check::read_truth(truth_file);
    for (const check::TruthRow& row : truth.rows) {
      if (!std::isfinite(row.value) || !(row.lower <= row.upper)) fail("a truth that is none");
    }
    attempt([&] { check_match(truth, candidate_file, check::MatchBy::kReceiver); });
    attempt([&] { check_match(truth, candidate_file, check::MatchBy::kPosition); });
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
