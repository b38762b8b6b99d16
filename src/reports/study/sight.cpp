#include "study/sight.h"

#include <algorithm>
#include <array>

namespace exactff::study {
namespace {

Sight sight_of(Outcome outcome) {
  switch (outcome) {
    case Outcome::kUnoccluded:
      return Sight::kVisible;
    case Outcome::kPartlyHidden:
      return Sight::kPartly;
    case Outcome::kHiddenByOne:
    case Outcome::kHiddenByUnion:
      return Sight::kHidden;
    case Outcome::kReceiverFace:
    case Outcome::kBehind:
    case Outcome::kBelowHorizon:
      break;
  }
  return Sight::kNothing;
}

}  // namespace

Sight sight_of(const FormFactor& result) {
  Sight sight = Sight::kNothing;
  for (const PlaneRecord& plane : result.planes) sight = joined(sight, sight_of(plane.outcome));
  return sight;
}

Sight joined(Sight a, Sight b) {
  if (a == Sight::kNothing) return b;
  if (b == Sight::kNothing || a == b) return a;
  return Sight::kPartly;
}

bool needs_rays(const FormFactor& result) {
  return std::any_of(result.planes.begin(), result.planes.end(), [](const PlaneRecord& plane) {
    return plane.outcome == Outcome::kPartlyHidden || plane.outcome == Outcome::kHiddenByUnion;
  });
}

std::string_view to_string(Sight sight) {
  constexpr std::array<std::string_view, 4> kNames = {"faces away", "hidden", "partly hidden", "visible"};
  return kNames[static_cast<std::size_t>(sight)];
}

}  // namespace exactff::study
