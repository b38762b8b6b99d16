// The light at a point from the radiosities of all patches: the sum of B_j F(x, j), F exact.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "exactff/radiosity.h"
#include "whole_view/light.h"

namespace exactff::radiosity {

inline constexpr std::array<double Rgb::*, 3> kColours = {&Rgb::r, &Rgb::g, &Rgb::b};

[[nodiscard]] Rgb sum_of(const std::vector<Rgb>& radiosities);

// Of all numbers.
[[nodiscard]] std::string hash_of(const Radiosities& radiosities);
// "the view factors behind them are estimated", in metadata.
[[nodiscard]] std::string words_of_claim(const Radiosities& radiosities);

enum class GatherBounds { kNone, kAll };

// Immutable; threads may share it. Keeps a reference to the scene.
class Gather {
 public:
  // Throws InputError if radiosities are too large to be added in the scene, called `scene_name`.
  Gather(const Scene& scene, const Radiosities& radiosities, const std::string& scene_name);

  [[nodiscard]] const whole_view::SourceFactors& factors() const { return factors_; }

  // With the patches' values, correctly rounded. With bounds, lower and upper hold the sum for all radiosities within
  // theirs; otherwise they are neighbours of the value. Numbers in the formula must be finite and not negative.
  [[nodiscard]] whole_view::Channels at(const Receiver& receiver, const whole_view::LightFormula& formula,
                                        const ExactOptions& options, GatherBounds bounds,
                                        whole_view::Light::Results& results) const;

 private:
  whole_view::SourceFactors factors_;
  whole_view::Light value_, lower_, upper_;
};

}  // namespace exactff::radiosity
