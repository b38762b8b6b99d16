// Colours for the things in a picture: things that touch can be told apart.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exactff/scene.h"

namespace exactff::whole_view {

// Colours are linear, from 0 to 1.
struct Tinted {
  Rgb own;                                   // the colour that it has if it can
  double light = 1.0;                        // colours from the list are multiplied by this
  std::vector<std::uint32_t> touching = {};  // indices; each pair may be listed on one side, or several times
};

// The colour of each. The first one, and then the most colourful ones, keep their own. The others do so if it differs
// from those of all things that they touch; if not, they get the first colour of a list that does.
[[nodiscard]] std::vector<Rgb> distinct_colours(std::span<const Tinted> things);

// How much two colours differ: their distance in Oklab (B. Ottosson, "A perceptual color space for image processing",
// 2020), with half of that in lightness, which slopes change as well. Just noticeable: about 0.02.
[[nodiscard]] double difference_of_colours(const Rgb& a, const Rgb& b);

}  // namespace exactff::whole_view
