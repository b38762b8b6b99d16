// Karkanis' timings (experiments.h).
#include <algorithm>
#include <array>
#include <cmath>

#include "exactff/exact.h"
#include "experiments/experiments.h"
#include "files/parallel.h"
#include "text/phrases.h"

namespace exactff::experiments {
namespace {

using table::counts;
using table::keys;
using table::numbers;
using table::Type;

using text::duration;
using text::rounded;

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
