#include "experiments/small_emitters.h"

#include <algorithm>
#include <cmath>

#include "exactff/models.h"
#include "files/parallel.h"
#include "kernel/statistics.h"
#include "page/chapter.h"
#include "study/statistics.h"
#include "text/phrases.h"

namespace exactff::experiments {

namespace {

using page::Axes;
using page::Series;
using text::counted;
using text::duration;
using text::rounded;

constexpr std::string_view kSmallEmittersStage = "small-emitters";

struct Hall {
  std::string name;
  Scene scene;
  std::vector<Selection> lamps;
  std::vector<Receiver> receivers;
};

Hall make_hall(const EmittersSize& size) {
  std::string name = "emitters:n=" + std::to_string(size.lamps);
  Scene scene = models::make_scene(name);
  std::vector<Selection> lamps = scene.emitters();
  std::vector<Receiver> receivers = grid_receivers(scene, scene.select("floor"), {size.grid, size.grid});
  return {std::move(name), std::move(scene), std::move(lamps), std::move(receivers)};
}

// The radiosity from all lamps. The lamps are equal, and grey.
double radiosity(const Hall& hall, const Receiver& receiver, std::span<const methods::Estimate> estimates) {
  double sum = 0.0;
  for (std::size_t i = 0; i < estimates.size(); ++i) {
    sum += hall.scene.source_radiosity(hall.lamps[i]).r * estimates[i].form_factor;
  }
  return hall.scene.receiver_reflectance(receiver.on).r * sum;
}

// Indexed by choice, then receiver. Each thread takes blocks of receivers.
std::vector<std::vector<double>> radiosities(const Hall& hall, std::span<const std::string> choices, int threads,
                                             const Hooks& hooks) {
  constexpr std::size_t kBlocks = 8;
  const std::size_t count = hall.receivers.size();
  std::vector<std::vector<double>> all(choices.size(), std::vector<double>(count));
  files::parallel_for(kBlocks * choices.size(), threads, kSmallEmittersStage, hooks, [&](std::size_t task) {
    const std::size_t choice = task / kBlocks, block = task % kBlocks;
    Bench bench(methods::parse(choices[choice]), hall.scene, hall.lamps);
    for (std::size_t i = block * count / kBlocks; i < (block + 1) * count / kBlocks; ++i) {
      files::require_not_cancelled(hooks);
      all[choice][i] = radiosity(hall, hall.receivers[i], bench.look_from(hall.receivers[i]));
    }
  });
  return all;
}

// Seconds per receiver, for all lamps.
double seconds_per_receiver(const Hall& hall, const std::string& choice, int timed) {
  Bench bench(methods::parse(choice), hall.scene, hall.lamps);
  std::vector<double> times;
  const std::size_t step = std::max<std::size_t>(1, hall.receivers.size() / static_cast<std::size_t>(timed));
  for (std::size_t i = step / 2; i < hall.receivers.size(); i += step) {
    times.push_back(median_seconds([&] { (void)bench.look_from(hall.receivers[i]); }, 3));
  }
  return kernel::mean(times);
}

struct Timed {
  const EmitterErrors* errors = nullptr;
  double seconds = 0.0;
};

// ---------------------------------------------------------------------------------------------------------- sentences

std::string scene_sentence(const EmitterStudy& study, const EmittersSize& size) {
  return "A test of Karkanis' conclusion that accurate form factors pay off for small, bright emitters: a hall has " +
         counted(static_cast<std::uint64_t>(size.lamps), "lamp") +
         " of 3 × 3 cm and boxes on its floor. The methods compute the radiosity that all lamps together cause at " +
         counted(study.receivers.size(), "receiver") +
         " on the floor. Errors are in radiosity, divided by the mean radiosity of " + rounded(study.mean) + ".";
}

// The first and the last setting of a method family; null if there is none.
std::pair<const Timed*, const Timed*> ends_of(const std::vector<Timed>& methods, std::string_view family) {
  const Timed* first = nullptr;
  const Timed* last = nullptr;
  for (const Timed& t : methods) {
    if (!t.errors->choice.starts_with(family)) continue;
    if (first == nullptr) first = &t;
    last = &t;
  }
  return {first, last};
}

NumberTable methods_table(const std::vector<Timed>& methods, double exact_seconds) {
  NumberTable table{"All settings: time per receiver for all lamps, and errors over the mean radiosity",
                    {"method", "time", "exact ×", "RMS error", "worst"},
                    {{"exact", duration(exact_seconds), "1", "0 %", "0 %"}}};
  for (const Timed& t : methods) {
    table.rows.push_back({t.errors->choice, duration(t.seconds), rounded(t.seconds / exact_seconds, 2),
                          percent(t.errors->rms), percent(t.errors->worst)});
  }
  return table;
}

const Timed* cheapest_within(const std::vector<Timed>& methods, double error) {
  const Timed* cheapest = nullptr;
  for (const Timed& t : methods) {
    if (t.errors->rms <= error && (cheapest == nullptr || t.seconds < cheapest->seconds)) cheapest = &t;
  }
  return cheapest;
}

std::string in_exact_times(double factor) {
  return factor >= 1.0 ? rounded(factor, 2) + " times as long as the exact method"
                       : percent(factor) + " of the exact method's time";
}

std::string hemicube_verdict(const std::vector<Timed>& methods, double exact_seconds) {
  const auto [coarsest, finest] = ends_of(methods, "hemicube");
  if (finest == nullptr) return {};
  const std::string verdict = finest->seconds > exact_seconds
                                  ? "Compared with the hemicube, his reference, the exact method is worth it: "
                                  : "Compared with the hemicube, his reference: ";
  return verdict + coarsest->errors->choice + " takes " + in_exact_times(coarsest->seconds / exact_seconds) +
         " and has an RMS error of " + percent(coarsest->errors->rms) + "; " + finest->errors->choice + " takes " +
         in_exact_times(finest->seconds / exact_seconds) + " and still has an RMS error of " +
         percent(finest->errors->rms) + ".";
}

std::string ray_verdict(const std::vector<Timed>& methods, double exact_seconds) {
  std::string text =
      "Compared with rays, for which a small lamp is the easiest case, it depends on the required error: ";
  constexpr double kWanted = 1e-3;
  const Timed* cheapest = cheapest_within(methods, kWanted);
  text += "for " + percent(kWanted) + " ";
  return text + (cheapest == nullptr
                     ? "none of these settings is accurate enough."
                     : cheapest->errors->choice + " takes " + in_exact_times(cheapest->seconds / exact_seconds) + ".");
}

NumberTable needs_table(const std::vector<Timed>& methods, double exact_seconds) {
  NumberTable table{"The fastest setting for a required error", {"RMS error", "setting", "time", "exact ×"}, {}};
  for (const double wanted : {1e-2, 1e-3, 1e-4, 1e-5}) {
    const Timed* cheapest = cheapest_within(methods, wanted);
    if (cheapest == nullptr) {
      table.rows.push_back({percent(wanted), "exact", duration(exact_seconds), "1"});
    } else {
      table.rows.push_back({percent(wanted), cheapest->errors->choice, duration(cheapest->seconds),
                            rounded(cheapest->seconds / exact_seconds, 2)});
    }
  }
  return table;
}

// ------------------------------------------------------------------------------------------------------------- figure

page::Figure figure(const std::vector<Timed>& methods, double exact_seconds) {
  std::vector<Series> series;
  int style = 1;
  double low = 1.0, high = 0.0;
  for (const std::string_view family : {"hemicube", "area-sampling", "nettle", "adaptive"}) {
    Series line{std::string(family), {}, ++style};
    for (const Timed& t : methods) {
      if (t.errors->choice.starts_with(family)) line.points.emplace_back(t.seconds, t.errors->rms);
    }
    for (const auto& point : line.points) {
      low = std::min(low, point.second);
      high = std::max(high, point.second);
    }
    series.push_back(std::move(line));
  }
  series.insert(series.begin(), {"exact: no error", {{exact_seconds, low / 3.0}, {exact_seconds, high}}, 1});
  return {"small-emitters.time", "Many small bright lamps: error against time",
          "RMS radiosity error divided by the mean radiosity, against the time per receiver for all lamps, one thread. "
          "The vertical line is the time of the exact method.",
          page::line_plot(Axes{.x = "time per receiver, s", .y = "relative RMS error in radiosity"}, series)};
}

// ------------------------------------------------------------------------------------------------------------- tables

CsvFile value_table(const EmitterStudy& study, const Hall& hall) {
  TableWriter table(
      "radiosity that all lamps of the model " + hall.name + " bring to the floor, exact and by every method",
      {"receiver", "method", "radiosity"});
  const auto put = [&](std::string_view method, const std::vector<double>& values) {
    for (std::size_t i = 0; i < values.size(); ++i) table.row() << study.receivers[i].id << method << values[i];
  };
  put("exact", study.exact);
  for (const EmitterErrors& m : study.methods) put(m.choice, m.radiosity);
  return table.finish("small-emitters.csv", "radiosity under many small lamps, by every method");
}

CsvFile error_table(const EmitterStudy& study) {
  TableWriter table("radiosity errors over the mean exact radiosity of " + text::shortest(study.mean),
                    {"method", "rms", "worst"});
  for (const EmitterErrors& m : study.methods) table.row() << m.choice << m.rms << m.worst;
  return table.finish("small-emitters-errors.csv", "radiosity errors under many small lamps");
}

CsvFile time_table(const std::vector<Timed>& methods, double exact_seconds) {
  TableWriter table("seconds per receiver for all lamps, one thread, after a first call", {"method", "seconds"});
  table.row() << "exact" << exact_seconds;
  for (const Timed& t : methods) table.row() << t.errors->choice << t.seconds;
  return table.finish("small-emitters-times.csv", "time per receiver under many small lamps");
}

EmitterErrors errors_of(const EmitterStudy& study, const std::string& choice, std::vector<double> radiosity) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < study.exact.size(); ++i) errors.push_back((radiosity[i] - study.exact[i]) / study.mean);
  const study::ErrorStatistics statistics = study::error_statistics(errors);
  return {choice, statistics.rms, statistics.worst, std::move(radiosity)};
}

EmitterStudy study_of(const Hall& hall, const EmittersSize& size, int threads, const Hooks& hooks) {
  std::vector<std::string> choices = size.choices;
  choices.insert(choices.begin(), "exact");
  std::vector<std::vector<double>> values = radiosities(hall, choices, threads, hooks);
  EmitterStudy study{hall.receivers, std::move(values.front()), 0.0, {}};
  study.mean = kernel::mean(study.exact);
  for (std::size_t i = 1; i < choices.size(); ++i) {
    study.methods.push_back(errors_of(study, choices[i], std::move(values[i])));
  }
  return study;
}

}  // namespace

EmitterStudy emitter_study(const EmittersSize& size, int threads, const Hooks& hooks) {
  return study_of(make_hall(size), size, threads, hooks);
}

Result small_emitters(const EmittersSize& size, int threads, const Hooks& hooks) {
  const Hall hall = make_hall(size);
  const EmitterStudy study = study_of(hall, size, threads, hooks);
  const double exact_seconds = seconds_per_receiver(hall, "exact", size.timed);
  std::vector<Timed> timed;
  for (const EmitterErrors& m : study.methods) {
    files::require_not_cancelled(hooks);
    timed.push_back({&m, seconds_per_receiver(hall, m.choice, size.timed)});
    if (hooks.progress) hooks.progress({"small-emitters, times", timed.size(), study.methods.size()});
  }
  return {.name = "small-emitters",
          .title = "Many small bright emitters",
          .paragraphs = {scene_sentence(study, size), hemicube_verdict(timed, exact_seconds),
                         ray_verdict(timed, exact_seconds)},
          .tables = {needs_table(timed, exact_seconds), methods_table(timed, exact_seconds)},
          .figures = {figure(timed, exact_seconds)},
          .values = {value_table(study, hall), error_table(study)},
          .times = {time_table(timed, exact_seconds)}};
}

Result small_emitters(const Effort& effort, const Hooks& hooks) {
  EmittersSize size;
  if (!effort.abridged) return small_emitters(size, effort.threads, hooks);
  size.lamps = 64;
  size.grid = 8;
  size.timed = 6;
  std::erase(size.choices, "hemicube:resolution=1024");
  Result result = small_emitters(size, effort.threads, hooks);
  result.left_out.push_back({"a hemicube of 1024 pixels, and a hall with 256 lamps instead of 64", "abridged"});
  return result;
}

}  // namespace exactff::experiments
