// How much radiosity varies over the patches of a solution.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "exactff/radiosity.h"
#include "files/parallel.h"
#include "kernel/float_environment.h"
#include "radiosity/gather.h"

namespace exactff::radiosity {
namespace {

// Values of every patch; 0 where a channel has none.
Radiosities values_of(const Solution& solution) {
  Radiosities all{.patches = solution.patches};
  for (std::size_t i = 0; i < solution.patches.size(); ++i) {
    Rgb& rgb = all.value.emplace_back();
    for (std::size_t c = 0; c < kColours.size(); ++c) {
      const double value = solution.channels[c].radiosity[i].value;
      rgb.*kColours[c] = std::isfinite(value) ? value : 0.0;
    }
  }
  all.lower = all.upper = all.value;
  return all;
}

Rgb largest_difference(const Scene& scene, const Gather& gather, const Selection& patch, const Rgb& value,
                       whole_view::Light::Results& results) {
  Rgb largest;
  for (const FaceId face : scene.faces_of(patch)) {
    const auto formula = whole_view::light_formula(scene, std::span(&face, 1), whole_view::FaceSide::kFront,
                                                   Quantity::kRadiosity, KeMeans::kRadiosity);
    for (const Receiver& receiver : probe_receivers(scene, std::span(&face, 1))) {
      if (buried_under(scene, receiver)) continue;
      const auto channels = gather.at(receiver, formula, {}, GatherBounds::kNone, results);
      for (std::size_t c = 0; c < kColours.size(); ++c) {
        double& most = largest.*kColours[c];
        most = std::max(most, std::abs(channels[c].value - value.*kColours[c]));
      }
    }
  }
  return largest;
}

}  // namespace

void set_variation(const Scene& scene, Solution& solution, int threads, const Hooks& hooks) {
  const kernel::StandardArithmetic arithmetic;
  const Radiosities values = values_of(solution);
  const std::size_t patches = values.patches.size();
  for (Channel& channel : solution.channels)
    channel.variation.assign(patches, std::numeric_limits<double>::quiet_NaN());
  if (whole_view::problem_of_strength(scene, sum_of(values.value), {})) return;
  const Gather gather(scene, values, {});
  std::vector<Rgb> found(patches);
  files::parallel_for(patches, threads, "patches", hooks, [&](std::size_t i) {
    whole_view::Light::Results results;
    found[i] = largest_difference(scene, gather, values.patches[i], values.value[i], results);
  });
  for (std::size_t c = 0; c < kColours.size(); ++c) {
    Channel& channel = solution.channels[c];
    if (!std::ranges::all_of(channel.radiosity, [](const auto& b) { return std::isfinite(b.value); })) continue;
    for (std::size_t i = 0; i < patches; ++i) channel.variation[i] = found[i].*kColours[c];
  }
}

}  // namespace exactff::radiosity
