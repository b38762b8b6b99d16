// The list of experiments, and what several of them share.
#include "experiments/experiments.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <numbers>
#include <utility>

#include "exactff/exact.h"
#include "exactff/models.h"
#include "exactff/view.h"
#include "files/parallel.h"
#include "files/stopwatch.h"
#include "study/settings.h"
#include "text/phrases.h"
#include "text/settings.h"

namespace exactff::experiments {
namespace {

using table::counts;
using table::keys;
using table::numbers;
using table::Type;
using text::counted;
using text::duration;
using text::rounded;

// In the order of the report.
constexpr Experiment kExperiments[] = {{"hemicube-scatter", &hemicube_scatter},
                                       {"karkanis-times", &karkanis_times},
                                       {"meshing", &meshing},
                                       {"meshing-fine", &fine_meshing, true}};

}  // namespace

std::span<const Experiment> all_experiments() { return kExperiments; }

const Experiment& experiment_named(std::string_view name) {
  const auto found = std::ranges::find(kExperiments, name, &Experiment::name);
  if (found != std::end(kExperiments)) return *found;
  std::vector<std::string_view> names;
  for (const Experiment& e : kExperiments) names.push_back(e.name);
  throw text::unknown_name("experiment", name, names);
}

table::Rows rows_of(std::string_view experiment, std::string about, std::initializer_list<table::Columns> columns) {
  table::Head head;
  head.set("about", std::move(about));
  return {"experiment " + std::string(experiment), std::move(head), columns};
}

CsvFile csv_file(table::Rows rows, std::string file, std::string holds) {
  return {std::move(file), std::move(holds), table::csv_text(rows.take())};
}

table::Columns estimates(std::string_view names, std::string unit) {
  return table::numbers(names, table::Strength::kEstimated, std::move(unit));
}

// --- Karkanis ---

// Karkanis' two plots (experiments.h).

namespace {

// Triangles with a common normal that all face the receiver. Each is a source.
struct KarkanisScene {
  Scene scene;
  Receiver receiver;
  std::vector<Selection> triangles;
};

KarkanisScene karkanis_scene(int triangles, std::uint64_t seed) {
  Scene scene = models::make_scene("karkanis:n=" + std::to_string(triangles) + ",floor=0,seed=" + std::to_string(seed));
  std::vector<Selection> sources;
  const Selection all = scene.select("occ");
  for (const FaceId face : scene.faces_of(all)) sources.push_back({all.patch, face, scene.id()});
  return {std::move(scene), {.point = {0, 0, 0}, .normal = {0, 0, 1}, .on = {}, .id = {}}, std::move(sources)};
}

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
  const methods::Choice parsed = methods::parse(choice);
  const study::PreparedMethod prepared(*parsed.method, scene, sources);
  study::ReadySetting setting(prepared, parsed.settings);
  std::vector<double> values;
  for (const methods::Estimate& estimate : setting.look_from(receiver)) values.push_back(estimate.form_factor);
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
  Series seen{"a triangle", {}, 1}, missed{"missed: error 1", {}, 2};
  for (const ScatterPoint& p : points) {
    if (p.exact > 0.0) (p.hemicube.front() > 0.0 ? seen : missed).points.emplace_back(p.exact, error_of(p, 0));
  }
  const double pixel = largest_pixel(size.resolutions.front());
  const Series theory{"slope −3/4", {{pixel, 1.0}, {1000.0 * pixel, std::pow(1000.0, -0.75)}}, 0};
  return {
      "hemicube-scatter.error", "Normalised error of the hemicube against the exact value",
      "Karkanis' second plot. The grey line starts at the size of the largest pixel; a smaller triangle is either "
      "hit or missed.",
      page::scatter_plot(Axes{.x = "exact form factor", .y = "|hemicube − exact| / exact"}, {theory, seen, missed})};
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

}  // namespace

std::vector<ScatterPoint> scatter_points(const ScatterSize& size, int threads, const Hooks& hooks) {
  std::vector<std::vector<ScatterPoint>> by_scene(static_cast<std::size_t>(size.scenes));
  files::parallel_for(by_scene.size(), threads, "hemicube-scatter", hooks,
                      [&](std::size_t i) { by_scene[i] = points_of_scene(static_cast<int>(i) + 1, size); });
  std::vector<ScatterPoint> all;
  for (std::vector<ScatterPoint>& points : by_scene) std::ranges::move(points, std::back_inserter(all));
  return all;
}

Result hemicube_scatter(const ScatterSize& size, int threads, const Hooks& hooks) {
  const std::vector<ScatterPoint> points = scatter_points(size, threads, hooks);
  return {.name = "hemicube-scatter",
          .title = "Karkanis' two plots: hemicube against exact",
          .paragraphs = {scene_sentence(points, size), missed_sentence(points, size)},
          .tables = {missed_table(points, size)},
          .figures = {value_figure(points, size.resolutions.front()), error_figure(points, size)},
          .values = {point_table(points, size)}};
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

// The time of one call in seconds, on a steady clock: the median of up to 5 calls after a warm-up call, as long
// as they take less than a second together. If the first call takes longer than that, its time is the result.
double median_seconds(const std::function<void()>& call) {
  constexpr double kLong = 1.0;
  const double first = files::seconds_of(call);
  return first > kLong ? first : files::median_seconds(call, 5, kLong);
}

double exact_seconds(const KarkanisScene& scene, const std::vector<ExactSource>& sources, ShaftCulling culling,
                     const Hooks& hooks) {
  return median_seconds([&] { (void)all_patches(scene, sources, culling, hooks); });
}

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
  return row;
}

// ---------------------------------------------------------------------------------------------------------- sentences

std::string against_him(const std::vector<TimeRow>& rows) {
  std::string text = "The certified form factors of all triangles from one point, on one thread";
  const auto at = std::ranges::find(rows, kHis.back().triangles, &TimeRow::triangles);
  if (at == rows.end()) return text + '.';
  return text + ", take " + duration(at->with_shaft) + " for " + std::to_string(at->triangles) +
         " triangles, where Karkanis needed about 8 hours on a 300 MHz Pentium II, " +
         rounded(kHis.back().seconds / at->with_shaft, 2) + " times as long.";
}

NumberTable times_table(const std::vector<TimeRow>& rows) {
  NumberTable table{
      "Time for all triangles from one point", {"triangles", "exact", "without the shaft", "Karkanis 1999"}, {}};
  for (const TimeRow& row : rows) {
    const auto his = std::ranges::find(kHis, row.triangles, &HisTime::triangles);
    table.rows.push_back({std::to_string(row.triangles), duration(row.with_shaft),
                          row.without_shaft ? duration(*row.without_shaft) : "",
                          his == kHis.end() ? "" : duration(his->seconds)});
  }
  return table;
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

page::Figure figure(const std::vector<TimeRow>& rows) {
  Series with{"exact", {}, 1}, without{"exact, no shaft", {}, 3}, his{"Karkanis 1999", {}, 2};
  for (const HisTime& time : kHis) his.points.emplace_back(time.triangles, time.seconds);
  for (const TimeRow& row : rows) {
    with.points.emplace_back(row.triangles, row.with_shaft);
    if (row.without_shaft) without.points.emplace_back(row.triangles, *row.without_shaft);
  }
  return {"karkanis-times.time", "Time for all patches from one point",
          "Certified values, one thread. Karkanis' times are from a 300 MHz Pentium II.",
          page::line_plot(
              Axes{.x = "triangles, each a source",
                   .y = "time for all of them, s",
                   .extra = {"set xtics (50,100,200,500,1000,2000,5000,10000) rotate by -40", "set format x '%g'"}},
              {his, without, with})};
}

// ------------------------------------------------------------------------------------------------------------- tables

CsvFile time_table(const std::vector<TimeRow>& measured) {
  table::Rows rows = rows_of(
      "karkanis-times",
      "seconds for the form factors of all triangles from one point: models karkanis:n=TRIANGLES,floor=0,"
      "seed=1; one thread, after a first call unless that took more than a second; preparation of scene and sources "
      "not included",
      {keys("triangles", Type::kCount), estimates("exact,exact_without_shaft", "s")});
  for (const TimeRow& row : measured) rows << row.triangles << row.with_shaft << row.without_shaft;
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
  std::vector<std::string> paragraphs{against_him(times), bits_sentence(work)};
  std::erase(paragraphs, "");
  return {.name = "karkanis-times",
          .title = "Karkanis' timings: all patches from one point",
          .paragraphs = std::move(paragraphs),
          .tables = {times_table(times)},
          .figures = {figure(times)},
          .values = {work_table(work)},
          .times = {time_table(times)},
          .left_out = left_out(times, size)};
}

Result karkanis_times(const Effort& effort, const Hooks& hooks) {
  TimesSize size;
  if (effort.abridged) {
    size.triangles = {50, 100, 200, 500};
    size.same_bits_up_to = 200;
    size.budget = 2.0;
  }
  Result result = karkanis_times(size, hooks);
  if (effort.abridged) result.left_out.push_back({"Karkanis' scenes above 500 triangles", "abridged"});
  return result;
}

}  // namespace exactff::experiments
