// Karkanis' two plots (experiments.h).
#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>

#include "exactff/view.h"
#include "experiments/experiments.h"
#include "files/parallel.h"
#include "kernel/statistics.h"
#include "text/phrases.h"

namespace exactff::experiments {
namespace {

using table::counts;
using table::keys;
using table::numbers;
using table::Type;

using text::counted;
using text::rounded;

std::string choice_text(int resolution) { return "hemicube:resolution=" + std::to_string(resolution); }
std::string pixels_text(int resolution) { return std::to_string(resolution) + " × " + std::to_string(resolution); }

// The exact values of single faces, from one sweep over all that the receiver sees (exactff/view.h): the same bits as
// one source after another.
std::vector<double> exact_values(const Scene& scene, const Receiver& receiver, std::span<const Selection> faces) {
  std::vector<double> of_face(scene.faces().size());
  for (const SeenPatch& seen : view(scene, receiver, {.faces = true}).patches) {
    of_face[index_of(*seen.face)] = seen.form_factor.value;
  }
  std::vector<double> values;
  for (const Selection& face : faces) values.push_back(of_face[index_of(face.face.value())]);
  return values;
}

std::vector<double> values_of(std::string_view choice, const Scene& scene, const Receiver& receiver,
                              std::span<const Selection> sources) {
  Bench bench(methods::parse(choice), scene, sources);
  std::vector<double> values;
  for (const methods::Estimate& estimate : bench.look_from(receiver)) values.push_back(estimate.form_factor);
  return values;
}

std::vector<ScatterPoint> points_of_scene(int number, const ScatterSize& size) {
  const KarkanisScene scene = karkanis_scene(size.triangles, static_cast<std::uint64_t>(number));
  std::vector<ScatterPoint> points;
  for (const double exact : exact_values(scene.scene, scene.receiver, scene.triangles)) {
    points.push_back({number, static_cast<int>(points.size()) + 1, exact, {}});
  }
  for (const int resolution : size.resolutions) {
    const auto values = values_of(choice_text(resolution), scene.scene, scene.receiver, scene.triangles);
    for (std::size_t i = 0; i < points.size(); ++i) points[i].hemicube.push_back(values[i]);
  }
  return points;
}

double error_of(const ScatterPoint& point, std::size_t resolution) {
  return std::abs(point.hemicube[resolution] - point.exact) / point.exact;
}

// The form factor of the pixel around the normal, which is the largest one: of side 2 / n at distance 1.
double largest_pixel(int resolution) { return 4.0 / (std::numbers::pi * resolution * resolution); }

struct Counts {
  std::size_t visible = 0;
  std::size_t missed = 0;
  double largest_missed = 0.0;
};

Counts count(std::span<const ScatterPoint> points, std::size_t resolution) {
  Counts counts;
  for (const ScatterPoint& p : points) {
    if (p.exact <= 0.0) continue;
    ++counts.visible;
    if (p.hemicube[resolution] != 0.0) continue;
    ++counts.missed;
    counts.largest_missed = std::max(counts.largest_missed, p.exact);
  }
  return counts;
}

// "10⁻⁴"
std::string power_of_ten(int exponent) { return exponent == 0 ? "1" : "10" + text::superscript(exponent); }

// ---------------------------------------------------------------------------------------------------------- sentences

std::string scene_sentence(std::span<const ScatterPoint> points, const ScatterSize& size) {
  const std::size_t visible = count(points, 0).visible;
  return counted(static_cast<std::uint64_t>(size.scenes), "scene") + " of Karkanis' kind, each of " +
         counted(static_cast<std::uint64_t>(size.triangles), "triangle") +
         " that have the same normal and face one point. " + std::to_string(visible) + " of the " +
         std::to_string(points.size()) +
         " triangles are visible from this point. Their exact form factors are compared with those of a hemicube "
         "with " +
         pixels_text(size.resolutions.front()) + " pixels, which Karkanis used as reference.";
}

std::string missed_sentence(std::span<const ScatterPoint> points, const ScatterSize& size) {
  const Counts counts = count(points, 0);
  return "With " + pixels_text(size.resolutions.front()) + " pixels, the hemicube misses " +
         std::to_string(counts.missed) + " of the visible triangles completely (" +
         text::share(counts.missed, counts.visible) + ").";
}

NumberTable missed_table(std::span<const ScatterPoint> points, const ScatterSize& size) {
  NumberTable table{"Visible triangles that the hemicube misses",
                    {"pixels", "missed", "share", "the largest missed F", "F of the largest pixel"},
                    {}};
  for (std::size_t r = 0; r < size.resolutions.size(); ++r) {
    const Counts counts = count(points, r);
    table.rows.push_back(
        {pixels_text(size.resolutions[r]), std::to_string(counts.missed), text::share(counts.missed, counts.visible),
         counts.missed == 0 ? "" : rounded(counts.largest_missed, 2), rounded(largest_pixel(size.resolutions[r]), 2)});
  }
  return table;
}

NumberTable decades_of(std::span<const ScatterDecade> decades) {
  NumberTable table{"Normalised error |hemicube − exact| / exact, by the size of F",
                    {"F", "triangles", "median", "99th percentile"},
                    {}};
  for (const ScatterDecade& d : decades) {
    table.rows.push_back({power_of_ten(d.exponent) + " to " + power_of_ten(d.exponent + 1), std::to_string(d.visible),
                          percent(d.median), percent(d.p99)});
  }
  return table;
}

std::string trend_sentence(std::span<const ScatterPoint> points, const ScatterSize& size) {
  std::vector<std::string> powers;
  for (std::size_t r = 0; r < size.resolutions.size(); ++r) {
    const std::vector<double> slopes = scatter_slopes(points, size, r);
    if (slopes.size() < 2) continue;
    powers.push_back(slope_text(kernel::mean(slopes)) + " ± " + slope_text(kernel::mean_half_width(slopes)) + " with " +
                     pixels_text(size.resolutions[r]) + " pixels");
  }
  if (powers.empty()) return {};
  return "Karkanis' trend is confirmed: the error falls as the form factor grows. For triangles larger than a pixel, "
         "the normalised error is proportional to F to the power " +
         text::enumerate(powers) + " (95 % confidence intervals over " +
         counted(static_cast<std::uint64_t>(size.scenes), "scene") +
         "). Theory gives −3/4 if errors of a pixel's area add up at random along an outline of length √F. The slope "
         "is a little flatter for two reasons: the outlines of larger triangles are longer, because other triangles "
         "cut them; and triangles hardly larger than a pixel cannot err by much more than 100 %.";
}

// ------------------------------------------------------------------------------------------------------------ figures

page::Figure value_figure(std::span<const ScatterPoint> points, int resolution) {
  Series seen{"seen by the hemicube", {}, 1}, missed{"missed (drawn at the bottom)", {}, 2};
  double low = 1.0, high = 0.0;
  for (const ScatterPoint& p : points) {
    if (p.exact <= 0.0) continue;
    low = std::min(low, p.exact);
    high = std::max(high, p.exact);
    if (p.hemicube.front() > 0.0) seen.points.emplace_back(p.exact, p.hemicube.front());
  }
  double bottom = high;
  for (const auto& point : seen.points) bottom = std::min(bottom, point.second);
  bottom /= 3.0;
  for (const ScatterPoint& p : points) {
    if (p.exact > 0.0 && p.hemicube.front() == 0.0) missed.points.emplace_back(p.exact, bottom);
  }
  const Series diagonal{"hemicube = exact", {{std::max(low, bottom), std::max(low, bottom)}, {high, high}}, 0};
  return {"hemicube-scatter.value", "Hemicube against exact, triangle by triangle",
          "Karkanis' first plot, with " + pixels_text(resolution) +
              " pixels. Crosses at the bottom: visible triangles that the hemicube misses.",
          page::scatter_plot(Axes{.x = "exact form factor",
                                  .y = "form factor by the hemicube",
                                  .extra = {"set yrange [" + text::shortest(bottom / 1.5) + ":*]"}},
                             {diagonal, seen, missed})};
}

page::Figure error_figure(std::span<const ScatterPoint> points, const ScatterSize& size) {
  Series seen{"a triangle", {}, 1}, missed{"missed: error 1", {}, 2}, medians{"median by decade", {}, page::kOverlay};
  for (const ScatterPoint& p : points) {
    if (p.exact > 0.0) (p.hemicube.front() > 0.0 ? seen : missed).points.emplace_back(p.exact, error_of(p, 0));
  }
  for (const ScatterDecade& d : scatter_decades(points, 0)) {
    medians.points.emplace_back(std::pow(10.0, d.exponent + 0.5), d.median);
  }
  const double pixel = largest_pixel(size.resolutions.front());
  const Series theory{"slope −3/4", {{pixel, 1.0}, {1000.0 * pixel, std::pow(1000.0, -0.75)}}, 0};
  return {"hemicube-scatter.error", "Normalised error of the hemicube against the exact value",
          "Karkanis' second plot. The grey line starts at the size of the largest pixel; a smaller triangle is either "
          "hit or missed.",
          page::scatter_plot(Axes{.x = "exact form factor", .y = "|hemicube − exact| / exact"},
                             {theory, seen, missed, medians})};
}

// ------------------------------------------------------------------------------------------------------------- tables

CsvFile point_table(std::span<const ScatterPoint> points, const ScatterSize& size) {
  table::Rows rows =
      rows_of("hemicube-scatter",
              "every triangle of Karkanis' scenes: models karkanis:n=" + std::to_string(size.triangles) +
                  ",floor=0,seed=SCENE, seen from the origin along +z; exact is correctly rounded, 0 where nothing can "
                  "be seen; form_factor is of the method hemicube:resolution=RESOLUTION",
              {keys("scene,triangle", Type::kCount), numbers("exact", table::Strength::kCertified),
               keys("resolution", Type::kCount), estimates("form_factor")});
  for (const ScatterPoint& p : points) {
    for (std::size_t r = 0; r < p.hemicube.size(); ++r) {
      rows << p.scene << p.triangle << p.exact << size.resolutions[r] << p.hemicube[r];
    }
  }
  return csv_file(std::move(rows), "hemicube-scatter.csv", "exact and hemicube form factor of every triangle");
}

CsvFile decade_table(std::span<const ScatterPoint> points, const ScatterSize& size) {
  table::Rows rows =
      rows_of("hemicube-scatter",
              "normalised error |hemicube - exact| / exact of visible triangles, by decades of the exact form factor",
              {keys("resolution", Type::kCount), keys("from,to", Type::kNumber), counts("visible,missed"),
               estimates("median,p99")});
  for (std::size_t r = 0; r < size.resolutions.size(); ++r) {
    for (const ScatterDecade& d : scatter_decades(points, r)) {
      rows << size.resolutions[r] << std::pow(10.0, d.exponent) << std::pow(10.0, d.exponent + 1) << d.visible
           << d.missed << d.median << d.p99;
    }
  }
  return csv_file(std::move(rows), "hemicube-scatter-decades.csv", "hemicube error by decades of the form factor");
}

}  // namespace

std::vector<ScatterPoint> scatter_points(const ScatterSize& size, int threads, const Hooks& hooks) {
  std::vector<std::vector<ScatterPoint>> by_scene(static_cast<std::size_t>(size.scenes));
  files::parallel_for(by_scene.size(), threads, "hemicube-scatter", hooks,
                      [&](std::size_t i) { by_scene[i] = points_of_scene(static_cast<int>(i) + 1, size); });
  std::vector<ScatterPoint> all;
  for (std::vector<ScatterPoint>& points : by_scene) std::ranges::move(points, std::back_inserter(all));
  return all;
}

std::vector<ScatterDecade> scatter_decades(std::span<const ScatterPoint> points, std::size_t resolution) {
  std::map<int, std::vector<double>> errors;
  std::map<int, std::size_t> missed;
  for (const ScatterPoint& p : points) {
    if (p.exact <= 0.0) continue;
    const int exponent = static_cast<int>(std::floor(std::log10(p.exact)));
    errors[exponent].push_back(error_of(p, resolution));
    missed[exponent] += p.hemicube[resolution] == 0.0 ? 1U : 0U;
  }
  std::vector<ScatterDecade> decades;
  for (const auto& [exponent, list] : errors) {
    decades.push_back(
        {exponent, list.size(), missed[exponent], kernel::median(list), kernel::nearest_rank(list, 0.99)});
  }
  return decades;
}

std::vector<double> scatter_slopes(std::span<const ScatterPoint> points, const ScatterSize& size,
                                   std::size_t resolution) {
  constexpr std::size_t kFew = 10;
  std::vector<Points> by_scene(static_cast<std::size_t>(size.scenes));
  const double pixel = largest_pixel(size.resolutions[resolution]);
  for (const ScatterPoint& p : points) {
    if (p.exact <= pixel) continue;
    by_scene[static_cast<std::size_t>(p.scene - 1)].emplace_back(p.exact, error_of(p, resolution));
  }
  std::vector<double> slopes;
  for (const Points& scene : by_scene) {
    const std::optional<double> slope = scene.size() < kFew ? std::nullopt : kernel::fitted_slope(scene);
    if (slope) slopes.push_back(*slope);
  }
  return slopes;
}

Result hemicube_scatter(const ScatterSize& size, int threads, const Hooks& hooks) {
  const std::vector<ScatterPoint> points = scatter_points(size, threads, hooks);
  std::vector<std::string> paragraphs{scene_sentence(points, size), missed_sentence(points, size),
                                      trend_sentence(points, size)};
  std::erase(paragraphs, "");
  return {.name = "hemicube-scatter",
          .title = "Karkanis' two plots: hemicube against exact",
          .paragraphs = std::move(paragraphs),
          .tables = {missed_table(points, size), decades_of(scatter_decades(points, 0))},
          .figures = {value_figure(points, size.resolutions.front()), error_figure(points, size)},
          .values = {point_table(points, size), decade_table(points, size)}};
}

Result hemicube_scatter(const Effort& effort, const Hooks& hooks) {
  ScatterSize size;
  if (effort.abridged) size.scenes = 4;
  return hemicube_scatter(size, effort.threads, hooks);
}

}  // namespace exactff::experiments
