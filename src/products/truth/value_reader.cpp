#include "truth/value_reader.h"

#include <algorithm>
#include <charconv>
#include <limits>

#include "jobs/journal.h"
#include "kernel/vec.h"
#include "text/refuse.h"

namespace exactff::truth {

double Values::certified(double number) const {
  return status == Status::kNotCertified ? std::numeric_limits<double>::quiet_NaN() : number;
}

ValueReader::ValueReader(const std::filesystem::path& file) : lines_(file, "a truth file") {
  for (std::string_view line; fields_.empty() && lines_.next(line);) {
    if (!text::is_csv_comment(line) && !text::split_csv_line(line, fields_)) damaged();
  }
  source_ = column("source");
  status_ = column("status");
  fraction_ = column("visible_fraction");
  unoccluded_ = column("unoccluded");
  on_ = column("on");
  totals_ = columns("total_r", "total_g", "total_b");
  gradient_ = columns("dF_dx", "dF_dy", "dF_dz");
  point_ = columns("x", "y", "z");
  normal_ = columns("nx", "ny", "nz");
  numbers_ = {column("exact"),       column("lower"),       column("upper"),
              column("radiosity_r"), column("radiosity_g"), column("radiosity_b")};
  if (!has(source_) || !has(status_) || !std::ranges::all_of(numbers_, has)) {
    text::refuse(lines_.file(), "is not a truth file", "its values are read by the names of their columns",
                 "name a file that exactff truth or merge has written");
  }
}

std::size_t ValueReader::column(std::string_view name) const {
  const auto found = std::ranges::find(fields_, name);
  return found == fields_.end() ? kNoColumn : static_cast<std::size_t>(found - fields_.begin());
}

ValueReader::Three ValueReader::columns(std::string_view x, std::string_view y, std::string_view z) const {
  const Three found = {column(x), column(y), column(z)};
  return std::ranges::all_of(found, has) ? found : Three{kNoColumn, kNoColumn, kNoColumn};
}

bool ValueReader::has_receivers() const { return has(point_.back()) && has(normal_.back()) && has(on_); }

bool ValueReader::next() {
  if (count_ == 0) count_ = fields_.size();
  for (std::string_view line; lines_.next(line);) {
    if (text::is_csv_comment(line)) continue;
    if (!text::split_csv_line(line, fields_) || fields_.size() != count_) damaged();
    return true;
  }
  return false;
}

Values ValueReader::values() const {
  std::array<double, 6> n{};
  for (std::size_t i = 0; i < n.size(); ++i) n[i] = number(numbers_[i]);
  const Rgb total = has_totals() ? Rgb{number(totals_[0]), number(totals_[1]), number(totals_[2])} : Rgb{};
  return {n[0],
          n[1],
          n[2],
          status(),
          has_fractions() ? number(fraction_) : 0.0,
          has_unoccluded() ? number(unoccluded_) : 0.0,
          {n[3], n[4], n[5]},
          total,
          has_gradients() ? gradient() : Vec3{}};
}

Vec3 ValueReader::gradient() const {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  return fields_[gradient_[0]].empty() ? Vec3{kNone, kNone, kNone} : vector(gradient_);
}

Vec3 ValueReader::normal() const {
  const Vec3 normal = vector(normal_);
  if (!kernel::is_finite(normal) || normal == Vec3{}) damaged();
  return normal;
}

void ValueReader::damaged() const {
  throw InputError({.file = lines_.file(),
                    .line = lines_.number(),
                    .what = "is not a row of a truth file",
                    .why = "every row of every source is needed",
                    .suggestion = "compute the file again with --force"});
}

double ValueReader::number(std::size_t column) const {
  const std::string& field = fields_[column];
  double value = 0.0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc() || end != field.data() + field.size()) damaged();
  return value;
}

Status ValueReader::status() const {
  for (const Status one : {Status::kCertified, Status::kZero, Status::kUnderflow, Status::kNotCertified}) {
    if (fields_[status_] == to_string(one)) return one;
  }
  damaged();
}

Shape shape_of(const std::filesystem::path& file, const jobs::RowHooks& hooks) {
  ValueReader reader(file);
  const jobs::RowHooks silent{.cancelled = hooks.cancelled};  // the number of rows is not known yet
  jobs::Pace pace("reading rows", 0, silent);
  Shape shape;
  bool one_receiver = true;
  for (; reader.next(); ++shape.rows) {
    one_receiver = one_receiver && (shape.rows == 0 || reader.source() != shape.sources.front());
    if (one_receiver) shape.sources.push_back(reader.source());
    if (reader.source() != shape.sources[shape.rows % shape.sources.size()]) reader.damaged();
    if (shape.rows % kRowsBetweenChecks == 0) pace.add(0);
  }
  if (shape.rows == 0 || shape.rows % shape.sources.size() != 0) reader.damaged();
  return shape;
}

std::vector<std::string> head_lines(const std::filesystem::path& truth_file) {
  std::vector<std::string> lines;
  text::CsvLines file(truth_file, "a truth file");
  for (std::string_view line; file.next(line) && line.starts_with("# ");) lines.emplace_back(line.substr(2));
  return lines;
}

}  // namespace exactff::truth
