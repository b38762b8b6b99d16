#include "vtk/vtk.h"

#include <limits>
#include <stdexcept>
#include <utility>

#include "files/parallel.h"
#include "kernel/float_environment.h"
#include "vtk/data_set.h"

namespace exactff::vtk {

Field field_of_faces(const Scene& scene, std::string name, std::span<const Selection> selections,
                     std::size_t components, const std::function<double(std::size_t, std::size_t)>& value) {
  std::vector<double> values(components * scene.faces().size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < selections.size(); ++i) {
    for (const FaceId face : scene.faces_of(selections[i])) {
      for (std::size_t c = 0; c < components; ++c) values[components * index_of(face) + c] = value(i, c);
    }
  }
  return {std::move(name), components, std::move(values)};
}

// --- Write ---

namespace {

template <class T>
std::vector<T> in_order(const std::vector<T>& values, std::size_t components, const std::vector<std::size_t>& order) {
  std::vector<T> sorted;
  sorted.reserve(components * order.size());
  for (const std::size_t i : order) {
    for (std::size_t c = 0; c < components; ++c) sorted.push_back(values[i * components + c]);
  }
  return sorted;
}

void require_tuples(const Field& field, std::size_t count) {
  const std::size_t numbers = std::visit([](const auto& values) { return values.size(); }, field.values);
  if (numbers == field.components * count) return;
  throw std::invalid_argument("a field has not a value for each receiver or face");
}

Array array_of(const Field& field, const std::vector<std::size_t>& order) {
  Array array{field.name, field.components, {}};
  std::visit([&](const auto& values) { array.values = in_order(values, field.components, order); }, field.values);
  return array;
}

DataSet data_of(const Content& content) {
  const std::vector<std::size_t> order = cell_order(content.receivers);
  DataSet data = cells_of(*content.scene, content.receivers, order);
  for (const Field& field : content.fields) {
    require_tuples(field, order.size());
    data.of_cells.push_back(array_of(field, order));
  }
  if (!content.fields.empty()) data.shown = content.fields.front().name;
  if (!content.about.empty()) data.of_file.push_back({"about", 1, content.about});
  return data;
}

std::vector<double> as_vectors(const std::vector<Rgb>& colours) {
  std::vector<double> list;
  for (const Rgb& c : colours) list.insert(list.end(), {c.r, c.g, c.b});
  return list;
}

void add(std::vector<Rgb>& sum, const std::vector<Rgb>& more) {
  sum.resize(more.size());
  for (std::size_t i = 0; i < more.size(); ++i) {
    sum[i] = {sum[i].r + more[i].r, sum[i].g + more[i].g, sum[i].b + more[i].b};
  }
}

std::vector<double> components_of(const std::vector<Vec3>& vectors) {
  std::vector<double> numbers;
  for (const Vec3& v : vectors) numbers.insert(numbers.end(), {v.x, v.y, v.z});
  return numbers;
}

}  // namespace

std::vector<Field> fields_of(std::vector<SourceValues> sources) {
  const bool several = sources.size() > 1;
  std::vector<Field> fields;
  std::vector<Rgb> sum;
  for (SourceValues& one : sources) {
    const auto name = [&](const char* quantity) {
      return several ? std::string(quantity) + " (" + one.source + ')' : std::string(quantity);
    };
    fields.push_back({name("exact"), 1, std::move(one.exact)});
    fields.push_back({name("lower"), 1, std::move(one.lower)});
    fields.push_back({name("upper"), 1, std::move(one.upper)});
    fields.push_back({name("status"), 1, std::move(one.status)});
    if (!one.visible_fraction.empty()) fields.push_back({name("visible fraction"), 1, std::move(one.visible_fraction)});
    if (!one.gradient.empty()) fields.push_back({name("gradient"), 3, components_of(one.gradient)});
    fields.push_back({name("radiosity"), 3, as_vectors(one.radiosity)});
    if (several) add(sum, one.radiosity);
  }
  if (several) fields.push_back({"radiosity", 3, as_vectors(sum)});
  return fields;
}

std::filesystem::path scene_file(const std::filesystem::path& file) {
  return file.parent_path() / (file.stem().string() + "_scene" + file.extension().string());
}

void require_extension(const std::filesystem::path& file) { static_cast<void>(format_of(file)); }

void write_faces(const Scene& scene, const std::vector<Field>& fields, std::vector<std::string> about,
                 const std::filesystem::path& file, const Hooks& hooks) {
  const kernel::StandardArithmetic arithmetic;
  const Format format = format_of(file);
  files::WholeFile cells(file);
  std::vector<std::size_t> face_of_cell;
  for (const Piece& piece : scene.pieces()) face_of_cell.push_back(index_of(piece.face));
  DataSet data = cells_of(scene);
  for (const Field& field : fields) {
    require_tuples(field, scene.faces().size());
    data.of_cells.push_back(array_of(field, face_of_cell));
  }
  if (!fields.empty()) data.shown = fields.front().name;
  if (!about.empty()) data.of_file.push_back({"about", 1, std::move(about)});
  append(data, format, cells, hooks);
  files::require_not_cancelled(hooks);
  cells.commit();
}

void write(const Content& content, const std::filesystem::path& file, const Hooks& hooks) {
  const kernel::StandardArithmetic arithmetic;
  const Format format = format_of(file);
  files::WholeFile receivers(file), scene(scene_file(file));
  append(data_of(content), format, receivers, hooks);
  append(cells_of(*content.scene), format, scene, hooks);
  files::require_not_cancelled(hooks);
  receivers.commit();
  scene.commit();
}

}  // namespace exactff::vtk
