// Reports and baselines as JSON.
#include "check/report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "check/tables.h"
#include "kernel/float_environment.h"
#include "text/escape.h"
#include "text/names.h"
#include "text/phrases.h"
#include "text/refuse.h"
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

std::string json_text(const Report& report) { return text::json_document(json_of(report)) + '\n'; }

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
  if (!(slack >= 0.0) || std::isinf(slack)) {
    text::refuse("the slack for the baseline is " + text::shortest(slack),
                 "the slack is a share of the recorded errors", "give 0 or more, for example 0.1");
  }
  const auto refuse = [&](const char* what, const char* why, const char* suggestion) {
    text::refuse(path, what, why, suggestion);
  };
  constexpr const char* kNoNumbers = "there is nothing to compare with";
  constexpr const char* kRecord = "record one with --write-baseline";
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) refuse("this baseline file does not exist", kNoNumbers, kRecord);
  const std::string text = text::read_text_file(path, "a file written by --write-baseline");
  try {
    const ordered_json baseline = ordered_json::parse(text);
    if (baseline.at("baseline") != kFormat) refuse(kNoBaseline, kNoNumbers, kRecord);
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
    refuse(kNoBaseline, kNoNumbers, kRecord);
  }
}

// --- Sentences about a report, for people, JUnit and GitHub ---

std::string_view to_string(Measure measure) {
  constexpr std::array<std::string_view, 3> kNames = {"absolute error", "relative error", "error in radiosity"};
  return kNames[static_cast<std::size_t>(measure)];
}

std::string name_of(const Quantile& quantile) { return "quantile " + text::shortest(quantile.share); }

std::string name_of(const Verdict& verdict) {
  return verdict.criterion + (verdict.source.empty() ? "" : ", source " + verdict.source);
}

std::string name_of(const std::array<std::string, 2>& keys, const std::string& receiver, const std::string& source) {
  return word_of(keys[0]) + ' ' + text::in_quotes(receiver) +
         (source.empty() ? "" : ", " + word_of(keys[1]) + ' ' + text::in_quotes(source));
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
  return text + (verdict.worst ? ", worst at " + verdict.worst->name : "");
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
  if (report.overall.rows < report.truth_rows && report.levels.empty()) {  // a suite lists them
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
  for (const std::string& line : worst_lines(report)) text += "  " + text::printable(line) + '\n';
  return text;
}

std::vector<std::string> worst_lines(const Report& report) {
  std::vector<std::string> lines;
  for (const RowError& row : report.worst) lines.push_back(row.name + ": " + describe(row));
  return lines;
}

std::vector<std::string> sentences(const MatrixFacts& facts) {
  std::vector<std::string> texts;
  const auto at = [](const MatrixFacts::Largest& entry) {
    return ", at " + name_of({"from", "to"}, entry.from, entry.to);
  };
  if (facts.row_sum) {
    texts.push_back("sums of rows are at most " + text::short_number(facts.row_sum->by) + " off those of the truth" +
                    (facts.row_sum->by > 0.0 ? ", in the row of " + text::in_quotes(facts.row_sum->from) : ""));
  }
  if (facts.reciprocity) {
    texts.push_back("A_i F_ij and A_j F_ji differ by at most " + text::short_number(facts.reciprocity->by) +
                    " of the smaller area" + (facts.reciprocity->by > 0.0 ? at(*facts.reciprocity) : ""));
  }
  if (facts.negative > 0) {
    texts.push_back(text::counted(facts.negative, "entry", "entries") + " below 0, the least " +
                    text::shortest(facts.least.by) + at(facts.least));
  }
  if (facts.above_one > 0) {
    texts.push_back(text::counted(facts.above_one, "entry", "entries") + " above 1, the largest " +
                    text::shortest(facts.largest.by) + at(facts.largest));
  }
  return texts;
}

// --- JUnit ---

namespace {

std::string test_case(const Report& report, const Verdict& verdict) {
  std::string text = "    <testcase classname=\"" + text::html("exactff.check." + report.column) + "\" name=\"" +
                     text::html(name_of(verdict)) + "\" time=\"0\"";
  if (verdict.passed) return text + "/>\n";
  std::vector<std::string> lines = worst_lines(report);
  lines.insert(lines.begin(), sentence(verdict) + "\nworst rows by " + std::string(to_string(report.worst_by)) + ':');
  return text + ">\n      <failure message=\"" + text::html(sentence(verdict)) + "\" type=\"" +
         text::html(verdict.criterion) + "\">" + text::html(text::joined(lines, "\n")) +
         "</failure>\n    </testcase>\n";
}

std::string property(const std::string& name, const std::string& value) {
  return "      <property name=\"" + name + "\" value=\"" + text::html(value) + "\"/>\n";
}

struct Counts {
  std::size_t tests = 0, failures = 0;
  [[nodiscard]] std::string text() const {
    return " tests=\"" + std::to_string(tests) + "\" failures=\"" + std::to_string(failures) +
           "\" errors=\"0\" time=\"0\"";
  }
};

std::string suite(const Report& report, Counts& all) {
  const auto failures = static_cast<std::size_t>(
      std::ranges::count_if(report.verdicts, [](const Verdict& verdict) { return !verdict.passed; }));
  all.tests += report.verdicts.size();
  all.failures += failures;
  std::string text = "  <testsuite name=\"" + text::html("exactff check " + report.candidate_file) + "\"" +
                     Counts{report.verdicts.size(), failures}.text() + ">\n    <properties>\n" +
                     property("truth", report.truth_file) + property("candidate", report.candidate_file) +
                     property("rows", std::to_string(report.overall.rows)) + "    </properties>\n";
  for (const Verdict& verdict : report.verdicts) text += test_case(report, verdict);
  std::vector<std::string> lines = report.matrix ? sentences(*report.matrix) : std::vector<std::string>();
  for (const std::string& doubt : warnings(report)) lines.push_back("warning: " + doubt);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    text += (i == 0 ? "    <system-out>" : "\n") + text::html(lines[i]);
  }
  if (!lines.empty()) text += "</system-out>\n";
  return text + "  </testsuite>\n";
}

}  // namespace

std::string junit_xml(std::span<const Report> reports) {
  Counts all;
  std::string suites;
  for (const Report& report : reports) suites += suite(report, all);
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"exactff check\"" + all.text() + ">\n" +
         suites + "</testsuites>\n";
}

// --- GitHub ---

namespace {

struct FileLine {
  std::string file = {};
  std::size_t line = 0;
};

std::string command(std::string_view kind, const FileLine& place, const std::string& title,
                    const std::string& message) {
  std::string text = "::" + std::string(kind) + ' ';
  if (!place.file.empty()) text += "file=" + text::github_property(place.file) + ',';
  if (!place.file.empty() && place.line > 0) text += "line=" + std::to_string(place.line) + ',';
  return text + "title=" + text::github_property(title) + "::" + text::github_message(message) + '\n';
}

// The row that decides, or an example of the worst: of this source, if the verdict is on one. Null if there is none.
const RowError* row_to_show(const Report& report, const Verdict& verdict) {
  if (verdict.worst) return &*verdict.worst;
  const auto found = std::ranges::find_if(
      report.worst, [&](const RowError& row) { return verdict.source.empty() || row.source == verdict.source; });
  return found == report.worst.end() ? nullptr : &*found;
}

}  // namespace

std::string github_annotations(const Report& report) {
  std::string text;
  for (const Verdict& verdict : report.verdicts) {
    if (verdict.passed) continue;
    const RowError* row = row_to_show(report, verdict);
    std::string message = sentence(verdict);
    if (row != nullptr) message += "\n" + (verdict.worst ? "" : "worst row: " + row->name + ": ") + describe(*row);
    text += command("error", {report.candidate_file, row != nullptr ? row->line : 0},
                    "exactff check: " + name_of(verdict), message);
  }
  for (const std::string& warning : warnings(report)) {
    text += command("warning", {report.candidate_file, 0}, "exactff check", warning);
  }
  return text;
}

std::string github_annotations(const InputError& error) {
  constexpr std::size_t kShown = 10;  // the runner shows no more for one step
  std::string text;
  for (const Problem& problem : error.problems()) {
    if (&problem - error.problems().data() == kShown) break;
    text += command("error", {problem.file, problem.line}, "exactff check: bad input", problem.message());
  }
  return text;
}

}  // namespace exactff::check
