// Accuracy checks: the values of any other program, method or function held against certified truth.
//
//   const check::Truth truth = check::read_truth("truth.csv");
//   const check::Candidate mine = check::read_candidate("mine.csv");
//   const check::Report report = check::judge(truth, check::match(truth, mine), {.max_abs = 1e-6});
//   report.passed(); report.worst; report.verdicts;
//
// The error of a value c is c - F*, F* being the truth, correctly rounded. Where a row of the truth is not certified,
// F* is the nearest point of its enclosure: nobody is blamed for what is not known. The relative error is taken of F*;
// where F* is 0 it is 0 for c = 0 and infinite otherwise. The error in radiosity is the error times the largest rho_r
// B_s of the colour channels, which is what eps_B bounds, row by row.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "exactff/error.h"
#include "exactff/exact.h"
#include "exactff/geometry.h"

namespace exactff::check {

// --- Truth ---------------------------------------------------------------------------------------------------------

struct TruthRow {
  std::string receiver;
  std::uint32_t source = 0;  // into Truth::sources
  std::uint32_t on = 0;      // into Truth::faces
  std::uint32_t line = 0;    // of the file
  Status status = Status::kCertified;
  Vec3 point;   // if Truth::has_points
  Vec3 normal;  // if Truth::has_normals
  double value = 0.0;
  double lower = 0.0;
  double upper = 0.0;
  std::optional<double> largest_rho_b;  // over the colour channels; nothing where the file does not tell
};

struct Truth {
  std::string file;
  std::string column;                // that the values are of
  std::vector<std::string> header;   // the comment lines, without their '#'
  std::vector<std::string> sources;  // by first appearance; one empty name in a file without that column
  std::vector<std::string> faces;    // that rows lie on; the first name is empty and stands for none
  bool has_points = false;
  bool has_normals = false;
  std::vector<TruthRow> rows;

  [[nodiscard]] const std::string& source_of(const TruthRow& row) const { return sources[row.source]; }
  [[nodiscard]] const std::string& face_of(const TruthRow& row) const { return faces[row.on]; }
};

// A file of `exactff truth`, the exact.csv of `exactff compare`, or any CSV with the columns receiver (or id) and
// exact; source, on, x,y,z, nx,ny,nz, lower, upper, status, largest_rho_b and radiosity_r, _g, _b are used where they
// are. `column` names another column to be held against, such as unoccluded or radiosity_g. Throws one InputError with
// file:line for everything wrong, rows that occur twice included.
[[nodiscard]] Truth read_truth(const std::filesystem::path& path, const std::string& column = "exact");

// --- Candidate -----------------------------------------------------------------------------------------------------

enum class MatchBy {
  kReceiver,  // the receiver's id
  kPosition,  // its coordinates
};

// An empty name stands for the default.
struct CandidateColumns {
  std::string value = {};     // default: value, approximate or exact, whichever is there first
  std::string receiver = {};  // default: receiver or id
  std::string source = {};    // default: source, which may be absent where the truth has one source only
  std::array<std::string, 3> position = {"x", "y", "z"};
  std::array<std::string, 3> normal = {"nx", "ny", "nz"};
};

struct CandidateRow {
  std::string receiver;
  std::uint32_t source = 0;  // into Candidate::sources
  std::uint32_t line = 0;
  Vec3 point;
  Vec3 normal;
  double value = 0.0;  // may be infinite or not a number: a failure of the candidate, not of the file
};

struct Candidate {
  std::string file;
  bool has_sources = false;
  bool has_normals = false;
  std::vector<std::string> sources;
  std::vector<CandidateRow> rows;
};

// Reads the columns that matching `by` needs. Throws one InputError with file:line for everything wrong.
[[nodiscard]] Candidate read_candidate(const std::filesystem::path& path, const CandidateColumns& columns = {},
                                       MatchBy by = MatchBy::kReceiver);

// --- Matching ------------------------------------------------------------------------------------------------------

struct MatchOptions {
  MatchBy by = MatchBy::kReceiver;
  // By position: the largest distance between two points that count as one, in the scene's unit of length, and, where
  // both sides have normals, between their unit vectors.
  double tolerance = 0.0;
  double normal_tolerance = 1e-3;
  bool partial = false;  // rows of the truth may be missing
};

// A value for one row of the truth.
struct Measured {
  std::uint32_t row = 0;   // into Truth::rows
  std::uint32_t line = 0;  // of the candidate's file; 0 where there is none
  double value = 0.0;
};

// In the order of the truth. Throws one InputError with every row of the candidate that is not in the truth, that
// matches several of its rows, or matches one that another row has matched; and with the rows that are missing.
[[nodiscard]] std::vector<Measured> match(const Truth& truth, const Candidate& candidate,
                                          const MatchOptions& options = {});

// --- Judging -------------------------------------------------------------------------------------------------------

enum class Measure { kAbsolute, kRelative, kRadiosity };
[[nodiscard]] std::string_view to_string(Measure measure);  // "absolute error", ...

// At least the given share of the rows has an absolute error of at most `limit`.
struct Quantile {
  double share = 0.99;  // in (0, 1]
  double limit = 0.0;
};

// What is asked for; without any of it nothing but finiteness is judged. A limit is kept by an error equal to it.
struct Criteria {
  std::optional<double> max_abs = {};
  std::optional<double> max_rel = {};
  std::optional<double> rms = {};    // of the absolute errors
  std::optional<double> eps_b = {};  // on the error in radiosity
  std::vector<Quantile> quantiles = {};
  bool per_source = false;      // every source has to keep every limit; then all together do
  double relative_floor = 0.0;  // relative errors are taken of the truth or of this, whichever is larger
  std::size_t worst = 10;       // rows to report
};

// Of magnitudes. A quantile is by nearest rank: the smallest magnitude that so many rows do not exceed.
struct Distribution {
  double median = 0.0;
  double p90 = 0.0;
  double p99 = 0.0;
  double p999 = 0.0;
  double max = 0.0;
  double rms = 0.0;
};

// Over the rows whose value is finite.
struct Statistics {
  std::size_t rows = 0;        // all
  std::size_t not_finite = 0;  // of these: no number, or infinite
  std::size_t leaks = 0;       // the truth is 0, the value is not
  double bias = 0.0;           // mean error, with its sign
  Distribution absolute;
  Distribution relative;
  std::optional<Distribution> radiosity;  // where rho B is known for every row
  double largest_value = 0.0;             // of the truth
  double largest_radiosity = 0.0;
};

struct RowError {
  std::string receiver;
  std::string source;
  std::uint32_t truth_line = 0;
  std::uint32_t line = 0;
  Status status = Status::kCertified;
  double truth = 0.0;
  double value = 0.0;
  double error = 0.0;
  double relative = 0.0;
  std::optional<double> radiosity;
};

struct Verdict {
  std::string criterion;  // "finite", "max-abs", "max-rel", "rms", "eps-b", "quantile 0.99", "baseline rms"
  std::string source;     // empty: all together
  double measured = 0.0;
  double limit = 0.0;
  bool passed = false;
  std::optional<RowError> worst;  // where a single row decides
};

// What became better than the baseline, by more than its slack.
struct Improvement {
  std::string criterion;
  std::string source;
  double recorded = 0.0;
  double now = 0.0;
};

struct Report {
  std::string truth_file;
  std::string candidate_file;  // empty for values that are of no file
  std::string column;          // of the truth
  std::string identity;        // of the rows judged and their truths, whatever their order: 16 hexadecimal digits
  Criteria criteria;
  std::size_t truth_rows = 0;
  std::size_t not_certified = 0;  // rows judged by their enclosures
  Statistics overall;
  std::vector<std::string> sources;
  std::vector<Statistics> by_source;  // of each
  std::vector<Verdict> verdicts;      // the first is on finiteness
  std::vector<Improvement> improvements;
  Measure worst_by = Measure::kAbsolute;  // of the first limit that is broken
  std::vector<RowError> worst;            // the worst first; values that are not finite before all others
  std::vector<double> magnitudes;         // of the errors, ascending

  [[nodiscard]] bool passed() const;
};

// Holds values against the truth. Throws InputError where there is nothing to judge, where a limit is no limit (not a
// number, negative), and where eps_b is asked for and rho B is not known.
[[nodiscard]] Report judge(const Truth& truth, const std::vector<Measured>& values, const Criteria& criteria,
                           const std::string& candidate_file = {});

// The same for one value for each row of the truth, in its order.
[[nodiscard]] Report judge(const Truth& truth, std::span<const double> values, const Criteria& criteria);

// --- Ratchet -------------------------------------------------------------------------------------------------------

// What a baseline file holds: the statistics that must not get worse.
inline constexpr std::array<std::string_view, 5> kRatcheted = {"max-abs", "max-rel", "rms", "quantile 0.99", "eps-b"};
// Default slack: far above the noise that rounding makes in an error, far below any change of a method.
inline constexpr double kDefaultSlack = 1e-9;

// Today's statistics as JSON.
[[nodiscard]] std::string baseline_text(const Report& report);

// Adds to the report a verdict on every statistic of the baseline and what has improved. Worse is: larger than
// recorded by more than the share `slack` of it and by more than 4 units in the last place of the largest truth, since
// no two compilers agree on more. Throws InputError where the file cannot be read, or was recorded with other rows,
// other truths or another relative floor.
void hold_against_baseline(Report& report, const std::filesystem::path& baseline, double slack = kDefaultSlack);

// --- Output --------------------------------------------------------------------------------------------------------

// Lines of text: every limit that is broken, then the worst rows.
[[nodiscard]] std::string failure_message(const Report& report);

// JUnit XML: one test case per verdict.
[[nodiscard]] std::string junit_xml(const Report& report);

// Workflow commands of GitHub Actions: an ::error for every verdict that failed, a ::warning for what is doubtful.
[[nodiscard]] std::string github_annotations(const Report& report);
[[nodiscard]] std::string github_annotations(const InputError& error);

// Everything in the report.
[[nodiscard]] std::string json_text(const Report& report);

// A histogram of the magnitudes of the errors. The bins of a decade are equally wide on a logarithmic axis.
struct HistogramBin {
  double low = 0.0;  // not within, but for the first bin, which holds what is below it as well
  double high = 0.0;
  std::size_t count = 0;
};
struct Histogram {
  std::size_t exact = 0;  // errors of 0
  std::vector<HistogramBin> bins;
};
[[nodiscard]] Histogram histogram(const Report& report, int bins_per_decade = 1, std::size_t most_bins = 24);

// The same as a gnuplot script that plots an SVG to standard output; empty where every error is 0.
[[nodiscard]] std::string histogram_script(const Report& report);

// --- Single values -------------------------------------------------------------------------------------------------

// What a value is held against: a form factor, a row of a truth file, or a plain number.
struct Expected {
  Expected(double number);                  // NOLINT(google-explicit-constructor): an assertion takes any of them
  Expected(const FormFactor& form_factor);  // NOLINT(google-explicit-constructor)
  Expected(const TruthRow& row);            // NOLINT(google-explicit-constructor)

  double value;
  double lower;
  double upper;
  std::optional<Status> status;
};

// Kept if either part is. A plain number is an absolute tolerance.
struct Tolerance {
  Tolerance(double absolute_error) : absolute(absolute_error) {}  // NOLINT(google-explicit-constructor)
  Tolerance(double absolute_error, double relative_error) : absolute(absolute_error), relative(relative_error) {}

  double absolute = 0.0;
  double relative = 0.0;
};
[[nodiscard]] inline Tolerance relative(double error) { return {0.0, error}; }

struct Difference {
  double error = 0.0;  // with its sign
  double relative = 0.0;
  double ulps = 0.0;  // doubles passed on the way from the truth to the value
};
[[nodiscard]] Difference difference(double actual, const Expected& expected);
[[nodiscard]] bool is_near(double actual, const Expected& expected, const Tolerance& tolerance);
// What a failed assertion tells: both values, the bounds and status of the truth, the error, the tolerance.
[[nodiscard]] std::string describe_difference(double actual, const Expected& expected, const Tolerance& tolerance);

}  // namespace exactff::check
