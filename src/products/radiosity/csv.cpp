#include <cmath>
#include <optional>

#include "exactff/radiosity.h"
#include "exactff/version.h"
#include "text/csv_row.h"
#include "text/phrases.h"

namespace exactff::radiosity {
namespace {

std::optional<double> if_finite(double value) { return std::isfinite(value) ? std::optional(value) : std::nullopt; }

}  // namespace

std::string csv_text(const Scene& scene, const Solution& solution, const ViewFactorOptions& options) {
  std::string text = "# exactff " + std::string(kVersion) +
                     " radiosity: what leaves each patch after all bounces, in the unit of Ke; areas in the scene's "
                     "unit squared\n# scene hash " +
                     scene.hash() + "; view factors: accuracy " + text::shortest(options.accuracy) + ", budget " +
                     std::to_string(options.budget) +
                     " cells\npatch,channel,radiosity,lower,upper,irradiance,irradiance_lower,irradiance_upper,claim,"
                     "area\n";
  for (std::size_t i = 0; i < solution.patches.size(); ++i) {
    const std::string name = scene.name_of(solution.patches[i]);
    for (std::size_t c = 0; c < solution.channels.size(); ++c) {
      const Channel& channel = solution.channels[c];
      text::CsvRow row(text);
      row << name << kChannelNames[c];
      for (const BoundedValue& q : {channel.radiosity[i], channel.irradiance[i]}) {
        row << if_finite(q.value) << q.lower << if_finite(q.upper);
      }
      row << claim_text(solution, channel) << solution.areas[i];
    }
  }
  return text;
}

}  // namespace exactff::radiosity
