// Reads truths and candidates: which columns of a file are needed, and what their values mean.
#include "check/tables.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>

#include "exactff/radiosity.h"
#include "kernel/float_environment.h"
#include "matrix/columns.h"
#include "table/csv.h"
#include "text/escape.h"
#include "text/names.h"
#include "text/refuse.h"

namespace exactff::check {
namespace {

using table::Table;
using table::Type;

constexpr std::array<std::string_view, 3> kChannels = {"radiosity_r", "radiosity_g", "radiosity_b"};
constexpr std::array<std::string_view, 3> kTotals = {"total_r", "total_g", "total_b"};
constexpr std::array<std::string_view, 3> kDerivatives = {"dF_dx", "dF_dy", "dF_dz"};
constexpr std::array<std::string_view, 3> kMainColumns = {"exact", "factor", "radiosity"};
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kNoColumn = static_cast<std::size_t>(-1);

bool is_among(const auto& list, std::string_view name) { return std::ranges::find(list, name) != list.end(); }

// A file row by row: any CSV file, or a table that exactff wrote in another format, as the CSV file that it could be.
class Input {
 public:
  Input(const std::filesystem::path& file, const std::string& purpose) {
    const bool is_csv = table::kind_of(file).empty() || std::ifstream(file).peek() == '#';
    if (is_csv) {
      csv_.emplace(file, purpose);
      return;
    }
    text_.str(table::csv_text(table::read(file)));
    csv_.emplace(text_, file.string(), purpose);
    lines_before_ = file.extension() == ".npz" ? 2 : 1;  // rows of an archive are counted from 1
  }

  [[nodiscard]] table::CsvReader& csv() { return *csv_; }
  [[nodiscard]] const table::CsvReader& csv() const { return *csv_; }
  [[nodiscard]] std::uint32_t line() const { return static_cast<std::uint32_t>(csv_->line() - lines_before_); }

  [[nodiscard]] std::size_t column(std::string_view name) const { return csv_->column(name).value_or(kNoColumn); }
  [[nodiscard]] std::array<std::size_t, 3> three(const std::array<std::string, 3>& names) const {
    return {column(names[0]), column(names[1]), column(names[2])};
  }
  // The columns of a key "b, c"; none if one is missing.
  [[nodiscard]] std::vector<std::size_t> columns_of(std::string_view key) const {
    std::vector<std::size_t> columns;
    while (!key.empty()) {
      const std::size_t end = std::min(key.find(kBetweenKeys), key.size());
      columns.push_back(column(key.substr(0, end)));
      if (columns.back() == kNoColumn) return {};
      key.remove_prefix(std::min(end + kBetweenKeys.size(), key.size()));
    }
    return columns;
  }

  // Of the present row; empty without a column.
  [[nodiscard]] const std::string& text(std::size_t column) const {
    static const std::string kNone;
    return column == kNoColumn ? kNone : csv_->field(column);
  }
  [[nodiscard]] std::string text(const std::vector<std::size_t>& columns) const {
    if (columns.size() == 1) return csv_->field(columns.front());
    std::string text;
    for (const std::size_t column : columns)
      text += std::string(text.empty() ? "" : kBetweenKeys) + csv_->field(column);
    return text;
  }
  // NaN without a column. An empty field is NaN, too, of a table that exactff wrote.
  [[nodiscard]] double number(std::size_t column, table::NotFinite not_finite = table::NotFinite::kRefuse) {
    if (column == kNoColumn || (csv_->head() && csv_->field(column).empty())) return kNaN;
    return csv_->number(column, csv_->head() ? table::NotFinite::kAccept : not_finite);
  }
  [[nodiscard]] Vec3 vector(const std::array<std::size_t, 3>& columns) {
    const double x = number(columns[0]), y = number(columns[1]), z = number(columns[2]);
    return {x, y, z};
  }

  static constexpr std::string_view kBetweenKeys = ", ";

 private:
  std::istringstream text_;
  std::optional<table::CsvReader> csv_;
  std::size_t lines_before_ = 0;
};

bool all_there(const std::array<std::size_t, 3>& columns) {
  return std::ranges::find(columns, kNoColumn) == columns.end();
}

}  // namespace

const std::vector<double>* numbers_of(const Table& table, std::string_view column) {
  const auto found = table.column(column);
  return found ? &table.numbers(*found) : nullptr;
}
const std::vector<std::string>* texts_of(const Table& table, std::string_view column) {
  const auto found = table.column(column);
  return found ? &table.texts(*found) : nullptr;
}
// --- Words ---

std::string word_of(const std::string& key) { return key == "from" ? "row" : key == "to" ? "column" : key; }

std::string of_source(const Truth& truth, const std::string& source) {
  return source.empty() ? "" : " of " + word_of(truth.keys[1]) + " '" + source + "'";
}

matrix::Order order_of(const Truth& truth) {
  NameList rows;
  for (const TruthRow& row : truth.rows) (void)rows.number_of(row.receiver);
  matrix::Order order{truth.keys, rows.take(), {}, {}};
  for (const std::string& source : truth.sources) {
    if (!is_among(truth.further, source)) order.columns.push_back(source);
  }
  for (const std::string& row : order.rows) {
    if (!truth.areas.empty()) order.areas.push_back(truth.areas.at(row));
  }
  return order;
}

// --- Truths ---

namespace {

// "total_lower_r" of "total_r".
std::string bound_of(const std::string& column, const std::string& bound) {
  if (is_among(kMainColumns, column)) return bound;
  const bool of_channel =
      column.size() > 2 && column[column.size() - 2] == '_' && column.find_last_of("rgb") + 1 == column.size();
  const std::size_t end = of_channel ? column.size() - 2 : column.size();
  return column.substr(0, end) + '_' + bound + column.substr(end);
}

class TruthReader {
 public:
  TruthReader(const std::filesystem::path& path, const std::string& column)
      : input_(path, "a truth file"), csv_(input_.csv()) {
    truth_.file = path.string();
    truth_.column = column.empty() ? default_column() : column;
    is_total_ = is_among(kTotals, truth_.column);
    is_radiosity_ = truth_.column == "radiosity" || is_among(kChannels, truth_.column);
    if (csv_.head()) find_keys();
    find_columns();
  }

  Truth read() {
    (void)faces_.number_of("");
    const bool has_columns = csv_.is_sound();
    while (has_columns && csv_.next()) take_row();
    if (csv_.is_sound() && truth_.rows.empty()) {
      csv_.complain("the file has no rows", "there is nothing to compare values with", "give a truth file with rows");
    }
    truth_.sources = sources_.take();
    truth_.faces = faces_.take();
    complain_about_repetitions();
    csv_.throw_if_any();
    return std::move(truth_);
  }

 private:
  // Of a table without the usual ones: its first number that is no input.
  [[nodiscard]] std::string default_column() const {
    for (const std::string_view name : kMainColumns) {
      if (csv_.head() && csv_.column(name)) return std::string(name);
    }
    for (const table::Column& column : csv_.head() ? csv_.head()->columns : std::vector<table::Column>()) {
      if (!column.key && column.type == Type::kNumber && column.strength != table::Strength::kGiven) return column.name;
    }
    return "exact";
  }

  void find_keys() {
    truth_.kind = csv_.head()->kind;
    truth_.further = csv_.head()->head.list("further");
    std::vector<std::string> keys;
    for (const table::Column& column : csv_.head()->columns) {
      if (column.key) keys.push_back(column.name);
    }
    if (keys.empty()) return;
    truth_.keys = {keys.front(), text::joined(std::vector(keys.begin() + 1, keys.end()), Input::kBetweenKeys)};
  }

  void find_columns() {
    const std::string advice = "give a table that exactff wrote";
    const std::string& column = truth_.column;
    receiver_ = csv_.head() ? csv_.needed_column({truth_.keys[0]}, "it identifies the rows", advice)
                            : csv_.needed_column({"receiver", "id"}, "it identifies the rows", advice);
    value_ = csv_.needed_column({column}, "it contains the true values", advice);
    if (!is_total_) source_ = input_.columns_of(truth_.keys[1]);
    on_ = input_.column("on");
    status_ = csv_.first_column({column + "_status", "status"}).value_or(kNoColumn);
    lower_ = input_.column(bound_of(column, "lower"));
    upper_ = input_.column(bound_of(column, "upper"));
    if (csv_.head()) claim_ = input_.column("claim");
    way_ = input_.column("way");
    accurate_ = input_.column("accurate");
    if (truth_.kind == "matrix") area_ = input_.column("area_from");
    point_ = input_.three({"x", "y", "z"});
    normal_ = input_.three({"nx", "ny", "nz"});
    truth_.has_points = all_there(point_);
    truth_.has_normals = all_there(normal_);
    find_radiosity();
  }

  // An error in a radiosity needs no conversion to a radiosity error; an error in a fraction has none.
  void find_radiosity() {
    if (truth_.column != "exact" && truth_.column != "unoccluded") return;
    rho_b_ = input_.column("largest_rho_b");
    exact_ = input_.column("exact");
    channels_ = input_.three({"radiosity_r", "radiosity_g", "radiosity_b"});
    has_channels_ = rho_b_ == kNoColumn && exact_ != kNoColumn && all_there(channels_);
  }

  void take_row() {
    TruthRow row;
    row.line = input_.line();
    row.receiver = input_.text(receiver_);
    if (row.receiver.empty()) {
      csv_.complain("the " + truth_.keys[0] + " has no id", "its row cannot be identified", "give it an id");
    }
    if (is_total_ && is_repeated(row.receiver)) return;
    row.source = sources_.number_of(input_.text(source_));
    row.on = faces_.number_of(input_.text(on_));
    if (truth_.has_points) row.point = input_.vector(point_);
    if (truth_.has_normals) row.normal = input_.vector(normal_);
    take_value(row);
    row.largest_rho_b = rho_b();
    if (area_ != kNoColumn) truth_.areas.try_emplace(row.receiver, input_.number(area_));
    truth_.rows.push_back(std::move(row));
  }

  // The rows of a receiver follow each other, one for each source, and a total is the same in all of them.
  [[nodiscard]] bool is_repeated(const std::string& receiver) const {
    return !truth_.rows.empty() && truth_.rows.back().receiver == receiver;
  }

  // A factor or a radiosity is judged by its bounds: its value is not rounded. So is any other value with bounds of its
  // own. Where nothing is known, as of a derivative at a kink, no value is wrong.
  void take_value(TruthRow& row) {
    constexpr double kLargest = std::numeric_limits<double>::max();
    const bool is_kink = is_among(kDerivatives, truth_.column) && input_.text(value_).empty();
    row.value = row.lower = row.upper = is_kink ? kNaN : input_.number(value_);
    if (status_ != kNoColumn) row.status = status_named(input_.text(status_));
    const bool is_known = !std::isnan(row.value), has_bounds = lower_ != kNoColumn && upper_ != kNoColumn;
    if (has_bounds || !is_known) {
      const double lower = has_bounds ? input_.number(lower_) : kNaN, upper = has_bounds ? input_.number(upper_) : kNaN;
      row.lower = std::isnan(lower) ? -kLargest : lower;
      row.upper = std::isnan(upper) ? kLargest : std::min(upper, kLargest);
      if (!is_known || (truth_.column != "exact" && row.lower < row.upper)) row.status = Status::kNotCertified;
    }
    if (claim_ != kNoColumn) take_claim(row);
    if (!is_known) row.value = std::clamp(0.0, row.lower, std::max(row.lower, row.upper));
    if (row.lower <= row.value && row.value <= row.upper) return;
    csv_.complain("the value is not within its bounds", "the file contradicts itself",
                  "use the file as `exactff` wrote it");
  }

  void take_claim(TruthRow& row) {
    const std::string word = input_.text(claim_);
    row.claim = matrix::named<Claim>(word);
    if (!row.claim && word != radiosity::kNoBound) {
      csv_.complain("unknown claim " + text::in_quotes(word), "it says how strong the bounds are",
                    "use the file as `exactff` wrote it");
    }
    row.status = row.claim == Claim::kZero ? Status::kZero : Status::kNotCertified;
    row.by_points = row.claim == Claim::kEstimated && way_ != kNoColumn && input_.text(way_) != to_string(Way::kCells);
    row.accurate = input_.text(accurate_) != "no";
  }

  // The statuses of form factors and of derivatives. Of those that are enclosed, or at a kink, no bit is certain.
  Status status_named(const std::string& word) {
    for (Status status : {Status::kCertified, Status::kZero, Status::kUnderflow, Status::kNotCertified}) {
      if (word == to_string(status)) return status;
    }
    if (word == "enclosed" || word == "kink") return Status::kNotCertified;
    csv_.complain("unknown status " + text::in_quotes(word), "it says whether the value is certified",
                  "write certified, zero, underflow or not certified");
    return Status::kCertified;
  }

  [[nodiscard]] std::optional<double> rho_b() {
    if (is_radiosity_) return 1.0;
    if (has_channels_) return quotient();
    const double rho_b = input_.number(rho_b_);
    return std::isnan(rho_b) ? std::nullopt : std::optional(rho_b);
  }

  // The largest radiosity divided by the form factor, if the division loses nothing but rounding errors.
  std::optional<double> quotient() {
    constexpr double kNormal = 1e-290;
    const double exact = input_.number(exact_);
    const Vec3 radiosity = input_.vector(channels_);
    const double largest = std::max({radiosity.x, radiosity.y, radiosity.z});
    if (!(exact >= kNormal) || !(largest == 0.0 || largest >= kNormal)) return std::nullopt;
    return largest / exact;
  }

  void complain_about_repetitions() {
    RowIndex rows(truth_.rows.size());
    for (std::uint32_t i = 0; i < truth_.rows.size(); ++i) {
      const TruthRow& row = truth_.rows[i];
      const auto [first, is_new] = rows.try_emplace({row.receiver, row.source}, i);
      if (is_new) continue;
      csv_.complain_at(row.line,
                       word_of(truth_.keys[0]) + ' ' + text::in_quotes(row.receiver) + " has a second " +
                           (truth_.kind == "matrix" ? "entry" : "row") + of_source(truth_, truth_.source_of(row)) +
                           " (the first is line " + std::to_string(truth_.rows[first->second].line) + ")",
                       "it is not clear which one a value belongs to", "keep one of them");
    }
  }

  Input input_;
  table::CsvReader& csv_;
  Truth truth_;
  NameList sources_, faces_;
  std::vector<std::size_t> source_;
  std::size_t receiver_ = 0, value_ = 0, on_ = kNoColumn, status_ = kNoColumn, lower_ = kNoColumn, upper_ = kNoColumn,
              claim_ = kNoColumn, way_ = kNoColumn, accurate_ = kNoColumn, area_ = kNoColumn, rho_b_ = kNoColumn,
              exact_ = kNoColumn;
  std::array<std::size_t, 3> point_{}, normal_{}, channels_{};
  bool is_total_ = false, is_radiosity_ = false, has_channels_ = false;
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
  if (path.filename() == "questions.csv" && std::filesystem::is_directory(path.parent_path() / "answers")) {
    text::refuse(path, "holds the questions of a suite", "its answers are what values are checked against",
                 "give its folder, " + text::printable(path.parent_path().string()));
  }
  Truth truth = TruthReader(path, column).read();
  fill_in_rho_b(truth);
  return truth;
}

// --- Suites ---

namespace {

// " (version 1.0)", by which a suite is cited; nothing if it does not say.
std::string version_of(const std::filesystem::path& suite) {
  std::ifstream citation(suite / "CITATION.cff");
  for (std::string line; std::getline(citation, line);) {
    if (line.starts_with("version: \"") && line.ends_with('"')) {
      return " (version " + line.substr(10, line.size() - 11) + ")";
    }
  }
  return {};
}

}  // namespace

bool is_suite(const std::filesystem::path& path) { return std::filesystem::is_regular_file(path / "questions.csv"); }

Truth read_suite(const std::filesystem::path& folder) {
  constexpr std::array kQuantities = {std::pair{"form factor", "exact"}, std::pair{"sphere", "sphere"},
                                      std::pair{"solid angle", "solid_angle"}, std::pair{"overcast sky", "overcast"},
                                      std::pair{"view factor", "factor"}};
  const kernel::StandardArithmetic arithmetic;
  table::CsvReader questions(folder / "questions.csv", "the questions of a suite");
  std::array<std::size_t, 6> columns{};
  for (std::size_t i = 0; i < columns.size(); ++i) {
    constexpr std::array kNames = {"question", "level", "scene", "quantity", "from", "to"};
    columns[i] = questions.needed_column({kNames.at(i)}, "it is a part of every question", "restore the file");
  }
  Truth suite;
  suite.file = folder.string() + version_of(folder);
  suite.kind = kSuite;
  suite.column = "value";
  suite.keys = {"question", "level"};
  std::map<std::pair<std::string, std::string>, Truth> tables;  // by file and column
  NameList levels;
  for (const bool has_columns = questions.is_sound(); has_columns && questions.next();) {
    const auto field = [&](std::size_t i) -> const std::string& { return questions.field(columns.at(i)); };
    const auto quantity =
        std::ranges::find(kQuantities, field(3), [](const auto& one) { return std::string(one.first); });
    if (quantity == kQuantities.end()) {
      questions.complain("unknown quantity " + text::in_quotes(field(3)), "it says which column holds the answer");
      continue;
    }
    const std::string& receiver = field(4).empty() ? field(0) : field(4);
    const std::string file = field(2) + (field(4).empty() ? ".points.csv" : ".pairs.csv");
    auto& table = tables[{file, quantity->second}];
    if (table.rows.empty()) table = read_truth(folder / "answers" / file, quantity->second);
    const auto row = std::ranges::find_if(
        table.rows, [&](const TruthRow& one) { return one.receiver == receiver && table.source_of(one) == field(5); });
    if (row == table.rows.end()) {
      questions.complain("its answer is not in answers/" + file, "a question without an answer cannot be judged");
      continue;
    }
    TruthRow& question = suite.rows.emplace_back(*row);
    question.receiver = field(0);
    question.line = static_cast<std::uint32_t>(questions.line());
    question.source = levels.number_of(field(1));
    question.on = 0;
  }
  questions.throw_if_any();
  suite.sources = levels.take();
  suite.faces = {""};
  return suite;
}

// --- Candidates ---

namespace {

class CandidateReader {
 public:
  CandidateReader(const std::filesystem::path& path, const Truth& truth, const CandidateColumns& columns, MatchBy by)
      : input_(path, "a CSV file of values"), csv_(input_.csv()), by_(by), receiver_word_(truth.keys[0]) {
    find_value(columns.value, truth.column);
    if (by == MatchBy::kReceiver) find_receiver(columns.receiver);
    if (columns.source.empty()) {
      source_ = input_.columns_of(truth.keys[1]);
    } else {
      source_ = {csv_.needed_column({columns.source}, "it names the source", kSpelling)};
    }
    if (by == MatchBy::kReceiver) return;
    for (std::size_t i = 0; i < 3; ++i) {
      point_[i] =
          csv_.needed_column({columns.position[i]}, "rows are matched by position", "name it with --position-columns");
    }
    normal_ = input_.three(columns.normal);
  }

  Table read() {
    std::vector<table::Column> columns = {{"value"}};
    std::vector<std::size_t> coordinates;
    if (by_ == MatchBy::kReceiver) columns.push_back({"receiver", Type::kText});
    if (!source_.empty()) columns.push_back({"source", Type::kText});
    for (std::size_t i = 0; by_ == MatchBy::kPosition && i < (all_there(normal_) ? 6 : 3); ++i) {
      columns.push_back({std::array{"x", "y", "z", "nx", "ny", "nz"}.at(i)});
      coordinates.push_back(i < 3 ? point_.at(i) : normal_.at(i - 3));
    }
    Table table(csv_.head() ? csv_.head()->kind : std::string(), {}, columns);
    std::string receiver, source;
    std::vector<table::Cell> row;
    for (const bool has_columns = csv_.is_sound(); has_columns && csv_.next(); row.clear()) {
      row.emplace_back(input_.number(value_, table::NotFinite::kAccept));
      if (by_ == MatchBy::kReceiver) row.emplace_back(take_receiver(receiver));
      if (!source_.empty()) row.emplace_back(std::string_view(source = input_.text(source_)));
      for (const std::size_t place : coordinates) row.emplace_back(input_.number(place));
      table.append(row, input_.line());
    }
    csv_.throw_if_any();
    return table;
  }

 private:
  // Of a table that exactff wrote, what the truth is judged by.
  void find_value(const std::string& given, const std::string& of_truth) {
    const std::string why = "it contains the values to check", advice = "name it with --value-column";
    const bool may_be_named_so = of_truth != "exact" && (csv_.head() || is_among(kMainColumns, of_truth));
    value_ = !given.empty()    ? csv_.needed_column({given}, why, kSpelling)
             : may_be_named_so ? csv_.needed_column({"value", "approximate", of_truth, "exact"}, why, advice)
                               : csv_.needed_column({"value", "approximate", "exact"}, why, advice);
  }

  void find_receiver(const std::string& given) {
    const std::string why = "it says which row of the truth a value belongs to",
                      advice = "name it with --receiver-column, or use --match position";
    receiver_ = !given.empty()                 ? csv_.needed_column({given}, why, kSpelling)
                : receiver_word_ == "receiver" ? csv_.needed_column({"receiver", "id"}, why, advice)
                                               : csv_.needed_column({receiver_word_}, why, advice);
  }

  std::string_view take_receiver(std::string& receiver) {
    receiver = input_.text(receiver_);
    if (receiver.empty()) {
      csv_.complain("the " + receiver_word_ + " has no id", "its row in the truth cannot be found", "give it an id");
    }
    return receiver;
  }

  static constexpr const char* kSpelling = "check the spelling";
  Input input_;
  table::CsvReader& csv_;
  MatchBy by_;
  std::string receiver_word_;
  std::size_t value_ = 0, receiver_ = 0;
  std::vector<std::size_t> source_;
  std::array<std::size_t, 3> point_{}, normal_{};
};

}  // namespace

Candidate read_candidate(const std::filesystem::path& path, const Truth& truth, const CandidateColumns& columns,
                         MatchBy by) {
  const kernel::StandardArithmetic arithmetic;
  const bool has_two_keys = !truth.keys[1].empty() && truth.keys[1].find(Input::kBetweenKeys) == std::string::npos;
  const bool like_matrix = !truth.kind.empty() && truth.kind != kSuite && truth.keys[0] != "receiver" && has_two_keys;
  if (by == MatchBy::kReceiver && like_matrix) {
    matrix::Order order = order_of(truth);
    if (!columns.receiver.empty()) order.keys[0] = columns.receiver;
    if (!columns.source.empty()) order.keys[1] = columns.source;
    if (std::optional<Table> matrix = matrix::read_other(path, order)) return {path.string(), std::move(*matrix)};
  }
  return {path.string(), CandidateReader(path, truth, columns, by).read()};
}

}  // namespace exactff::check
