// The light of several sources at one point: sums of form factors with weights, correctly rounded in each channel.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "exactff/exact.h"
#include "exactff/view.h"
#include "kernel/ball.h"
#include "whole_view/source_factors.h"

namespace exactff::whole_view {

// One channel is  pi^pi_power (emitted + reflectance * sum over sources of radiosity * F).
struct LightFormula {
  Rgb emitted = {};
  Rgb reflectance{1.0, 1.0, 1.0};
  int pi_power = 0;  // -1, 0 or 1
};

enum class FaceSide { kFront, kBack };
// What a point shows that lies on these faces, of which the first counts: its back reflects as its front, but does not
// emit. A point on no face reflects everything.
[[nodiscard]] LightFormula light_formula(const Scene& scene, std::span<const FaceId> on, FaceSide side,
                                         Quantity quantity, KeMeans ke);
// B_s of each source, or 1 for form factors and for the sky. Throws InputError if the light of the scene, called
// `scene_name`, is negative or so strong that sums could overflow.
[[nodiscard]] std::vector<Rgb> light_weights(const Scene& scene, const SourceFactors& sources, Quantity quantity,
                                             const std::string& scene_name);

// Whether the light of the scene, called `scene_name`, is negative or so strong that sums could overflow. `sum`: of the
// sources' radiosities.
[[nodiscard]] std::optional<Problem> problem_of_strength(const Scene& scene, const Rgb& sum,
                                                         const std::string& scene_name);

struct CertifiedNumber {
  double value = 0.0;  // correctly rounded if certified
  double lower = 0.0;  // if certified, the neighbours of value; both 0 if the number is proved to be 0
  double upper = 0.0;
  bool certified = true;
};
using Channels = std::array<CertifiedNumber, 3>;

// The sources with their weights. Immutable; threads may share it. Keeps a reference to the sources.
class Light {
 public:
  // `radiosities`: one for each source, finite and not negative.
  Light(const SourceFactors& sources, std::vector<Rgb> radiosities);

  // Objects that a thread reuses from point to point.
  struct Results {
    SourceFactors::Results at;      // of the last point
    std::vector<FormFactor> finer;  // the same with more digits, where a channel needed them
  };

  // Computes all form factors, then the channels. Numbers in the formula must be finite and not negative.
  //
  // Raises the precision until both ends of each channel's ball round to the same double. A channel is not certified if
  // a form factor would need more than 65,536 bits for that: if the channel were exactly halfway between two doubles.
  [[nodiscard]] Channels at(const Receiver& receiver, const LightFormula& formula, const ExactOptions& options,
                            Results& results) const;
  // The same from form factors that are there already: those of `results`, of the last at() of any Light with the same
  // sources, at the same receiver with the same options.
  [[nodiscard]] Channels again(const Receiver& receiver, const LightFormula& formula, const ExactOptions& options,
                               Results& results) const;

 private:
  [[nodiscard]] Ball ball(const std::vector<FormFactor>& factors, const LightFormula& formula, int channel,
                          long bits) const;
  [[nodiscard]] CertifiedNumber channel(const Receiver& receiver, const LightFormula& formula, int channel,
                                        const ExactOptions& options, Results& results) const;
  [[nodiscard]] bool is_zero(const std::vector<FormFactor>& factors, const LightFormula& formula, int channel) const;
  [[nodiscard]] bool same_weights(const LightFormula& formula, int a, int b) const;

  const SourceFactors& sources_;
  std::vector<Rgb> radiosities_;
};

}  // namespace exactff::whole_view
