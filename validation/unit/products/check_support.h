// Truths, candidates and reports of a few rows, for the tests of the check.
#pragma once

#include <stdexcept>

#include "support/test.h"

namespace exactff::check {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

inline Truth truth_of(const std::string& text, const std::string& column = "exact") {
  const TemporaryDirectory directory;
  return read_truth(directory.write("truth.csv", text), column);
}

inline Candidate candidate_of(const std::string& text, const CandidateColumns& columns = {},
                              MatchBy by = MatchBy::kReceiver) {
  const TemporaryDirectory directory;
  return read_candidate(directory.write("mine.csv", text), {}, columns, by);
}
inline std::vector<double> values_of(const Candidate& candidate) {
  return candidate.table.numbers(*candidate.table.column("value"));
}
inline std::vector<std::string> texts_of(const Candidate& candidate, const std::string& column) {
  return candidate.table.texts(*candidate.table.column(column));
}

inline TruthRow row_of(const std::string& receiver, double value, std::uint32_t source = 0) {
  TruthRow row;
  row.receiver = receiver;
  row.source = source;
  row.value = row.lower = row.upper = value;
  return row;
}

// Receivers 1, 2, ... with these values of one source.
inline Truth truth_with(const std::vector<double>& values) {
  Truth truth;
  truth.file = "truth.csv";
  truth.column = "exact";
  truth.sources = {"light"};
  truth.faces = {""};
  for (const double value : values) truth.rows.push_back(row_of(std::to_string(truth.rows.size() + 1), value));
  return truth;
}

// Sources s and t of receivers 1, 2, ...
inline Truth truth_of_two(const std::vector<double>& s, const std::vector<double>& t) {
  Truth truth = truth_with({});
  truth.sources = {"s", "t"};
  for (std::size_t i = 0; i < s.size(); ++i) {
    truth.rows.push_back(row_of(std::to_string(i + 1), s[i], 0));
    truth.rows.push_back(row_of(std::to_string(i + 1), t[i], 1));
  }
  return truth;
}

inline Report judged(const std::vector<double>& truth, const std::vector<double>& values,
                     const Criteria& criteria = {}) {
  return judge(truth_with(truth), values, criteria);
}

inline const Verdict& verdict_on(const Report& report, const std::string& criterion, const std::string& source = {}) {
  for (const Verdict& verdict : report.verdicts) {
    if (verdict.criterion == criterion && verdict.source == source) return verdict;
  }
  throw std::runtime_error("there is no verdict on " + criterion);
}

}  // namespace exactff::check
