#include "check/words.h"

#include <array>
#include <cmath>

#include "kernel/float_environment.h"
#include "text/escape.h"
#include "text/phrases.h"
#include "text/text_lines.h"

namespace exactff::check {

std::string_view to_string(Measure measure) {
  constexpr std::array<std::string_view, 3> kNames = {"absolute error", "relative error", "error in radiosity"};
  return kNames[static_cast<std::size_t>(measure)];
}

std::string name_of(const Quantile& quantile) { return "quantile " + text::shortest(quantile.share); }

std::string name_of(const Verdict& verdict) {
  return verdict.criterion + (verdict.source.empty() ? "" : ", source " + verdict.source);
}

std::string name_of_entry(const std::string& from, const std::string& to) {
  return "row " + text::in_quotes(from) + ", column " + text::in_quotes(to);
}

std::string name_of(const RowError& row) {
  if (row.claim) return name_of_entry(row.receiver, row.source);
  return "receiver " + text::in_quotes(row.receiver) +
         (row.source.empty() ? "" : ", source " + text::in_quotes(row.source));
}

std::string describe(const RowError& row) {
  std::string text = (row.claim ? "" : "exact ") + text::shortest(row.truth);
  if (row.claim) {
    text += " in [" + text::shortest(row.lower) + ", " + text::shortest(row.upper) + "] (" +
            std::string(to_string(*row.claim)) + ")";
  }
  text += ", found " + text::shortest(row.value);
  if (!std::isfinite(row.value)) return text;
  text += ", error " + text::short_number(row.error, 4) + ", relative " + text::short_number(row.relative, 4);
  if (!row.claim && row.status == Status::kNotCertified) text += ", truth not certified";
  return text;
}

std::string sentence(const Verdict& verdict) {
  std::string text = name_of(verdict) + ": ";
  if (verdict.criterion == "finite") {
    text += verdict.passed ? std::string("every value is a finite number")
                           : "values that are not finite numbers: " + text::shortest(verdict.measured);
  } else {
    text += text::shortest(verdict.measured) + (verdict.passed ? " is within the limit " : " is above the limit ") +
            text::shortest(verdict.limit);
  }
  return text + (verdict.worst ? ", worst at " + name_of(*verdict.worst) : "");
}

namespace {

// An entry is judged by its bounds, however wide they are.
void add_words_of_matrix(const Report& report, std::vector<std::string>& texts) {
  const auto add = [&](std::size_t count, const std::string& what) {
    if (count == 0) return;
    texts.push_back(text::counted(count, "entry", "entries") + " of the truth " + what + ": judged by " +
                    (count == 1 ? "its" : "their") + " bounds, which are up to " + text::short_number(report.widest) +
                    " wide");
  };
  add(report.by_points, "estimated by points");
  add(report.not_accurate, "wider than the accuracy it was computed with");
}

}  // namespace

std::vector<std::string> warnings(const Report& report) {
  std::vector<std::string> texts;
  if (report.not_certified > 0) {
    texts.push_back(text::counted_of(report.not_certified, report.overall.rows, "row") +
                    " of the truth not certified: compared with the enclosure instead");
  }
  add_words_of_matrix(report, texts);
  if (report.overall.rows < report.truth_rows) {
    texts.push_back(text::counted_of(report.truth_rows - report.overall.rows, report.truth_rows, "row") +
                    " of the truth without a value: not checked");
  }
  if (report.verdicts.size() == 1) {
    texts.emplace_back("no limit was given: the only check was that all values are finite numbers");
  }
  return texts;
}

std::string failure_message(const Report& report) {
  const kernel::StandardArithmetic arithmetic;
  std::string text;
  for (const Verdict& verdict : report.verdicts) {
    if (!verdict.passed) text += sentence(verdict) + '\n';
  }
  if (report.worst.empty()) return text;
  text += "worst rows by " + std::string(to_string(report.worst_by)) + ":\n";
  for (const RowError& row : report.worst) text += "  " + text::printable(name_of(row) + ": " + describe(row)) + '\n';
  return text;
}

}  // namespace exactff::check
