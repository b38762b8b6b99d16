// The hemicube's error against its resolution, its rotation about the normal, and the distance of a source.
//
// Two subjects. The triangles of Karkanis' scenes have edges in every direction. A square light, parallel to the
// hemicube's top with its edges along the rows of pixels, is the worst there is: an edge that moves across a row of
// pixel centres gains or loses the whole row. Turned by an angle, the same light has edges like any other.
//
// Everything is measured in groups that are independent of each other, so that a slope has a confidence interval.
#pragma once

#include "experiments/support.h"

namespace exactff::experiments {

struct ResolutionSize {
  std::vector<double> resolutions = {32, 48, 64, 96, 128, 192, 256, 384, 512, 768, 1024};
  std::vector<double> rotations = {0, 5, 10, 15, 20, 25, 30, 35, 40, 45, 50, 55, 60, 65, 70, 75, 80, 85};  // degrees
  std::vector<double> distances = geometric(1.0, 128.0, 15);  // of a light with sides of 1
  std::size_t groups = 8;  // a scene of Karkanis, seeds 1, 2, ..., or some places of the light
  int triangles = 200;     // of each scene
  int places = 12;         // of the light, in each group
};

// Errors of one group at one place along a curve.
using ErrorsAt = std::function<std::vector<double>(std::size_t group, double at)>;

struct ErrorCurve {
  std::vector<double> at;
  std::vector<double> rms;                        // over all groups
  std::vector<double> median;                     // of magnitudes, over all groups
  std::vector<std::vector<double>> rms_by_group;  // by group, then place
  // Of the log-log line through the places up to `last`.
  [[nodiscard]] SlopeFit slope(double last) const;
};
// What is to be measured along a curve.
struct CurvePlan {
  std::vector<double> at;
  ErrorsAt errors;
};
[[nodiscard]] std::vector<ErrorCurve> error_curves(std::size_t groups, std::span<const CurvePlan> plans, int threads,
                                                   const study::Hooks& hooks);

// All curves. Errors of the triangles are in F; those of the light are relative to its exact value.
struct ResolutionCurves {
  ErrorCurve triangles_by_resolution, aligned_by_resolution, turned_by_resolution;
  ErrorCurve triangles_by_rotation, light_by_rotation;
  ErrorCurve aligned_by_distance, turned_by_distance;
};
[[nodiscard]] ResolutionCurves resolution_curves(const ResolutionSize& size, int threads, const study::Hooks& hooks);

[[nodiscard]] Result hemicube_resolution(const ResolutionSize& size, int threads, const study::Hooks& hooks);
[[nodiscard]] Result hemicube_resolution(const Effort& effort, const study::Hooks& hooks);

}  // namespace exactff::experiments
