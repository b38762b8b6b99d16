// Comparisons of other values with true ones: of files, as `exactff check` compares them, and of arrays.
#include "exactff/check.h"

#include <pybind11/stl/filesystem.h>

#include "check/baseline.h"
#include "check/json.h"
#include "check/junit.h"
#include "check/words.h"
#include "files/file.h"
#include "python/bindings.h"

namespace exactff::python {
namespace {

struct Limits {
  std::optional<double> max_abs, max_rel, rms, eps_b;
  std::vector<std::pair<double, double>> quantiles;
  bool per_source = false;
  double relative_floor = 0.0;
  std::size_t worst = 10;
};

check::Criteria criteria_of(const Limits& limits) {
  check::Criteria criteria{.max_abs = limits.max_abs,
                           .max_rel = limits.max_rel,
                           .rms = limits.rms,
                           .eps_b = limits.eps_b,
                           .per_source = limits.per_source,
                           .relative_floor = limits.relative_floor,
                           .worst = limits.worst};
  for (const auto& [share, limit] : limits.quantiles) criteria.quantiles.push_back({share, limit});
  return criteria;
}

py::tuple distribution(const check::Distribution& d) {
  return py::make_tuple(d.median, d.p90, d.p99, d.p999, d.max, d.rms);
}

// Files that a check reads and writes besides.
struct CheckFiles {
  std::optional<std::filesystem::path> baseline, write_baseline, junit;
  double slack = check::kDefaultSlack;
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

// Adds the verdicts on the baseline, and writes the files.
py::tuple result_of(check::Report report, const CheckFiles& files) {
  std::vector<check::Improvement> improvements;
  if (files.baseline) improvements = check::hold_against_baseline(report, *files.baseline, files.slack);
  if (files.junit) write_file(*files.junit, check::junit_xml(report));
  if (files.write_baseline && check::may_be_recorded(report)) {
    write_file(*files.write_baseline, check::baseline_text(report));
  }
  py::list verdicts, worst, warnings, better;
  for (const check::Verdict& v : report.verdicts) {
    verdicts.append(py::make_tuple(v.criterion, shown(v.source), v.measured, v.limit, v.passed, shown(sentence(v))));
  }
  for (const check::RowError& row : report.worst) {
    worst.append(py::make_tuple(shown(row.receiver), shown(row.source), row.truth, row.value, row.error, row.relative));
  }
  for (const std::string& warning : check::warnings(report)) warnings.append(shown(warning));
  for (const check::Improvement& one : improvements) {
    better.append(py::make_tuple(one.criterion, shown(one.source), one.recorded, one.now));
  }
  return py::make_tuple(report.passed(), statistics_of(report), verdicts, worst, warnings, better,
                        shown(failure_message(report)), shown(json_text(report, {}, improvements)));
}

py::tuple check_files(const std::filesystem::path& truth_file, const std::filesystem::path& candidate_file,
                      const std::string& truth_column, const std::string& value_column, bool by_position,
                      double tolerance, bool partial, const Limits& limits, const CheckFiles& files) {
  require_apart(files, {{"truth", truth_file}, {"values", candidate_file}});
  check::MatchOptions options;
  options.by = by_position ? check::MatchBy::kPosition : check::MatchBy::kReceiver;
  options.tolerance = tolerance;
  options.partial = partial;
  check::Report report = [&] {
    const py::gil_scoped_release released;
    const check::Truth truth = check::read_truth(truth_file, truth_column);
    const check::Candidate candidate = check::read_candidate(candidate_file, {.value = value_column}, options.by);
    return judge(truth, match(truth, candidate, options), criteria_of(limits), candidate.file);
  }();
  return result_of(std::move(report), files);
}

check::Report judged(const check::Truth& truth, const Numbers& values, const Limits& limits) {
  const std::span<const double> list(values.data(), static_cast<std::size_t>(values.size()));
  const py::gil_scoped_release released;
  check::Report report = judge(truth, list, criteria_of(limits));
  report.candidate_file = "values";
  return report;
}

// Values for the rows of a truth file, in their order.
py::tuple check_values(const std::filesystem::path& truth_file, const Numbers& values, const std::string& truth_column,
                       const Limits& limits, const CheckFiles& files) {
  require_apart(files, {{"truth", truth_file}});
  const check::Truth truth = [&] {
    const py::gil_scoped_release released;
    return check::read_truth(truth_file, truth_column);
  }();
  if (truth.rows.size() != static_cast<std::size_t>(values.size())) {
    throw InputError({.file = truth_file.string(),
                      .what = "has " + std::to_string(truth.rows.size()) + " rows, and there are " +
                              std::to_string(values.size()) + " values",
                      .why = "the values are compared with the rows in their order",
                      .suggestion = "give one value for each row, or a file whose rows are matched by receiver"});
  }
  return result_of(judged(truth, values, limits), files);
}

// True values and their bounds in arrays (receivers, sources). Without names, receivers have their index.
py::tuple check_arrays(const Numbers& exact, const Numbers& lower, const Numbers& upper,
                       const py::array_t<std::int8_t>& status, const std::vector<std::string>& receivers,
                       const std::vector<std::string>& sources, const Numbers& values, const Limits& limits,
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
  py::class_<Limits>(module, "Limits")
      .def(py::init<>())
      .def_readwrite("max_abs", &Limits::max_abs)
      .def_readwrite("max_rel", &Limits::max_rel)
      .def_readwrite("rms", &Limits::rms)
      .def_readwrite("eps_b", &Limits::eps_b)
      .def_readwrite("quantiles", &Limits::quantiles)
      .def_readwrite("per_source", &Limits::per_source)
      .def_readwrite("relative_floor", &Limits::relative_floor)
      .def_readwrite("worst", &Limits::worst);
  py::class_<CheckFiles>(module, "CheckFiles")
      .def(py::init<>())
      .def_readwrite("baseline", &CheckFiles::baseline)
      .def_readwrite("write_baseline", &CheckFiles::write_baseline)
      .def_readwrite("junit", &CheckFiles::junit)
      .def_readwrite("slack", &CheckFiles::slack);
  module.def("check_files", &check_files, py::arg("truth"), py::arg("candidate"), py::arg("truth_column"),
             py::arg("value_column"), py::arg("by_position"), py::arg("tolerance"), py::arg("partial"),
             py::arg("limits"), py::arg("files"));
  module.def("check_values", &check_values, py::arg("truth"), py::arg("values"), py::arg("truth_column"),
             py::arg("limits"), py::arg("files"));
  module.def("check_arrays", &check_arrays, py::arg("exact"), py::arg("lower"), py::arg("upper"), py::arg("status"),
             py::arg("receivers"), py::arg("sources"), py::arg("values"), py::arg("limits"), py::arg("files"));
}

}  // namespace exactff::python
