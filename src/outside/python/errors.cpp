// Exceptions: InputError with its problems; Cancelled, which is KeyboardInterrupt unless Python itself has raised
// something (Interrupt). pybind11 makes ValueError of std::invalid_argument, RuntimeError of other exceptions.
#include "exactff/error.h"
#include "exactff/progress.h"
#include "python/bindings.h"

namespace exactff::python {
namespace {

py::handle input_error;  // lives as long as the interpreter

void translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const InputError& error) {
    const py::object raised = input_error(shown(error.what()));
    py::tuple problems(error.problems().size());
    for (std::size_t i = 0; i < problems.size(); ++i) problems[i] = to_tuple(error.problems()[i]);
    raised.attr("_problems") = problems;
    PyErr_SetObject(input_error.ptr(), raised.ptr());
  } catch (const Cancelled& cancelled) {
    PyErr_SetString(PyExc_KeyboardInterrupt, cancelled.what());
  }
}

}  // namespace

py::str shown(const std::string& text) {
  PyObject* const decoded = PyUnicode_DecodeUTF8(text.data(), static_cast<Py_ssize_t>(text.size()), "backslashreplace");
  if (decoded == nullptr) throw py::error_already_set();
  return py::reinterpret_steal<py::str>(decoded);
}

py::tuple to_tuple(const Problem& problem) {
  return py::make_tuple(shown(problem.file), problem.line, shown(problem.what), shown(problem.why),
                        shown(problem.suggestion), shown(problem.message()));
}

py::tuple to_tuple(const Vec3& v) { return py::make_tuple(v.x, v.y, v.z); }
py::tuple to_tuple(const Rgb& colour) { return py::make_tuple(colour.r, colour.g, colour.b); }

void bind_errors(py::module_& module) {
  module.def("_set_input_error", [](const py::object& type) { input_error = py::object(type).release(); });
  py::register_exception_translator(translate);
}

}  // namespace exactff::python
