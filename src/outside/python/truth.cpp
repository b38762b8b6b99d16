// Truth files, as `exactff truth` writes them.
#include "exactff/truth.h"

#include <pybind11/stl/filesystem.h>

#include <algorithm>

#include "flags/lists.h"
#include "python/bindings.h"
#include "python/interrupt.h"

namespace exactff::python {
namespace {

jobs::Existing existing_of(const std::string& word) {
  if (word == "resume") return jobs::Existing::kResume;
  return word == "replace" ? jobs::Existing::kReplace : jobs::Existing::kRefuse;
}

py::tuple write_rows(const SharedScene& scene, const std::string& scene_name, const std::vector<Receiver>& receivers,
                     const std::string& receivers_name, const std::vector<std::string>& sources,
                     const std::filesystem::path& file, const std::string& existing,
                     const std::vector<std::string>& columns, int threads, const py::object& progress) {
  const auto wanted = [&](const char* column) { return std::ranges::find(columns, column) != columns.end(); };
  truth::Request request;
  request.scene = &scene.scene();
  request.scene_name = scene_name;
  request.receivers = receivers;
  request.receivers_name = receivers_name;
  std::vector<std::string> patches = sources;
  request.sky = flags::take_sky(scene.scene(), patches);
  if (!request.sky || !patches.empty()) request.sources = scene.selections(patches);
  request.unoccluded = wanted("unoccluded");
  request.visible_fraction = wanted("visible_fraction");
  request.unit_normals = wanted("unit_normals");
  request.uv = wanted("uv");
  request.gradient = wanted("gradient");
  request.threads = threads;
  Interrupt interrupt(progress);
  const truth::Summary summary = interrupt.run([&] {
    return truth::write(std::move(request), file, existing_of(existing),
                        {.progress = interrupt.hooks().progress, .cancelled = interrupt.hooks().cancelled});
  });
  py::list by_status;
  for (const std::uint64_t rows : summary.rows_by_status) by_status.append(rows);
  return py::make_tuple(summary.rows, by_status, summary.resumed, summary.seconds);
}

}  // namespace

void bind_truth(py::module_& module) {
  module.def("write_truth", &write_rows, py::arg("scene"), py::arg("scene_name"), py::arg("receivers"),
             py::arg("receivers_name"), py::arg("sources"), py::arg("file"), py::arg("existing"), py::arg("columns"),
             py::arg("threads"), py::arg("progress"));
}

}  // namespace exactff::python
