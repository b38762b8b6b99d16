// Point sets of the unit square for area sampling.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "adaptive/sample_points.h"

namespace exactff::methods {

enum class PointSet {
  kRandom,      // independent
  kStratified,  // one in each of n cells of equal area, in about sqrt(n) rows
  kSobol,       // the first n points of a sequence, shifted modulo 1 by a random vector (Cranley and Patterson 1976)
  kHalton,      // bases 2 and 3
  kR2,          // Roberts' additive recurrence by the plastic number
};

class UnitPoints {
 public:
  UnitPoints(PointSet set, int count);

  // The points of the set, with the random numbers of the stream `key`.
  void place(std::uint64_t key, std::vector<adaptive::UnitPoint>& points);

 private:
  void place_stratified(std::uint64_t key, std::vector<adaptive::UnitPoint>& points);

  PointSet set_;
  int count_;
  std::vector<adaptive::UnitPoint> sequence_;
  adaptive::SamplePlan cells_;
  adaptive::RayEnds ends_;
};

}  // namespace exactff::methods
