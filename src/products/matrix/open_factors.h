// For each row, what is open: by the cheapest of a few ways that hold.
//
// - Closed surfaces around all that the row sees: nothing.
// - Surfaces around it that are almost closed: no more than their strips let through, if that is within the accuracy.
// - Within a surface with a convex hole and nothing beyond: the factor to the hole (SceneWithSky).
// - If little is there to be seen: the rest that the faces leave of 1, from either side.
// - Otherwise, or if the rest is not accurate: the factor to the sky or the rest, the one that is narrower.
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "exactff/view_factors.h"
#include "matrix/surroundings.h"
#include "view_factors/pairs.h"

namespace exactff::matrix {

class OpenFactors {
 public:
  // Keeps references to the scene and its pairs, whose rows these are.
  OpenFactors(const Scene& scene, std::span<const Selection> from, const ViewFactorOptions& options,
              const view_factors::Pairs& pairs);
  ~OpenFactors();
  OpenFactors(const OpenFactors&) = delete;
  OpenFactors& operator=(const OpenFactors&) = delete;

  // Of the row's patch, without its area. From any thread.
  [[nodiscard]] ViewFactor of_row(std::size_t row) const;

 private:
  class Sides;
  [[nodiscard]] const Sides& sides() const;
  // By the last two ways.
  [[nodiscard]] ViewFactor computed(std::size_t row) const;

  const Scene& scene_;
  std::vector<Selection> from_;
  ViewFactorOptions options_;
  const view_factors::Pairs& pairs_;
  SceneWithSky made_;
  view_factors::Pairs to_sky_;
  std::optional<view_factors::Pairs> to_windows_;
  mutable std::once_flag sides_once_;
  mutable std::unique_ptr<const Sides> sides_;  // made when asked for
};

}  // namespace exactff::matrix
