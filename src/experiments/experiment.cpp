#include "experiments/experiment.h"

#include <algorithm>
#include <array>

#include "text/nearest_names.h"
#include "text/phrases.h"
#include "text/refuse.h"

namespace exactff::experiments {

#define EXACTFF_EXPERIMENT(function, name, summary) Result function(const Effort&, const Hooks&);
#include "experiments/list.h"
#undef EXACTFF_EXPERIMENT

namespace {

constexpr std::array kExperiments = {
#define EXACTFF_EXPERIMENT(function, name, summary) Experiment{name, summary, &function},
#include "experiments/list.h"
#undef EXACTFF_EXPERIMENT
};

}  // namespace

std::span<const Experiment> all_experiments() { return kExperiments; }

const Experiment& experiment_named(std::string_view name) {
  const auto found = std::ranges::find(kExperiments, name, &Experiment::name);
  if (found != kExperiments.end()) return *found;
  std::vector<std::string_view> names;
  for (const Experiment& e : kExperiments) names.push_back(e.name);
  std::vector<std::string> near;
  for (const std::string_view n : text::nearest_names(names, name, 3)) near.emplace_back(n);
  text::refuse("there is no experiment '" + std::string(name) + "'", "only known experiments can be run",
               "the closest are " + text::enumerate(near));
}

}  // namespace exactff::experiments
