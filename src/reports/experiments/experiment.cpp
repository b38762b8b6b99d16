#include "experiments/experiment.h"

#include <algorithm>

#include "experiments/closure.h"
#include "experiments/gradient_differences.h"
#include "experiments/hemicube_resolution.h"
#include "experiments/hemicube_scatter.h"
#include "experiments/karkanis_times.h"
#include "experiments/meshing.h"
#include "experiments/nettle_rule.h"
#include "experiments/small_emitters.h"
#include "text/names.h"
#include "text/phrases.h"
#include "text/refuse.h"

namespace exactff::experiments {

namespace {

// In the order of the report.
constexpr Experiment kExperiments[] = {
    {"hemicube-scatter", "Karkanis' two plots: hemicube against exact values, triangle by triangle", &hemicube_scatter},
    {"hemicube-resolution", "hemicube error against resolution, rotation and distance", &hemicube_resolution},
    {"karkanis-times", "time for all patches from one point against their number, compared with Karkanis' times",
     &karkanis_times},
    {"nettle-rule", "Nettle's rule: error against the patch's size over its distance", &nettle_rule},
    {"small-emitters", "Karkanis' conclusion: many small bright emitters, in radiosity", &small_emitters},
    {"closure", "a closed room: the form factors from a point to all patches sum to 1", &closure},
    {"gradient", "finite differences of every method against exact derivatives, by step", &gradient_differences},
    {"meshing", "the Cornell box after all bounces: error against the size of cells, down to 1/8 of the box", &meshing},
    {"meshing-fine", "the same down to 1/16: a quarter of an hour", &fine_meshing, true}};

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

}  // namespace exactff::experiments
