#include "study/statistics.h"

#include <iterator>
#include <optional>
#include <utility>

#include "kernel/statistics.h"

namespace exactff::study {
namespace {

constexpr double kRoundingError = 1e-12;  // relative; smaller errors say nothing about a method

// At the chosen receivers that see the source in this way; at all of them without one.
void append(std::vector<double>& errors, const Study& study, const std::vector<double>& of_seed,
            std::optional<Sight> sight) {
  for (std::size_t r = 0; r < of_seed.size(); ++r) {
    if (!sight || study.exact[study.methods.receivers[r]].sight == *sight) errors.push_back(of_seed[r]);
  }
}

std::optional<Slope> slope(const Study& study, std::size_t ladder, Sight sight) {
  std::vector<const MethodCell*> cells;
  for (const MethodCell& cell : study.methods.cells) {
    if (cell.ladder == ladder && cell.work > 0.0) cells.push_back(&cell);
  }
  // Settings of the sweeps may have fewer seeds than the others, and need not be in any order of effort.
  std::erase_if(cells, [&](const MethodCell* cell) { return cell->seeds.size() < cells.front()->seeds.size(); });
  if (cells.size() < 3 || study.methods.ladders[ladder].along.empty()) return std::nullopt;
  const double negligible = kRoundingError * largest_radiosity(study);
  std::vector<double> exponents;
  for (std::size_t seed = 0; seed < cells.front()->seeds.size(); ++seed) {
    std::vector<std::pair<double, double>> points;
    for (const MethodCell* cell : cells) {
      std::vector<double> errors;
      append(errors, study, cell->radiosity_errors[seed], sight);
      const double rms = error_statistics(errors).rms;
      if (rms > negligible) points.emplace_back(cell->work, rms);
    }
    const auto exponent = points.size() == cells.size() ? kernel::fitted_slope(points) : std::nullopt;
    if (exponent) exponents.push_back(*exponent);
  }
  if (exponents.empty()) return std::nullopt;
  const double middle = kernel::mean(exponents), half = kernel::mean_half_width(exponents);
  return Slope{middle, middle - half, middle + half, exponents.size(), cells.size()};
}

}  // namespace

ErrorStatistics error_statistics(std::span<const double> errors) {
  ErrorStatistics result;
  std::vector<double> numbers;
  std::ranges::copy_if(errors, std::back_inserter(numbers), [](double v) { return std::isfinite(v); });
  result.not_a_number = errors.size() - numbers.size();
  result.mean = kernel::mean(numbers);
  for (double& number : numbers) number = std::abs(number);
  const kernel::Distribution magnitudes = kernel::distribution(std::move(numbers));
  result.rms = magnitudes.rms;
  result.p99 = magnitudes.p99;
  result.worst = magnitudes.max;
  return result;
}

void summarise(MethodCell& cell, const Study& study) {
  const auto statistics = [&](std::optional<Sight> sight) {
    std::vector<double> errors;
    for (const std::vector<double>& of_seed : cell.radiosity_errors) append(errors, study, of_seed, sight);
    return error_statistics(errors);
  };
  cell.error = statistics({});
  cell.error_partly = statistics(Sight::kPartly);
  cell.error_visible = statistics(Sight::kVisible);
}

LadderSlopes slopes_of(const Study& study, std::size_t ladder) {
  return {slope(study, ladder, Sight::kPartly), slope(study, ladder, Sight::kVisible)};
}

Summary summarise(const std::vector<SampleRow>& rows, const Study& study, double eps_b) {
  Summary summary;
  std::vector<double> form_factor, radiosity, silent;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const SampleRow& row = rows[i];
    form_factor.push_back(row.error);
    radiosity.push_back(row.radiosity_error);
    if (!(std::abs(row.radiosity_error) <= eps_b)) ++summary.violations;
    summary.leaves += row.leaves;
    summary.rays += row.rays;
    summary.silent_leaves += row.silent_leaves;
    summary.wrong_leaves += row.wrong_leaves;
    summary.silent_receivers += row.silent_leaves + row.wrong_leaves > 0 ? 1 : 0;
  }
  for (const std::size_t i : study.judged) silent.push_back(rows[i].silent_error);
  summary.form_factor = error_statistics(form_factor);
  summary.radiosity = error_statistics(radiosity);
  summary.silent = error_statistics(silent);
  return summary;
}

double largest_radiosity(const Study& study) {
  double largest = 0.0;
  for (const ExactRow& row : study.exact) largest = std::max(largest, row.radiosity.largest());
  return largest;
}

}  // namespace exactff::study
