// The experiments of the report that do not concern one scene with its grid of receivers: they repeat what Karkanis and
// Nettle measured or claimed, with exact values, or measure what only exact values can.
//
// An experiment is one pair of files and one line of the list in experiment.cpp. It generates its scenes from fixed
// seeds and returns sentences, figures and tables. Tables of values are the same bytes on every run and for any number
// of threads. Results that depend on the clock are in tables of times and in sentences.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "exactff/study.h"
#include "page/chapter.h"

namespace exactff::experiments {

struct Effort {
  bool abridged = false;  // some seconds each, for a first look; otherwise at most minutes
  int threads = 1;        // for values; times are always measured with one thread
};

using page::CsvFile;
using Result = page::Chapter;

struct Experiment {
  std::string_view name;     // letters, digits and hyphens
  std::string_view summary;  // one line
  Result (*run)(const Effort&, const Hooks&) = nullptr;
  bool by_name_only = false;  // "all" leaves it out: it takes long
};

// In the order of the report.
[[nodiscard]] std::span<const Experiment> all_experiments();

// Throws an InputError that names the closest existing names.
[[nodiscard]] const Experiment& experiment_named(std::string_view name);

}  // namespace exactff::experiments
