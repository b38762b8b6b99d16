// Ctrl-C and progress while the library computes without the GIL.
#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <chrono>
#include <optional>
#include <thread>
#include <type_traits>

#include "exactff/progress.h"

namespace exactff::python {

namespace py = pybind11;

// Hooks for work that the thread calls which made this object. Signals are looked at in that thread; Python handles
// them in its main thread alone. What the handler or the progress function raises ends the work: afterwards, rethrow()
// raises it instead of Cancelled.
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

}  // namespace exactff::python
