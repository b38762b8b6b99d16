#include "experiments/gradient_differences.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "exactff/models.h"
#include "files/parallel.h"
#include "kernel/statistics.h"
#include "text/phrases.h"

namespace exactff::experiments {

namespace {

using page::Axes;
using page::Series;
using text::duration;
using text::rounded;

constexpr std::string_view kDifferencesStage = "gradient";

// Its floor, its light and its blocks; the walls hide nothing from the floor.
Scene floor_of_cornell_box() {
  SmallScene small;
  small.add("floor", {{552, 0, 0}, {0, 0, 0}, {0, 0, 552}, {552, 0, 552}});
  small.add("light", {{343, 548.75, 227}, {343, 548.75, 332}, {213, 548.75, 332}, {213, 548.75, 227}});
  const auto block = [&](std::string_view name, double height, const std::array<std::array<double, 2>, 4>& base) {
    const auto at = [&](std::size_t i, double y) { return Vec3{base[i][0], y, base[i][1]}; };
    small.add(name, {at(0, height), at(1, height), at(2, height), at(3, height)});
    for (std::size_t i = 0; i < base.size(); ++i) {
      const std::size_t next = (i + 1) % base.size();
      small.add(name, {at(i, height), at(i, 0), at(next, 0), at(next, height)});
    }
  };
  block("short_block", 165, {{{130, 65}, {82, 225}, {240, 272}, {290, 114}}});
  block("tall_block", 330, {{{423, 247}, {265, 296}, {314, 456}, {472, 406}}});
  return small.build();
}

// A scene with a horizontal floor, y being up.
struct Floor {
  std::string name;
  Scene scene;
  Selection source;
  double width = 0.0;  // of the floor
  std::vector<Receiver> receivers;
  std::vector<std::array<double, 2>> slopes;  // dF/dx and dF/dz of each, exact
  std::size_t kinks = 0;
};

Floor make_floor(std::string name, Scene scene, std::string_view source, std::uint64_t count) {
  const Selection selection = scene.select(source);
  Floor place{std::move(name), std::move(scene), selection, 0.0, {}, {}, 0};
  const std::vector<FaceId> floor = place.scene.faces_of(place.scene.select("floor"));
  place.width = std::sqrt(place.scene.face(floor.front()).area);
  const ExactSource exact(place.scene, selection);
  for (Receiver& receiver : sample_receivers(place.scene, floor, count, 1)) {
    const Gradient gradient = *exact_form_factor(place.scene, receiver, exact, {.gradient = true}).gradient;
    if (gradient.kink) {
      ++place.kinks;
      continue;
    }
    place.slopes.push_back({gradient.position[0].value, gradient.position[2].value});
    place.receivers.push_back(std::move(receiver));
  }
  return place;
}

std::vector<Floor> make_floors(const DifferencesSize& size) {
  std::vector<Floor> places;
  places.push_back(make_floor("Cornell box", floor_of_cornell_box(), "light", size.receivers));
  places.push_back(make_floor("room with a blind", models::make_scene("room:n=12"), "window", size.receivers));
  return places;
}

Receiver moved_along_floor(const Receiver& receiver, int axis, double by) {
  Receiver result = receiver;
  (axis == 0 ? result.point.x : result.point.z) += by;
  return result;
}

// The central difference along an axis of the floor. Also the step is rounded: the points are doubles.
double central_difference(Bench& bench, const Receiver& receiver, int axis, double step) {
  const Receiver ahead = moved_along_floor(receiver, axis, step), back = moved_along_floor(receiver, axis, -step);
  const double up = bench.look_from(ahead).front().form_factor, down = bench.look_from(back).front().form_factor;
  const double width = axis == 0 ? ahead.point.x - back.point.x : ahead.point.z - back.point.z;
  return (up - down) / width;
}

DifferenceErrors difference_errors_of(const Floor& place, const std::string& choice, const DifferencesSize& size,
                                      const Hooks& hooks) {
  Bench bench(methods::parse(choice), place.scene, {&place.source, 1});
  DifferenceErrors result{place.name, choice, {}};
  std::vector<double> truths;
  for (const auto& slopes : place.slopes) truths.insert(truths.end(), slopes.begin(), slopes.end());
  const double typical = root_mean_square(truths);
  for (const double step : size.steps) {
    std::vector<double> errors;
    for (std::size_t i = 0; i < place.receivers.size(); ++i) {
      files::require_not_cancelled(hooks);
      for (const int axis : {0, 1}) {
        const double found = central_difference(bench, place.receivers[i], axis, step * place.width);
        errors.push_back((found - place.slopes[i][static_cast<std::size_t>(axis)]) / typical);
      }
    }
    result.rms.push_back(root_mean_square(errors));
  }
  return result;
}

DifferencesStudy differences_study_of(const std::vector<Floor>& places, const DifferencesSize& size, int threads,
                                      const Hooks& hooks) {
  DifferencesStudy study;
  for (const Floor& place : places) {
    study.receivers += place.receivers.size();
    study.kinks += place.kinks;
  }
  const std::size_t count = size.choices.size();
  study.errors.resize(places.size() * count);
  files::parallel_for(study.errors.size(), threads, kDifferencesStage, hooks, [&](std::size_t i) {
    study.errors[i] = difference_errors_of(places[i / count], size.choices[i % count], size, hooks);
  });
  return study;
}

// --- times ---

template <class Call>
double difference_seconds_per(const Floor& place, std::size_t timed, const Call& call) {
  std::vector<double> times;
  const std::size_t step = std::max<std::size_t>(1, place.receivers.size() / timed);
  for (std::size_t i = step / 2; i < place.receivers.size(); i += step) {
    times.push_back(median_seconds([&] { call(place.receivers[i]); }, 3));
  }
  return kernel::mean(times);
}

// One exact gradient.
double exact_gradient_seconds(const Floor& place, std::size_t timed) {
  const ExactSource source(place.scene, place.source);
  Workspace workspace;
  FormFactor result;
  return difference_seconds_per(place, timed, [&](const Receiver& receiver) {
    exact_form_factor(place.scene, receiver, source, {.gradient = true}, result, workspace);
  });
}

// The four values of two central differences.
double seconds_of_differences(const Floor& place, const std::string& choice, std::size_t timed, double step) {
  Bench bench(methods::parse(choice), place.scene, {&place.source, 1});
  return difference_seconds_per(place, timed, [&](const Receiver& receiver) {
    for (const int axis : {0, 1}) (void)central_difference(bench, receiver, axis, step * place.width);
  });
}

struct TimedDifferences {
  const DifferenceErrors* errors = nullptr;
  double seconds = 0.0, exact_seconds = 0.0;
};

// --- what is told ---

std::string differences_sentence(const DifferencesStudy& study) {
  const std::string left_out =
      study.kinks == 0 ? "" : ", without " + text::counted(study.kinks, "other") + " at kinks, where F has none";
  return "Central differences of the form factor along the floor are compared with the exact derivative at " +
         text::counted(study.receivers, "receiver") + " of two scenes" + left_out +
         ". A difference takes two values for each direction, the exact gradient takes one call for all.";
}

// Of each scene.
std::string differences_verdict(const std::vector<TimedDifferences>& rows) {
  const auto error = [](const TimedDifferences& row) { return row.errors->rms[row.errors->best()]; };
  std::vector<const TimedDifferences*> best;
  for (const TimedDifferences& row : rows) {
    if (row.errors->choice == "exact") continue;
    if (best.empty() || best.back()->errors->scene != row.errors->scene) {
      best.push_back(&row);
    } else if (error(row) < error(*best.back())) {
      best.back() = &row;
    }
  }
  std::vector<std::string> found;
  for (const TimedDifferences* row : best) {
    found.push_back("by " + percent(error(*row)) + " in the " + row->errors->scene + " (" + row->errors->choice + ", " +
                    rounded(row->seconds / row->exact_seconds, 2) + " times as long as the exact gradient)");
  }
  if (found.empty()) return {};
  return "At their best steps, the best differences of sampled values are wrong, measured by a typical derivative, " +
         text::enumerate(found) + '.';
}

NumberTable differences_table(const std::vector<TimedDifferences>& rows, const DifferencesSize& size) {
  NumberTable table{"At the best step: error over the root mean square of the true derivatives, and time",
                    {"scene", "values", "best step / width", "RMS error", "time", "exact gradient ×"},
                    {}};
  for (const TimedDifferences& row : rows) {
    const std::size_t best = row.errors->best();
    table.rows.push_back({row.errors->scene, row.errors->choice, rounded(size.steps[best], 2),
                          percent(row.errors->rms[best]), duration(row.seconds),
                          rounded(row.seconds / row.exact_seconds, 2)});
  }
  return table;
}

page::Figure differences_figure(const DifferencesStudy& study, const DifferencesSize& size, const std::string& scene,
                                std::string_view id) {
  std::vector<Series> series;
  int style = 0;
  for (const DifferenceErrors& errors : study.errors) {
    if (errors.scene != scene) continue;
    Series line{errors.choice, {}, ++style};
    for (std::size_t s = 0; s < size.steps.size(); ++s) line.points.emplace_back(size.steps[s], errors.rms[s]);
    series.push_back(std::move(line));
  }
  return {"gradient." + std::string(id), "Finite differences: error against step, " + scene,
          "RMS error of central differences over the root mean square of the true derivatives, against the step over "
          "the width of the floor.",
          page::line_plot(Axes{.x = "step / width", .y = "relative RMS error of the derivative"}, series)};
}

CsvFile differences_values(const DifferencesStudy& study, const DifferencesSize& size) {
  TableWriter table(
      "errors of central differences of the form factor along the floor, over the root mean square of the exact "
      "derivatives",
      {"scene", "values", "step_over_width", "rms"});
  for (const DifferenceErrors& errors : study.errors) {
    for (std::size_t s = 0; s < size.steps.size(); ++s) {
      table.row() << errors.scene << errors.choice << size.steps[s] << errors.rms[s];
    }
  }
  return table.finish("gradient.csv", "errors of finite differences by step");
}

CsvFile differences_times(const std::vector<TimedDifferences>& rows) {
  TableWriter table("seconds per receiver for two central differences, and for one exact gradient; one thread",
                    {"scene", "values", "seconds", "exact_gradient_seconds"});
  for (const TimedDifferences& row : rows) {
    table.row() << row.errors->scene << row.errors->choice << row.seconds << row.exact_seconds;
  }
  return table.finish("gradient-times.csv", "time of finite differences and of exact gradients");
}

}  // namespace

std::size_t DifferenceErrors::best() const {
  return static_cast<std::size_t>(std::ranges::min_element(rms) - rms.begin());
}

DifferencesStudy differences_study(const DifferencesSize& size, int threads, const Hooks& hooks) {
  return differences_study_of(make_floors(size), size, threads, hooks);
}

Result gradient_differences(const DifferencesSize& size, int threads, const Hooks& hooks) {
  files::require_not_cancelled(hooks);
  const std::vector<Floor> places = make_floors(size);
  const DifferencesStudy study = differences_study_of(places, size, threads, hooks);
  std::vector<TimedDifferences> rows;
  for (const Floor& place : places) {
    const double exact = exact_gradient_seconds(place, size.timed);
    for (const DifferenceErrors& errors : study.errors) {
      if (errors.scene != place.name) continue;
      files::require_not_cancelled(hooks);
      rows.push_back(
          {&errors, seconds_of_differences(place, errors.choice, size.timed, size.steps[errors.best()]), exact});
    }
  }
  return {.name = "gradient",
          .title = "Finite differences against exact derivatives",
          .paragraphs = {differences_verdict(rows), differences_sentence(study)},
          .tables = {differences_table(rows, size)},
          .figures = {differences_figure(study, size, places[0].name, "cornell"),
                      differences_figure(study, size, places[1].name, "blind")},
          .values = {differences_values(study, size)},
          .times = {differences_times(rows)}};
}

Result gradient_differences(const Effort& effort, const Hooks& hooks) {
  DifferencesSize size;
  if (!effort.abridged) return gradient_differences(size, effort.threads, hooks);
  size.receivers = 12;
  size.timed = 4;
  return gradient_differences(size, effort.threads, hooks);
}

}  // namespace exactff::experiments
