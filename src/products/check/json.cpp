#include "check/json.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "check/histogram.h"
#include "check/words.h"
#include "kernel/float_environment.h"
#include "text/json_document.h"
#include "text/phrases.h"

namespace exactff::check {
namespace {

using nlohmann::ordered_json;

// JSON has neither infinity nor NaN: they are written as words.
ordered_json number(double value) {
  if (std::isfinite(value)) return value;
  return std::isnan(value) ? "nan" : value > 0.0 ? "inf" : "-inf";
}

ordered_json to_json(const Distribution& d) {
  return {{"median", number(d.median)}, {"p90", number(d.p90)}, {"p99", number(d.p99)},
          {"p999", number(d.p999)},     {"max", number(d.max)}, {"rms", number(d.rms)}};
}

ordered_json to_json(const Statistics& s) {
  ordered_json json = {{"rows", s.rows},         {"not_finite", s.not_finite},      {"leaks", s.leaks},
                       {"bias", number(s.bias)}, {"absolute", to_json(s.absolute)}, {"relative", to_json(s.relative)}};
  if (s.radiosity) json["radiosity"] = to_json(*s.radiosity);
  if (s.relative_mse) json["relative_mse"] = number(*s.relative_mse);
  return json;
}

ordered_json to_json(const RowError& row) {
  ordered_json json = {{"receiver", row.receiver},
                       {"source", row.source},
                       {"line", row.line},
                       {"truth_line", row.truth_line},
                       {"status", row.claim ? to_string(*row.claim) : to_string(row.status)},
                       {"truth", number(row.truth)},
                       {"value", number(row.value)},
                       {"error", number(row.error)},
                       {"relative", number(row.relative)}};
  if (row.radiosity) json["radiosity"] = number(*row.radiosity);
  if (row.claim) json["bounds"] = {row.lower, row.upper};
  return json;
}

ordered_json to_json(const MatrixFacts& facts) {
  const auto entry = [](const MatrixFacts::Largest& one) -> ordered_json {
    return {{"by", number(one.by)}, {"from", one.from}, {"to", one.to}};
  };
  ordered_json json = {{"negative", facts.negative}, {"above_one", facts.above_one}};
  if (facts.negative > 0) json["least"] = entry(facts.least);
  if (facts.above_one > 0) json["largest"] = entry(facts.largest);
  if (facts.row_sum) json["row_sum"] = {{"by", number(facts.row_sum->by)}, {"from", facts.row_sum->from}};
  if (facts.reciprocity) json["reciprocity"] = entry(*facts.reciprocity);
  return json;
}

ordered_json to_json(const Verdict& verdict) {
  ordered_json json = {{"criterion", verdict.criterion},
                       {"source", verdict.source},
                       {"measured", number(verdict.measured)},
                       {"limit", number(verdict.limit)},
                       {"passed", verdict.passed}};
  if (verdict.worst) json["worst"] = to_json(*verdict.worst);
  return json;
}

ordered_json to_json(const Improvement& improvement) {
  return {{"criterion", improvement.criterion},
          {"source", improvement.source},
          {"recorded", number(improvement.recorded)},
          {"now", number(improvement.now)}};
}

ordered_json to_json(const Histogram& histogram) {
  ordered_json json = {{"without_error", histogram.exact}, {"bins", ordered_json::array()}};
  for (const HistogramBin& bin : histogram.bins) {
    json["bins"].push_back({{"above", number(bin.low)}, {"up_to", number(bin.high)}, {"rows", bin.count}});
  }
  return json;
}

template <class List>
ordered_json list(const List& items) {
  ordered_json json = ordered_json::array();
  for (const auto& item : items) json.push_back(to_json(item));
  return json;
}

}  // namespace

std::string json_text(const Report& report, const std::optional<MatrixFacts>& matrix,
                      const std::vector<Improvement>& improvements) {
  const kernel::StandardArithmetic arithmetic;
  ordered_json json;
  json["program"] = text::program_version();
  json["truth"] = {{"file", report.truth_file},
                   {"column", report.column},
                   {"rows", report.truth_rows},
                   {"identity", report.identity}};
  json["candidate"] = report.candidate_file;
  json["passed"] = report.passed();
  if (matrix) json["matrix"] = to_json(*matrix);
  json["warnings"] = warnings(report);
  json["verdicts"] = list(report.verdicts);
  json["improvements"] = list(improvements);
  json["relative_floor"] = report.criteria.relative_floor;
  json["overall"] = to_json(report.overall);
  json["sources"] = ordered_json::object();
  for (std::size_t s = 0; s < report.sources.size(); ++s) {
    json["sources"][report.sources[s]] = to_json(report.by_source[s]);
  }
  json["worst_by"] = to_string(report.worst_by);
  json["worst"] = list(report.worst);
  json["histogram"] = to_json(histogram(report));
  return text::json_document(json) + '\n';
}

}  // namespace exactff::check
