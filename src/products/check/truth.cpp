// Reads truth files.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <unordered_map>

#include "check/grid_ids.h"
#include "check/name_list.h"
#include "check/row_keys.h"
#include "exactff/check.h"
#include "kernel/float_environment.h"
#include "table/csv.h"

namespace exactff::check {
namespace {

constexpr std::array<std::string_view, 3> kChannels = {"radiosity_r", "radiosity_g", "radiosity_b"};
constexpr std::array<std::string_view, 3> kTotals = {"total_r", "total_g", "total_b"};
constexpr std::array<std::string_view, 3> kGradient = {"dF_dx", "dF_dy", "dF_dz"};
constexpr std::size_t kNoColumn = static_cast<std::size_t>(-1);

class TruthReader {
 public:
  TruthReader(const std::filesystem::path& path, const std::string& column) : table_(path, "a truth file") {
    truth_.file = table_.file();
    truth_.column = column;
    find_columns();
  }

  Truth read() {
    (void)faces_.number_of("");
    const bool has_columns = table_.is_sound();
    while (has_columns && table_.next()) take_row();
    if (table_.is_sound() && truth_.rows.empty()) {
      table_.complain("the file has no rows", "there is nothing to compare values with", "give a truth file with rows");
    }
    truth_.sources = sources_.take();
    truth_.faces = faces_.take();
    complain_about_repetitions();
    table_.throw_if_any();
    return std::move(truth_);
  }

 private:
  void find_columns() {
    const std::string advice = "give a file written by `exactff truth`, or exact.csv of `exactff compare`";
    receiver_ = table_.needed_column({"receiver", "id"}, "it identifies the rows", advice);
    value_ = table_.needed_column({truth_.column}, "it contains the true values", advice);
    is_total_ = std::ranges::find(kTotals, truth_.column) != kTotals.end();
    source_ = is_total_ ? kNoColumn : table_.column("source").value_or(kNoColumn);
    on_ = table_.column("on").value_or(kNoColumn);
    status_ = table_.column("status").value_or(kNoColumn);
    rho_b_ = table_.column("largest_rho_b").value_or(kNoColumn);
    truth_.has_points = find_three({"x", "y", "z"}, point_);
    truth_.has_normals = find_three({"nx", "ny", "nz"}, normal_);
    find_bounds();
    find_radiosity();
  }

  bool find_three(const std::array<std::string_view, 3>& names, std::array<std::size_t, 3>& columns) {
    for (std::size_t i = 0; i < 3; ++i) columns[i] = table_.column(names[i]).value_or(kNoColumn);
    return std::find(columns.begin(), columns.end(), kNoColumn) == columns.end();
  }

  // The bounds are those of the form factor, and of no other column.
  void find_bounds() {
    if (truth_.column != "exact") return;
    lower_ = table_.column("lower").value_or(kNoColumn);
    upper_ = table_.column("upper").value_or(kNoColumn);
    if (lower_ == kNoColumn || upper_ == kNoColumn) lower_ = upper_ = kNoColumn;
  }

  // An error in a radiosity needs no conversion to a radiosity error; an error in a fraction has none.
  void find_radiosity() {
    const bool is_form_factor = truth_.column == "exact" || truth_.column == "unoccluded";
    is_radiosity_ = std::find(kChannels.begin(), kChannels.end(), truth_.column) != kChannels.end();
    if (!is_form_factor) rho_b_ = kNoColumn;
    if (rho_b_ == kNoColumn && is_form_factor) has_channels_ = find_three(kChannels, channels_);
    exact_ = table_.column("exact").value_or(kNoColumn);
    if (exact_ == kNoColumn) has_channels_ = false;
  }

  void take_row() {
    TruthRow row;
    row.line = static_cast<std::uint32_t>(table_.line());
    row.receiver = current_id(table_.field(receiver_));
    if (row.receiver.empty()) {
      table_.complain("the receiver has no id", "its row cannot be identified", "give it an id");
    }
    if (is_total_ && is_repeated(row.receiver)) return;
    row.source = sources_.number_of(source_ == kNoColumn ? std::string() : table_.field(source_));
    row.on = on_ == kNoColumn ? 0 : faces_.number_of(table_.field(on_));
    if (truth_.has_points) row.point = table_.vector(point_);
    if (truth_.has_normals) row.normal = table_.vector(normal_);
    take_value(row);
    row.largest_rho_b = rho_b();
    truth_.rows.push_back(std::move(row));
  }

  // The rows of a receiver follow each other, one for each source, and a total is the same in all of them.
  [[nodiscard]] bool is_repeated(const std::string& receiver) const {
    return !truth_.rows.empty() && truth_.rows.back().receiver == receiver;
  }

  // At a kink there is no derivative, so that no value is wrong.
  [[nodiscard]] bool is_kink() const {
    return std::ranges::find(kGradient, truth_.column) != kGradient.end() && table_.field(value_).empty();
  }

  void take_value(TruthRow& row) {
    if (is_kink()) {
      row.status = Status::kNotCertified;
      row.lower = -std::numeric_limits<double>::max();
      row.upper = std::numeric_limits<double>::max();
      return;
    }
    row.value = row.lower = row.upper = table_.number(value_);
    row.status = status_ == kNoColumn ? Status::kCertified : status_named(table_.field(status_));
    if (lower_ == kNoColumn) return;
    row.lower = table_.number(lower_);
    row.upper = table_.number(upper_);
    if (row.lower <= row.value && row.value <= row.upper) return;
    table_.complain("the value is not within its bounds", "the file contradicts itself",
                    "use the file as `exactff` wrote it");
  }

  Status status_named(const std::string& word) {
    for (Status status : {Status::kCertified, Status::kZero, Status::kUnderflow, Status::kNotCertified}) {
      if (word == to_string(status)) return status;
    }
    table_.complain("unknown status " + text::in_quotes(word), "it says whether the value is certified",
                    "write certified, zero, underflow or not certified");
    return Status::kCertified;
  }

  std::optional<double> rho_b() {
    if (is_radiosity_) return 1.0;
    if (rho_b_ != kNoColumn) return table_.number(rho_b_);
    return has_channels_ ? quotient() : std::nullopt;
  }

  // The largest radiosity divided by the form factor, if the division loses nothing but rounding errors.
  std::optional<double> quotient() {
    constexpr double kNormal = 1e-290;
    const double exact = table_.number(exact_);
    const Vec3 radiosity = table_.vector(channels_);
    const double largest = std::max({radiosity.x, radiosity.y, radiosity.z});
    if (!(exact >= kNormal) || !(largest == 0.0 || largest >= kNormal)) return std::nullopt;
    return largest / exact;
  }

  void complain_about_repetitions() {
    RowKeys<TruthRow> keys(truth_.rows);
    for (std::uint32_t i = 0; i < truth_.rows.size(); ++i) {
      const std::uint32_t first = keys.insert(i);
      if (first == i) continue;
      table_.complain_at(truth_.rows[i].line,
                         "receiver " + text::in_quotes(truth_.rows[i].receiver) + " has a second row" +
                             of_source(truth_.source_of(truth_.rows[i])) + " (the first is line " +
                             std::to_string(truth_.rows[first].line) + ")",
                         "it is not clear which one a value belongs to", "keep one of them");
    }
  }

  table::CsvReader table_;
  Truth truth_;
  NameList sources_, faces_;
  std::size_t receiver_ = 0, value_ = 0, source_ = 0, on_ = 0, status_ = 0, rho_b_ = 0, exact_ = 0;
  std::size_t lower_ = kNoColumn, upper_ = kNoColumn;
  std::array<std::size_t, 3> point_{}, normal_{}, channels_{};
  bool is_radiosity_ = false;
  bool is_total_ = false;
  bool has_channels_ = false;
};

// Where the truth is 0, rho B cannot be found by division. Then the largest rho B of the rows with the same face and
// source is used; if there is none, the largest with the same source.
class RhoB {
 public:
  explicit RhoB(const Truth& truth) : of_source_(truth.sources.size()) {
    for (const TruthRow& row : truth.rows) {
      if (!row.largest_rho_b) continue;
      raise(of_source_[row.source], *row.largest_rho_b);
      raise(of_face_[pair_of(row)], *row.largest_rho_b);
    }
  }
  [[nodiscard]] std::optional<double> of(const TruthRow& row) const {
    const auto found = of_face_.find(pair_of(row));
    return found == of_face_.end() ? of_source_[row.source] : found->second;
  }

 private:
  static void raise(std::optional<double>& largest, double value) { largest = std::max(largest.value_or(0.0), value); }
  static std::uint64_t pair_of(const TruthRow& row) { return (std::uint64_t{row.on} << 32U) | row.source; }

  std::vector<std::optional<double>> of_source_;
  std::unordered_map<std::uint64_t, std::optional<double>> of_face_;
};

void fill_in_rho_b(Truth& truth) {
  const auto is_known = [](const TruthRow& row) { return row.largest_rho_b.has_value(); };
  if (std::all_of(truth.rows.begin(), truth.rows.end(), is_known)) return;
  const RhoB known(truth);
  for (TruthRow& row : truth.rows) {
    if (!row.largest_rho_b) row.largest_rho_b = known.of(row);
  }
}

}  // namespace

Truth read_truth(const std::filesystem::path& path, const std::string& column) {
  const kernel::StandardArithmetic arithmetic;
  Truth truth = TruthReader(path, column).read();
  fill_in_rho_b(truth);
  return truth;
}

}  // namespace exactff::check
