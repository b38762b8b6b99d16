#include "matrix/columns.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "kernel/float_environment.h"
#include "text/hashes.h"
#include "text/text_lines.h"

namespace exactff::matrix {
namespace {

using table::Cell;
using table::Strength;
using table::Type;
using Field = table::Field<Entry>;

template <auto Member>
Field number(std::string name, Strength strength, std::string unit = {}) {
  return table::member_field<Member, Entry>({.name = std::move(name), .unit = std::move(unit), .strength = strength});
}

template <auto Member>
Field word(std::string name) {
  using Word = std::remove_cvref_t<decltype(std::declval<ViewFactor&>().*Member)>;
  return {{.name = std::move(name), .type = Type::kText, .strength = Strength::kProved},
          [](const Entry& entry) -> Cell { return to_string(entry.*Member); },
          [](Entry& entry, const Cell& cell) {
            const std::optional<Word> known = named<Word>(std::get<std::string_view>(cell));
            if (known) entry.*Member = *known;
            return known.has_value();
          }};
}

Field area_to() {
  return {{"area_to", Type::kNumber, "area", Strength::kEstimated},
          [](const Entry& entry) -> Cell { return entry.has_area_to ? Cell(entry.area_to) : Cell(); },
          [](Entry& entry, const Cell& cell) {
            const double* const area = std::get_if<double>(&cell);
            entry.has_area_to = area != nullptr;
            entry.area_to = area != nullptr ? *area : 0.0;
            return true;
          }};
}

void add(text::Fnv1a& hash, std::span<const Selection> patches) {
  hash.add(std::uint64_t{patches.size()});
  for (const Selection& patch : patches) {
    hash.add(std::uint64_t{index_of(patch.patch)});
    hash.add(patch.face ? std::uint64_t{index_of(*patch.face)} : ~std::uint64_t{0});
  }
}

}  // namespace

const table::Fields<Entry>& columns() {
  static const table::Fields<Entry> all(
      "matrix", {table::member_field<&Entry::from, Entry>({.name = "from", .key = true}),
                 table::member_field<&Entry::to, Entry>({.name = "to", .key = true}),
                 number<&Entry::value>("factor", Strength::kStated), number<&Entry::lower>("lower", Strength::kStated),
                 number<&Entry::upper>("upper", Strength::kStated), word<&Entry::claim>("claim"),
                 word<&Entry::way>("way"), number<&Entry::accurate>("accurate", Strength::kProved),
                 number<&Entry::area_from>("area_from", Strength::kEstimated, "area"), area_to(),
                 number<&Entry::cells>("cells", Strength::kProved),
                 number<&Entry::event_cells>("event_cells", Strength::kProved), word<&Entry::limit>("limit")});
  return all;
}

void set_scene(table::Head& head, const Scene& scene) {
  head.set("scene_hash", scene.hash());
  if (scene.unit() != Unit::kNone) head.set("unit", std::string(name_of(scene.unit())));
}

void set_options(table::Head& head, const ViewFactorOptions& options) {
  head.set("accuracy", options.accuracy);
  head.set("budget", std::uint64_t{options.budget});
  if (options.certify) head.set("certify", true);
  if (options.both_directions) head.set("both_directions", true);
  if (!options.sample_crowds) head.set("no_points", true);
}

ViewFactorOptions options_of(const table::Head& head) {
  ViewFactorOptions options;
  options.accuracy = head.number("accuracy").value_or(options.accuracy);
  options.budget = head.count("budget").value_or(options.budget);
  options.certify = head.flag("certify");
  options.both_directions = head.flag("both_directions");
  options.sample_crowds = !head.flag("no_points");
  return options;
}

table::Head head_of(const Scene& scene, std::span<const Selection> from, std::span<const Selection> to,
                    const ViewFactorOptions& options, Surroundings surroundings) {
  text::Fnv1a patches;
  add(patches, from);
  add(patches, to);
  table::Head head;
  set_scene(head, scene);
  set_options(head, options);
  head.set("from_patches", std::uint64_t{from.size()});
  head.set("to_patches", std::uint64_t{to.size()});
  head.set("patches_hash", patches.digits());
  std::vector<std::string> further;
  if (surroundings.back) further.emplace_back(kBack);
  if (surroundings.open) further.emplace_back(kOpen);
  if (surroundings.buried) further.emplace_back(kBuried);
  further.insert(further.end(), surroundings.sums.begin(), surroundings.sums.end());
  if (!further.empty()) head.set("further", std::move(further));
  return head;
}

// --- Tables ---

namespace {

constexpr std::string_view kSum = "(sum ";

const table::Fields<Entry>& columns_with_balanced() {
  static const table::Fields<Entry> all("matrix", [] {
    std::vector<Field> fields = columns().all();
    const auto after_upper = std::ranges::find(fields, "claim", [](const Field& field) { return field.column.name; });
    fields.insert(after_upper, number<&Entry::balanced>("balanced", Strength::kEstimated));
    return fields;
  }());
  return all;
}

constexpr const char* kAdvice = "use the file as `exactff matrix` wrote it";

class NamedReader {
 public:
  NamedReader(const table::Table& table, const std::filesystem::path& file)
      : table_(table), sums_(sums_among(table.head().list("further"))) {
    named_.file = file.string();
    named_.head = table.head();
    const bool has_columns = std::ranges::all_of(
        columns().columns(), [&](const table::Column& column) { return table.column(column.name).has_value(); });
    if (table.kind() != columns().kind() || !has_columns || table.rows() == 0) {
      complain(0, "is no matrix of view factors, or has no entries", "give a file written by `exactff matrix -o`");
      problems_.throw_if_any();
    }
    from_ = table.texts(table.column("from").value());
    to_ = table.texts(table.column("to").value());
    for (std::size_t i = 0; i < table.rows(); ++i) take(i);
    problems_.throw_if_any();
  }

  NamedMatrix read() {
    find_columns();
    for (std::size_t first = 0; first < factors_.size() && problems_.empty(); first += width_) take_row(first);
    problems_.throw_if_any();
    return std::move(named_);
  }

 private:
  void complain(std::size_t line, std::string what, const char* advice = kAdvice) {
    problems_.add({named_.file, line, std::move(what), "the file contradicts itself", advice});
  }

  void take(std::size_t row) {
    const auto bad = columns().read(table_, row, entry_);
    const ViewFactor& f = factors_.emplace_back(entry_);
    if (bad) {
      complain(table_.line_of(row), "column " + text::in_quotes(*bad) + " has an impossible value");
    } else if (!(0.0 <= f.lower && f.lower <= f.value && f.value <= f.upper && f.upper <= most_to(to_[row])) ||
               !(f.area_from > 0.0)) {
      complain(table_.line_of(row),
               "the entry is not within its bounds, these are not within 0 and 1, or the area is not positive");
    }
  }

  // Factors to patches that hide nothing, or have fronts in common, may add up to more than 1.
  [[nodiscard]] double most_to(const std::string& to) const {
    return std::ranges::find(sums_, to) != sums_.end() ? std::numeric_limits<double>::max() : 1.0;
  }

  // Those of the first row: up to the first entry of another.
  void find_columns() {
    width_ = 1;
    while (width_ < factors_.size() && from_[width_] == from_.front() && to_[width_] != to_.front()) ++width_;
    known_ = patches_ = width_ - std::min(sums_.size(), width_ - 1);
    const auto take_off = [&](std::string_view name) {
      const bool there = patches_ > 0 && to_[patches_ - 1] == name;
      patches_ -= there ? 1 : 0;
      return there;
    };
    has_buried_ = take_off(kBuried);
    (void)take_off(kOpen);
    has_back_ = take_off(kBack);
    named_.to.assign(to_.begin(), to_.begin() + static_cast<std::ptrdiff_t>(patches_));
  }

  void take_row(std::size_t first) {
    named_.from.push_back(from_[first]);
    for (std::size_t i = first; i < first + width_; ++i) {
      if (i == factors_.size() || from_[i] != from_[first] || to_[i] != to_[i - first] ||
          factors_[i].area_from != factors_[first].area_from) {
        return complain(
            table_.line_of(std::min(i, factors_.size() - 1)),
            "the row of " + text::in_quotes(from_[first]) + " has not the columns of the first row, or two areas");
      }
      if (i - first >= known_) continue;
      entries_of(i - first).push_back(factors_[i]);
      named_.lines.push_back(table_.line_of(i));
    }
  }

  std::vector<ViewFactor>& entries_of(std::size_t column) {
    if (column < patches_) return named_.entries;
    if (has_buried_ && column + 1 == known_) return named_.buried;
    return column == patches_ && has_back_ ? named_.back : named_.open;
  }

  const table::Table& table_;
  NamedMatrix named_;
  Entry entry_;  // kept to avoid reallocation
  std::vector<ViewFactor> factors_;
  std::vector<std::string> sums_;           // names of columns
  std::span<const std::string> from_, to_;  // of the table
  text::ProblemList problems_;
  std::size_t width_ = 1;    // entries of a row
  std::size_t known_ = 1;    // those that are no sums
  std::size_t patches_ = 1;  // those to patches
  bool has_back_ = false, has_buried_ = false;
};

}  // namespace

std::string name_of(const GroupSum& sum) { return std::string(kSum) + sum.name + ')'; }

std::vector<std::string> sums_among(std::vector<std::string> further) {
  std::erase_if(further, [](const std::string& name) { return !name.starts_with(kSum); });
  return further;
}

table::Table table_of(const Scene& scene, const Matrix& matrix, const ViewFactorOptions& options,
                      const Balanced* balanced) {
  const kernel::StandardArithmetic arithmetic;
  const Factors& all = matrix.factors;
  Surroundings surroundings{!matrix.back.empty(), !matrix.open.empty(), !matrix.buried.empty()};
  const std::span<const GroupSum> sums = balanced != nullptr ? std::span<const GroupSum>() : matrix.sums;
  for (const GroupSum& sum : sums) surroundings.sums.push_back(name_of(sum));
  const table::Fields<Entry>& fields = balanced != nullptr ? columns_with_balanced() : columns();
  table::Table table("matrix", head_of(scene, all.from, all.to, options, surroundings), fields.columns());
  Entry entry;
  const auto add = [&](std::string_view to, const std::vector<ViewFactor>& factors,
                       std::vector<double> Balanced::*values, std::size_t k, bool has_area_to) {
    entry.to = to;
    static_cast<ViewFactor&>(entry) = factors[k];
    entry.balanced = balanced != nullptr ? (balanced->*values)[k] : 0.0;
    entry.has_area_to = has_area_to;
    fields.append(entry, table);
  };
  for (std::size_t i = 0; i < all.from.size(); ++i) {
    entry.from = scene.name_of(all.from[i]);
    for (std::size_t j = 0; j < all.to.size(); ++j) {
      add(scene.name_of(all.to[j]), all.entries, &Balanced::entries, i * all.to.size() + j, true);
    }
    if (surroundings.back) add(kBack, matrix.back, &Balanced::back, i, true);
    if (surroundings.open) add(kOpen, matrix.open, &Balanced::open, i, false);
    if (surroundings.buried) add(kBuried, matrix.buried, &Balanced::buried, i, false);
    for (std::size_t k = 0; k < sums.size(); ++k) add(surroundings.sums[k], sums[k].factors, nullptr, i, true);
  }
  return table;
}

NamedMatrix read_named(const std::filesystem::path& file) {
  const kernel::StandardArithmetic arithmetic;
  const table::Table table = table::read(file);
  return NamedReader(table, file).read();
}

}  // namespace exactff::matrix
