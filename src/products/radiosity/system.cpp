#include "radiosity/system.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "kernel/float_environment.h"

namespace exactff::radiosity {
namespace {

using kernel::above;
using kernel::below;

constexpr int kMostSteps = 60;      // each doubles what is added
constexpr double kRounding = 1e-9;  // of an estimate

// The sum over a row of F x for L <= F <= U, x >= 0, rounded outward: L x and U x. A sum of zeros is 0.
double sum_below(std::span<const Entry> row, const Numbers& x) {
  double sum = 0.0;
  for (const Entry& entry : row) {
    if (entry.lower == 0.0 || x[entry.column] == 0.0) continue;
    const double term = std::max(0.0, below(entry.lower * x[entry.column]));
    sum = sum == 0.0 ? term : below(sum + term);
  }
  return sum;
}

double sum_above(std::span<const Entry> row, const Numbers& x) {
  double sum = 0.0;
  for (const Entry& entry : row) {
    if (entry.upper == 0.0 || x[entry.column] == 0.0) continue;
    const double term = above(entry.upper * x[entry.column]);
    sum = sum == 0.0 ? term : above(sum + term);
  }
  return sum;
}

// rho_i times a sum. Zero is exact.
double reflected_above(const System& system, std::size_t i, const Numbers& x) {
  const double sum = sum_above(system.factors.row(i), x), rho = system.reflectances[i];
  return sum == 0.0 || rho == 0.0 ? 0.0 : above(rho * sum);
}
double reflected_below(const System& system, std::size_t i, const Numbers& x) {
  const double sum = sum_below(system.factors.row(i), x), rho = system.reflectances[i];
  return sum == 0.0 || rho == 0.0 ? 0.0 : std::max(0.0, below(rho * sum));
}

// E_i + rho_i (U w)_i, rounded up; E_i + rho_i (L v)_i, rounded down.
double radiosity_above(const System& system, std::size_t i, const Numbers& w) {
  const double reflected = reflected_above(system, i, w), emitted = system.emissions[i];
  return reflected == 0.0 ? emitted : emitted == 0.0 ? reflected : above(emitted + reflected);
}
double radiosity_below(const System& system, std::size_t i, const Numbers& v) {
  const double reflected = reflected_below(system, i, v), emitted = system.emissions[i];
  return reflected == 0.0 ? emitted : emitted == 0.0 ? reflected : below(emitted + reflected);
}

template <class Holds>
bool holds_everywhere(const System& system, const Holds& holds) {
  for (std::size_t i = 0; i < system.factors.size(); ++i) {
    if (!holds(i)) return false;
  }
  return true;
}

}  // namespace

bool is_supersolution(const System& system, const Numbers& w) {
  return holds_everywhere(system, [&](std::size_t i) {
    return std::isfinite(w[i]) && w[i] >= 0.0 && w[i] >= radiosity_above(system, i, w);
  });
}

bool is_subsolution(const System& system, const Numbers& v) {
  return holds_everywhere(system, [&](std::size_t i) {
    return std::isfinite(v[i]) && v[i] >= 0.0 && v[i] <= radiosity_below(system, i, v);
  });
}

bool is_contracting(const System& system, const Numbers& z) {
  return holds_everywhere(
      system, [&](std::size_t i) { return std::isfinite(z[i]) && z[i] > 0.0 && z[i] > reflected_above(system, i, z); });
}

namespace {

// The system of the patches that light may reach (step 1).
struct Reached {
  std::vector<std::uint32_t> patches;
  System system;
};

std::vector<bool> is_reached(const System& all) {
  const std::size_t size = all.factors.size();
  std::vector<bool> reached(size);
  for (std::size_t i = 0; i < size; ++i) reached[i] = all.emissions[i] > 0.0;
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t i = 0; i < size; ++i) {
      if (reached[i] || all.reflectances[i] == 0.0) continue;
      reached[i] = std::ranges::any_of(all.factors.row(i), [&](const Entry& entry) { return reached[entry.column]; });
      changed = changed || reached[i];
    }
  }
  return reached;
}

Reached reached_part(const System& all) {
  const std::vector<bool> reached = is_reached(all);
  Reached part;
  std::vector<std::uint32_t> place(reached.size());
  for (std::size_t i = 0; i < reached.size(); ++i) {
    place[i] = static_cast<std::uint32_t>(part.patches.size());
    if (reached[i]) part.patches.push_back(static_cast<std::uint32_t>(i));
  }
  for (const std::uint32_t i : part.patches) {
    for (const Entry& entry : all.factors.row(i)) {
      if (reached[entry.column]) part.system.factors.add({place[entry.column], entry.lower, entry.value, entry.upper});
    }
    part.system.factors.end_row();
    part.system.reflectances.push_back(all.reflectances[i]);
    part.system.emissions.push_back(all.emissions[i]);
  }
  return part;
}

// Step 2.
std::optional<Numbers> contracting(const System& system) {
  const Numbers ones(system.factors.size(), 1.0);
  Numbers z = approximate_solution(system, &Entry::upper, ones);
  if (!z.empty() && is_contracting(system, z)) return z;
  if (is_contracting(system, ones)) return ones;
  return std::nullopt;
}

// The smallest c with c (I - rho U) z >= defect, in plain doubles.
template <class Defect>
double smallest_step(const System& system, const Numbers& z, const Defect& defect) {
  double step = 0.0;
  for (std::size_t i = 0; i < z.size(); ++i) {
    if (!(defect(i) > 0.0)) continue;
    step = std::max(step, defect(i) / (z[i] - reflected_above(system, i, z)));
  }
  return step;
}

// Step 3.
Numbers upper_bounds(const System& system, const Numbers& z) {
  Numbers start = approximate_solution(system, &Entry::upper, system.emissions);
  if (start.empty()) start = system.emissions;
  for (std::size_t i = 0; i < start.size(); ++i) start[i] = std::max(start[i], system.emissions[i]);
  Numbers w = start;
  double step = smallest_step(system, z, [&](std::size_t i) { return radiosity_above(system, i, w) - w[i]; });
  for (int tries = 0; tries < kMostSteps; ++tries, step *= 2.0) {
    if (is_supersolution(system, w)) return w;
    for (std::size_t i = 0; i < w.size(); ++i) w[i] = start[i] + step * z[i];
  }
  return {};
}

// Step 4.
Numbers lower_bounds(const System& system, const Numbers& z) {
  const Numbers start = approximate_solution(system, &Entry::lower, system.emissions);
  if (start.empty()) return system.emissions;
  Numbers v = start;
  for (std::size_t i = 0; i < v.size(); ++i) v[i] = std::max(start[i], system.emissions[i]);
  double step = smallest_step(system, z, [&](std::size_t i) { return v[i] - radiosity_below(system, i, v); });
  for (int tries = 0; tries < kMostSteps; ++tries, step *= 2.0) {
    if (is_subsolution(system, v)) return v;
    for (std::size_t i = 0; i < v.size(); ++i) v[i] = std::max(start[i] - step * z[i], system.emissions[i]);
  }
  return system.emissions;
}

// Step 5.
template <class Bounce>
Numbers after_a_bounce(const System& system, const Numbers& x, const Bounce& bounce) {
  Numbers result;
  for (std::size_t i = 0; i < x.size(); ++i) result.push_back(bounce(system, i, x));
  return result;
}

// Nothing if it is no light.
Numbers estimate(const System& system) {
  Numbers value = approximate_solution(system, &Entry::value, system.emissions);
  if (value.empty() || std::ranges::min(value) < -kRounding * std::ranges::max(value)) return {};
  for (std::size_t i = 0; i < value.size(); ++i) value[i] = std::max(value[i], system.emissions[i]);
  return value;
}

Numbers spread(const Reached& part, const Numbers& of_part, std::size_t size) {
  Numbers result(size);
  for (std::size_t k = 0; k < of_part.size(); ++k) result[part.patches[k]] = of_part[k];
  return result;
}

}  // namespace

double sum_of_values(std::span<const Entry> row, const Numbers& x) {
  double sum = 0.0;
  for (const Entry& entry : row) sum += entry.value * x[entry.column];
  return sum;
}

SolutionBounds bounds_of(const System& system) {
  const std::size_t size = system.factors.size();
  const Reached part = reached_part(system);
  if (part.patches.empty()) return {Numbers(size), Numbers(size), Numbers(size)};
  SolutionBounds result;
  const Numbers value = estimate(part.system);
  if (!value.empty()) result.value = spread(part, value, size);
  const std::optional<Numbers> z = contracting(part.system);
  if (!z) return result;
  const Numbers w = upper_bounds(part.system, *z);
  if (w.empty()) return result;
  const Numbers v = lower_bounds(part.system, *z);
  result.upper = spread(part, after_a_bounce(part.system, w, radiosity_above), size);
  result.lower = spread(part, after_a_bounce(part.system, v, radiosity_below), size);
  return result;
}

SolutionBounds bounds_of(System system, std::span<const BoundedValue> emissions) {
  const auto of_ends = [&](double BoundedValue::*end) {
    system.emissions.clear();
    for (const BoundedValue& one : emissions) system.emissions.push_back(one.*end);
    return bounds_of(system);
  };
  SolutionBounds low = of_ends(&BoundedValue::lower), middle = of_ends(&BoundedValue::value),
                 high = of_ends(&BoundedValue::upper);
  if (low.upper.empty() || high.upper.empty()) return {};
  return {std::move(middle.value), std::move(low.lower), std::move(high.upper)};
}

std::vector<BoundedValue> irradiances(const Factors& factors, const SolutionBounds& radiosities) {
  const auto& [value, lower, upper] = radiosities;
  std::vector<BoundedValue> all;
  for (std::size_t i = 0; i < factors.size(); ++i) {
    const auto row = factors.row(i);
    const double estimate = value.empty() ? std::numeric_limits<double>::quiet_NaN() : sum_of_values(row, value);
    all.push_back({estimate, sum_below(row, lower), sum_above(row, upper)});
  }
  return all;
}

bool may_have_no_solution(const System& system) {
  return std::ranges::any_of(system.reflectances, [](double rho) { return rho >= 1.0; });
}

}  // namespace exactff::radiosity
