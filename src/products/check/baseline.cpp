#include "check/baseline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "kernel/float_environment.h"
#include "text/escape.h"
#include "text/json_document.h"
#include "text/phrases.h"
#include "text/text_lines.h"

namespace exactff::check {
namespace {

using nlohmann::ordered_json;

constexpr int kFormat = 1;

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

class Baseline {
 public:
  explicit Baseline(const std::filesystem::path& path) : file_(path.string()) {
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) {
      throw InputError({file_, 0, "this baseline file does not exist", "there is nothing to compare with",
                        "record one with --write-baseline"});
    }
    json_ = ordered_json::parse(text::read_text_file(path, "a file written by --write-baseline"), nullptr, false);
    if (!json_.is_object() || !json_.contains("baseline") || json_["baseline"] != kFormat) refuse_format();
  }

  void require_same_rows(const Report& report) const {
    if (at({"truth", "identity"}) == report.identity && at({"relative_floor"}) == report.criteria.relative_floor)
      return;
    throw InputError({file_, 0, "was recorded with different rows, true values or relative floor",
                      "its errors cannot be compared", "record a new one with --write-baseline"});
  }

  // Nothing if the baseline does not have the statistic.
  [[nodiscard]] std::optional<double> recorded(const std::string& source, std::string_view name) const {
    const ordered_json& statistics = source.empty() ? at({"overall"}) : at({"sources", text::utf8(source)});
    if (!statistics.is_object()) refuse_format();
    const auto found = statistics.find(std::string(name));
    if (found == statistics.end()) return std::nullopt;
    if (found->is_null()) return std::numeric_limits<double>::infinity();
    if (!found->is_number()) refuse_format();
    return found->get<double>();
  }

 private:
  [[noreturn]] void refuse_format() const {
    throw InputError({file_, 0, "is not a baseline that this program can read", "there is nothing to compare with",
                      "record one with --write-baseline"});
  }

  [[nodiscard]] const ordered_json& at(std::initializer_list<std::string> path) const {
    const ordered_json* node = &json_;
    for (const std::string& key : path) {
      if (!node->is_object() || !node->contains(key)) refuse_format();
      node = &(*node)[key];
    }
    return *node;
  }

  std::string file_;
  ordered_json json_;
};

void compare(Report& report, const Baseline& baseline, const std::string& source, const Statistics& statistics,
             double slack, std::vector<Improvement>& improvements) {
  constexpr double kRoundings = 4.0 * std::numeric_limits<double>::epsilon();
  for (const std::string_view name : kRatcheted) {
    const auto recorded = baseline.recorded(source, name);
    const Ratcheted one = ratchet_of(statistics, name);
    if (!recorded || !one.now) continue;
    const double allowance = std::isinf(*recorded) ? 0.0 : std::max(*recorded * slack, kRoundings * one.scale);
    const double limit = *recorded + allowance;
    const std::string criterion = "baseline " + std::string(name);
    report.verdicts.push_back({criterion, source, *one.now, limit, *one.now <= limit, {}});
    if (*one.now < *recorded - allowance) improvements.push_back({criterion, source, *recorded, *one.now});
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

std::vector<Improvement> hold_against_baseline(Report& report, const std::filesystem::path& path, double slack) {
  const kernel::StandardArithmetic arithmetic;
  if (!(slack >= 0.0) || std::isinf(slack)) {
    throw InputError({.what = "the slack for the baseline is " + text::shortest(slack),
                      .why = "the slack is a share of the recorded errors",
                      .suggestion = "give 0 or more, for example 0.1"});
  }
  const Baseline baseline(path);
  baseline.require_same_rows(report);
  std::vector<Improvement> improvements;
  if (!report.criteria.per_source) compare(report, baseline, {}, report.overall, slack, improvements);
  for (std::size_t s = 0; report.criteria.per_source && s < report.sources.size(); ++s) {
    compare(report, baseline, report.sources[s], report.by_source[s], slack, improvements);
  }
  return improvements;
}

}  // namespace exactff::check
