// The list of experiments, and what several of them share.
#include "experiments/experiments.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "exactff/models.h"
#include "files/stopwatch.h"
#include "text/names.h"
#include "text/phrases.h"
#include "text/refuse.h"

namespace exactff::experiments {
namespace {

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
  std::vector<std::string> near;
  for (const std::string_view n : text::nearest_names(names, name, 3)) near.emplace_back(n);
  text::refuse("there is no experiment '" + std::string(name) + "'", "only known experiments can be run",
               "the closest are " + text::enumerate(near));
}

KarkanisScene karkanis_scene(int triangles, std::uint64_t seed) {
  Scene scene = models::make_scene("karkanis:n=" + std::to_string(triangles) + ",floor=0,seed=" + std::to_string(seed));
  std::vector<Selection> sources;
  const Selection all = scene.select("occ");
  for (const FaceId face : scene.faces_of(all)) sources.push_back({all.patch, face});
  return {std::move(scene), {.point = {0, 0, 0}, .normal = {0, 0, 1}, .on = {}, .id = {}}, std::move(sources)};
}

double median_seconds(const std::function<void()>& call, std::size_t repeats) {
  constexpr double kLong = 1.0;
  const double first = files::seconds_of(call);
  return first > kLong ? first : files::median_seconds(call, repeats, kLong);
}

std::string slope_text(double slope) {
  const long hundredths = std::lround(std::abs(slope) * 100.0);
  const std::string digits = std::to_string(100 + hundredths % 100).substr(1);
  return (slope < 0.0 && hundredths > 0 ? "−" : "") + std::to_string(hundredths / 100) + '.' + digits;
}

std::string percent(double share) { return text::rounded(100.0 * share, 2) + " %"; }

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

}  // namespace exactff::experiments
