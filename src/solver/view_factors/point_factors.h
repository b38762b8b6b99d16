// Form factors at exact points of patches, by the exact solver (exact.h).
#pragma once

#include <cstdint>
#include <optional>

#include "exactff/exact.h"
#include "view_factors/near_planes.h"

namespace exactff::view_factors {

inline constexpr std::uint64_t kLeastEffort = 225;  // of a point that sees little

class PointFactors {
 public:
  explicit PointFactors(const Scene& scene) : scene_(scene) {}

  // At a point of a part. Nothing where rounding matters (NearPlanes::round).
  std::optional<double> at(const Point& point, const NearPlanes& near, const ExactSource& source);
  // So far, as of Pair::effort.
  [[nodiscard]] std::uint64_t effort() const { return effort_; }

 private:
  const Scene& scene_;
  FormFactor factor_;
  Workspace workspace_;
  std::uint64_t effort_ = 0;
};

}  // namespace exactff::view_factors
