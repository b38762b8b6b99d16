// Ends of shadow rays for the tests of the sampled module.
#pragma once

#include <cstdint>
#include <vector>

#include "adaptive/sub_patch.h"

namespace exactff::adaptive {

inline RayEnds place(const SubPatch& s, SamplePattern pattern, int rays, std::uint64_t key = 7) {
  SamplePlan plan;
  plan.prepare(pattern, rays);
  RayEnds ends;
  ends.resize(plan.ray_count());
  plan.place(s, key, ends);
  return ends;
}

inline std::vector<Vec3> points(const RayEnds& ends) {
  std::vector<Vec3> result;
  for (std::size_t i = 0; i < static_cast<std::size_t>(ends.count); ++i) {
    result.push_back({ends.x[i], ends.y[i], ends.z[i]});
  }
  return result;
}

}  // namespace exactff::adaptive
