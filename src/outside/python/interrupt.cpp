#include "python/interrupt.h"

#include <utility>

namespace exactff::python {
namespace {

constexpr auto kBetweenLooks = std::chrono::milliseconds(10);

}  // namespace

Interrupt::Interrupt(py::object progress) : progress_(std::move(progress)) {
  hooks_.cancelled = [this] { return is_cancelled(); };
  if (!progress_.is_none()) hooks_.progress = [this](const Progress& at) { tell(at); };
}

bool Interrupt::is_cancelled() {
  if (stop_) return true;
  if (std::this_thread::get_id() != caller_) return false;
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

}  // namespace exactff::python
