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
    case Outcome::kBuried:
    case Outcome::kReceiverFace:
    case Outcome::kBehind:
    case Outcome::kBelowHorizon:
      break;
  }
  return Sight::kNothing;
}

void take_evenly(std::vector<std::size_t>& chosen, const std::vector<std::size_t>& from, std::size_t count) {
  count = std::min(count, from.size());
  for (std::size_t i = 0; i < count; ++i) chosen.push_back(from[(2 * i + 1) * from.size() / (2 * count)]);
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

std::vector<std::size_t> choose_receivers(const std::vector<ExactRow>& exact, std::size_t count) {
  std::vector<std::size_t> partly, visible;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    if (exact[i].sight == Sight::kPartly) partly.push_back(i);
    if (exact[i].sight == Sight::kVisible) visible.push_back(i);
  }
  const std::size_t of_visible = std::max(count / 3, count - std::min(count, partly.size()));
  std::vector<std::size_t> chosen;
  take_evenly(chosen, visible, of_visible);
  take_evenly(chosen, partly, count - chosen.size());
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

std::string_view to_string(Sight sight) {
  constexpr std::array<std::string_view, 4> kNames = {"faces away", "hidden", "partly hidden", "visible"};
  return kNames[static_cast<std::size_t>(sight)];
}

}  // namespace exactff::study
