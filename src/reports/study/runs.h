// Plans, runs and times the settings of a study: those of the sweeps at every receiver, and all of them at the chosen
// receivers. What a setting is planned to cost follows from counted work at fixed prices: no plan depends on a clock.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "exactff/study.h"
#include "jobs/kept_work.h"
#include "study/settings.h"

namespace exactff::study {

// Everything that the exact values of a request depend on.
[[nodiscard]] std::string text_of_exact_values(const Request& request);

// Seconds of one evaluation with this work.
[[nodiscard]] double planned_seconds(const methods::Counters& counters, std::size_t faces);
// Finds the planned seconds of evaluations by doing them.
class Estimator {
 public:
  // A recursion is stopped when it has certainly exceeded `most_seconds`.
  Estimator(const methods::Choice& choice, const PreparedMethod& prepared, double most_seconds);
  // For all sources.
  [[nodiscard]] double seconds_at(const Receiver& receiver);

 private:
  std::size_t faces_;  // of the scene
  ReadySetting setting_;
};

// The settings of the sweeps to leave out: those with the most planned work, but not the base, until the rest fits into
// Request::sweep_budget. In order of decreasing work. Requires exact values and settings. Throws InputError if even the
// base would take far too long.
[[nodiscard]] std::vector<std::size_t> over_budget(const Study& study, const PreparedMethod& adaptive);

// Chooses the receivers of MethodStudy, and plans its ladders, cells and fields. Every rung is evaluated once. A ladder
// ends before the rung that would take more than what is left of MethodSweep::budget. A setting of the sweeps is run
// all the same, with fewer seeds, but never on one or two alone; on a ladder of such settings every rung gets an equal
// share of what is left.
void plan_runs(Study& study, std::vector<Ladder> ladders, PreparedMethods& methods);

// Fills in Study::judged, samples, and the values, statistics and slopes of methods. `study` must have its exact
// values, and the settings and cells that plan_runs() leaves.
void run_settings(Study& study, std::span<const ExactSource> sources, PreparedMethods& methods,
                  const jobs::KeptWork& kept, const Hooks& hooks);

// --- times, measured with nothing else running ---

// Times every setting that a study with its values has run, as MethodCell describes it, and sets all times of the study
// but that of the ray-tracing structure. Which receivers a setting is timed at depends on counted work alone, so that
// its time means the same in every run. Throws std::logic_error if a value is not that of the study.
void measure_times(Study& study, const Hooks& hooks);

// A permutation of the numbers below `count` whose every prefix is spread evenly.
[[nodiscard]] std::vector<std::size_t> spread_order(std::size_t count);

// Every prefix is spread evenly, and has about the same share of receivers that see the source partly.
[[nodiscard]] std::vector<std::size_t> order_of_timing(const std::vector<std::size_t>& receivers,
                                                       const std::vector<ExactRow>& exact);

}  // namespace exactff::study
