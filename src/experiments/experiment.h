// The experiments of the report that are not about one scene with its grid of receivers: what Karkanis and Nettle
// measured or claimed, done again against exact values.
//
// An experiment is one pair of files and one line of list.h. It draws its scenes from fixed seeds and gives sentences,
// figures and tables. Tables of values are the same bytes on every run and for any number of threads; whatever depends
// on the clock is in tables of times and in sentences.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "exactff/study.h"
#include "study/report.h"

namespace exactff::experiments {

struct Effort {
  bool abridged = false;  // a second each, for a first look; else half a minute at most
  int threads = 1;        // for values; times are always of one thread
};

using study::TextTable;
using Result = study::Chapter;

struct Experiment {
  std::string_view name;     // letters, digits and hyphens
  std::string_view summary;  // a line
  Result (*run)(const Effort&, const study::Hooks&) = nullptr;
};

// In the order in which a report shows them.
[[nodiscard]] std::span<const Experiment> all_experiments();

// Throws InputError that names the closest ones.
[[nodiscard]] const Experiment& experiment_named(std::string_view name);

}  // namespace exactff::experiments
