// What is proved of the factor of a patch on small tiles of another one, whatever lies between.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "view_factors/factor_bound.h"
#include "view_factors/prepared_patch.h"
#include "view_factors/slope_bound.h"
#include "view_factors/split_strata.h"

namespace exactff::view_factors {

class PatchBounds {
 public:
  // Keeps references.
  PatchBounds(const ExactScene& scene, const SeenParts& seen, const PreparedPatch& from, const PreparedPatch& to);

  // On a tile of a part of `from`, or of a fragment of this part. Without the change if it is not asked for, or useless
  // beside the range.
  [[nodiscard]] Span on(std::size_t part, const Part& fragment, const Tile& tile, bool with_change);
  [[nodiscard]] double range_at(std::size_t part, const Vec3& point) { return range_on(of(part), {&point, 1}); }
  // The same, and the largest change for each unit of the distance from there.
  [[nodiscard]] Span about(std::size_t part, const Vec3& point);

 private:
  struct OfPart {
    bool knows_unhidden = false;
    std::vector<UnhiddenBound> unhidden;  // of each part of `to` that lies before the part, as that does before it
    std::vector<SlopeBound> slopes;       // of those that are seen
    bool slopes_asked = false, has_slopes = false;
  };

  [[nodiscard]] OfPart& of(std::size_t part);
  [[nodiscard]] OfPart& with_slopes(std::size_t part);
  [[nodiscard]] double range_on(const OfPart& of, std::span<const Vec3> corners) const;
  void add_slopes(std::size_t part, OfPart& of);
  template <class Slope>
  [[nodiscard]] static double sum_of(const OfPart& of, const Slope& slope);

  const ExactScene& scene_;
  const SeenParts& seen_;
  const PreparedPatch &from_, &to_;
  std::vector<std::optional<OfPart>> parts_;  // made when asked for
  std::size_t pieces_ = 0;                    // of all slopes
};

}  // namespace exactff::view_factors
