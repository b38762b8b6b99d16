#include "view_factors/point_factors.h"

namespace exactff::view_factors {
namespace {

// About what they take, measured in crowds.
constexpr std::uint64_t kEffortOfPoint = 100, kEffortOfPlane = 125, kEffortOfCandidate = 15, kEffortOfEdges = 2;

}  // namespace

std::optional<double> PointFactors::at(const Point& point, const NearPlanes& near, const ExactSource& source) {
  const std::optional<Vec3> rounded = near.round(point);
  if (!rounded) return std::nullopt;
  exact_form_factor(scene_, {.point = *rounded, .normal = near.normal(), .on = {near.own()}, .id = {}}, source, {},
                    factor_, workspace_);
  effort_ += kEffortOfPoint;
  for (const PlaneRecord& plane : factor_.planes) {
    effort_ += kEffortOfPlane + kEffortOfCandidate * plane.tree_candidates + kEffortOfEdges * plane.pairs;
  }
  return factor_.value;
}

}  // namespace exactff::view_factors
