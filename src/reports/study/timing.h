// Measures times, with nothing else running.
#pragma once

#include "exactff/study.h"

namespace exactff::study {

// Seconds.
struct Times {
  struct Setting {
    TimeSummary summary;
    std::vector<double> by_receiver;  // at the first of the receivers
    double ratio_low = kNotTimed;     // quartiles, as in MethodCell
    double ratio_high = kNotTimed;
  };
  std::vector<std::size_t> receivers;  // that were timed, in that order
  Setting exact;                       // at all of them
  std::vector<Setting> cells;          // by cell of the methods
  double exact_fastest = 1.0;          // as in Study
  double exact_slowest = 1.0;
  double exact_setup = 0.0;          // once per source
  std::vector<double> method_setup;  // by ladder
};

// Times every setting that a study with its values has run, as MethodCell describes it. Which receivers a setting is
// timed at depends on counted work alone, so that its time means the same in every run. Throws std::logic_error if a
// value is not that of the study.
[[nodiscard]] Times measure_times(const Study& study, const Hooks& hooks);

// A permutation of the numbers below `count` whose every prefix is spread evenly.
[[nodiscard]] std::vector<std::size_t> spread_order(std::size_t count);

// Every prefix is spread evenly, and has about the same share of receivers that see the source partly.
[[nodiscard]] std::vector<std::size_t> order_of_timing(const std::vector<std::size_t>& receivers,
                                                       const std::vector<ExactRow>& exact);

}  // namespace exactff::study
