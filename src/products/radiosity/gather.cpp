#include "radiosity/gather.h"

#include <optional>
#include <utility>

#include "text/hashes.h"

namespace exactff::radiosity {

Rgb sum_of(const std::vector<Rgb>& radiosities) {
  Rgb sum;
  for (const Rgb& one : radiosities) sum = {sum.r + one.r, sum.g + one.g, sum.b + one.b};
  return sum;
}

std::string hash_of(const Radiosities& radiosities) {
  text::Fnv1a hash;
  for (const auto* list : {&radiosities.value, &radiosities.lower, &radiosities.upper}) {
    for (const Rgb& one : *list) {
      for (const double v : {one.r, one.g, one.b}) hash.add(v);
    }
  }
  return hash.digits();
}

std::string words_of_claim(const Radiosities& radiosities) {
  return "the view factors behind them are " + std::string(to_string(radiosities.claim));
}

Gather::Gather(const Scene& scene, const Radiosities& radiosities, const std::string& scene_name)
    : factors_(scene, radiosities.patches, whole_view::Sky::kLeftOut),
      value_(factors_, radiosities.value),
      lower_(factors_, radiosities.lower),
      upper_(factors_, radiosities.upper) {
  std::optional<Problem> problem = whole_view::problem_of_strength(scene, sum_of(radiosities.upper), scene_name);
  if (problem) throw InputError(std::move(*problem));
}

whole_view::Channels Gather::at(const Receiver& receiver, const whole_view::LightFormula& formula,
                                const ExactOptions& options, GatherBounds bounds,
                                whole_view::Light::Results& results) const {
  whole_view::Channels channels = value_.at(receiver, formula, options, results);
  if (bounds == GatherBounds::kNone) return channels;
  const whole_view::Channels lower = lower_.again(receiver, formula, options, results);
  const whole_view::Channels upper = upper_.again(receiver, formula, options, results);
  for (std::size_t c = 0; c < channels.size(); ++c) {
    channels[c].lower = lower[c].lower;
    channels[c].upper = upper[c].upper;
  }
  return channels;
}

}  // namespace exactff::radiosity
