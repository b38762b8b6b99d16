// Form factors at exact points of patches, rounded to receivers of the exact solver (exact.h).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "exactff/exact.h"
#include "view_factors/sight.h"

namespace exactff::view_factors {

// --- Near planes ---

// Points of a part of a patch, rounded to receivers of the exact solver, and what rounding may change.

inline constexpr double kRoundedPoints = 0x1p-30;  // of F: see NearPlanes::round

class NearPlanes {
 public:
  NearPlanes(const ExactScene& scene, const Part& part);

  // The part's face. Pieces in the part's plane neither hide anything from its exact points nor are seen by them.
  [[nodiscard]] FaceId own() const { return own_; }
  [[nodiscard]] const Vec3& normal() const { return normal_; }

  // The nearest doubles to an exact point of the part, in the scene's unit of length. Nothing where they may see other
  // things than the point: where they lie on another side of the plane of a close piece that is nearly in the part's
  // plane, or on another triangle of a face that is not planar, or are less precise than in other units. Any other face
  // in whose plane the point nearly lies is farther away than 2^-20, and is seen within 2^-32 of the horizon or of its
  // edge-on view: less than 2^-30 of F.
  [[nodiscard]] std::optional<Vec3> round(const Point& point) const;

 private:
  const ExactScene* scene_;
  FaceId own_;
  Homogeneous front_;  // the part's plane
  Vec3 normal_;
  std::vector<const ExactPiece*> nearly_;  // nearly in the part's plane, and close to the part
};

// --- Point factors ---

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
