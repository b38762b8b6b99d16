// Reports and baselines as JSON.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "check/report.h"
#include "kernel/float_environment.h"
#include "text/escape.h"
#include "text/json_document.h"
#include "text/phrases.h"
#include "text/text_lines.h"

namespace exactff::check {
using nlohmann::ordered_json;

ordered_json json_number(double value) {
  if (std::isfinite(value)) return value;
  return std::isnan(value) ? "nan" : value > 0.0 ? "inf" : "-inf";
}

ordered_json json_of(const Distribution& d) {
  return {{"median", json_number(d.median)}, {"p90", json_number(d.p90)}, {"p99", json_number(d.p99)},
          {"p999", json_number(d.p999)},     {"max", json_number(d.max)}, {"rms", json_number(d.rms)}};
}

namespace {

ordered_json json_of(const Statistics& s) {
  ordered_json json = {{"rows", s.rows},
                       {"not_finite", s.not_finite},
                       {"leaks", s.leaks},
                       {"bias", json_number(s.bias)},
                       {"absolute", json_of(s.absolute)},
                       {"relative", json_of(s.relative)}};
  if (s.radiosity) json["radiosity"] = json_of(*s.radiosity);
  if (s.relative_mse) json["relative_mse"] = json_number(*s.relative_mse);
  return json;
}

ordered_json json_of(const RowError& row) {
  ordered_json json = {{"receiver", row.receiver},
                       {"source", row.source},
                       {"line", row.line},
                       {"truth_line", row.truth_line},
                       {"status", row.claim ? to_string(*row.claim) : to_string(row.status)},
                       {"truth", json_number(row.truth)},
                       {"value", json_number(row.value)},
                       {"error", json_number(row.error)},
                       {"relative", json_number(row.relative)}};
  if (row.radiosity) json["radiosity"] = json_number(*row.radiosity);
  if (row.claim) json["bounds"] = {row.lower, row.upper};
  return json;
}

ordered_json json_of(const MatrixFacts& facts) {
  const auto entry = [](const MatrixFacts::Largest& one) -> ordered_json {
    return {{"by", json_number(one.by)}, {"from", one.from}, {"to", one.to}};
  };
  ordered_json json = {{"negative", facts.negative}, {"above_one", facts.above_one}};
  if (facts.negative > 0) json["least"] = entry(facts.least);
  if (facts.above_one > 0) json["largest"] = entry(facts.largest);
  if (facts.row_sum) json["row_sum"] = {{"by", json_number(facts.row_sum->by)}, {"from", facts.row_sum->from}};
  if (facts.reciprocity) json["reciprocity"] = entry(*facts.reciprocity);
  return json;
}

ordered_json json_of(const Verdict& verdict) {
  ordered_json json = {{"criterion", verdict.criterion},
                       {"source", verdict.source},
                       {"measured", json_number(verdict.measured)},
                       {"limit", json_number(verdict.limit)},
                       {"passed", verdict.passed}};
  if (verdict.worst) json["worst"] = json_of(*verdict.worst);
  return json;
}

ordered_json json_of(const Improvement& improvement) {
  return {{"criterion", improvement.criterion},
          {"source", improvement.source},
          {"recorded", json_number(improvement.recorded)},
          {"now", json_number(improvement.now)}};
}

ordered_json json_of(const Histogram& histogram) {
  ordered_json json = {{"without_error", histogram.exact}, {"bins", ordered_json::array()}};
  for (const HistogramBin& bin : histogram.bins) {
    json["bins"].push_back({{"above", json_number(bin.low)}, {"up_to", json_number(bin.high)}, {"rows", bin.count}});
  }
  return json;
}

template <class List>
ordered_json list(const List& items) {
  ordered_json json = ordered_json::array();
  for (const auto& item : items) json.push_back(json_of(item));
  return json;
}

}  // namespace

ordered_json json_of(const Report& report) {
  ordered_json json;
  json["program"] = text::program_version();
  json["truth"] = {{"file", report.truth_file},
                   {"column", report.column},
                   {"rows", report.truth_rows},
                   {"identity", report.identity}};
  json["candidate"] = report.candidate_file;
  json["passed"] = report.passed();
  if (report.matrix) json["matrix"] = json_of(*report.matrix);
  json["warnings"] = warnings(report);
  json["verdicts"] = list(report.verdicts);
  json["improvements"] = list(report.improvements);
  json["relative_floor"] = report.criteria.relative_floor;
  json["overall"] = json_of(report.overall);
  json["sources"] = ordered_json::object();
  for (std::size_t s = 0; s < report.sources.size(); ++s) {
    json["sources"][report.sources[s]] = json_of(report.by_source[s]);
  }
  json["worst_by"] = to_string(report.worst_by);
  json["worst"] = list(report.worst);
  json["histogram"] = json_of(histogram(report));
  return json;
}

std::string json_text(const Report& report) {
  const kernel::StandardArithmetic arithmetic;
  return text::json_document(json_of(report)) + '\n';
}

// --- Baselines ---

namespace {

constexpr int kFormat = 1;
constexpr const char* kNoBaseline = "is not a baseline that this program can read";

// The statistics in a baseline file. They must not get worse.
constexpr std::array<std::string_view, 5> kRatcheted = {"max-abs", "max-rel", "rms", "quantile 0.99", "eps-b"};

struct Ratcheted {
  std::optional<double> now;
  double scale = 0.0;  // the magnitude that rounding errors are relative to
};

Ratcheted ratchet_of(const Statistics& statistics, std::string_view name) {
  if (name == "max-abs") return {statistics.absolute.max, statistics.largest_value};
  if (name == "max-rel") return {statistics.relative.max, 1.0};
  if (name == "rms") return {statistics.absolute.rms, statistics.largest_value};
  if (name == "quantile 0.99") return {statistics.absolute.p99, statistics.largest_value};
  if (!statistics.radiosity) return {};
  return {statistics.radiosity->max, statistics.largest_radiosity};
}

// JSON has no infinity: null stands for it.
ordered_json numbers_json(const Statistics& statistics) {
  ordered_json json = ordered_json::object();
  for (const std::string_view name : kRatcheted) {
    if (const auto value = ratchet_of(statistics, name).now) json[std::string(name)] = *value;
  }
  return json;
}

// Throws a nlohmann::json::exception if the baseline has not these statistics.
void hold(Report& report, const ordered_json& baseline, const std::string& source, const Statistics& statistics,
          double slack) {
  constexpr double kRoundings = 4.0 * std::numeric_limits<double>::epsilon();
  const auto& known = (source.empty() ? baseline.at("overall") : baseline.at("sources").at(text::utf8(source)))
                          .get_ref<const ordered_json::object_t&>();
  for (const std::string_view name : kRatcheted) {
    const auto found = known.find(std::string(name));
    const Ratcheted one = ratchet_of(statistics, name);
    if (found == known.end() || !one.now) continue;
    const double recorded =
        found->second.is_null() ? std::numeric_limits<double>::infinity() : found->second.get<double>();
    const double allowance = std::isinf(recorded) ? 0.0 : std::max(recorded * slack, kRoundings * one.scale);
    const double limit = recorded + allowance;
    const std::string criterion = "baseline " + std::string(name);
    report.verdicts.push_back({criterion, source, *one.now, limit, *one.now <= limit, {}});
    if (*one.now < recorded - allowance) report.improvements.push_back({criterion, source, recorded, *one.now});
  }
}

}  // namespace

std::string baseline_text(const Report& report) {
  const kernel::StandardArithmetic arithmetic;
  ordered_json json;
  json["baseline"] = kFormat;
  json["program"] = text::program_version();
  json["truth"] = {{"identity", report.identity}, {"rows", report.overall.rows}, {"column", report.column}};
  json["relative_floor"] = report.criteria.relative_floor;
  json["overall"] = numbers_json(report.overall);
  json["sources"] = ordered_json::object();
  for (std::size_t s = 0; s < report.sources.size(); ++s) {
    json["sources"][report.sources[s]] = numbers_json(report.by_source[s]);
  }
  return text::json_document(json) + '\n';
}

bool may_be_recorded(const Report& report) {
  return std::ranges::all_of(report.verdicts, [](const Verdict& verdict) {
    return verdict.passed || !(verdict.criterion == "finite" || verdict.criterion.starts_with("baseline "));
  });
}

void hold_against_baseline(Report& report, const std::filesystem::path& path, double slack) {
  const kernel::StandardArithmetic arithmetic;
  if (!(slack >= 0.0) || std::isinf(slack)) {
    throw InputError({.what = "the slack for the baseline is " + text::shortest(slack),
                      .why = "the slack is a share of the recorded errors",
                      .suggestion = "give 0 or more, for example 0.1"});
  }
  const auto refuse = [&](const char* what, const char* why, const char* suggestion) {
    throw InputError({path.string(), 0, what, why, suggestion});
  };
  constexpr const char* kNothing = "there is nothing to compare with";
  constexpr const char* kRecord = "record one with --write-baseline";
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) refuse("this baseline file does not exist", kNothing, kRecord);
  const std::string text = text::read_text_file(path, "a file written by --write-baseline");
  try {
    const ordered_json baseline = ordered_json::parse(text);
    if (baseline.at("baseline") != kFormat) refuse(kNoBaseline, kNothing, kRecord);
    if (baseline.at("truth").at("identity") != report.identity ||
        baseline.at("relative_floor") != report.criteria.relative_floor) {
      refuse("was recorded with different rows, true values or relative floor", "its errors cannot be compared",
             "record a new one with --write-baseline");
    }
    if (!report.criteria.per_source) hold(report, baseline, {}, report.overall, slack);
    for (std::size_t s = 0; report.criteria.per_source && s < report.sources.size(); ++s) {
      hold(report, baseline, report.sources[s], report.by_source[s], slack);
    }
  } catch (const nlohmann::json::exception&) {
    refuse(kNoBaseline, kNothing, kRecord);
  }
}

}  // namespace exactff::check
