#include "flags/receivers.h"

#include <pybind11/stl/filesystem.h>

#include <algorithm>

#include "exactff/batch.h"
#include "exactff/receiver.h"
#include "python/bindings.h"
#include "python/interrupt.h"
#include "truth/unit_normal.h"

namespace exactff::python {

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

Numbers rows_of(const List& list, Vec3 Receiver::*field) {
  Numbers result({static_cast<py::ssize_t>(list.size()), py::ssize_t{3}});
  double* out = result.mutable_data();
  for (const Receiver& receiver : list) {
    *out++ = (receiver.*field).x;
    *out++ = (receiver.*field).y;
    *out++ = (receiver.*field).z;
  }
  return result;
}

Numbers unit_normals_of(const List& list) {
  List unit(list.size());
  truth::UnitNormal last;
  for (std::size_t i = 0; i < list.size(); ++i) unit[i].normal = last.of(list[i].normal);
  return rows_of(unit, &Receiver::normal);
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

}  // namespace

void bind_receivers(py::module_& module) {
  py::class_<List, std::shared_ptr<List>>(module, "ReceiverList", py::module_local())
      .def_static("on_faces", &make_on, py::arg("scene"), py::arg("names"), py::arg("grid"), py::arg("vertices"),
                  py::arg("centres"), py::arg("samples"), py::arg("seed"), py::arg("per_face"))
      .def_static("from_arrays", &from_arrays, py::arg("points"), py::arg("normals"), py::arg("on"), py::arg("ids"))
      .def_static("read", &read_csv, py::arg("scene"), py::arg("path"))
      .def("__len__", [](const List& list) { return list.size(); })
      .def("points", [](const List& list) { return rows_of(list, &Receiver::point); })
      .def("normals", [](const List& list) { return rows_of(list, &Receiver::normal); })
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
  module.def("find_faces", &find, py::arg("scene"), py::arg("points"), py::arg("normals"), py::arg("tolerance"),
             py::arg("threads"));
  module.def("near_misses", &misses, py::arg("scene"), py::arg("points"), py::arg("normals"), py::arg("on"));
}

}  // namespace exactff::python
