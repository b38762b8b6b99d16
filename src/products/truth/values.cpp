// The values of a finished truth file in other formats. They are read from the file itself, so they are the same
// whether its rows were computed at once, resumed, merged, or computed by several processes.
#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <utility>

#include "exactff/exr.h"
#include "exactff/truth.h"
#include "files/file.h"
#include "files/npy_file.h"
#include "files/parallel.h"
#include "jobs/journal.h"
#include "kernel/float_environment.h"
#include "text/csv_lines.h"
#include "text/refuse.h"
#include "vtk/vtk.h"

namespace exactff::truth {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kNoColumn = static_cast<std::size_t>(-1);
constexpr std::size_t kRowsBetweenChecks = 256;  // whether the user has cancelled

struct Values {
  double exact = 0.0, lower = 0.0, upper = 0.0;
  Status status = Status::kCertified;
  double visible_fraction = 0.0;
  Rgb radiosity, total;

  // The number, or NaN where it is only an estimate.
  [[nodiscard]] double certified(double number) const {
    return status == Status::kNotCertified ? std::numeric_limits<double>::quiet_NaN() : number;
  }
};

// Reads the rows of a truth file in order.
class ValueReader {
 public:
  explicit ValueReader(const fs::path& file) : lines_(file, "a truth file") {
    for (std::string_view line; fields_.empty() && lines_.next(line);) {
      if (!text::is_csv_comment(line) && !text::split_csv_line(line, fields_)) damaged();
    }
    const auto column = [&](std::string_view name) {
      const auto found = std::ranges::find(fields_, name);
      return found == fields_.end() ? kNoColumn : static_cast<std::size_t>(found - fields_.begin());
    };
    source_ = column("source");
    status_ = column("status");
    fraction_ = column("visible_fraction");
    totals_ = {column("total_r"), column("total_g"), column("total_b")};
    numbers_ = {column("exact"),       column("lower"),       column("upper"),
                column("radiosity_r"), column("radiosity_g"), column("radiosity_b")};
    if (source_ == kNoColumn || status_ == kNoColumn || std::ranges::find(numbers_, kNoColumn) != numbers_.end()) {
      text::refuse(lines_.file(), "is not a truth file", "its values are read by the names of their columns",
                   "name a file that exactff truth or merge has written");
    }
  }

  [[nodiscard]] bool has_fractions() const { return fraction_ != kNoColumn; }
  [[nodiscard]] bool has_totals() const { return std::ranges::find(totals_, kNoColumn) == totals_.end(); }

  bool next() {
    const std::size_t columns = columns_ == 0 ? fields_.size() : columns_;
    columns_ = columns;
    for (std::string_view line; lines_.next(line);) {
      if (text::is_csv_comment(line)) continue;
      if (!text::split_csv_line(line, fields_) || fields_.size() != columns) damaged();
      return true;
    }
    return false;
  }

  // Of the row last read.
  [[nodiscard]] const std::string& source() const { return fields_[source_]; }
  [[nodiscard]] Values values() const {
    std::array<double, 6> n{};
    for (std::size_t i = 0; i < n.size(); ++i) n[i] = number(numbers_[i]);
    const Rgb total = has_totals() ? Rgb{number(totals_[0]), number(totals_[1]), number(totals_[2])} : Rgb{};
    return {n[0], n[1], n[2], status(), has_fractions() ? number(fraction_) : 0.0, {n[3], n[4], n[5]}, total};
  }

  [[noreturn]] void damaged() const {
    throw InputError({.file = lines_.file(),
                      .line = lines_.number(),
                      .what = "is not a row of a truth file",
                      .why = "every row of every source is needed",
                      .suggestion = "compute the file again with --force"});
  }

 private:
  [[nodiscard]] double number(std::size_t column) const {
    const std::string& field = fields_[column];
    double value = 0.0;
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (error != std::errc() || end != field.data() + field.size()) damaged();
    return value;
  }
  [[nodiscard]] Status status() const {
    for (const Status one : {Status::kCertified, Status::kZero, Status::kUnderflow, Status::kNotCertified}) {
      if (fields_[status_] == to_string(one)) return one;
    }
    damaged();
  }

  text::CsvLines lines_;
  std::vector<std::string> fields_;
  std::size_t columns_ = 0, source_ = 0, status_ = 0, fraction_ = 0;
  std::array<std::size_t, 6> numbers_{};
  std::array<std::size_t, 3> totals_{};
};

// The sources of the first receiver: the rows before its first source returns.
struct Shape {
  std::size_t rows = 0;
  std::vector<std::string> sources;
};

Shape shape_of(const fs::path& file, const jobs::RowHooks& hooks) {
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

}  // namespace

void write_npy(const fs::path& truth_file, const fs::path& file, const jobs::RowHooks& hooks) {
  const kernel::StandardArithmetic arithmetic;
  const Shape shape = shape_of(truth_file, hooks);
  ValueReader reader(truth_file);
  const std::size_t sources = shape.sources.size();
  const std::array extents{shape.rows / sources, sources + (reader.has_totals() ? 3 : 0)};
  files::NpyFile<double> array(file, extents);
  jobs::Pace pace("writing the NumPy file", shape.rows, hooks);
  for (std::size_t row = 0; row < shape.rows && reader.next(); ++row) {
    const Values values = reader.values();
    array.append(values.certified(values.exact));
    if (reader.has_totals() && row % sources == sources - 1) {
      for (const double total : {values.total.r, values.total.g, values.total.b}) array.append(values.certified(total));
    }
    if ((row + 1) % kRowsBetweenChecks == 0) pace.add(kRowsBetweenChecks);
  }
  pace.add(0);
  array.commit();
}

namespace {

void require_receivers(const Shape& shape, std::size_t receivers, const fs::path& truth_file) {
  if (shape.rows == receivers * shape.sources.size()) return;
  text::refuse(truth_file, "has values of other receivers", "each place shows the values of its receiver",
               "use the flags with which the file was made");
}

void add(vtk::SourceValues& list, const Values& values, bool has_fractions) {
  list.exact.push_back(values.exact);
  list.lower.push_back(values.lower);
  list.upper.push_back(values.upper);
  list.status.push_back(static_cast<std::uint8_t>(values.status));
  if (has_fractions) list.visible_fraction.push_back(values.visible_fraction);
  list.radiosity.push_back(values.radiosity);
}

// What the cells show.
std::vector<vtk::Field> fields_of(const fs::path& truth_file, const Request& request, const jobs::RowHooks& hooks) {
  const Shape shape = shape_of(truth_file, hooks);
  require_receivers(shape, request.receivers.size(), truth_file);
  std::vector<vtk::SourceValues> list;
  for (const std::string& source : shape.sources) list.push_back({source, {}, {}, {}, {}, {}, {}});
  std::vector<double> totals;
  ValueReader reader(truth_file);
  jobs::Pace pace("reading rows", shape.rows, hooks);
  for (std::size_t row = 0; row < shape.rows && reader.next(); ++row) {
    const Values values = reader.values();
    add(list[row % list.size()], values, reader.has_fractions());
    if (row % list.size() == 0) totals.insert(totals.end(), {values.total.r, values.total.g, values.total.b});
    if ((row + 1) % kRowsBetweenChecks == 0) pace.add(kRowsBetweenChecks);
  }
  std::vector<vtk::Field> fields = vtk::fields_of(std::move(list));
  if (reader.has_totals()) fields.push_back({"total", 3, std::move(totals)});
  return fields;
}

// The comments at the head of the file.
std::vector<std::string> about(const fs::path& truth_file) {
  std::vector<std::string> lines;
  text::CsvLines file(truth_file, "a truth file");
  for (std::string_view line; file.next(line) && line.starts_with("# ");) lines.emplace_back(line.substr(2));
  return lines;
}

}  // namespace

void write_vtk(const Request& request, const fs::path& truth_file, const fs::path& file, const jobs::RowHooks& hooks) {
  const kernel::StandardArithmetic arithmetic;
  const vtk::Content content{.scene = request.scene,
                             .receivers = request.receivers,
                             .fields = fields_of(truth_file, request, hooks),
                             .about = about(truth_file)};
  vtk::write(content, file, {{}, hooks.cancelled});
}

void write_exr(const exr::Frame& frame, const fs::path& truth_file, const fs::path& file, const jobs::RowHooks& hooks) {
  const kernel::StandardArithmetic arithmetic;
  const Shape shape = shape_of(truth_file, hooks);
  require_receivers(shape, frame.pixels.size(), truth_file);
  ValueReader reader(truth_file);
  if (!reader.has_totals()) {
    text::refuse(truth_file, "has no totals", "a pixel shows the light of all sources together",
                 "compute it again with --total radiance and --force");
  }
  exr::FrameValues values(frame);
  jobs::Pace pace("writing the image", shape.rows, hooks);
  for (std::size_t row = 0; row < shape.rows && reader.next(); ++row) {
    if (row % shape.sources.size() == 0) {
      const Values one = reader.values();
      values.set(row / shape.sources.size(), one.total, one.status != Status::kNotCertified);
    }
    if ((row + 1) % kRowsBetweenChecks == 0) pace.add(kRowsBetweenChecks);
  }
  files::WholeFile whole(file);
  whole.append(values.exr(about(truth_file)));
  whole.commit();
}

}  // namespace exactff::truth
