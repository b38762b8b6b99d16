// Points of a part of a patch, rounded to receivers of the exact solver, and what rounding may change.
#pragma once

#include <optional>
#include <vector>

#include "view_factors/sight.h"

namespace exactff::view_factors {

inline constexpr double kRoundedPoints = 0x1p-30;  // of F: see NearPlanes::round

class NearPlanes {
 public:
  NearPlanes(const ExactScene& scene, const Part& part);

  // The part's face and the faces in its plane that are close to it. They neither hide anything from the exact points
  // nor are seen by them.
  [[nodiscard]] const std::vector<FaceId>& own() const { return own_; }
  [[nodiscard]] const Vec3& normal() const { return normal_; }

  // The nearest doubles to an exact point of the part, in the scene's unit of length. Nothing where they may see other
  // things than the point: where they lie on another side of the plane of a close face that is nearly in the part's
  // plane, or are less precise than in other units. Any other face in whose plane the point nearly lies is farther away
  // than 2^-20, and is seen within 2^-32 of the horizon or of its edge-on view: less than 2^-30 of F.
  [[nodiscard]] std::optional<Vec3> round(const Point& point) const;

 private:
  const ExactScene* scene_;
  std::vector<FaceId> own_;
  Vec3 normal_;
  std::vector<const ExactPiece*> nearly_;  // nearly in the part's plane, and close to the part
};

}  // namespace exactff::view_factors
