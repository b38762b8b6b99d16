// exactff check: compares the values of other programs with a truth file.
#include "exactff/check.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>

#include "check/report.h"
#include "cli/commands.h"
#include "cli/output.h"
#include "cli/process.h"
#include "exactff/render.h"
#include "exr/exr_file.h"
#include "flags/values.h"
#include "text/csv_lines.h"
#include "text/escape.h"
#include "text/names.h"
#include "text/number_text.h"
#include "text/phrases.h"
#include "text/refuse.h"
#include "text/text_lines.h"

namespace exactff::cli {

namespace {

// --- What `exactff check` prints ---

void add_statistics(TextTable& table, const std::string& what, const std::string& source,
                    const check::Statistics& statistics, const check::Distribution& d, bool has_bias) {
  table.add_row({what, source, std::to_string(statistics.rows - statistics.not_finite), text::short_number(d.median),
                 text::short_number(d.p90), text::short_number(d.p99), text::short_number(d.p999),
                 text::short_number(d.max), text::short_number(d.rms),
                 has_bias ? text::short_number(statistics.bias) : ""});
}

void add_all(TextTable& table, const std::string& source, const check::Statistics& s) {
  add_statistics(table, "absolute", source, s, s.absolute, true);
  add_statistics(table, "relative", source, s, s.relative, false);
  if (s.radiosity) add_statistics(table, "radiosity", source, s, *s.radiosity, false);
}

void print_distribution(const check::Report& report) {
  TextTable table;
  table.add_columns({"error", "source"});
  table.add_columns({"rows", "median", "90 %", "99 %", "99.9 %", "max", "RMS", "bias"}, Align::kRight);
  const bool several = report.sources.size() > 1;
  add_all(table, several ? "all" : report.sources.front(), report.overall);
  for (std::size_t s = 0; several && s < report.sources.size(); ++s) {
    add_all(table, report.sources[s], report.by_source[s]);
  }
  table.print(std::cout);
  if (report.overall.relative_mse) {
    std::cout << "Relative MSE, the mean of e^2 / (t^2 + " << text::shortest(check::kRelativeMseEpsilon)
              << "): " << text::short_number(*report.overall.relative_mse) << '\n';
  }
  if (report.overall.leaks > 0) {
    std::cout << "Truth is 0, but value is not: " << text::counted(report.overall.leaks, "row") << '\n';
  }
  std::cout << '\n';
}

void print_histogram(const check::Report& report) {
  const check::Histogram histogram = check::histogram(report);
  std::size_t most = histogram.exact;
  for (const check::HistogramBin& bin : histogram.bins) most = std::max(most, bin.count);
  TextTable table;
  table.add_column("absolute error");
  table.add_column("rows", Align::kRight);
  table.add_column("");
  const auto add = [&](const std::string& range, std::size_t count) {
    constexpr std::size_t kWidth = 50;
    const std::size_t length = count == 0 ? 0 : std::max<std::size_t>(1, kWidth * count / most);
    table.add_row({range, std::to_string(count), std::string(length, '#')});
  };
  if (histogram.exact > 0) add("0", histogram.exact);
  for (const check::HistogramBin& bin : histogram.bins) add("up to " + text::short_number(bin.high, 1), bin.count);
  table.print(std::cout);
  std::cout << '\n';
}

void print_matrix_facts(const std::optional<check::MatrixFacts>& matrix) {
  if (!matrix) return;
  std::cout << "The matrix itself\n";
  for (const std::string& fact : check::sentences(*matrix)) std::cout << "  " << text::printable(fact) << '\n';
  std::cout << '\n';
}

// The first column is always our own text, so that no line can begin with text from a file.
void print_worst(const check::Report& report) {
  if (report.worst.empty()) return;
  std::cout << "Worst rows by " << to_string(report.worst_by) << '\n';
  TextTable table;
  table.add_column("#", Align::kRight);
  for (const std::string& title : report.keys) table.add_column(title);
  table.add_columns({report.worst.front().claim ? "truth" : "exact", "found", "error", "relative", "line"},
                    Align::kRight);
  for (std::size_t i = 0; i < report.worst.size(); ++i) {
    const check::RowError& row = report.worst[i];
    table.add_row({std::to_string(i + 1), row.receiver, row.source, text::shortest(row.truth),
                   text::shortest(row.value), text::short_number(row.error), text::short_number(row.relative),
                   row.line > 0 ? std::to_string(row.line) : std::string()});
  }
  table.print(std::cout);
  std::cout << '\n';
}

void print_verdicts(const check::Report& report) {
  TextTable table;
  table.add_columns({"verdict", "criterion", "source"});
  table.add_columns({"measured", "limit"}, Align::kRight);
  for (const check::Verdict& verdict : report.verdicts) {
    table.add_row({verdict.passed ? "pass" : "FAIL", verdict.criterion, verdict.source.empty() ? "all" : verdict.source,
                   text::short_number(verdict.measured, 6), text::short_number(verdict.limit, 6)});
  }
  table.print(std::cout);
}

void print_improvements(const std::vector<check::Improvement>& improvements) {
  for (const check::Improvement& better : improvements) {
    std::cout << "Better than " << better.criterion
              << (better.source.empty() ? "" : ", source " + text::printable(better.source)) << ": "
              << text::short_number(better.recorded) << " -> " << text::short_number(better.now);
    if (better.recorded > 0.0 && std::isfinite(better.recorded)) {
      std::cout << ", " << text::short_number(100.0 * (1.0 - better.now / better.recorded)) << " % less";
    }
    std::cout << '\n';
  }
}

void print_end(const check::Report& report, bool improved, const std::string& baseline_to_tighten) {
  const auto failed = static_cast<std::size_t>(std::count_if(
      report.verdicts.begin(), report.verdicts.end(), [](const check::Verdict& verdict) { return !verdict.passed; }));
  if (failed > 0) {
    std::cout << "Failed: " << failed << " of " << text::counted(report.verdicts.size(), "criterion", "criteria")
              << '\n';
    return;
  }
  std::cout << "Passed\n";
  if (improved && !baseline_to_tighten.empty())
    std::cout << "To record this improvement, without --baseline: --write-baseline "
              << text::printable(baseline_to_tighten) << '\n';
}

// `baseline_to_tighten`: the file to suggest for improvements; empty if none is to be suggested.
void print_check(const check::Report& report, const std::string& baseline_to_tighten) {
  std::cout << "truth      " << text::printable(report.truth_file) << " (" << text::printable(report.column) << ", "
            << (report.matrix ? text::counted(report.truth_rows, "entry", "entries")
                              : text::counted(report.truth_rows, "row"))
            << ")\n"
            << "candidate  " << text::printable(report.candidate_file) << " ("
            << text::counted(report.overall.rows, "row") << " judged)\n\n";
  print_distribution(report);
  print_histogram(report);
  print_matrix_facts(report.matrix);
  print_worst(report);
  print_verdicts(report);
  print_improvements(report.improvements);
  print_end(report, !report.improvements.empty(), baseline_to_tighten);
}

constexpr const char* kCheckFooter =
    "Every row of the truth file needs a value, and every value needs a row in the truth file. A value that is not a\n"
    "finite number is a failure. If no limit is given, the errors are printed and nothing else is checked.\n"
    "An error that is equal to a limit passes.\n"
    "The relative error is infinite if the truth is 0 and the value is not. With --relative-floor, relative errors\n"
    "are divided by the truth or by the floor, whichever is larger. --eps-b limits the error in radiosity: in each\n"
    "row, the absolute error times the largest rho B (reflectance of the receiver times radiosity of the source). A\n"
    "baseline file records errors, which become the limits of later runs. An error counts as worse if it is larger by\n"
    "more than --slack and by more than 4 units in the last place. A program that draws new random numbers in every\n"
    "run needs a slack such as 0.2, or a fixed seed.\n"
    "With --baseline, --write-baseline writes its file, another one, only if nothing got worse.\n"
    "Tables may have commas, or semicolons as spreadsheets write them, then also with decimal commas.\n"
    "Two images, .exr or .npy arrays (height, width, 3), are compared pixel by pixel, in each channel: pixels are\n"
    "receivers, channels are sources. A pixel of the truth that is not a finite number does not count. --error-image\n"
    "shows where the errors are.\n"
    "Any table that exactff wrote can be the truth, as CSV, .npz or .jsonl. Its\n"
    "key columns match rows. Values with bounds are judged by their distance from [lower, upper].\n"
    "A file of `exactff matrix -o` is compared entry by entry with another program's matrix: a table with\n"
    "from,to,value or with names above and beside it, UserViewFactors of EnergyPlus, or, in the same order, View3D's\n"
    "output, OpenFOAM's F, CalculiX' .vwf, numbers only or .npy. Negative entries, entries above 1, sums of rows and\n"
    "reciprocity are printed. Several candidates are a scoreboard, printed as a table in Markdown; -o DIR writes a\n"
    "page, JSON and JUnit XML. If TRUTH is the folder of a suite, such as data/suite, candidates have the columns\n"
    "question and value, and are graded on each of its levels; questions may be left out.\n"
    "Exit codes: 0 passed, 1 failed, 2 bad input.\n"
    "\n"
    "Examples:\n"
    "  exactff check truth.csv mine.csv --max-abs 1e-4 --quantile 0.99=1e-6 --junit check.xml\n"
    "  exactff check truth.csv mine.csv --match position --tolerance 1e-6 --value-column ff\n"
    "  exactff check truth.csv mine.csv --baseline accuracy.json\n"
    "  exactff check truth.exr mine.exr --rms 1e-3 --error-image errors.png\n"
    "  exactff check factors.csv view3d.out --max-abs 1e-5\n"
    "  exactff check truth.csv ours.csv theirs.csv --max-abs 1e-4 --time ours=3.2 --time theirs=0.4 -o scoreboard\n"
    "  exactff check data/suite mine.csv theirs.csv --max-abs 1e-3 -o scoreboard";

struct CheckArguments {
  std::string truth;
  std::vector<std::string> candidates;
  std::string truth_column, folder;
  std::vector<std::string> times;
  check::CandidateColumns columns;
  std::string position_columns = "x,y,z", normal_columns = "nx,ny,nz";
  std::string match = "receiver", tolerance = "0", normal_tolerance = "0.001";
  bool partial = false;
  std::string max_abs, max_rel, rms, eps_b, relative_floor = "0";
  std::vector<std::string> quantiles;
  bool per_source = false;
  std::string baseline, write_baseline, slack = "1e-9";
  std::size_t worst = 10;
  std::string plot, junit, json, error_image;
  std::string relative_mse;
  bool github = false;

  [[nodiscard]] std::vector<std::filesystem::path> files() const { return {candidates.begin(), candidates.end()}; }
};

double to_limit(const std::string& text, const std::string& flag) {
  const text::ParsedNumber number = text::parse_number(text);
  if (number.fault == text::NumberFault::kNone && number.value >= 0.0) return number.value;
  text::refuse(flag + ": " +
                   (number.fault == text::NumberFault::kNone ? text::in_quotes(text) + " is negative"
                                                             : describe(number.fault, text)),
               "a limit is a finite number of at least 0", "write, for example, " + flag + " 1e-6");
}

std::optional<double> to_optional_limit(const std::string& text, const std::string& flag) {
  return text.empty() ? std::nullopt : std::optional(to_limit(text, flag));
}

// "NAME=NUMBER", the last equals sign counts.
std::pair<std::string, double> to_pair(const std::string& text, const std::string& flag, const char* why,
                                       const char* example) {
  const std::size_t equals = text.rfind('=');
  if (equals == std::string::npos) {
    text::refuse(flag + ": " + text::in_quotes(text) + " has no equals sign", why,
                 "write, for example, " + flag + ' ' + example);
  }
  return {text.substr(0, equals), to_limit(text.substr(equals + 1), flag)};
}

check::Quantile to_quantile(const std::string& text) {
  const auto [share, limit] =
      to_pair(text, "--quantile", "a quantile is a share of the rows and a limit for their errors", "0.99=1e-3");
  return {to_limit(share, "--quantile"), limit};
}

std::array<std::string, 3> to_three_names(const std::string& text, const std::string& flag) {
  std::array<std::string, 3> names;
  std::vector<std::string> fields;
  if (!text::split_csv_line(text, fields) || fields.size() != 3) {
    text::refuse(flag + ": " + text::in_quotes(text) + " does not name three columns", "a point has three coordinates",
                 "separate them by commas, for example " + flag + " x,y,z");
  }
  std::move(fields.begin(), fields.end(), names.begin());
  return names;
}

check::Criteria criteria_of(const CheckArguments& args) {
  check::Criteria criteria;
  criteria.max_abs = to_optional_limit(args.max_abs, "--max-abs");
  criteria.max_rel = to_optional_limit(args.max_rel, "--max-rel");
  criteria.rms = to_optional_limit(args.rms, "--rms");
  criteria.eps_b = to_optional_limit(args.eps_b, "--eps-b");
  criteria.relative_mse = to_optional_limit(args.relative_mse, "--relative-mse");
  criteria.relative_floor = to_limit(args.relative_floor, "--relative-floor");
  for (const std::string& text : args.quantiles) criteria.quantiles.push_back(to_quantile(text));
  criteria.per_source = args.per_source;
  criteria.worst = args.worst;
  return criteria;
}

check::Options options_of(const CheckArguments& args) {
  check::Options options{.truth_column = args.truth_column, .columns = args.columns, .criteria = criteria_of(args)};
  options.match.by = args.match == "position" ? check::MatchBy::kPosition : check::MatchBy::kReceiver;
  options.match.tolerance = to_limit(args.tolerance, "--tolerance");
  options.match.normal_tolerance = to_limit(args.normal_tolerance, "--normal-tolerance");
  options.match.partial = args.partial;
  options.columns.position = to_three_names(args.position_columns, "--position-columns");
  options.columns.normal = to_three_names(args.normal_columns, "--normal-columns");
  return options;
}

// --- One candidate ---

// Refuses a file that cannot be written as an image, and one for files that are not images.
void check_error_image(const CheckArguments& args) {
  if (args.error_image.empty()) return;
  static_cast<void>(render::image_kind(args.error_image));
  if (exr::is_image(args.truth) && exr::is_image(args.candidates.front())) return;
  text::refuse("--error-image is given, but the files are tables", "only images have pixels to show",
               "compare two images, or use --plot");
}

void draw(const check::Report& report, const std::string& file) {
  check::Plot plot;
  {
    const InterruptWatch watch;  // a signal waits until gnuplot's folder is removed
    plot = check::plot(check::histogram_script(report), is_interrupted);
  }
  leave_if_interrupted();
  if (!plot.svg.empty()) return write_whole_file(file, plot.svg);
  std::cerr << "note: " << text::printable(file) << " was not drawn: " << text::printable(plot.why_not) << '\n';
}

void write_files(const CheckArguments& args, const check::Report& report) {
  if (!args.junit.empty()) write_whole_file(args.junit, check::junit_xml(report));
  if (!args.json.empty()) write_whole_file(args.json, check::json_text(report));
  if (!args.plot.empty()) draw(report, args.plot);
  if (args.error_image.empty()) return;
  const check::Images images =
      check::read_images(args.truth, args.candidates.front(), {args.truth_column, args.columns.value}, args.partial);
  write_whole_file(args.error_image, check::error_image(images, render::image_kind(args.error_image)));
}

// Without an existing baseline, the present statistics are recorded whatever they are.
void record(const CheckArguments& args, const check::Report& report) {
  if (args.write_baseline.empty()) return;
  if (!check::may_be_recorded(report)) {
    std::cerr << "note: " << text::printable(args.write_baseline) << " was not written: "
              << (report.overall.not_finite > 0 ? "some values are not numbers\n" : "errors got worse\n");
    return;
  }
  write_whole_file(args.write_baseline, check::baseline_text(report));
  std::cout << "Baseline: " << text::printable(args.write_baseline) << '\n';
}

// Limits that a program of a scoreboard exceeds.
void print_broken(const check::Score& score) {
  for (const check::Verdict& verdict : score.report.verdicts) {
    if (verdict.passed) continue;
    std::cerr << "failed: " << text::printable(score.program + ": " + check::sentence(verdict)) << '\n';
  }
}

void print_doubts(const CheckArguments& args, const check::Report& report, const std::string& of) {
  if (args.github) std::cout << check::github_annotations(report);
  for (const std::string& warning : check::warnings(report)) {
    std::cerr << "warning: " << text::printable(of + warning) << '\n';
  }
}

int check_one(const CheckArguments& args) {
  check_error_image(args);
  check::Report report = check::compare(args.truth, args.candidates.front(), options_of(args));
  if (!args.baseline.empty()) check::hold_against_baseline(report, args.baseline, to_limit(args.slack, "--slack"));
  write_files(args, report);
  print_check(report, args.write_baseline.empty() ? args.baseline : "");
  record(args, report);
  print_doubts(args, report, "");
  check_output(std::cout);
  return report.passed() ? 0 : 1;
}

// --- Several candidates ---

void refuse_flags_of_one(const CheckArguments& args) {
  const CheckArguments without;
  for (const auto& [flag, file] :
       {std::pair("--json", &args.json), std::pair("--junit", &args.junit), std::pair("--plot", &args.plot),
        std::pair("--error-image", &args.error_image), std::pair("--baseline", &args.baseline),
        std::pair("--write-baseline", &args.write_baseline)}) {
    if (file->empty()) continue;
    text::refuse(std::string(flag) + " is given with a scoreboard",
                 "it is for the report on one candidate, without -o and against no suite",
                 "use -o DIR, which holds JSON and JUnit XML");
  }
}

int check_several(const CheckArguments& args) {
  refuse_flags_of_one(args);
  const std::vector<std::filesystem::path> files = args.files();
  const std::vector<std::string> names = check::program_names(files);
  std::vector<std::optional<double>> seconds(names.size());
  for (const std::string& text : args.times) {
    const auto [name, time] = to_pair(text, "--time", "a time is of one program", "mine=3.2");
    const auto known = std::ranges::find(names, name);
    if (known == names.end()) {
      text::refuse("--time: there is no program " + text::in_quotes(name), "its time has no row",
                   "the programs are " + text::joined(names) + ", named by their files");
    }
    seconds[static_cast<std::size_t>(known - names.begin())] = time;
  }
  check::Scoreboard board = check::scoreboard(args.truth, files, options_of(args));
  for (std::size_t i = 0; i < names.size(); ++i) board.scores[i].seconds = seconds[i];
  std::cout << check::markdown(board);
  if (!args.folder.empty()) {
    {
      const InterruptWatch watch;  // a signal waits until the folder is complete or removed
      check::write(board, args.folder);
    }
    leave_if_interrupted();
    std::cout << "\nScoreboard: " << text::printable(args.folder + "/index.html") << '\n';
  }
  bool passed = true;
  for (const check::Score& score : board.scores) {
    print_broken(score);
    print_doubts(args, score.report, score.program + ": ");
    passed = passed && score.report.passed();
  }
  check_output(std::cout);
  return passed ? 0 : 1;
}

int run(const CheckArguments& args) {
  try {
    const bool one = args.candidates.size() == 1 && args.folder.empty() && !check::is_suite(args.truth);
    return one ? check_one(args) : check_several(args);
  } catch (const InputError& error) {
    if (args.github) std::cout << check::github_annotations(error) << std::flush;
    throw;
  }
}

void add_matching(CLI::App& command, CheckArguments& args) {
  flags::add_value(command, "--value-column", args.columns.value, "NAME",
                   "The candidate's column to judge (default: value, approximate or exact; of a table of "
                   "exactff that of the truth); of an image its layer or "
                   "channel (default: R, G, B)");
  flags::add_value(command, "--receiver-column", args.columns.receiver, "NAME",
                   "The candidate's column of receivers (default: receiver or id; from; patch)");
  flags::add_value(
      command, "--source-column", args.columns.source, "NAME",
      "The candidate's column of sources (default: source; to; channel); needed only if the truth has several");
  flags::add_value(
      command, "--truth-column", args.truth_column, "NAME",
      "The truth's column to compare with, such as unoccluded, radiosity_g, total_g or dF_dx (default: exact, "
      "factor or radiosity); of an image its layer or channel");
  command.add_option("--match", args.match, "How rows are matched: by the receiver's id or by its position")
      ->check(CLI::IsMember({"receiver", "position"}))
      ->capture_default_str();
  flags::add_value(command, "--tolerance", args.tolerance, "DISTANCE",
                   "Matching by position: largest distance between matching points")
      ->capture_default_str();
  flags::add_value(command, "--normal-tolerance", args.normal_tolerance, "DISTANCE",
                   "Matching by position: largest distance between matching unit normals, if both files have normals")
      ->capture_default_str();
  flags::add_value(command, "--position-columns", args.position_columns, "X,Y,Z",
                   "The candidate's columns of coordinates")
      ->capture_default_str();
  flags::add_value(command, "--normal-columns", args.normal_columns, "NX,NY,NZ",
                   "The candidate's columns of normals, if it has any")
      ->capture_default_str();
  command.add_flag("--partial", args.partial, "Rows of the truth may be missing");
}

void add_criteria(CLI::App& command, CheckArguments& args) {
  flags::add_value(command, "--max-abs", args.max_abs, "LIMIT", "Limit for every absolute error");
  flags::add_value(command, "--max-rel", args.max_rel, "LIMIT", "Limit for every relative error");
  flags::add_value(command, "--rms", args.rms, "LIMIT", "Limit for the root mean square of the absolute errors");
  flags::add_value(command, "--eps-b", args.eps_b, "LIMIT", "Limit for every error in radiosity");
  flags::add_value(command, "--relative-mse", args.relative_mse, "LIMIT",
                   "Of two images: limit for the relative mean square error");
  flags::add_value(
      command, "--quantile", args.quantiles, "SHARE=LIMIT",
      "This share of the rows must have absolute errors within the limit, such as 0.99=1e-3; can be repeated")
      ->expected(1)
      ->take_all();
  command.add_flag("--per-source", args.per_source, "Check every limit and the baseline for each source separately");
  flags::add_value(command, "--relative-floor", args.relative_floor, "NUMBER",
                   "Divide by at least this number in relative errors")
      ->capture_default_str();
  flags::add_read(command, "--baseline", args.baseline, "Fail if errors are worse than those recorded in this file");
  flags::add_written(command, "--write-baseline", args.write_baseline, "Record the errors of this run",
                     flags::Format::kJson);
  flags::add_value(command, "--slack", args.slack, "SHARE",
                   "Share by which errors may exceed the baseline: 0.1 allows 10 % more")
      ->capture_default_str();
}

void add_outputs(CLI::App& command, CheckArguments& args) {
  flags::add_written(command, "--error-image", args.error_image,
                     "Of two images: write candidate minus truth as .exr, or in colours as .png",
                     flags::Format::kImage);
  flags::add_value(command, "--worst", args.worst, "N", "Number of rows to list, worst first")->capture_default_str();
  flags::add_written(command, "--plot", args.plot, "Draw the histogram of the errors as SVG", flags::Format::kSvg);
  flags::add_written(command, "--junit", args.junit, "Write the verdicts as JUnit XML", flags::Format::kXml);
  flags::add_written(command, "--json", args.json, "Write everything as JSON", flags::Format::kJson);
  flags::add_value(command, "-o,--output", args.folder, "DIR",
                   "Folder for a scoreboard: index.html, scoreboard.json, junit.xml")
      ->check(flags::is_written_folder());
  flags::add_value(command, "--time", args.times, "NAME=SECONDS",
                   "Scoreboard: the time of the program whose file is NAME.*; can be repeated")
      ->expected(1)
      ->take_all();
  command.add_flag("--github", args.github, "Also print annotations for GitHub Actions");
}

}  // namespace

Command add_check(CLI::App& app) {
  auto args = std::make_shared<CheckArguments>();
  CLI::App* command =
      app.add_subcommand("check", "Compare the values of other programs with a truth file: pass or fail");
  flags::add_read(
      *command, "TRUTH", args->truth,
      "Table written by exactff: of `truth`, `matrix -o`, `radiosity -o`, a report, ...; or an image, .exr or "
      ".npy; or the folder of a suite")
      ->required();
  flags::add_read(*command, "CANDIDATE", args->candidates,
                  "CSV file of the values to judge; or an image, or a matrix; several are a scoreboard")
      ->required()
      ->expected(1, -1);
  add_matching(*command, *args);
  add_criteria(*command, *args);
  add_outputs(*command, *args);
  command->footer(kCheckFooter);
  return {command, [args] { return run(*args); }};
}

}  // namespace exactff::cli
