// Karkanis' two plots (experiments.h).
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>

#include "exactff/exact.h"
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
using text::duration;
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

// --- Karkanis' timings (experiments.h) ---

namespace {

struct HisTime {
  int triangles;
  double seconds;
};
constexpr std::array<HisTime, 4> kHis = {{{50, 0.2}, {100, 2.8}, {200, 300.0}, {500, 8.0 * 3600.0}}};

constexpr std::string_view kKarkanisStage = "karkanis-times";

// ------------------------------------------------------------------------------------------------------- measurements

// Seconds for all patches.
struct TimeRow {
  int triangles = 0;
  double with_shaft = 0.0;
  std::optional<double> without_shaft = {};
  double hemicube = 0.0;
  double rays = 0.0;
};

std::vector<ExactSource> exact_sources(const Scene& scene, std::span<const Selection> sources) {
  std::vector<ExactSource> exact;
  exact.reserve(sources.size());
  for (const Selection& source : sources) exact.emplace_back(scene, source);
  return exact;
}

std::vector<FormFactor> all_patches(const KarkanisScene& scene, const std::vector<ExactSource>& sources,
                                    ShaftCulling culling, const Hooks& hooks) {
  std::vector<FormFactor> results;
  results.reserve(sources.size());
  for (const ExactSource& source : sources) {
    if (results.size() % 64 == 0) files::require_not_cancelled(hooks);
    results.push_back(exact_form_factor(scene.scene, scene.receiver, source, {.culling = culling}));
  }
  return results;
}

double exact_seconds(const KarkanisScene& scene, const std::vector<ExactSource>& sources, ShaftCulling culling,
                     const Hooks& hooks) {
  return median_seconds([&] { (void)all_patches(scene, sources, culling, hooks); });
}

// Measures every k-th source and scales the time to all sources.
double sampled_seconds(const std::string& choice, const KarkanisScene& scene, std::size_t most) {
  std::vector<Selection> some;
  const std::size_t step = std::max<std::size_t>(1, scene.triangles.size() / most);
  for (std::size_t i = step / 2; i < scene.triangles.size(); i += step) some.push_back(scene.triangles[i]);
  Bench bench(methods::parse(choice), scene.scene, some);
  const double seconds = median_seconds([&] { (void)bench.look_from(scene.receiver); }, 3);
  return seconds * static_cast<double>(scene.triangles.size()) / static_cast<double>(some.size());
}

double hemicube_seconds(const KarkanisScene& scene) {
  Bench bench(methods::parse("hemicube"), scene.scene, scene.triangles);
  return median_seconds([&] { (void)bench.look_from(scene.receiver); });
}

std::string rays_choice(int rays) { return "area-sampling:pattern=stratified,samples=" + std::to_string(rays); }

// Extrapolates from the two previous times. For the first two numbers of triangles there is nothing to extrapolate
// from.
double predict_seconds(const std::vector<TimeRow>& rows, int triangles) {
  const TimeRow& last = rows.back();
  if (rows.size() < 2 || !last.without_shaft) return last.without_shaft.value_or(INFINITY);
  const TimeRow& before = rows[rows.size() - 2];
  const double exponent =
      std::max(2.0, local_exponent(before.triangles, *before.without_shaft, last.triangles, *last.without_shaft));
  return *last.without_shaft * std::pow(static_cast<double>(triangles) / last.triangles, exponent);
}

bool affordable_without_shaft(const std::vector<TimeRow>& rows, int triangles, double budget) {
  return rows.empty() || predict_seconds(rows, triangles) <= budget;
}

TimeRow time_row(const TimesSize& size, int triangles, const std::vector<TimeRow>& before, const Hooks& hooks) {
  const KarkanisScene scene = karkanis_scene(triangles, 1);
  const std::vector<ExactSource> sources = exact_sources(scene.scene, scene.triangles);
  TimeRow row{.triangles = triangles};
  row.with_shaft = exact_seconds(scene, sources, ShaftCulling::kTree, hooks);
  if (affordable_without_shaft(before, triangles, size.budget)) {
    row.without_shaft = exact_seconds(scene, sources, ShaftCulling::kNone, hooks);
  }
  row.hemicube = hemicube_seconds(scene);
  row.rays = sampled_seconds(rays_choice(size.rays), scene, size.ray_patches);
  return row;
}

// ---------------------------------------------------------------------------------------------------------- sentences

std::string his_list() {
  std::string text;
  for (std::size_t i = 1; i < kHis.size(); ++i) {
    const double exponent =
        local_exponent(kHis[i - 1].triangles, kHis[i - 1].seconds, kHis[i].triangles, kHis[i].seconds);
    text += (i == 1 ? "" : i + 1 == kHis.size() ? " and " : ", ") + rounded(exponent, 2);
  }
  return text;
}

// The exponent over about the last factor of four, where start-up costs no longer matter.
std::string exponent_between(const std::vector<TimeRow>& rows, const auto& seconds) {
  std::vector<const TimeRow*> measured;
  for (const TimeRow& row : rows) {
    if (seconds(row)) measured.push_back(&row);
  }
  if (measured.size() < 2) return "?";
  const TimeRow& last = *measured.back();
  const TimeRow* first = measured.front();
  for (const TimeRow* row : measured) {
    if (row->triangles * 4 <= last.triangles) first = row;
  }
  return slope_text(local_exponent(first->triangles, *seconds(*first), last.triangles, *seconds(last))) + " (from " +
         std::to_string(first->triangles) + " to " + std::to_string(last.triangles) + " triangles)";
}

std::optional<double> with_shaft(const TimeRow& row) { return row.with_shaft; }
std::optional<double> without_shaft(const TimeRow& row) { return row.without_shaft; }

// "3.7 million", "2100"
std::string large_number(double value) {
  if (value >= 1e6) return rounded(value / 1e6, 2) + " million";
  if (value < 100.0) return rounded(value, 2);
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1.0);
  return rounded(std::round(value / unit) * unit);
}

std::string against_him(const std::vector<TimeRow>& rows) {
  std::string text = "The certified form factors of all triangles from one point, on one thread";
  const auto at = std::ranges::find(rows, kHis.back().triangles, &TimeRow::triangles);
  if (at == rows.end()) return text + '.';
  return text + ", take " + duration(at->with_shaft) + " for " + std::to_string(at->triangles) +
         " triangles, where Karkanis needed about 8 hours on a 300 MHz Pentium II, " +
         large_number(kHis.back().seconds / at->with_shaft) + " times as long.";
}

NumberTable times_table(const std::vector<TimeRow>& rows, const TimesSize& size) {
  NumberTable table{
      "Time for all triangles from one point",
      {"triangles", "exact", "without the shaft", "Karkanis 1999", "hemicube 100", rounded(size.rays) + " rays each"},
      {}};
  for (const TimeRow& row : rows) {
    const auto his = std::ranges::find(kHis, row.triangles, &HisTime::triangles);
    table.rows.push_back({std::to_string(row.triangles), duration(row.with_shaft),
                          row.without_shaft ? duration(*row.without_shaft) : "",
                          his == kHis.end() ? "" : duration(his->seconds), duration(row.hemicube), duration(row.rays)});
  }
  return table;
}

std::string exponents_sentence(const std::vector<TimeRow>& rows) {
  return "The time grows like n to the power " + exponent_between(rows, with_shaft) + ", and without the shaft " +
         exponent_between(rows, without_shaft) + "; Karkanis' local exponents are " + his_list() +
         ". He called this exponential behaviour; it was a property of his algorithm, not of the problem.";
}

std::string others_sentence(const std::vector<TimeRow>& rows, const TimesSize& size) {
  const TimeRow& row = rows.back();
  return "At " + std::to_string(row.triangles) + " triangles, a hemicube of 100 × 100 pixels takes " +
         duration(row.hemicube) + " for all of them together, " + rounded(row.with_shaft / row.hemicube, 2) +
         " times less than the exact method; " + text::rounded(size.rays) + " rays to each triangle take " +
         duration(row.rays) + ", " + rounded(row.rays / row.with_shaft, 2) + " times as much as the exact method.";
}

std::string bits_sentence(const std::vector<WorkRow>& rows) {
  std::size_t compared = 0, differences = 0;
  for (const WorkRow& row : rows) {
    if (!row.differences) continue;
    compared += static_cast<std::size_t>(row.triangles);
    differences += *row.differences;
  }
  if (compared == 0) return {};
  const WorkRow& last =
      *std::find_if(rows.rbegin(), rows.rend(), [](const WorkRow& r) { return r.differences.has_value(); });
  return "The shaft (the convex hull of the receiver and the source, outside of which no face can be an occluder) "
         "changes no bit: " +
         std::to_string(differences) + " of " + std::to_string(compared) +
         " values differ without it. On average it leaves " +
         rounded(static_cast<double>(last.looked_at) / last.triangles, 2) +
         " possible occluders per source in the scene of " + std::to_string(last.triangles) + ", instead of " +
         rounded(static_cast<double>(*last.looked_at_without) / last.triangles, 3) + ".";
}

// ------------------------------------------------------------------------------------------------------------ figures

page::Figure figure(const std::vector<TimeRow>& rows, int rays) {
  Series with{"exact", {}, 1}, without{"exact, no shaft", {}, 3}, his{"Karkanis 1999", {}, 2};
  Series hemicube{"hemicube 100", {}, 4}, sampled{rounded(rays) + " rays each", {}, 5};
  for (const HisTime& time : kHis) his.points.emplace_back(time.triangles, time.seconds);
  for (const TimeRow& row : rows) {
    with.points.emplace_back(row.triangles, row.with_shaft);
    if (row.without_shaft) without.points.emplace_back(row.triangles, *row.without_shaft);
    hemicube.points.emplace_back(row.triangles, row.hemicube);
    sampled.points.emplace_back(row.triangles, row.rays);
  }
  return {"karkanis-times.time", "Time for all patches from one point",
          "Certified values, one thread. Karkanis' times are from a 300 MHz Pentium II.",
          page::line_plot(
              Axes{.x = "triangles, each a source",
                   .y = "time for all of them, s",
                   .extra = {"set xtics (50,100,200,500,1000,2000,5000,10000) rotate by -40", "set format x '%g'"}},
              {his, without, with, sampled, hemicube})};
}

// ------------------------------------------------------------------------------------------------------------- tables

CsvFile time_table(const std::vector<TimeRow>& measured, const TimesSize& size) {
  table::Rows rows = rows_of(
      "karkanis-times",
      "seconds for the form factors of all triangles from one point: models karkanis:n=TRIANGLES,floor=0,"
      "seed=1; one thread, after a first call unless that took more than a second; preparation of scene and sources "
      "not included; rays: " +
          std::to_string(size.rays) + " stratified rays to each, from the time of " + std::to_string(size.ray_patches) +
          " triangles or all",
      {keys("triangles", Type::kCount), estimates("exact,exact_without_shaft,hemicube_100,rays", "s")});
  for (const TimeRow& row : measured) {
    rows << row.triangles << row.with_shaft << row.without_shaft << row.hemicube << row.rays;
  }
  return csv_file(std::move(rows), "karkanis-times.csv", "time for all patches from one point against their number");
}

CsvFile work_table(const std::vector<WorkRow>& measured) {
  table::Rows rows =
      rows_of("karkanis-times",
              "all triangles of karkanis:n=TRIANGLES,floor=0,seed=1 from one point; looked_at: pairs of a source and a "
              "face that may hide it; differences: values that differ without the shaft, empty where not compared",
              {keys("triangles", Type::kCount), counts("visible"), estimates("sum"), counts("looked_at"),
               numbers("looked_at_without_shaft,differences", table::Strength::kProved)});
  for (const WorkRow& row : measured) {
    rows << row.triangles << row.visible << row.sum << row.looked_at << row.looked_at_without << row.differences;
  }
  return csv_file(std::move(rows), "karkanis-times-work.csv", "work and values behind the times");
}

std::vector<LeftOut> left_out(const std::vector<TimeRow>& rows, const TimesSize& size) {
  std::vector<std::string> missing;
  for (const TimeRow& row : rows) {
    if (!row.without_shaft) missing.push_back(std::to_string(row.triangles));
  }
  if (missing.empty()) return {};
  return {{"exact times without the shaft at " + text::enumerate(missing) + " triangles",
           "estimated from the smaller scenes, they would take longer than the budget of " + duration(size.budget)}};
}

}  // namespace

double local_exponent(int n0, double t0, int n1, double t1) {
  return std::log(t1 / t0) / std::log(static_cast<double>(n1) / n0);
}

WorkRow work_row(int triangles, bool compare) {
  const KarkanisScene scene = karkanis_scene(triangles, 1);
  const std::vector<ExactSource> sources = exact_sources(scene.scene, scene.triangles);
  const std::vector<FormFactor> with = all_patches(scene, sources, ShaftCulling::kTree, {});
  WorkRow row{.triangles = triangles};
  for (const FormFactor& f : with) {
    row.visible += f.value > 0.0 ? 1U : 0U;
    row.sum += f.value;
    row.looked_at += f.planes.front().tree_candidates;
  }
  if (!compare) return row;
  const std::vector<FormFactor> without = all_patches(scene, sources, ShaftCulling::kNone, {});
  row.looked_at_without = 0;
  row.differences = 0;
  for (std::size_t i = 0; i < with.size(); ++i) {
    *row.looked_at_without += without[i].planes.front().tree_candidates;
    *row.differences += with[i].value != without[i].value || with[i].status != without[i].status ? 1U : 0U;
  }
  return row;
}

Result karkanis_times(const TimesSize& size, const Hooks& hooks) {
  std::vector<TimeRow> times;
  std::vector<WorkRow> work;
  for (const int triangles : size.triangles) {
    files::require_not_cancelled(hooks);
    work.push_back(work_row(triangles, triangles <= size.same_bits_up_to));
    times.push_back(time_row(size, triangles, times, hooks));
    if (hooks.progress) hooks.progress({kKarkanisStage, times.size(), size.triangles.size()});
  }
  std::vector<std::string> paragraphs{against_him(times), exponents_sentence(times), bits_sentence(work),
                                      others_sentence(times, size)};
  std::erase(paragraphs, "");
  return {.name = "karkanis-times",
          .title = "Karkanis' timings: all patches from one point",
          .paragraphs = std::move(paragraphs),
          .tables = {times_table(times, size)},
          .figures = {figure(times, size.rays)},
          .values = {work_table(work)},
          .times = {time_table(times, size)},
          .left_out = left_out(times, size)};
}

Result karkanis_times(const Effort& effort, const Hooks& hooks) {
  TimesSize size;
  if (effort.abridged) {
    size.triangles = {50, 100, 200, 500};
    size.same_bits_up_to = 200;
    size.budget = 2.0;
    size.rays = 1000;
  }
  Result result = karkanis_times(size, hooks);
  if (effort.abridged) result.left_out.push_back({"Karkanis' scenes above 500 triangles, and 10,000 rays", "abridged"});
  return result;
}

}  // namespace exactff::experiments
