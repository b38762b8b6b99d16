#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>

#include "page/gnuplot.h"
#include "stress/report.h"
#include "text/phrases.h"

namespace exactff::stress {

namespace {

using page::Axes;
using page::Points;
using page::Series;

// Errors outside this range are drawn at its ends.
constexpr double kSmallestDrawn = 1e-18;
constexpr double kLargestDrawn = 1e3;

// Indexed by Method.
struct LineLook {
  const char* label;
  int style;
};
constexpr std::array<LineLook, kMethodCount> kLooks = {
    {{"exact", 1}, {"acos", 2}, {"atan2", 3}, {"a×(b−a)", page::kOverlay}, {"Tampieri", 5}, {"as printed", 6}}};

// Up to 10^16 a decade is one unit of the axis, beyond it 1/18 of a unit, so that both ends are readable.
constexpr double kBend = 16.0;
constexpr double kBeyond = 18.0;

double position(double stiffness) {
  const double decade = std::log10(stiffness);
  return decade <= kBend ? decade : kBend + (decade - kBend) / kBeyond;
}

std::string tic_commands(double largest) {
  std::string marks;
  const auto mark = [&](int decade) {
    const std::string label = decade == 0 ? "1" : decade == 1 ? "10" : "10^{" + std::to_string(decade) + "}";
    marks += (marks.empty() ? "'" : ", '") + label + "' " +
             text::shortest(position(std::stod("1e" + std::to_string(decade))));
  };
  const int last = static_cast<int>(std::log10(largest));
  const int step = last < 6 ? 1 : 4;
  for (int decade = 0; decade <= std::min(last, static_cast<int>(kBend)); decade += step) mark(decade);
  for (int decade = 100; decade <= last; decade += 100) mark(decade);
  return "set xtics (" + marks + ')';
}

Points points(const FamilyResult& result, const std::function<double(const Row&)>& y) {
  Points list;
  for (const Row& row : result.rows) list.emplace_back(position(row.stiffness), y(row));
  return list;
}

Series series_of(const FamilyResult& result, Method method, const std::function<double(const Answer&)>& y) {
  const LineLook& look = kLooks[static_cast<std::size_t>(method)];
  return {look.label, points(result, [&](const Row& row) { return y(row.of(method)); }), look.style};
}

// An answer that is refused or not a number is not drawn.
double drawn_error(const Answer& answer) {
  return std::isfinite(answer.error) ? std::clamp(answer.error, kSmallestDrawn, kLargestDrawn) : -1.0;
}

double microseconds(const Answer& answer) { return 1e6 * answer.seconds; }

Axes axes(const FamilyResult& result, const char* y) {
  const double largest = result.rows.back().stiffness;
  Axes a{.x = "stiffness: " + std::string(result.family.stiffness), .y = y, .log_x = false};
  a.extra.push_back(tic_commands(largest));
  a.extra.push_back("set xrange [-0.3:" + text::shortest(position(largest) + 0.3) + ']');
  return a;
}

page::Figure error_figure(const FamilyResult& result) {
  Axes a = axes(result, "relative error");
  a.extra.emplace_back("set yrange [3e-19:3e3]");
  a.extra.emplace_back("set ytics 1e-18,1e3");
  a.extra.emplace_back("unset mytics");
  std::vector<Series> series;
  for (Method method : kMethods) series.push_back(series_of(result, method, drawn_error));
  return {std::string(result.family.name) + ".error", "Error",
          "Errors below 10<sup>−18</sup> and above 10<sup>3</sup> are drawn at these values. A line ends where its "
          "method returns no number or refuses the scene.",
          line_plot(a, series)};
}

page::Figure precision_figure(const FamilyResult& result) {
  Axes a = axes(result, "bits of the certified sum");
  a.log_y = false;
  a.extra.emplace_back("set yrange [0:*]");
  a.extra.emplace_back("unset key");
  const Points bits = points(result, [](const Row& row) { return static_cast<double>(row.precision_bits); });
  return {std::string(result.family.name) + ".bits", "Precision that the proof needed", "",
          line_plot(a, {{"", bits, 1}})};
}

page::Figure time_figure(const FamilyResult& result) {
  const Axes a = axes(result, "time per value, µs");
  std::vector<Series> series;
  for (Method method : {Method::kExact, Method::kAtan2Difference, Method::kAdaptive, Method::kAdaptiveLiteral}) {
    series.push_back(series_of(result, method, microseconds));
  }
  return {std::string(result.family.name) + ".time", "Time", "", line_plot(a, series)};
}

}  // namespace

std::vector<page::Figure> figures(const FamilyResult& result) {
  const auto bits = [](const Row& row) { return row.precision_bits; };
  const bool constant = std::ranges::adjacent_find(result.rows, std::not_equal_to<>{}, bits) == result.rows.end();
  if (constant) return {error_figure(result), time_figure(result)};
  return {error_figure(result), precision_figure(result), time_figure(result)};
}

}  // namespace exactff::stress
