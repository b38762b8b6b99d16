// Compares files: tables, matrices with what they must keep to, images.
#include <algorithm>
#include <boost/geometry/algorithms/comparable_distance.hpp>
#include <boost/geometry/algorithms/disjoint.hpp>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <boost/geometry/strategies/strategies.hpp>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "check/report.h"
#include "check/tables.h"
#include "exr/exr_file.h"
#include "files/file.h"
#include "kernel/float_environment.h"
#include "kernel/vec.h"
#include "matrix/columns.h"
#include "text/phrases.h"
#include "text/refuse.h"
#include "text/text_lines.h"

namespace exactff::check {

// --- Matrices ---

namespace {

class FactFinder {
 public:
  FactFinder(const Truth& truth, const std::vector<Measured>& values)
      : truth_(truth), order_(order_of(truth)), width_(truth.sources.size()) {
    const std::vector<std::string> sums = matrix::sums_among(truth.further);
    for (const std::string& one : truth.sources) is_sum_.push_back(std::ranges::find(sums, one) != sums.end());
    NameList rows;
    for (const std::string& name : order_.rows) (void)rows.number_of(name);
    entries_.resize(order_.rows.size() * width_);
    std::vector<std::size_t> place;  // of each row of the truth
    for (const TruthRow& row : truth.rows) {
      place.push_back(*rows.find(row.receiver) * width_ + row.source);
      entries_[place.back()] = {true, kNaN, row.lower, row.upper};
    }
    for (const Measured& one : values) entries_[place[one.row]].value = one.value;
  }

  MatrixFacts find() {
    for (std::size_t i = 0; i < order_.rows.size(); ++i) look_at_row(i);
    if (order_.rows == order_.columns && !order_.areas.empty()) look_at_reciprocity();
    return facts_;
  }

 private:
  static constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();  // where there is no value
  struct Entry {
    bool in_truth = false;
    double value = kNaN;
    double lower = 0.0, upper = 0.0;  // of the truth
  };

  static void raise(std::optional<MatrixFacts::Largest>& largest, MatrixFacts::Largest one) {
    if (!largest || one.by > largest->by) largest = std::move(one);
  }

  // Sums of groups are not parts of a row.
  void look_at_row(std::size_t i) {
    double sum = 0.0, lower = 0.0, upper = 0.0;
    for (std::size_t j = 0; j < width_; ++j) {
      const auto& [in_truth, value, least, most] = entries_[i * width_ + j];
      if (!in_truth || is_sum_[j]) continue;
      const auto entry = [&, f = value] { return MatrixFacts::Largest{f, order_.rows[i], truth_.sources[j]}; };
      if (value < 0.0 && (facts_.negative++ == 0 || value < facts_.least.by)) facts_.least = entry();
      if (value > 1.0 && (facts_.above_one++ == 0 || value > facts_.largest.by)) facts_.largest = entry();
      sum += value;
      lower += least;
      upper += most;
    }
    if (!std::isfinite(sum)) return;  // an entry is missing, or not finite
    raise(facts_.row_sum, {std::max({0.0, sum - upper, lower - sum}), order_.rows[i], {}});
  }

  void look_at_reciprocity() {
    const std::vector<std::string>& names = order_.rows;
    for (std::size_t i = 0; i < names.size(); ++i) {
      for (std::size_t j = i + 1; j < names.size(); ++j) {
        const double ratio = order_.areas[j] / order_.areas[i];  // A_j / A_i
        const double f_ij = entries_[i * width_ + j].value, f_ji = entries_[j * width_ + i].value;
        const double by = ratio >= 1.0 ? std::abs(f_ij - ratio * f_ji) : std::abs(f_ij / ratio - f_ji);
        if (std::isfinite(by)) raise(facts_.reciprocity, {by, names[i], names[j]});
      }
    }
  }

  const Truth& truth_;
  const matrix::Order order_;
  const std::size_t width_;
  std::vector<bool> is_sum_;  // of each source
  std::vector<Entry> entries_;
  MatrixFacts facts_;
};

// --- Files ---

// Without the rows of further sources that the candidate does not have, such as "(back)".
Truth without_absent(Truth truth, const Candidate& candidate) {
  const std::vector<std::string>* sources = texts_of(candidate.table, "source");
  const auto has = [](const std::vector<std::string>& list, const std::string& one) {
    return std::ranges::find(list, one) != list.end();
  };
  std::vector<bool> absent;  // of each source
  for (const std::string& one : truth.sources) {
    absent.push_back(has(truth.further, one) && (sources == nullptr || !has(*sources, one)));
  }
  std::erase_if(truth.rows, [&](const TruthRow& row) { return absent[row.source]; });
  return truth;
}

Report compare_tables(const Truth& all, const std::filesystem::path& file, const Options& options) {
  const Candidate candidate = read_candidate(file, all, options.columns, options.match.by);
  std::optional<Truth> kept;
  if (!all.further.empty()) kept = without_absent(all, candidate);
  const Truth& truth = kept ? *kept : all;
  const std::vector<Measured> values = match(truth, candidate, options.match);
  Report report = judge(truth, values, options.criteria, candidate.file);
  if (truth.kind == "matrix") report.matrix = FactFinder(truth, values).find();
  if (truth.kind == kSuite) {
    for (const std::string& level : truth.sources) {
      const auto asked = [&](const TruthRow& row) { return truth.source_of(row) == level; };
      report.levels.push_back({level, static_cast<std::size_t>(std::ranges::count_if(truth.rows, asked))});
    }
  }
  return report;
}

Report compare_images(const std::filesystem::path& truth, const std::filesystem::path& candidate,
                      const Options& options) {
  if (options.match != MatchOptions{.partial = options.match.partial} ||
      options.columns != CandidateColumns{.value = options.columns.value}) {
    text::refuse("a flag that matches rows is given with two images", "pixels are matched by their coordinates",
                 "remove --match, the tolerances and the columns of ids and coordinates");
  }
  const Images images =
      read_images(truth, candidate, {options.truth_column, options.columns.value}, options.match.partial);
  return judge(images.truth, images.values, options.criteria, images.candidate_file);
}

// Before anything is read: a file that is missing is not a file of another kind.
void require_file(const std::filesystem::path& file) {
  if (!files::is_there(file)) (void)text::open_text_file(file, "a file");
}

}  // namespace

std::vector<Report> compare_all(const std::filesystem::path& truth, std::span<const std::filesystem::path> candidates,
                                const Options& asked) {
  const bool suite = is_suite(truth);
  Options options = asked;
  if (suite) options.match.partial = options.criteria.per_source = true;
  if (!suite) require_file(truth);
  std::ranges::for_each(candidates, require_file);
  check_criteria(options.criteria);
  const std::string kind = suite ? std::string() : table::kind_of(truth);
  const bool image = !suite && kind.empty() && exr::is_image(truth);
  const bool takes_arrays = !kind.empty() && kind != "truth";  // as matrices of numbers
  std::optional<Truth> table;
  std::vector<Report> reports;
  std::vector<Problem> problems;
  for (const std::filesystem::path& candidate : candidates) {
    if (image != exr::is_image(candidate) && !takes_arrays) {
      text::refuse(image ? candidate : truth, "is no image, and the file to compare it with is one",
                   "images are OpenEXR files and NumPy arrays of shape (height, width, 3)",
                   "give two images, or two tables");
    }
    if (!image && !table) table = suite ? read_suite(truth) : read_truth(truth, options.truth_column);
    try {
      reports.push_back(image ? compare_images(truth, candidate, options) : compare_tables(*table, candidate, options));
    } catch (const InputError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  }
  if (!problems.empty()) throw InputError(std::move(problems));
  return reports;
}

Report compare(const std::filesystem::path& truth, const std::filesystem::path& candidate, const Options& options) {
  const kernel::StandardArithmetic arithmetic;
  return std::move(compare_all(truth, std::span(&candidate, 1), options).front());
}

// --- Match ---

// Which row of the truth a value is compared with.
//
//   1. Look up the candidate's sources among those of the truth. Without a source column the truth must have only one,
//      or be a suite, whose questions are found without their levels.
//   2. Match every row of the candidate by receiver and source, or by position and source.
//   3. No row of the truth may be matched twice. Unless the options allow it, none may be left unmatched.

namespace {

constexpr std::uint32_t kNothing = std::numeric_limits<std::uint32_t>::max();

namespace bg = boost::geometry;
using Point = bg::model::point<double, 3, bg::cs::cartesian>;
using Box = bg::model::box<Point>;
using Entry = std::pair<Point, std::uint32_t>;

// Finds rows of the truth by their position: an R-tree, built in one step. A query takes the box around the point and
// keeps what is within the ball. Unlike a grid of cells, it works with a tolerance of 0 and with coordinates of any
// size.
class PositionIndex {
 public:
  // With `normals`, the unit normals must be near as well.
  PositionIndex(const Truth& truth, const MatchOptions& options, bool normals)
      : truth_(truth), options_(options), normals_(normals) {
    std::vector<Entry> entries;
    entries.reserve(truth.rows.size());
    for (std::uint32_t i = 0; i < truth.rows.size(); ++i) {
      const Vec3& p = truth.rows[i].point;
      entries.emplace_back(Point(p.x, p.y, p.z), i);
    }
    tree_ = {entries.begin(), entries.end()};
  }

  // All rows of the source that are near enough to the point, the nearest first; equally near rows in the order of the
  // truth.
  [[nodiscard]] std::vector<std::uint32_t> near(const Vec3& point, const Vec3& normal, std::uint32_t source) const {
    const double t = options_.tolerance;
    const Box box({point.x - t, point.y - t, point.z - t}, {point.x + t, point.y + t, point.z + t});
    std::vector<std::pair<double, std::uint32_t>> found;
    for (auto entry = tree_.qbegin(bg::index::intersects(box)); entry != tree_.qend(); ++entry) {
      const TruthRow& row = truth_.rows[entry->second];
      const double away = kernel::distance(row.point, point);
      if (row.source != source || away > t) continue;
      if (normals_ && kernel::distance(kernel::unit(row.normal), kernel::unit(normal)) > options_.normal_tolerance)
        continue;
      found.emplace_back(away, entry->second);
    }
    std::sort(found.begin(), found.end());
    std::vector<std::uint32_t> rows;
    for (const auto& [away, row] : found) rows.push_back(row);
    return rows;
  }

  // The distance to the nearest row of the source, whatever its normal.
  [[nodiscard]] double distance_to_nearest(const Vec3& point, std::uint32_t source) const {
    const auto is_of_source = [&](const Entry& entry) { return truth_.rows[entry.second].source == source; };
    const auto found =
        tree_.qbegin(bg::index::nearest(Point(point.x, point.y, point.z), 1) && bg::index::satisfies(is_of_source));
    if (found == tree_.qend()) return std::numeric_limits<double>::infinity();
    return kernel::distance(truth_.rows[found->second].point, point);
  }

 private:
  const Truth& truth_;
  const MatchOptions& options_;
  const bool normals_;
  bg::index::rtree<Entry, bg::index::linear<16>> tree_;
};

class Matcher {
 public:
  Matcher(const Truth& truth, const Candidate& candidate, const MatchOptions& options)
      : truth_(truth),
        file_(candidate.file),
        table_(candidate.table),
        options_(options),
        values_(numbers_of(table_, "value")),
        receivers_(texts_of(table_, "receiver")),
        sources_(texts_of(table_, "source")),
        point_{numbers_of(table_, "x"), numbers_of(table_, "y"), numbers_of(table_, "z")},
        normal_{numbers_of(table_, "nx"), numbers_of(table_, "ny"), numbers_of(table_, "nz")},
        found_(truth.rows.size(), kNothing) {}

  std::vector<Measured> match() {
    check_request();
    look_up_sources();
    options_.by == MatchBy::kReceiver ? match_receivers() : match_positions();
    complain_about_missing();
    problems_.throw_if_any();
    return measured();
  }

 private:
  using Vector = std::array<const std::vector<double>*, 3>;  // null where the candidate has none
  [[nodiscard]] static Vec3 at(const Vector& columns, std::size_t row) {
    return {(*columns[0])[row], (*columns[1])[row], (*columns[2])[row]};
  }

  void complain(std::size_t line, std::string what, std::string why, std::string suggestion) {
    problems_.add({file_, line, std::move(what), std::move(why), std::move(suggestion)});
  }

  void check_request() {
    const auto is_tolerance = [](double t) { return std::isfinite(t) && t >= 0.0; };
    if (!is_tolerance(options_.tolerance) || !is_tolerance(options_.normal_tolerance)) {
      text::refuse("the tolerance for matching is negative or not finite", "a tolerance is a distance",
                   "give 0 or more");
    }
    if (options_.by == MatchBy::kPosition && !truth_.has_points) {
      text::refuse(truth_.file, "has no columns x, y and z", "matching by position needs them",
                   "match by receiver instead");
    }
    if (table_.rows() == 0) {
      text::refuse(file_, "has no rows", "there is nothing to check", "write one row per value");
    }
  }

  void look_up_sources() {
    source_.assign(table_.rows(), 0);
    const bool has_none = truth_.sources.size() == 1 && truth_.sources.front().empty();
    if (has_none) return;
    if (sources_ == nullptr && truth_.kind == kSuite) return find_levels();
    if (sources_ == nullptr) return require_single_source();
    NameList known;
    for (const std::string& source : truth_.sources) (void)known.number_of(source);
    for (std::size_t i = 0; i < source_.size(); ++i) source_[i] = known.find((*sources_)[i]).value_or(kNothing);
  }

  void find_levels() {
    std::unordered_map<std::string_view, std::uint32_t> levels;
    for (const TruthRow& row : truth_.rows) levels.try_emplace(row.receiver, row.source);
    for (std::size_t i = 0; i < source_.size(); ++i) {
      const auto found = levels.find((*receivers_)[i]);
      if (found != levels.end()) source_[i] = found->second;
    }
  }

  void require_single_source() const {
    if (truth_.sources.size() == 1) return;
    text::refuse(file_, "has no column that names the " + truth_.keys[1],
                 "the truth has " + std::to_string(truth_.sources.size()) + ": " + source_names(),
                 "add a column named " + truth_.keys[1] + ", or name the column with --source-column");
  }

  [[nodiscard]] std::string receiver_word() const { return word_of(truth_.keys[0]); }
  [[nodiscard]] std::string source_word() const { return word_of(truth_.keys[1]); }
  // " of source 'light'", as the candidate names it.
  [[nodiscard]] std::string of_source(std::uint32_t row) const {
    return sources_ == nullptr ? std::string() : check::of_source(truth_, (*sources_)[row]);
  }

  [[nodiscard]] std::string source_names() const {
    constexpr std::size_t kShown = 10;
    std::vector<std::string> names(
        truth_.sources.begin(),
        truth_.sources.begin() + static_cast<std::ptrdiff_t>(std::min(truth_.sources.size(), kShown)));
    if (truth_.sources.size() > kShown) names.emplace_back("others");
    return text::enumerate(names);
  }

  // Returns false, and complains, if the truth does not have the source of the row.
  bool has_known_source(std::uint32_t row) {
    if (source_[row] != kNothing) return true;
    complain(table_.line_of(row), "the truth has no " + source_word() + ' ' + text::in_quotes((*sources_)[row]),
             "its " + source_word() + "s are " + source_names(), "check the name, or remove the row");
    return false;
  }

  void match_receivers() {
    RowIndex rows(truth_.rows.size());
    for (std::uint32_t i = 0; i < truth_.rows.size(); ++i)
      rows.try_emplace({truth_.rows[i].receiver, truth_.rows[i].source}, i);
    for (std::uint32_t i = 0; i < table_.rows(); ++i) {
      if (!has_known_source(i)) continue;
      const auto found = rows.find({(*receivers_)[i], source_[i]});
      if (found == rows.end()) {
        complain(table_.line_of(i),
                 "the truth has no " + receiver_word() + ' ' + text::in_quotes((*receivers_)[i]) + of_source(i),
                 "its value cannot be checked", unknown_advice());
      } else {
        take(found->second, i);
      }
    }
  }

  [[nodiscard]] std::string unknown_advice() const {
    const std::string first = text::in_quotes(truth_.rows.front().receiver);
    const std::string word = receiver_word();
    if (word != "receiver") {
      return "its " + word + (word.ends_with("ch") ? "es" : "s") + " have names such as " + first +
             "; correct the name";
    }
    return "its receivers have ids such as " + first + "; correct the id, or use --match position";
  }

  void match_positions() {
    const PositionIndex index(truth_, options_, truth_.has_normals && normal_[0] != nullptr);
    std::vector<std::uint32_t> unmatched;
    for (std::uint32_t i = 0; i < table_.rows(); ++i) {
      if (!has_known_source(i)) continue;
      const Vec3 normal = normal_[0] != nullptr ? at(normal_, i) : Vec3{};
      const std::vector<std::uint32_t> found = index.near(at(point_, i), normal, source_[i]);
      if (found.size() == 1) {
        take(found.front(), i);
      } else if (found.empty()) {
        unmatched.push_back(i);
      } else {
        complain_about_choice(i, found);
      }
    }
    complain_about_distances(index, unmatched);
    for (const std::uint32_t i : unmatched) {
      complain(table_.line_of(i),
               "the truth has no receiver within " + text::shortest(options_.tolerance) + " of " +
                   place_of(at(point_, i)) + of_source(i),
               "its value cannot be checked", "use a larger --tolerance if the coordinates were rounded");
    }
  }

  [[nodiscard]] static std::string place_of(const Vec3& p) {
    return '(' + text::shortest(p.x) + ", " + text::shortest(p.y) + ", " + text::shortest(p.z) + ')';
  }

  // Told once for all rows without a match: it shows whether a tolerance would do, or the units are others.
  void complain_about_distances(const PositionIndex& index, std::span<const std::uint32_t> unmatched) {
    double nearest = std::numeric_limits<double>::infinity(), furthest = 0.0;
    for (const std::uint32_t i : unmatched) {
      const double distance = index.distance_to_nearest(at(point_, i), source_[i]);
      nearest = std::min(nearest, distance);
      furthest = std::max(furthest, distance);
    }
    if (unmatched.empty()) return;
    const bool near = nearest <= options_.tolerance;
    const std::string least = text::short_number(nearest), most = text::short_number(furthest);
    complain(0,
             text::counted(unmatched.size(), "row") + (unmatched.size() == 1 ? " has" : " have") +
                 " no match; the distance to the nearest receiver of the truth is " + least +
                 (least == most ? "" : " to " + most),
             near ? "the normals of such receivers differ by more than --normal-tolerance"
                  : "points match up to --tolerance",
             near ? "check the normals, or use a larger --normal-tolerance"
                  : "check the unit of length and the columns, or use a larger --tolerance");
  }

  void complain_about_choice(std::uint32_t row, const std::vector<std::uint32_t>& found) {
    const auto told = [&](std::size_t i) {
      const TruthRow& other = truth_.rows[found[i]];
      return text::in_quotes(other.receiver) + " at a distance of " +
             text::short_number(kernel::distance(other.point, at(point_, row)));
    };
    complain(table_.line_of(row),
             std::to_string(found.size()) + " receivers of the truth match: " + told(0) + " and " + told(1) +
                 (found.size() > 2 ? ", and more" : ""),
             "it is not clear which one the value belongs to",
             "use a smaller --tolerance, add normals, or match by receiver");
  }

  void take(std::size_t truth_row, std::uint32_t row) {
    std::uint32_t& found = found_[truth_row];
    if (found == kNothing) {
      found = row;
      return;
    }
    const TruthRow& known = truth_.rows[truth_row];
    // Our own tables repeat a total for each source.
    if (truth_.column.starts_with("total_") && !table_.kind().empty() && (*values_)[row] == (*values_)[found]) return;
    complain(table_.line_of(row),
             receiver_word() + ' ' + text::in_quotes(known.receiver) +
                 check::of_source(truth_, truth_.source_of(known)) + " already has a value (line " +
                 std::to_string(table_.line_of(found)) + ")",
             "only one value can be checked", "keep one of them");
  }

  // Called last: rows that were matched under a wrong name are missing, too.
  void complain_about_missing() {
    const auto missing = static_cast<std::size_t>(std::count(found_.begin(), found_.end(), kNothing));
    if (missing == 0 || (options_.partial && missing < found_.size())) return;
    constexpr std::size_t kShown = 5;
    std::vector<std::string> names;
    for (std::size_t i = 0; i < found_.size() && names.size() < kShown; ++i) {
      if (found_[i] != kNothing) continue;
      const TruthRow& row = truth_.rows[i];
      const bool by_position = options_.by == MatchBy::kPosition;
      names.push_back(text::in_quotes(row.receiver) + (by_position ? " at " + place_of(row.point) : "") +
                      check::of_source(truth_, truth_.source_of(row)));
    }
    if (missing > kShown) names.push_back(std::to_string(missing - kShown) + " more");
    complain(0,
             "no value for " + text::counted_of(missing, found_.size(), truth_.kind == "matrix" ? "value" : "row") +
                 " of the truth: " + receiver_word() + ' ' + text::enumerate(names),
             "missing values cannot be checked",
             missing < found_.size() ? "add them, or use --partial to check the others" : "check how rows are matched");
  }

  [[nodiscard]] std::vector<Measured> measured() const {
    std::vector<Measured> values;
    for (std::uint32_t i = 0; i < found_.size(); ++i) {
      if (found_[i] == kNothing) continue;
      values.push_back({i, static_cast<std::uint32_t>(table_.line_of(found_[i])), (*values_)[found_[i]]});
    }
    return values;
  }

  const Truth& truth_;
  const std::string& file_;
  const table::Table& table_;
  const MatchOptions& options_;
  const std::vector<double>* values_;
  const std::vector<std::string>*receivers_, *sources_;  // null where the candidate has none
  const Vector point_, normal_;
  std::vector<std::uint32_t> source_;  // source of the truth, of each row of the candidate
  std::vector<std::uint32_t> found_;   // row of the candidate, indexed by row of the truth
  text::ProblemList problems_;
};

}  // namespace

std::vector<Measured> match(const Truth& truth, const Candidate& candidate, const MatchOptions& options) {
  const kernel::StandardArithmetic arithmetic;
  return Matcher(truth, candidate, options).match();
}

}  // namespace exactff::check
