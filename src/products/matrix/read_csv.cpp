// Reads the CSV file of a matrix.
#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "exactff/matrix.h"
#include "kernel/float_environment.h"
#include "matrix/words.h"
#include "text/csv_table.h"
#include "text/phrases.h"

namespace exactff::matrix {
namespace {

// A way of files with drafts: the mean of whole views.
constexpr std::string_view kOldByViews = "views";

class TableReader {
 public:
  explicit TableReader(const std::filesystem::path& path) : csv_(path, "a matrix of `exactff matrix -o`") {
    table_.file = csv_.file();
    table_.header = std::move(csv_.comments());
    const auto column = [&](std::string_view name) {
      return csv_.needed_column({name}, "a matrix has it", "give a file written by `exactff matrix -o`");
    };
    from_ = column("from");
    to_ = column("to");
    for (std::size_t i = 0; i < kNumbers.size(); ++i) numbers_[i] = column(kNumbers[i]);
    area_to_ = column("area_to");
    claim_ = column("claim");
    way_ = csv_.column("way");
    limit_ = csv_.column("limit");
    accurate_ = column("accurate");
  }

  Table read() {
    const bool has_columns = csv_.is_sound();
    while (has_columns && csv_.next()) take_row();
    if (csv_.is_sound() && rows_.empty()) {
      csv_.complain("the file has no entries", "a matrix has at least one", "compute it with `exactff matrix -o`");
    }
    csv_.throw_if_any();
    find_columns();
    for (std::size_t i = 0; i < rows_.size(); i += width_) take_line_of_entries(i);
    csv_.throw_if_any();
    return std::move(table_);
  }

 private:
  struct Row {
    std::string from, to;
    ViewFactor factor;
    std::uint32_t line = 0;
  };

  static constexpr std::array<std::string_view, 6> kNumbers = {"factor",    "lower", "upper",
                                                               "area_from", "cells", "event_cells"};

  void take_row() {
    Row row{csv_.field(from_), csv_.field(to_), {}, static_cast<std::uint32_t>(csv_.line())};
    ViewFactor& f = row.factor;
    f.value = csv_.number(numbers_[0]);
    f.lower = csv_.number(numbers_[1]);
    f.upper = csv_.number(numbers_[2]);
    f.area_from = csv_.number(numbers_[3]);
    f.cells = count(numbers_[4]);
    f.event_cells = count(numbers_[5]);
    if (!csv_.field(area_to_).empty()) f.area_to = csv_.number(area_to_);
    if (!(0.0 <= f.lower && f.lower <= f.value && f.value <= f.upper && f.upper <= 1.0) || !(f.area_from > 0.0)) {
      csv_.complain("the entry is not within its bounds, these are not within 0 and 1, or the area is not positive",
                    "the file contradicts itself", "use the file as `exactff matrix` wrote it");
    }
    take_words(f);
    rows_.push_back(std::move(row));
  }

  // A whole number that a double holds.
  std::size_t count(std::size_t column) {
    const double number = csv_.number(column);
    if (number >= 0.0 && number < 0x1p53) return static_cast<std::size_t>(number);
    csv_.complain("a number of cells is negative or too large", "cells are counted",
                  "use the file as `exactff matrix` wrote it");
    return 0;
  }

  void take_words(ViewFactor& f) {
    const std::string claim = csv_.field(claim_);
    const bool is_old = is_old_claim(claim);
    table_.has_old_claims = table_.has_old_claims || is_old;
    f.claim = is_old ? Claim::kEstimated : known<Claim>("claim", claim);
    f.way = way_ ? known_way(csv_.field(*way_)) : claim == kOldByPoints ? Way::kPoints : Way::kCells;
    const std::string& accurate = csv_.field(accurate_);
    if (accurate != "yes" && accurate != "no") {
      csv_.complain("'accurate' is " + text::in_quotes(accurate), "it says what is known of the entry",
                    "write yes or no");
    }
    f.accurate = accurate == "yes";
    if (limit_) f.limit = known<Limit>("limit", csv_.field(*limit_));
  }

  Way known_way(const std::string& word) { return word == kOldByViews ? Way::kPoints : known<Way>("way", word); }

  template <class Word>
  Word known(const char* column, const std::string& word) {
    const std::optional<Word> found = named<Word>(word);
    if (!found) {
      csv_.complain(std::string("unknown ") + column + ' ' + text::in_quotes(word),
                    "it says what is known of the entry", "use the file as `exactff matrix` wrote it");
    }
    return found.value_or(Word{});
  }

  // Those of the first row: up to the first entry of another.
  void find_columns() {
    width_ = 1;
    while (width_ < rows_.size() && rows_[width_].from == rows_.front().from && rows_[width_].to != rows_.front().to) {
      ++width_;
    }
    patches_ = width_;
    const auto take_off = [&](std::string_view name) {
      const bool there = patches_ > 0 && rows_[patches_ - 1].to == name;
      patches_ -= there ? 1 : 0;
      return there;
    };
    has_buried_ = take_off(kBuried);
    has_open_ = take_off(kOpen);
    has_back_ = take_off(kBack);
    for (std::size_t j = 0; j < patches_; ++j) table_.to.push_back(rows_[j].to);
  }

  void take_line_of_entries(std::size_t first) {
    table_.from.push_back(rows_[first].from);
    for (std::size_t j = 0; j < width_; ++j) {
      if (first + j == rows_.size() || rows_[first + j].from != rows_[first].from ||
          rows_[first + j].to != rows_[j].to || rows_[first + j].factor.area_from != rows_[first].factor.area_from) {
        csv_.complain_at(
            rows_[std::min(first + j, rows_.size() - 1)].line,
            "the row of " + text::in_quotes(rows_[first].from) + " has not the columns of the first row, or two areas",
            "a matrix has the same columns in every row", "use the file as `exactff matrix` wrote it");
        return;
      }
      const Row& row = rows_[first + j];
      entries_of(j).push_back(row.factor);
      table_.lines.push_back(row.line);
    }
  }

  std::vector<ViewFactor>& entries_of(std::size_t column) {
    if (column < patches_) return table_.entries;
    if (has_buried_ && column + 1 == width_) return table_.buried;
    return column == patches_ && has_back_ ? table_.back : table_.open;
  }

  text::CsvTable csv_;
  Table table_;
  std::vector<Row> rows_;
  std::size_t from_ = 0, to_ = 0, area_to_ = 0, claim_ = 0, accurate_ = 0;
  std::optional<std::size_t> way_, limit_;
  std::array<std::size_t, kNumbers.size()> numbers_{};
  std::size_t width_ = 1;    // entries of a row
  std::size_t patches_ = 1;  // those to patches
  bool has_back_ = false, has_open_ = false, has_buried_ = false;
};

}  // namespace

bool is_csv(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) return false;
  std::ifstream in(file, std::ios::binary);
  constexpr std::size_t kMostRead = 1 << 16;
  std::string text(kMostRead, '\0');
  in.read(text.data(), kMostRead);
  text.resize(static_cast<std::size_t>(in.gcount()));
  std::size_t line = 0;
  while (line < text.size() && text[line] == '#') line = std::min(text.find('\n', line), text.size() - 1) + 1;
  return std::string_view(text).substr(line).starts_with("from,to,factor,lower,upper,claim,");
}

Table read_csv(const std::filesystem::path& file) {
  const kernel::StandardArithmetic arithmetic;
  return TableReader(file).read();
}

}  // namespace exactff::matrix
