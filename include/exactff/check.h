// Accuracy checks: compares the values of any other program, method or function with true ones.
//
//   const check::Report report = check::compare("truth.csv", "mine.csv", {.criteria = {.max_abs = 1e-6}});
//   report.passed(); report.worst; report.verdicts;
//   check::scoreboard("truth.csv", candidates, options);  // several programs, a row for each
//
// A truth is any table that exactff wrote (table.h): a truth file, a matrix, radiosities. Its key columns identify the
// rows, and one column of numbers is judged. The error of a value c is c - F*, where F* is the true value, correctly
// rounded. If a row of the truth is not certified, F* is the point of its enclosure nearest to c, so a value within the
// enclosure has no error. The relative error is relative to F*; for F* = 0 it is 0 if c = 0 and infinite
// otherwise. The error in radiosity is the error times the largest rho_r B_s over the colour channels. This is the
// quantity that eps_B bounds, row by row.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "exactff/error.h"
#include "exactff/exact.h"
#include "exactff/geometry.h"
#include "exactff/table.h"
#include "exactff/view_factors.h"

namespace exactff::check {

// --- Truth ---------------------------------------------------------------------------------------------------------

struct TruthRow {
  std::string receiver;      // the first key
  std::uint32_t source = 0;  // the second key: index into Truth::sources
  std::uint32_t on = 0;      // index into Truth::faces
  std::uint32_t line = 0;    // of the file
  Status status = Status::kCertified;
  Vec3 point;   // if Truth::has_points
  Vec3 normal;  // of any length; if Truth::has_normals
  double value = 0.0;
  double lower = 0.0;
  double upper = 0.0;
  std::optional<double> largest_rho_b;  // over the colour channels; empty if the file does not give it
  std::optional<Claim> claim;           // of a factor or a radiosity
  bool by_points = false;               // of a factor: estimated by points
  bool accurate = true;                 // of a factor: within the accuracy that was asked for
};

struct Truth {
  std::string file;
  std::string kind;    // "truth", "matrix", ...: of the table; "image"; "suite"; empty for other files
  std::string column;  // the column that `value` was read from
  std::array<std::string, 2> keys = {"receiver", "source"};  // "from" and "to", "patch" and "channel"
  std::vector<std::string> sources;  // in order of first appearance; one empty name if there is no second key
  std::vector<std::string> further;  // sources that count only for candidates that have them, such as "(back)"
  std::vector<std::string> faces;    // faces that receivers lie on; the first name is empty and stands for none
  std::unordered_map<std::string, double> areas;  // of the receivers, if the file has them
  bool has_points = false;
  bool has_normals = false;
  std::vector<TruthRow> rows;

  [[nodiscard]] const std::string& source_of(const TruthRow& row) const { return sources[row.source]; }
  [[nodiscard]] const std::string& face_of(const TruthRow& row) const { return faces[row.on]; }
};

// Reads any table that exactff wrote, in any of its formats; or a CSV file with the columns receiver (or id) and exact.
// `column` names the column with the true values; empty stands for exact,
// factor or radiosity. Of a table, the key columns identify the rows; further keys than two are joined with the second.
// The bounds of NAME are lower and upper for these three, else NAME_lower and NAME_upper (total_lower_r for total_r);
// NAME_status or status, and claim, say how a row is judged. Other files may have source, on, x,y,z, nx,ny,nz, lower,
// upper, status, largest_rho_b and radiosity_r, _g, _b. A value that is not known, such as a derivative (dF_dx) at a
// kink, is not certified and its bounds are the largest doubles, so that no value has an error. A total (total_r, _g,
// _b) is one value for all sources: only the first row of each receiver counts. Throws one InputError with file:line
// for every problem, including rows that occur twice.
[[nodiscard]] Truth read_truth(const std::filesystem::path& path, const std::string& column = {});

// Whether the path is the folder of a suite, such as data/suite, and its answers. `questions.csv` has the columns
// question, level, scene, quantity, from and to. A question is a row of answers/SCENE.pairs.csv, a table of `exactff
// matrix`, if it has a patch `from`, else of answers/SCENE.points.csv, one of `exactff truth` whose receivers are
// questions. The keys are question and level. Throws one InputError with file:line for every problem.
[[nodiscard]] bool is_suite(const std::filesystem::path& path);
[[nodiscard]] Truth read_suite(const std::filesystem::path& folder);

// --- Candidate -----------------------------------------------------------------------------------------------------

enum class MatchBy {
  kReceiver,  // by the keys
  kPosition,  // by the coordinates of the receiver
};

// Column names. An empty name stands for the default.
struct CandidateColumns {
  // Default: the first of value, approximate and exact that exists; factor or radiosity if that is the truth's; of a
  // table that exactff wrote, the truth's column.
  std::string value = {};
  std::string receiver = {};  // default: the first key of the truth, or id
  std::string source = {};    // default: the second key, which may be absent if it has only one value in the truth
  std::array<std::string, 3> position = {"x", "y", "z"};
  std::array<std::string, 3> normal = {"nx", "ny", "nz"};

  friend bool operator==(const CandidateColumns&, const CandidateColumns&) = default;
};

// The values of another program: text columns receiver and source, a number column value, which may be infinite or NaN
// (that is a failure of the candidate, not of the file), and x, y, z, nx, ny, nz for matching by position.
struct Candidate {
  std::string file;
  table::Table table;
};

// Reads the columns that matching `by` needs, of any table of exactff or any CSV file. If the truth is a matrix, or a
// table like it, the file may also be a matrix, recognised by its content: a CSV file with names above and beside it;
// the UserViewFactors object of EnergyPlus; or, in the order of the truth, whose size (and areas, if it has areas) they
// must have, View3D's output, numbers only (CSV, or blanks between), a NumPy array, OpenFOAM's file F (with
// globalFaceFaces beside it), CalculiX's file .vwf. Throws one InputError with file:line for every problem.
[[nodiscard]] Candidate read_candidate(const std::filesystem::path& path, const Truth& truth = {},
                                       const CandidateColumns& columns = {}, MatchBy by = MatchBy::kReceiver);

// --- Matching ------------------------------------------------------------------------------------------------------

struct MatchOptions {
  MatchBy by = MatchBy::kReceiver;
  // For matching by position: the largest distance between two points that count as equal, in the scene's unit of
  // length. `normal_tolerance`: if both sides have normals, the largest distance between their unit vectors.
  double tolerance = 0.0;
  double normal_tolerance = 1e-3;
  bool partial = false;  // rows of the truth may be missing

  friend bool operator==(const MatchOptions&, const MatchOptions&) = default;
};

// A value for one row of the truth.
struct Measured {
  std::uint32_t row = 0;   // index into Truth::rows
  std::uint32_t line = 0;  // in the candidate's file; 0 if there is no file
  double value = 0.0;
};

// The matched values, in the order of the truth. Throws one InputError that lists every row of the candidate that is
// not in the truth, matches several of its rows, or matches a row that another row has already matched; and every row
// of the truth without a match, unless options.partial.
[[nodiscard]] std::vector<Measured> match(const Truth& truth, const Candidate& candidate,
                                          const MatchOptions& options = {});

// --- Judging -------------------------------------------------------------------------------------------------------

enum class Measure { kAbsolute, kRelative, kRadiosity };
[[nodiscard]] std::string_view to_string(Measure measure);  // "absolute error", ...

// At least this share of the rows must have an absolute error of at most `limit`.
struct Quantile {
  double share = 0.99;  // in (0, 1]
  double limit = 0.0;
};

// The limits to check. Without any limit, only finiteness is checked. An error equal to its limit passes.
struct Criteria {
  std::optional<double> max_abs = {};
  std::optional<double> max_rel = {};
  std::optional<double> rms = {};           // of the absolute errors
  std::optional<double> eps_b = {};         // bound on the error in radiosity
  std::optional<double> relative_mse = {};  // of images
  std::vector<Quantile> quantiles = {};
  bool per_source = false;      // every source must meet every limit, which implies that all together do
  double relative_floor = 0.0;  // relative errors are relative to the truth or to this, whichever is larger
  std::size_t worst = 10;       // rows to report
};

// Statistics of error magnitudes. A quantile is by nearest rank: the smallest magnitude that at least this share of the
// rows does not exceed.
struct Distribution {
  double median = 0.0;
  double p90 = 0.0;
  double p99 = 0.0;
  double p999 = 0.0;
  double max = 0.0;
  double rms = 0.0;
};

// Statistics over the rows with a finite value.
struct Statistics {
  std::size_t rows = 0;        // all rows
  std::size_t not_finite = 0;  // rows whose value is NaN or infinite
  std::size_t leaks = 0;       // rows where the truth is 0 and the value is not
  double bias = 0.0;           // signed mean error
  Distribution absolute;
  Distribution relative;
  std::optional<Distribution> radiosity;  // if rho B is known for every row
  std::optional<double> relative_mse;     // of images: the mean of e^2 / (t^2 + 0.01), t the truth
  double largest_value = 0.0;             // of the truth
  double largest_radiosity = 0.0;
};

struct RowError {
  std::string receiver;
  std::string source;
  std::string name;  // "receiver '7', source 'light'"
  std::uint32_t truth_line = 0;
  std::uint32_t line = 0;
  Status status = Status::kCertified;
  double truth = 0.0;
  double value = 0.0;
  double error = 0.0;
  double relative = 0.0;
  std::optional<double> radiosity;
  double lower = 0.0, upper = 0.0;  // of the truth
  std::optional<Claim> claim;       // of a factor or a radiosity
};

struct Verdict {
  // "finite", "max-abs", "max-rel", "rms", "eps-b", "relative-mse", "quantile 0.99", "baseline rms"
  std::string criterion;
  std::string source;  // empty: all sources together
  double measured = 0.0;
  double limit = 0.0;
  bool passed = false;
  std::optional<RowError> worst;  // set if a single row decides
};

// A statistic that is better than the baseline by more than the slack.
struct Improvement {
  std::string criterion;
  std::string source;
  double recorded = 0.0;
  double now = 0.0;
};

// What view factors must keep to, whatever the truth is: how far the candidate's entries are from it.
struct MatrixFacts {
  struct Largest {
    double by = 0.0;
    std::string from, to;
  };
  std::size_t negative = 0, above_one = 0;  // entries
  Largest least, largest;                   // the entries themselves
  std::optional<Largest> row_sum;      // the distance of a row's sum from the sum of the truth's bounds; of whole rows
  std::optional<Largest> reciprocity;  // |A_i F_ij - A_j F_ji| / min(A_i, A_j), if rows and columns are the same
};

// Of a suite: a group of questions that is graded by itself.
struct Level {
  std::string name;
  std::size_t questions = 0;
};

struct Report {
  std::string truth_file;
  std::string candidate_file;       // empty for values that come from no file
  std::string column;               // of the truth
  std::array<std::string, 2> keys;  // of the truth
  std::string identity;  // 16 hexadecimal digits that identify the rows judged and their truths, in any order
  Criteria criteria;
  std::size_t truth_rows = 0;
  std::size_t not_certified = 0;                // rows judged by their enclosures
  std::size_t by_points = 0, not_accurate = 0;  // entries of a matrix
  double widest = 0.0;                          // upper - lower of these
  Statistics overall;
  std::vector<std::string> sources;
  std::vector<Statistics> by_source;      // of each
  std::vector<Verdict> verdicts;          // the first one is about finiteness
  Measure worst_by = Measure::kAbsolute;  // the measure of the first limit that is exceeded
  std::vector<RowError> worst;            // worst first; values that are not finite come before all others
  std::vector<double> magnitudes;         // magnitudes of the errors, ascending
  std::optional<MatrixFacts> matrix;      // if matrices were compared
  std::vector<Improvement> improvements;  // over the baseline, if there is one
  std::vector<Level> levels;              // of a suite, in its order; `sources` are those with answers

  [[nodiscard]] bool passed() const;
};

// Compares values with the truth. Throws InputError if there are no values to judge, if a limit is invalid (NaN or
// negative), or if eps_b is given but rho B is not known.
[[nodiscard]] Report judge(const Truth& truth, const std::vector<Measured>& values, const Criteria& criteria,
                           const std::string& candidate_file = {});

// As above, with one value for each row of the truth, in its order.
[[nodiscard]] Report judge(const Truth& truth, std::span<const double> values, const Criteria& criteria);

// --- Files ---------------------------------------------------------------------------------------------------------

struct Options {
  std::string truth_column = {};  // of an image, its layer or channel
  CandidateColumns columns = {};
  MatchOptions match = {};
  Criteria criteria = {};
};

// Reads, matches and judges. If the truth is the folder of a suite, answers may be missing, limits are those of each
// level, and a candidate has the columns question and value. Two images, OpenEXR files or NumPy arrays, are compared
// pixel by pixel: pixels are receivers, channels are sources. Throws InputError; of images also Cancelled.
[[nodiscard]] Report compare(const std::filesystem::path& truth, const std::filesystem::path& candidate,
                             const Options& options = {});

// A program in a scoreboard.
struct Score {
  std::string program;            // the name of its file without the extension; all of it if two are equal
  std::optional<double> seconds;  // the run time of the program, if it is known
  Report report;
};
struct Scoreboard {
  std::vector<Score> scores;  // in the order of the candidates
};

// The programs' names of these files.
[[nodiscard]] std::vector<std::string> program_names(std::span<const std::filesystem::path> candidates);
// The same truth and the same limits for all of them; at least one.
[[nodiscard]] Scoreboard scoreboard(const std::filesystem::path& truth,
                                    std::span<const std::filesystem::path> candidates, const Options& options = {});
// Decimal digits that are right, -log10 of a relative error: 0 from 1 on, kMostDigits if there is no error.
inline constexpr double kMostDigits = 17.0;
[[nodiscard]] double digits_of(double relative_error);
// A table in Markdown: a line for each program.
[[nodiscard]] std::string markdown(const Scoreboard& board);
// Writes index.html, scoreboard.json and junit.xml (a suite for each program). The folder appears complete or not at
// all, and replaces an earlier scoreboard. Throws InputError if it cannot be written.
void write(const Scoreboard& board, const std::filesystem::path& folder);

// Lines of text: every limit that is exceeded, then the worst rows.
[[nodiscard]] std::string failure_message(const Report& report);

// --- Single values -------------------------------------------------------------------------------------------------

// The expected value: a form factor, a row of a truth file, or a plain number.
struct Expected {
  Expected(double number);                  // NOLINT(google-explicit-constructor): an assertion takes any of them
  Expected(const FormFactor& form_factor);  // NOLINT(google-explicit-constructor)
  Expected(const TruthRow& row);            // NOLINT(google-explicit-constructor)

  double value;
  double lower;
  double upper;
  std::optional<Status> status;
};

// Met if either part is met. A plain number is an absolute tolerance.
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
  double ulps = 0.0;  // distance from the truth to the value, counted in doubles
};
[[nodiscard]] Difference difference(double actual, const Expected& expected);
[[nodiscard]] bool is_near(double actual, const Expected& expected, const Tolerance& tolerance);
// The text of a failed assertion: both values, the bounds and status of the truth, the error and the tolerance.
[[nodiscard]] std::string describe_difference(double actual, const Expected& expected, const Tolerance& tolerance);

}  // namespace exactff::check
