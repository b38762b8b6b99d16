// What all parts of the module share: Ctrl-C, exceptions, text; and the module itself.
#include "python/bindings.h"

#include "exactff/error.h"
#include "exactff/version.h"

namespace exactff::python {

Interrupt::Interrupt(py::object progress) : progress_(std::move(progress)) {
  hooks_.cancelled = [this] { return is_cancelled(); };
  if (!progress_.is_none()) hooks_.progress = [this](const Progress& at) { tell(at); };
}

bool Interrupt::is_cancelled() {
  if (stop_) return true;
  if (std::this_thread::get_id() != caller_) return false;
  constexpr auto kBetweenLooks = std::chrono::milliseconds(10);
  const auto now = Clock::now();
  if (now - looked_ < kBetweenLooks) return false;
  looked_ = now;
  const py::gil_scoped_acquire held;
  if (PyErr_CheckSignals() != 0) keep(py::error_already_set());
  return stop_;
}

void Interrupt::tell(const Progress& progress) {
  const py::gil_scoped_acquire held;
  if (stop_) return;
  try {
    progress_(progress.done, progress.total);
  } catch (py::error_already_set& error) {
    keep(std::move(error));
  }
}

void Interrupt::keep(py::error_already_set&& error) {
  if (!error_) error_.emplace(std::move(error));
  stop_ = true;
}

void Interrupt::rethrow() {
  if (!error_) return;
  py::error_already_set error = std::move(*error_);
  error_.reset();
  throw error;
}

namespace {

py::handle input_error;  // lives as long as the interpreter

// InputError with its problems; Cancelled, which is KeyboardInterrupt unless Python itself has raised something
// (Interrupt). pybind11 makes ValueError of std::invalid_argument, RuntimeError of other exceptions.
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

PYBIND11_MODULE(_exactff, module) {
  using namespace exactff::python;
  module.doc() = "The compiled part of the package exactff.";
  module.attr("version") = std::string(exactff::kVersion);
  bind_errors(module);
  bind_scene(module);
  bind_receivers(module);
  bind_form_factors(module);
  bind_methods(module);
  bind_truth(module);
  bind_check(module);
  bind_view_factors(module);
  bind_radiosity(module);
}
