// Radiosities after all bounces.
#include "exactff/radiosity.h"

#include <algorithm>

#include "python/bindings.h"
#include "python/interrupt.h"
#include "radiosity/narrowing.h"

namespace exactff::python {
namespace {

using radiosity::Channel;
using radiosity::Solution;

constexpr std::size_t kNumbers = 6;  // radiosity: value, lower, upper; irradiance likewise

// (patches, channels, kNumbers).
Numbers quantities_of(const Solution& solution) {
  const std::size_t channels = solution.channels.size();
  Numbers array({solution.patches.size(), channels, kNumbers});
  auto entry = array.mutable_unchecked<3>();
  for (std::size_t c = 0; c < channels; ++c) {
    for (std::size_t i = 0; i < solution.patches.size(); ++i) {
      const radiosity::BoundedValue &b = solution.channels[c].radiosity[i], &h = solution.channels[c].irradiance[i];
      std::size_t k = 0;
      for (const double number : {b.value, b.lower, b.upper, h.value, h.lower, h.upper}) {
        entry(static_cast<py::ssize_t>(i), static_cast<py::ssize_t>(c), static_cast<py::ssize_t>(k++)) = number;
      }
    }
  }
  return array;
}

// For each channel the bounds of what is emitted, absorbed, meets backs, leaves, and does either of these two.
py::list balance_of(const Solution& solution) {
  py::list list;
  for (const Channel& channel : solution.channels) {
    const radiosity::Balance& b = channel.balance;
    py::list parts;
    for (const matrix::Sum& sum : {b.emitted, b.absorbed, b.back, b.open, b.lost}) {
      parts.append(py::make_tuple(sum.lower, sum.upper));
    }
    list.append(parts);
  }
  return list;
}

// Between patches; others only serve the balance.
std::size_t wide_entries(const matrix::Matrix& matrix) {
  const auto is_wide = [](const ViewFactor& f) { return !f.accurate; };
  return static_cast<std::size_t>(std::ranges::count_if(matrix.factors.entries, is_wide));
}

// Names, areas, quantities, reasons for no bound, claim, balance, its claim, reasons against it, wide view factors, the
// widest bounds, view factors computed again.
py::tuple radiosity_of(const SharedScene& scene, std::optional<double> accuracy, std::size_t budget,
                       std::optional<double> width, bool backs, int threads, const py::object& progress) {
  const Scene& in = scene.scene();
  Interrupt interrupt(progress);
  std::size_t wide = 0;
  const Solution solution = interrupt.run([&] {
    const std::vector<Selection> patches = radiosity::patches_of(in);
    radiosity::Options options{.factors = {.budget = budget}, .width = width, .backs = backs, .threads = threads};
    if (width) options.factors.accuracy = radiosity::accuracy_for(*width);
    if (accuracy) options.factors.accuracy = *accuracy;
    matrix::Matrix matrix =
        matrix::compute(in, patches, patches, radiosity::matrix_options(options), interrupt.hooks());
    Solution solved = radiosity::solve_within(in, matrix, options, nullptr, interrupt.hooks());
    wide = wide_entries(matrix);
    return solved;
  });
  std::vector<std::string> names, no_bound;
  for (const Selection& patch : solution.patches) names.push_back(in.name_of(patch));
  for (const Channel& channel : solution.channels) no_bound.push_back(channel.no_bound);
  return py::make_tuple(names, solution.areas, quantities_of(solution), no_bound,
                        std::string(to_string(solution.claim)), balance_of(solution),
                        std::string(to_string(solution.claim_of_balance)), solution.reasons_against_balance, wide,
                        widest_bounds(solution).share, solution.computed_again);
}

}  // namespace

void bind_radiosity(py::module_& module) {
  module.def("radiosity", &radiosity_of, py::arg("scene"), py::arg("accuracy"), py::arg("budget"), py::arg("width"),
             py::arg("backs"), py::arg("threads"), py::arg("progress"));
}

}  // namespace exactff::python
