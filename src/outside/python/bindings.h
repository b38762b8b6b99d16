// The parts of the Python module exactff._exactff. The package in exactff/ is what users see: it checks arrays, and its
// docstrings explain everything; this module expects what the package gives it.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <array>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "exactff/exact.h"
#include "exactff/jobs.h"
#include "exactff/methods.h"
#include "exactff/receiver.h"
#include "exactff/scene.h"

PYBIND11_MAKE_OPAQUE(std::vector<exactff::Receiver>)

namespace exactff::python {

namespace py = pybind11;
using py::literals::operator""_a;

using Numbers = py::array_t<double>;
using Integers = py::array_t<std::int64_t>;

// A scene, with the data of the sources that were used last.
class SharedScene {
 public:
  explicit SharedScene(Scene scene) : scene_(std::move(scene)) {}

  [[nodiscard]] const Scene& scene() const { return scene_; }
  [[nodiscard]] std::shared_ptr<const ExactSource> source(const Selection& selection) const;
  // As flags take names (flags::selections_named): patterns, "all", the cells of a divided patch. Every patch that
  // emits, if there are no names. Throws InputError for a name that the scene does not have.
  [[nodiscard]] std::vector<Selection> selections(const std::vector<std::string>& names) const;

 private:
  Scene scene_;
  mutable std::mutex mutex_;
  mutable std::map<std::string, std::shared_ptr<const ExactSource>> sources_;  // by name
};

// Text that may not be UTF-8, such as a message that names a file.
[[nodiscard]] py::str shown(const std::string& text);
// Writes the files, each complete or not at all: all are on disk before the first one gets its name.
void write_whole_files(const std::vector<std::pair<std::filesystem::path, std::string>>& files);
[[nodiscard]] py::tuple to_tuple(const Problem& problem);
[[nodiscard]] py::tuple to_tuple(const Vec3& v);
[[nodiscard]] py::tuple to_tuple(const Rgb& colour);

// An array (n, 3): of each element the vector that `get` finds.
template <class Elements, class Get>
Numbers rows_of(const Elements& elements, const Get& get) {
  Numbers result({static_cast<py::ssize_t>(elements.size()), py::ssize_t{3}});
  double* out = result.mutable_data();
  for (const auto& element : elements) {
    const Vec3& v = get(element);
    for (const double coordinate : {v.x, v.y, v.z}) *out++ = coordinate;
  }
  return result;
}

// Receivers in arrays: points and normals (n, 3), own faces (n, k), where -1 stands for none. Their `get` needs no GIL;
// the arrays must outlive this object.
class ArrayReceivers {
 public:
  ArrayReceivers(const Numbers& points, const Numbers& normals, const Integers& on);

  [[nodiscard]] std::size_t count() const { return static_cast<std::size_t>(points_.shape(0)); }
  void get(std::size_t i, Receiver& receiver) const;
  [[nodiscard]] std::vector<Receiver> list() const;
  [[nodiscard]] batch::Receivers in_batch() const {  // keeps a reference
    return {count(), [this](std::size_t i, Receiver& receiver) { get(i, receiver); }};
  }

 private:
  py::detail::unchecked_reference<double, 2> points_, normals_;
  py::detail::unchecked_reference<std::int64_t, 2> on_;
};

// Name, up, sphere; checked in Python.
using MeasureTuple = std::tuple<std::string, std::array<double, 3>, bool>;
[[nodiscard]] Measure measure_of(const MeasureTuple& measure);

// Ctrl-C and progress while the library computes without the GIL: hooks for work that the thread calls which made this
// object. Signals are looked at in that thread; Python handles them in its main thread alone. What the handler or the
// progress function raises ends the work: afterwards, rethrow() raises it instead of Cancelled.
class Interrupt {
 public:
  explicit Interrupt(py::object progress = py::none());
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  [[nodiscard]] const Hooks& hooks() const { return hooks_; }

  // Calls the function without the GIL and with these hooks.
  template <class Function>
  auto run(const Function& function) {
    if constexpr (std::is_void_v<decltype(function())>) {
      call(function);
      rethrow();
    } else {
      auto result = call(function);
      rethrow();
      return result;
    }
  }

 private:
  using Clock = std::chrono::steady_clock;

  template <class Function>
  auto call(const Function& function) {
    try {
      const py::gil_scoped_release released;
      const HooksOfThread during(hooks_);
      return function();
    } catch (const Cancelled&) {
      rethrow();
      throw;
    }
  }
  [[nodiscard]] bool is_cancelled();
  void tell(const Progress& progress);
  void rethrow();
  void keep(py::error_already_set&& error);

  const std::thread::id caller_ = std::this_thread::get_id();
  py::object progress_;
  Clock::time_point looked_{};
  std::atomic<bool> stop_{false};
  std::optional<py::error_already_set> error_;
  Hooks hooks_;
};

void bind_errors(py::module_& module);
void bind_scene(py::module_& module);
void bind_receivers(py::module_& module);
void bind_form_factors(py::module_& module);
void bind_methods(py::module_& module);
void bind_truth(py::module_& module);
void bind_check(py::module_& module);
void bind_view_factors(py::module_& module);
void bind_radiosity(py::module_& module);

}  // namespace exactff::python
