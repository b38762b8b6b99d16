// Accuracy checks: compares the values of any other program, method or function with certified true values (a truth
// file, truth.h).
//
//   const check::Truth truth = check::read_truth("truth.csv");
//   const check::Candidate mine = check::read_candidate("mine.csv");
//   const check::Report report = check::judge(truth, check::match(truth, mine), {.max_abs = 1e-6});
//   report.passed(); report.worst; report.verdicts;
//
// The error of a value c is c - F*, where F* is the truth: the true form factor, correctly rounded. If a row of the
// truth is not certified, F* is the point of its enclosure nearest to c, so that no candidate is blamed for what is not
// known. The relative error is relative to F*; for F* = 0 it is 0 if c = 0 and infinite otherwise. The error in
// radiosity is the error times the largest rho_r B_s over the colour channels. This is the quantity that eps_B bounds,
// row by row.
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
#include "exactff/exr.h"
#include "exactff/geometry.h"
#include "exactff/view_factors.h"

namespace exactff::check {

// --- Truth ---------------------------------------------------------------------------------------------------------

struct TruthRow {
  std::string receiver;
  std::uint32_t source = 0;  // index into Truth::sources
  std::uint32_t on = 0;      // index into Truth::faces
  std::uint32_t line = 0;    // of the file
  Status status = Status::kCertified;
  Vec3 point;   // if Truth::has_points
  Vec3 normal;  // of any length; if Truth::has_normals
  double value = 0.0;
  double lower = 0.0;
  double upper = 0.0;
  std::optional<double> largest_rho_b;  // over the colour channels; empty if the file does not give it
  std::optional<Claim> claim;           // of an entry of a matrix
  Way way = Way::kCells;                // the same
  bool accurate = true;                 // of an entry: within the accuracy that was asked for
};

struct Truth {
  std::string file;
  std::string column;                // the column that `value` was read from
  std::vector<std::string> sources;  // in order of first appearance; one empty name if the file has no such column
  std::vector<std::string> faces;    // faces that receivers lie on; the first name is empty and stands for none
  bool has_points = false;
  bool has_normals = false;
  bool is_image = false;   // receivers are pixels, sources are channels
  bool is_matrix = false;  // receivers are rows, sources are columns
  std::vector<TruthRow> rows;

  [[nodiscard]] const std::string& source_of(const TruthRow& row) const { return sources[row.source]; }
  [[nodiscard]] const std::string& face_of(const TruthRow& row) const { return faces[row.on]; }
};

// Reads a file of `exactff truth`, the exact.csv of `exactff compare`, or any CSV with the columns receiver (or id) and
// exact. Optional columns: source, on, x,y,z, nx,ny,nz, lower, upper, status, largest_rho_b and radiosity_r, _g, _b.
// `column` names the column with the true values if it is not `exact`, such as unoccluded or radiosity_g. Where a
// derivative (dF_dx, dF_dy, dF_dz) is empty, at a kink, the row is not certified and its bounds are the largest
// doubles, so that no value has an error. A total (total_r, _g, _b) is one value for all sources: only the first row of
// each receiver counts. Throws one InputError with file:line for every problem, including rows that occur twice.
[[nodiscard]] Truth read_truth(const std::filesystem::path& path, const std::string& column = "exact");

// --- Candidate -----------------------------------------------------------------------------------------------------

enum class MatchBy {
  kReceiver,  // by the id of the receiver
  kPosition,  // by its coordinates
};

// Column names. An empty name stands for the default.
struct CandidateColumns {
  std::string value = {};     // default: the first of value, approximate and exact that exists
  std::string receiver = {};  // default: receiver or id
  std::string source = {};    // default: source, which may be absent if the truth has only one source
  std::array<std::string, 3> position = {"x", "y", "z"};
  std::array<std::string, 3> normal = {"nx", "ny", "nz"};
};

struct CandidateRow {
  std::string receiver;
  std::uint32_t source = 0;  // index into Candidate::sources
  std::uint32_t line = 0;
  Vec3 point;
  Vec3 normal;
  double value = 0.0;  // may be infinite or NaN: that is a failure of the candidate, not of the file
};

struct Candidate {
  std::string file;
  bool has_sources = false;
  bool has_normals = false;
  std::vector<std::string> sources;
  std::vector<CandidateRow> rows;
};

// Reads the columns that matching `by` needs. Throws one InputError with file:line for every problem.
[[nodiscard]] Candidate read_candidate(const std::filesystem::path& path, const CandidateColumns& columns = {},
                                       MatchBy by = MatchBy::kReceiver);

// --- Matching ------------------------------------------------------------------------------------------------------

struct MatchOptions {
  MatchBy by = MatchBy::kReceiver;
  // For matching by position: the largest distance between two points that count as equal, in the scene's unit of
  // length. `normal_tolerance`: if both sides have normals, the largest distance between their unit vectors.
  double tolerance = 0.0;
  double normal_tolerance = 1e-3;
  bool partial = false;  // rows of the truth may be missing
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
  std::uint32_t truth_line = 0;
  std::uint32_t line = 0;
  Status status = Status::kCertified;
  double truth = 0.0;
  double value = 0.0;
  double error = 0.0;
  double relative = 0.0;
  std::optional<double> radiosity;
  double lower = 0.0, upper = 0.0;  // of the truth
  std::optional<Claim> claim;       // of an entry of a matrix
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

struct Report {
  std::string truth_file;
  std::string candidate_file;  // empty for values that come from no file
  std::string column;          // of the truth
  std::string identity;        // 16 hexadecimal digits that identify the rows judged and their truths, in any order
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

  [[nodiscard]] bool passed() const;
};

// Compares values with the truth. Throws InputError if there are no values to judge, if a limit is invalid (NaN or
// negative), or if eps_b is given but rho B is not known.
[[nodiscard]] Report judge(const Truth& truth, const std::vector<Measured>& values, const Criteria& criteria,
                           const std::string& candidate_file = {});

// As above, with one value for each row of the truth, in its order.
[[nodiscard]] Report judge(const Truth& truth, std::span<const double> values, const Criteria& criteria);

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
