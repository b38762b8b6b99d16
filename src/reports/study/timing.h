// Measures times, with nothing else running.
#pragma once

#include "exactff/study.h"

namespace exactff::study {

// Seconds; kNotTimed where nothing was measured.
struct Times {
  double exact_setup = 0.0;                  // once per source
  double ray_setup = 0.0;                    // once per scene
  std::vector<std::size_t> receivers;        // those that were timed, ascending
  std::vector<double> exact;                 // by receiver
  std::vector<std::vector<double>> samples;  // by setting, then receiver
  std::vector<double> method_setup;          // by ladder
  struct Cell {
    double all = kNotTimed;
    double partly = kNotTimed;
  };
  std::vector<Cell> cells;  // by cell of the methods
};

// Times everything that a study with its values has computed. A time is the median of three calls after a first call
// with the same arguments; if the first call is long, it is the time. Receivers are timed in an order that is spread
// over all of them, until the time reserved for the setting is used up.
[[nodiscard]] Times measure_times(const Study& study, const Hooks& hooks);

// A permutation of the numbers below `count` whose every prefix is spread evenly.
[[nodiscard]] std::vector<std::size_t> spread_order(std::size_t count);

}  // namespace exactff::study
