// Exact form factors: of arrays of receivers, and of one pair with everything that is known about it.
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <functional>

#include "exactff/methods.h"
#include "exactff/receiver.h"
#include "exactff/render.h"
#include "flags/scene.h"
#include "kernel/poll.h"
#include "python/bindings.h"
#include "report/report.h"
#include "scene/selections.h"
#include "text/refuse.h"
#include "truth/columns.h"

namespace exactff::python {

Measure measure_of(const MeasureTuple& measure) {
  const auto& [name, up, sphere] = measure;
  return {*measure_named(name), {up[0], up[1], up[2]}, sphere};
}

namespace {

void bind_enclosure(py::module_& module) {
  const auto decimals = [](const Enclosure& ball, int digits) {
    constexpr int kMostDigits = flags::PrecisionArguments::kMostDigits;
    if (digits >= 1 && digits <= kMostDigits) return ball.decimals(digits);
    text::refuse("digits is " + std::to_string(digits), "it is a whole number from 1 to " + std::to_string(kMostDigits),
                 "ask for fewer digits");
  };
  py::class_<Enclosure>(
      module, "Enclosure",
      "A ball that is proved to contain a real number: every number within ``radius`` of ``midpoint`` may be it.\n\n"
      "``midpoint`` and ``radius`` are decimal strings that mean exactly what they say:\n"
      "``fractions.Fraction(e.midpoint)`` and ``mpmath.mpf(e.midpoint)`` take them. Balls can be added and "
      "subtracted;\n"
      "rounded values cannot.")
      .def_property_readonly("midpoint", &Enclosure::midpoint, "The midpoint, as a decimal string.")
      .def_property_readonly("radius", &Enclosure::radius, "The radius, as a decimal string.")
      .def_property_readonly("lower", &Enclosure::lower, "The largest double that is not above the ball's lower end.")
      .def_property_readonly("upper", &Enclosure::upper, "The smallest double that is not below the ball's upper end.")
      .def_property_readonly(
          "nearest", &Enclosure::nearest,
          "The double to which every number in the ball rounds; None if they do not all round to the same one.")
      .def("decimals", decimals, "digits"_a,
           "The number to so many significant digits, correctly rounded; None if the ball does not determine them.")
      .def("__contains__", py::overload_cast<double>(&Enclosure::contains, py::const_))
      .def(
          "__add__", [](Enclosure a, const Enclosure& b) { return a += b; }, py::is_operator())
      .def(
          "__sub__", [](Enclosure a, const Enclosure& b) { return a -= b; }, py::is_operator())
      .def("__repr__", [](const Enclosure& ball) {
        return "<exactff.Enclosure " + ball.midpoint() + " +/- " + ball.radius() + ">";
      });
}

// --- arrays ---

template <class Value>
using Table = py::array_t<Value>;

template <class Value>
Table<Value> table(std::size_t rows, std::size_t columns) {
  return Table<Value>({static_cast<py::ssize_t>(rows), static_cast<py::ssize_t>(columns)});
}

// Results in arrays (receivers, sources), which threads fill without the GIL.
class Tables {
 public:
  Tables(std::size_t rows, std::size_t columns, bool full, bool fraction, bool gradient)
      : value_(table<double>(rows, columns)), status_(table<std::int8_t>(rows, columns)) {
    if (full) {
      lower_ = table<double>(rows, columns);
      upper_ = table<double>(rows, columns);
      bits_ = table<std::int32_t>(rows, columns);
    }
    if (fraction) fraction_ = table<double>(rows, columns);
    if (gradient) {
      gradient_ = table<double>(rows, 3 * columns);
      gradient_status_ = table<std::int8_t>(rows, 3 * columns);
    }
  }

  void set(std::size_t at, const FormFactor& f) {
    value_.mutable_data()[at] = f.value;
    status_.mutable_data()[at] = static_cast<std::int8_t>(f.status);
    if (fraction_) fraction_->mutable_data()[at] = f.visible_fraction.value_or(0.0);
    for (std::size_t axis = 0; gradient_ && axis < 3; ++axis) {
      const Derivative& d = f.gradient->position[axis];
      gradient_->mutable_data()[3 * at + axis] = d.value;
      gradient_status_->mutable_data()[3 * at + axis] = static_cast<std::int8_t>(d.status);
    }
    if (!lower_) return;
    lower_->mutable_data()[at] = f.lower;
    upper_->mutable_data()[at] = f.upper;
    bits_->mutable_data()[at] = f.precision_bits;
  }

  // None for what was not requested.
  [[nodiscard]] py::tuple tuple() const {
    return py::make_tuple(value_, status_, lower_, upper_, bits_, fraction_, gradient_, gradient_status_);
  }

 private:
  Table<double> value_;
  Table<std::int8_t> status_;
  std::optional<Table<double>> lower_, upper_, fraction_, gradient_;
  std::optional<Table<std::int8_t>> gradient_status_;
  std::optional<Table<std::int32_t>> bits_;
};

// The column of "sky", unless a patch has this name. Taken out of the names.
std::optional<std::size_t> take_sky(const Scene& scene, std::vector<std::string>& names) {
  const auto sky = std::ranges::find(names, "sky");
  if (sky == names.end() || has_patch(scene, "sky")) return {};
  const auto column = static_cast<std::size_t>(sky - names.begin());
  names.erase(sky);
  return column;
}

// Value, status, lower, upper, bits, fraction, gradient and its status (receivers, 3 sources).
py::tuple form_factors_of(const SharedScene& scene, const Numbers& points, const Numbers& normals, const Integers& on,
                          std::vector<std::string> names, bool full, bool fraction, bool gradient, int precision_cap,
                          int threads, const py::object& progress, const MeasureTuple& measure) {
  const ArrayReceivers receivers(points, normals, on);
  const std::optional<std::size_t> sky = take_sky(scene.scene(), names);
  std::vector<std::shared_ptr<const ExactSource>> sources;
  std::vector<const ExactSource*> list;
  if (!sky || !names.empty()) {
    for (const Selection& selection : scene.selections(names)) {
      list.push_back(sources.emplace_back(scene.source(selection)).get());
    }
  }
  const std::size_t columns = list.size() + (sky ? 1 : 0);
  Tables out(receivers.count(), columns, full, fraction, gradient);
  const ExactOptions options{.measure = measure_of(measure),
                             .visible_fraction = fraction,
                             .gradient = gradient,
                             .precision_cap = precision_cap};
  Interrupt interrupt(progress);
  interrupt.run([&] {
    const batch::Run run{threads, interrupt.hooks()};
    if (sky) {
      batch::sky_factors(scene.scene(), receivers.in_batch(), options, run,
                         [&](std::size_t i, const FormFactor& f) { out.set(i * columns + *sky, f); });
    }
    if (list.empty()) return;
    batch::exact_form_factors(scene.scene(), receivers.in_batch(), list, options, run,
                              [&](std::size_t i, std::size_t s, const FormFactor& f) {
                                out.set(i * columns + (sky && s >= *sky ? s + 1 : s), f);
                              });
  });
  return out.tuple();
}

// --- one pair ---

// One result, with what is needed to ask for more.
class Pair {
 public:
  Pair(std::shared_ptr<const SharedScene> scene, Receiver receiver, std::shared_ptr<const ExactSource> source,
       const ExactOptions& options)
      : scene_(std::move(scene)), receiver_(std::move(receiver)), source_(std::move(source)) {
    Interrupt interrupt;
    interrupt.run([&] { exact_form_factor(scene_->scene(), receiver_, *source_, options, result_); });
  }

  [[nodiscard]] const FormFactor& result() const { return result_; }
  [[nodiscard]] const Scene& scene() const { return scene_->scene(); }
  [[nodiscard]] std::string source_name() const { return scene().name_of(source_->selection()); }

  [[nodiscard]] std::string svg() const {
    Interrupt interrupt;
    return interrupt.run([&] {
      const FormFactor drawn = exact_form_factor(scene(), receiver_, *source_, {.list_cutters = true});
      return report::visibility_svg(scene(), receiver_, *source_, drawn);
    });
  }

 private:
  std::shared_ptr<const SharedScene> scene_;
  Receiver receiver_;
  std::shared_ptr<const ExactSource> source_;
  FormFactor result_;
};

std::shared_ptr<Pair> pair_of(const std::shared_ptr<SharedScene>& scene, const std::array<double, 3>& point,
                              const std::array<double, 3>& normal, const std::vector<std::uint32_t>& on,
                              const std::string& source, bool fraction, bool list_cutters, bool gradient, bool vertices,
                              int digits, int precision_cap,
                              const std::optional<std::vector<std::uint32_t>>& only_occluders,
                              const MeasureTuple& measure) {
  Receiver receiver{{point[0], point[1], point[2]}, {normal[0], normal[1], normal[2]}, {}, {}};
  for (const std::uint32_t face : on) receiver.on.push_back(static_cast<FaceId>(face));
  std::vector<FaceId> only;
  for (const std::uint32_t face : only_occluders.value_or(std::vector<std::uint32_t>{})) {
    only.push_back(static_cast<FaceId>(face));
  }
  const ExactOptions options{.measure = measure_of(measure),
                             .visible_fraction = fraction,
                             .exact_fraction = fraction,
                             .list_cutters = list_cutters,
                             .gradient = gradient,
                             .vertices = vertices,
                             .digits = digits,
                             .precision_cap = precision_cap,
                             .only_occluders = only_occluders ? &only : nullptr};
  return std::make_shared<Pair>(scene, std::move(receiver), scene->source(scene->scene().select(source)), options);
}

py::list planes_of(const Pair& pair) {
  py::list planes;
  for (const PlaneRecord& plane : pair.result().planes) {
    py::list faces, notes;
    for (const FaceId face : plane.faces) faces.append(pair.scene().name_of(face));
    for (const StageNote& note : stages(plane)) notes.append(py::make_tuple(note.stage, note.ran, note.note));
    planes.append(py::make_tuple(faces, std::string(to_string(decided_outcome(plane))), notes, plane.exact_fraction));
  }
  return planes;
}

// The reason of the kink and its faces (or none), then (value, status, enclosure) for dF/dx and for V; (vertex, place,
// such a list) for vertices, and the frames.
py::object gradient_of(const Pair& pair) {
  if (!pair.result().gradient) return py::none();
  const Gradient& gradient = *pair.result().gradient;
  const auto list = [](const std::array<Derivative, 3>& derivatives) {
    py::list result;
    for (const Derivative& d : derivatives) {
      result.append(py::make_tuple(d.value, static_cast<int>(d.status), d.enclosure));
    }
    return result;
  };
  py::object kink = py::none();
  if (gradient.kink) {
    py::list faces;
    for (const FaceId face : gradient.kink->faces) faces.append(pair.scene().name_of(face));
    kink = py::make_tuple(std::string(to_string(gradient.kink->reason)), faces);
  }
  py::list vertices;
  for (const VertexDerivative& v : gradient.vertices) {
    const Vec3& at = pair.scene().vertices()[v.vertex];
    vertices.append(py::make_tuple(v.vertex, py::make_tuple(at.x, at.y, at.z), list(v.position)));
  }
  return py::make_tuple(kink, list(gradient.position), list(gradient.normal), vertices, gradient.frames);
}

std::vector<std::size_t> cutters_of(const Pair& pair) {
  std::vector<std::size_t> indices;
  for (const FaceId face : pair.result().cutters) indices.push_back(index_of(face));
  return indices;
}

// Value, lower, upper, status, enclosure, source, bits, visible fraction and part.
py::tuple facts_of(const Pair& pair) {
  const FormFactor& f = pair.result();
  const auto part = f.visible_part ? std::optional(std::string(to_string(*f.visible_part))) : std::nullopt;
  return py::make_tuple(f.value, f.lower, f.upper, static_cast<int>(f.status), f.enclosure, pair.source_name(),
                        f.precision_bits, f.visible_fraction, part);
}

void bind_pair(py::module_& module) {
  py::class_<Pair, std::shared_ptr<Pair>>(module, "Pair")
      .def_property_readonly("value", [](const Pair& pair) { return pair.result().value; })
      .def("facts", &facts_of)
      .def("planes", &planes_of)
      .def("cutters", &cutters_of)
      .def("gradient", &gradient_of)
      .def("svg", &Pair::svg);
}

}  // namespace

void bind_form_factors(py::module_& module) {
  bind_enclosure(module);
  bind_pair(module);
  module.def("form_factors", &form_factors_of, "scene"_a, "points"_a, "normals"_a, "on"_a, "sources"_a, "full"_a,
             "fraction"_a, "gradient"_a, "precision_cap"_a, "threads"_a, "progress"_a, "measure"_a);
  module.def("form_factor", &pair_of, "scene"_a, "point"_a, "normal"_a, "on"_a, "source"_a, "fraction"_a,
             "list_cutters"_a, "gradient"_a, "vertices"_a, "digits"_a, "precision_cap"_a, "only_occluders"_a,
             "measure"_a);
  module.def(
      "status_name", [](int status) { return std::string(to_string(static_cast<Status>(status))); }, "status"_a);
}

// --- every method behind one interface ---

namespace {

Numbers estimates(const std::string& text, const SharedScene& scene, const Numbers& points, const Numbers& normals,
                  const Integers& on, const std::vector<std::string>& names, int threads, const py::object& progress) {
  const methods::Choice choice = methods::parse(text);
  const ArrayReceivers receivers(points, normals, on);
  const std::vector<Selection> selections = scene.selections(names);
  const std::size_t rows = receivers.count(), columns = selections.size();
  Numbers result({static_cast<py::ssize_t>(rows), static_cast<py::ssize_t>(columns)});
  double* const out = result.mutable_data();
  Interrupt interrupt(progress);
  interrupt.run([&] {
    const auto on_scene = choice.method->prepare(scene.scene());
    std::vector<std::unique_ptr<methods::PreparedSource>> sources;
    std::vector<const methods::PreparedSource*> list;
    for (const Selection& selection : selections) {
      sources.push_back(on_scene->prepare_source(selection));
      list.push_back(sources.back().get());
    }
    batch::form_factors(*on_scene, choice.settings, receivers.in_batch(), list, {threads, interrupt.hooks()},
                        [&](std::size_t i, std::span<const methods::Estimate> found) {
                          std::ranges::transform(found, out + i * columns, &methods::Estimate::form_factor);
                        });
  });
  return result;
}

std::vector<std::string> method_names() {
  std::vector<std::string> names;
  for (const methods::Method* method : methods::all_methods()) names.push_back(method->name);
  return names;
}

}  // namespace

void bind_methods(py::module_& module) {
  module.def("method_names", &method_names);
  module.def(
      "method_description", [](const std::string& name) { return description(methods::method_named(name)); }, "name"_a);
  module.def("estimates", &estimates, "method"_a, "scene"_a, "points"_a, "normals"_a, "on"_a, "sources"_a, "threads"_a,
             "progress"_a);
}

// --- receivers ---

ArrayReceivers::ArrayReceivers(const Numbers& points, const Numbers& normals, const Integers& on)
    : points_(points.unchecked<2>()), normals_(normals.unchecked<2>()), on_(on.unchecked<2>()) {}

void ArrayReceivers::get(std::size_t i, Receiver& receiver) const {
  const auto row = static_cast<py::ssize_t>(i);
  receiver.point = {points_(row, 0), points_(row, 1), points_(row, 2)};
  receiver.normal = {normals_(row, 0), normals_(row, 1), normals_(row, 2)};
  receiver.on.clear();
  for (py::ssize_t k = 0; k < on_.shape(1); ++k) {
    if (on_(row, k) >= 0) receiver.on.push_back(static_cast<FaceId>(on_(row, k)));
  }
}

std::vector<Receiver> ArrayReceivers::list() const {
  std::vector<Receiver> receivers(count());
  for (std::size_t i = 0; i < receivers.size(); ++i) get(i, receivers[i]);
  return receivers;
}

namespace {

using List = std::vector<Receiver>;

Numbers unit_normals_of(const List& list) {
  truth::UnitNormal last;
  return rows_of(list, [&](const Receiver& receiver) { return last.of(receiver.normal); });
}

// Lists of faces as rows of equal length, which end with -1.
template <class Lists, class FacesOf>
Integers padded(const Lists& lists, const FacesOf& faces_of) {
  std::size_t longest = 1;
  for (const auto& one : lists) longest = std::max(longest, faces_of(one).size());
  Integers result({static_cast<py::ssize_t>(lists.size()), static_cast<py::ssize_t>(longest)});
  std::int64_t* out = result.mutable_data();
  for (const auto& one : lists) {
    const std::vector<FaceId>& faces = faces_of(one);
    for (std::size_t k = 0; k < longest; ++k)
      *out++ = k < faces.size() ? static_cast<std::int64_t>(index_of(faces[k])) : -1;
  }
  return result;
}

// On patches or faces, as the flags of the program make them, and what the head of a truth file says of them.
py::tuple make_on(const SharedScene& scene, const std::vector<std::string>& names, const std::string& grid,
                  bool vertices, bool centres, std::uint64_t samples, std::uint64_t seed, bool per_face) {
  flags::ReceiverArguments args;
  args.on = names;
  args.grid = grid;
  args.vertices = vertices;
  args.centres = centres;
  args.per_face = per_face;
  if (samples > 0) {
    args.samples = std::to_string(samples);
    args.sample_seed = std::to_string(seed);
  }
  Interrupt interrupt;
  flags::ChosenReceivers chosen = interrupt.run([&] { return flags::receivers_of(args, scene.scene()); });
  return py::make_tuple(std::make_shared<List>(std::move(chosen.receivers)), shown(chosen.description));
}

List from_arrays(const Numbers& points, const Numbers& normals, const Integers& on, std::vector<std::string> ids) {
  List list = ArrayReceivers(points, normals, on).list();
  for (std::size_t i = 0; i < ids.size() && i < list.size(); ++i) list[i].id = std::move(ids[i]);
  return list;
}

List read_csv(const SharedScene& scene, const std::filesystem::path& path) {
  const py::gil_scoped_release released;
  return read_receivers(path, scene.scene());
}

Integers find(const SharedScene& scene, const Numbers& points, const Numbers& normals, std::optional<double> tolerance,
              int threads) {
  const Integers none(std::vector<py::ssize_t>{points.shape(0), 0});
  const ArrayReceivers receivers(points, normals, none);
  std::vector<std::vector<FaceId>> found(receivers.count());
  Interrupt interrupt;
  interrupt.run([&] {
    batch::find_faces(scene.scene(), receivers.in_batch(), tolerance, {threads, interrupt.hooks()},
                      [&](std::size_t i, const NearFaces& near) { found[i] = near.faces; });
  });
  return padded(
      found, [](const std::vector<FaceId>& faces) -> const auto& { return faces; });
}

std::vector<std::string> misses(const SharedScene& scene, const Numbers& points, const Numbers& normals,
                                const Integers& on) {
  const List list = ArrayReceivers(points, normals, on).list();
  Interrupt interrupt;
  return interrupt.run([&] { return sentences(near_misses(scene.scene(), list), list.size()); });
}

// The receivers of texels that show a face, their rows and columns, and the counts of Charts.
py::tuple of_lightmap(const SharedScene& scene, int width, int height, int set, const std::vector<std::string>& names,
                      bool all) {
  render::Lightmap map{{width, height}, set, {}, 0};
  if (!all) map.on = scene.selections(names);
  auto list = std::make_shared<List>();
  std::vector<std::int64_t> places;
  Interrupt interrupt;
  const render::Charts charts = interrupt.run([&] {
    const render::Atlas atlas(scene.scene(), map);
    for (int row = 0; row < height; ++row) {
      kernel::poll();
      for (int column = 0; column < width; ++column) {
        const std::optional<render::Hit> hit = atlas.hit(column, row);
        if (!hit) continue;
        list->push_back(render::receiver_at(scene.scene(), *hit));
        list->back().id = "x" + std::to_string(column) + "y" + std::to_string(row);
        places.insert(places.end(), {row, column});
      }
    }
    return atlas.charts();
  });
  Integers rows({static_cast<py::ssize_t>(list->size()), py::ssize_t{2}});
  std::ranges::copy(places, rows.mutable_data());
  return py::make_tuple(list, rows, charts.faces, charts.without, charts.flat, charts.outside, charts.missed,
                        charts.overlapping);
}

}  // namespace

void bind_receivers(py::module_& module) {
  py::class_<List, std::shared_ptr<List>>(module, "ReceiverList", py::module_local())
      .def_static("on_faces", &make_on, "scene"_a, "names"_a, "grid"_a, "vertices"_a, "centres"_a, "samples"_a,
                  "seed"_a, "per_face"_a)
      .def_static("from_arrays", &from_arrays, "points"_a, "normals"_a, "on"_a, "ids"_a)
      .def_static("read", &read_csv, "scene"_a, "path"_a)
      .def_static("of_lightmap", &of_lightmap, "scene"_a, "width"_a, "height"_a, "set"_a, "names"_a, "all"_a)
      .def("__len__", [](const List& list) { return list.size(); })
      .def("points", [](const List& list) { return rows_of(list, std::mem_fn(&Receiver::point)); })
      .def("normals", [](const List& list) { return rows_of(list, std::mem_fn(&Receiver::normal)); })
      .def("unit_normals", &unit_normals_of)
      .def("on",
           [](const List& list) {
             return padded(
                 list, [](const Receiver& receiver) -> const auto& { return receiver.on; });
           })
      .def("ids", [](const List& list) {
        py::list ids;
        for (const Receiver& receiver : list) ids.append(shown(receiver.id));
        return ids;
      });
  module.def("find_faces", &find, "scene"_a, "points"_a, "normals"_a, "tolerance"_a, "threads"_a);
  module.def("near_misses", &misses, "scene"_a, "points"_a, "normals"_a, "on"_a);
}

}  // namespace exactff::python
