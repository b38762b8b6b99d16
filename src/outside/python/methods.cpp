// Every method behind one interface.
#include "exactff/methods.h"

#include <algorithm>

#include "exactff/batch.h"
#include "python/bindings.h"
#include "python/interrupt.h"

namespace exactff::python {
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
      "method_description", [](const std::string& name) { return description(methods::method_named(name)); },
      py::arg("name"));
  module.def(
      "method_text", [](const std::string& text) { return methods::parse(text).text(); }, py::arg("text"));
  module.def("estimates", &estimates, py::arg("method"), py::arg("scene"), py::arg("points"), py::arg("normals"),
             py::arg("on"), py::arg("sources"), py::arg("threads"), py::arg("progress"));
}

}  // namespace exactff::python
