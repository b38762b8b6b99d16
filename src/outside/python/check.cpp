// Comparisons of other values with true ones: of files, as `exactff check` compares them, and of arrays.
#include "exactff/check.h"

#include <pybind11/stl/filesystem.h>

#include "check/report.h"
#include "exactff/truth.h"
#include "files/file.h"
#include "flags/values.h"
#include "kernel/float_environment.h"
#include "python/bindings.h"
#include "text/refuse.h"
#include "text/settings.h"

namespace exactff::python {
namespace {

py::tuple distribution(const check::Distribution& d) {
  return py::make_tuple(d.median, d.p90, d.p99, d.p999, d.max, d.rms);
}

// Files that a check reads and writes besides.
struct CheckFiles {
  std::optional<std::filesystem::path> baseline, write_baseline, junit;
  double slack;
};

void write_file(const std::filesystem::path& path, const std::string& text) {
  files::WholeFile file(path);
  file.append(text);
  file.commit();
}

// Before anything is written.
void require_apart(const CheckFiles& files, std::vector<files::NamedFile> read) {
  if (files.baseline) read.push_back({"baseline", *files.baseline});
  std::vector<files::NamedFile> written;
  if (files.junit) written.push_back({"junit", *files.junit});
  if (files.write_baseline) written.push_back({"write_baseline", *files.write_baseline});
  for (const files::NamedFile& output : written) files::require_not_read(output, read);
  files::require_apart(written);
}

py::tuple statistics_of(const check::Report& report) {
  const check::Statistics& all = report.overall;
  return py::make_tuple(all.rows, all.not_finite, all.leaks, all.bias, distribution(all.absolute),
                        distribution(all.relative));
}

py::tuple tuple_of(const check::Report& report) {
  py::list verdicts, worst, warnings, better;
  for (const check::Verdict& v : report.verdicts) {
    verdicts.append(py::make_tuple(v.criterion, shown(v.source), v.measured, v.limit, v.passed, shown(sentence(v))));
  }
  for (const check::RowError& row : report.worst) {
    worst.append(py::make_tuple(shown(row.receiver), shown(row.source), row.truth, row.value, row.error, row.relative));
  }
  for (const std::string& warning : check::warnings(report)) warnings.append(shown(warning));
  for (const check::Improvement& one : report.improvements) {
    better.append(py::make_tuple(one.criterion, shown(one.source), one.recorded, one.now));
  }
  return py::make_tuple(report.passed(), statistics_of(report), verdicts, worst, warnings, better,
                        shown(failure_message(report)), shown(json_text(report)));
}

// Adds the verdicts on the baseline, and writes the files.
py::tuple result_of(check::Report report, const CheckFiles& files) {
  const kernel::StandardArithmetic arithmetic;
  if (files.baseline) check::hold_against_baseline(report, *files.baseline, files.slack);
  if (files.junit) write_file(*files.junit, check::junit_xml(report));
  if (files.write_baseline && check::may_be_recorded(report)) {
    write_file(*files.write_baseline, check::baseline_text(report));
  }
  return tuple_of(report);
}

// How rows of two files are matched.
struct Matching {
  std::string truth_column, value_column;
  bool by_position, partial;
  double tolerance;
};

check::Options options_of(const Matching& matching, const check::Criteria& limits) {
  check::Options options{.truth_column = matching.truth_column, .criteria = limits};
  options.columns.value = matching.value_column;
  options.match.by = matching.by_position ? check::MatchBy::kPosition : check::MatchBy::kReceiver;
  options.match.tolerance = matching.tolerance;
  options.match.partial = matching.partial;
  return options;
}

py::tuple check_files(const std::filesystem::path& truth, const std::filesystem::path& candidate,
                      const Matching& matching, const check::Criteria& limits, const CheckFiles& files) {
  require_apart(files, {{"truth", truth}, {"values", candidate}});
  check::Report report = [&] {
    const py::gil_scoped_release released;
    return check::compare(truth, candidate, options_of(matching, limits));
  }();
  return result_of(std::move(report), files);
}

// The table in Markdown, and of each program its name, the seconds and the report.
py::tuple scoreboard(const std::filesystem::path& truth, const std::vector<std::filesystem::path>& candidates,
                     const Matching& matching, const check::Criteria& limits,
                     const std::vector<std::optional<double>>& seconds,
                     const std::optional<std::filesystem::path>& folder) {
  const kernel::StandardArithmetic arithmetic;
  check::Scoreboard board;
  {
    const py::gil_scoped_release released;
    board = check::scoreboard(truth, candidates, options_of(matching, limits));
    for (std::size_t i = 0; i < board.scores.size(); ++i) board.scores[i].seconds = seconds.at(i);
    if (folder) check::write(board, *folder);
  }
  py::list programs;
  for (const check::Score& score : board.scores) {
    programs.append(py::make_tuple(shown(score.program), score.seconds, tuple_of(score.report)));
  }
  return py::make_tuple(shown(check::markdown(board)), programs);
}

check::Report judged(const check::Truth& truth, const Numbers& values, const check::Criteria& limits) {
  const std::span<const double> list(values.data(), static_cast<std::size_t>(values.size()));
  const py::gil_scoped_release released;
  check::Report report = judge(truth, list, limits);
  report.candidate_file = "values";
  return report;
}

// Values for the rows of a truth file, in their order.
py::tuple check_values(const std::filesystem::path& truth_file, const Numbers& values, const std::string& truth_column,
                       const check::Criteria& limits, const CheckFiles& files) {
  require_apart(files, {{"truth", truth_file}});
  const check::Truth truth = [&] {
    const py::gil_scoped_release released;
    return check::read_truth(truth_file, truth_column);
  }();
  if (truth.rows.size() != static_cast<std::size_t>(values.size())) {
    text::refuse(truth_file,
                 "has " + std::to_string(truth.rows.size()) + " rows, and there are " + std::to_string(values.size()) +
                     " values",
                 "the values are compared with the rows in their order",
                 "give one value for each row, or a file whose rows are matched by receiver");
  }
  return result_of(judged(truth, values, limits), files);
}

// True values and their bounds in arrays (receivers, sources). Without names, receivers have their index.
py::tuple check_arrays(const Numbers& exact, const Numbers& lower, const Numbers& upper,
                       const py::array_t<std::int8_t>& status, const std::vector<std::string>& receivers,
                       const std::vector<std::string>& sources, const Numbers& values, const check::Criteria& limits,
                       const CheckFiles& files) {
  require_apart(files, {});
  const auto f = exact.unchecked<2>(), low = lower.unchecked<2>(), high = upper.unchecked<2>();
  const auto state = status.unchecked<2>();
  check::Truth truth;
  truth.file = "truth";
  truth.column = "exact";
  truth.sources = sources;
  truth.faces = {""};
  for (py::ssize_t i = 0; i < f.shape(0); ++i) {
    for (py::ssize_t s = 0; s < f.shape(1); ++s) {
      check::TruthRow& row = truth.rows.emplace_back();
      row.receiver = receivers.empty() ? std::to_string(i) : receivers[static_cast<std::size_t>(i)];
      row.source = static_cast<std::uint32_t>(s);
      row.status = static_cast<Status>(state(i, s));
      row.value = f(i, s);
      row.lower = low(i, s);
      row.upper = high(i, s);
    }
  }
  return result_of(judged(truth, values, limits), files);
}

}  // namespace

void bind_check(py::module_& module) {
  using check::Criteria;
  py::class_<Criteria>(module, "Limits")
      .def(py::init([](std::optional<double> max_abs, std::optional<double> max_rel, std::optional<double> rms,
                       std::optional<double> eps_b, const std::vector<std::pair<double, double>>& quantiles,
                       bool per_source, double relative_floor, std::size_t worst) {
        Criteria limits{.max_abs = max_abs, .max_rel = max_rel, .rms = rms, .eps_b = eps_b};
        for (const auto& [share, limit] : quantiles) limits.quantiles.push_back({share, limit});
        limits.per_source = per_source;
        limits.relative_floor = relative_floor;
        limits.worst = worst;
        return limits;
      }));
  using File = std::optional<std::filesystem::path>;
  py::class_<CheckFiles>(module, "CheckFiles")
      .def(py::init([](File baseline, File write_baseline, File junit, double slack) {
        return CheckFiles{std::move(baseline), std::move(write_baseline), std::move(junit), slack};
      }));
  py::class_<Matching>(module, "Matching")
      .def(py::init(
          [](std::string truth_column, std::string value_column, bool by_position, bool partial, double tolerance) {
            return Matching{std::move(truth_column), std::move(value_column), by_position, partial, tolerance};
          }));
  module.def("check_files", &check_files, "truth"_a, "candidate"_a, "matching"_a, "limits"_a, "files"_a);
  module.def("scoreboard", &scoreboard, "truth"_a, "candidates"_a, "matching"_a, "limits"_a, "seconds"_a, "folder"_a);
  module.def(
      "program_names", [](const std::vector<std::filesystem::path>& files) { return check::program_names(files); },
      "candidates"_a);
  module.def("check_values", &check_values, "truth"_a, "values"_a, "truth_column"_a, "limits"_a, "files"_a);
  module.def("check_arrays", &check_arrays, "exact"_a, "lower"_a, "upper"_a, "status"_a, "receivers"_a, "sources"_a,
             "values"_a, "limits"_a, "files"_a);
}

// --- truth files, as `exactff truth` writes them ---

namespace {

jobs::Existing existing_of(const std::string& word) {
  if (word == "resume") return jobs::Existing::kResume;
  return word == "replace" ? jobs::Existing::kReplace : jobs::Existing::kRefuse;
}

py::tuple write_rows(const SharedScene& scene, const std::string& scene_name, const std::vector<Receiver>& receivers,
                     const std::string& receivers_name, const std::vector<std::string>& sources,
                     const std::filesystem::path& file, const std::string& existing,
                     const std::vector<std::string>& columns, const std::vector<MeasureTuple>& measures, int threads,
                     const py::object& progress) {
  truth::Request request;
  const auto known = truth::optional_columns();
  for (const std::string& name : columns) {
    const auto found = std::ranges::find(known, name, &truth::OptionalColumn::name);
    if (found == known.end()) {
      std::vector<std::string_view> names;
      for (const truth::OptionalColumn& column : known) names.push_back(column.name);
      throw text::unknown_name("column", name, names);
    }
    request.*found->wanted = true;
  }
  request.scene = &scene.scene();
  request.scene_name = scene_name;
  request.receivers = receivers;
  request.receivers_name = receivers_name;
  std::vector<std::string> patches = sources;
  request.sky = flags::take_sky(scene.scene(), patches);
  if (!request.sky || !patches.empty()) request.sources = scene.selections(patches);
  for (const MeasureTuple& measure : measures) request.measures.push_back(measure_of(measure));
  request.threads = threads;
  Interrupt interrupt(progress);
  const truth::Summary summary = interrupt.run([&] {
    return truth::write(std::move(request), file, existing_of(existing),
                        {.progress = interrupt.hooks().progress, .cancelled = interrupt.hooks().cancelled});
  });
  py::list by_status;
  for (const std::uint64_t rows : summary.rows_by_status) by_status.append(rows);
  return py::make_tuple(summary.rows, by_status, summary.resumed, summary.seconds);
}

}  // namespace

void bind_truth(py::module_& module) {
  module.def("write_truth", &write_rows, "scene"_a, "scene_name"_a, "receivers"_a, "receivers_name"_a, "sources"_a,
             "file"_a, "existing"_a, "columns"_a, "measures"_a, "threads"_a, "progress"_a);
}

}  // namespace exactff::python
