// The values of a finished truth file in other formats. They are read from the file itself, so they are the same
// whether its rows were computed at once, resumed, merged, or computed by several processes.
#include <array>
#include <utility>

#include "exactff/exr.h"
#include "exactff/truth.h"
#include "files/file.h"
#include "files/numpy.h"
#include "files/parallel.h"
#include "jobs/journal.h"
#include "kernel/float_environment.h"
#include "text/refuse.h"
#include "truth/value_reader.h"
#include "vtk/vtk.h"

namespace exactff::truth {

namespace fs = std::filesystem;

void write_npy(const fs::path& truth_file, const fs::path& file, const jobs::RowHooks& hooks) {
  const kernel::StandardArithmetic arithmetic;
  const Shape shape = shape_of(truth_file, hooks);
  ValueReader reader(truth_file);
  const std::size_t sources = shape.sources.size();
  const std::size_t of_source = reader.has_gradients() ? 4 : 1;
  const std::array extents{shape.rows / sources, of_source * sources + (reader.has_totals() ? 3 : 0)};
  files::NpyFile<double> array(file, extents);
  jobs::Pace pace("writing the NumPy file", shape.rows, hooks);
  for (std::size_t row = 0; row < shape.rows && reader.next(); ++row) {
    const Values values = reader.values();
    array.append(values.certified(values.exact));
    if (reader.has_gradients()) {
      for (const double d : {values.gradient.x, values.gradient.y, values.gradient.z}) array.append(d);
    }
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

void add(vtk::SourceValues& list, const Values& values, const ValueReader& reader) {
  list.exact.push_back(values.exact);
  list.lower.push_back(values.lower);
  list.upper.push_back(values.upper);
  list.status.push_back(static_cast<std::uint8_t>(values.status));
  if (reader.has_gradients()) list.gradient.push_back(values.gradient);
  if (reader.has_fractions()) list.visible_fraction.push_back(values.visible_fraction);
  list.radiosity.push_back(values.radiosity);
}

// What the cells show.
std::vector<vtk::Field> fields_of(const fs::path& truth_file, const Request& request, const jobs::RowHooks& hooks) {
  const Shape shape = shape_of(truth_file, hooks);
  require_receivers(shape, request.receivers.size(), truth_file);
  std::vector<vtk::SourceValues> list;
  for (const std::string& source : shape.sources) list.push_back({source, {}, {}, {}, {}, {}, {}, {}});
  std::vector<double> totals;
  ValueReader reader(truth_file);
  jobs::Pace pace("reading rows", shape.rows, hooks);
  for (std::size_t row = 0; row < shape.rows && reader.next(); ++row) {
    const Values values = reader.values();
    add(list[row % list.size()], values, reader);
    if (row % list.size() == 0) totals.insert(totals.end(), {values.total.r, values.total.g, values.total.b});
    if ((row + 1) % kRowsBetweenChecks == 0) pace.add(kRowsBetweenChecks);
  }
  std::vector<vtk::Field> fields = vtk::fields_of(std::move(list));
  if (reader.has_totals()) fields.push_back({"total", 3, std::move(totals)});
  return fields;
}

}  // namespace

void write_vtk(const Request& request, const fs::path& truth_file, const fs::path& file, const jobs::RowHooks& hooks) {
  const kernel::StandardArithmetic arithmetic;
  const vtk::Content content{.scene = request.scene,
                             .receivers = request.receivers,
                             .fields = fields_of(truth_file, request, hooks),
                             .about = head_lines(truth_file)};
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
  whole.append(values.exr(head_lines(truth_file)));
  whole.commit();
}

}  // namespace exactff::truth
