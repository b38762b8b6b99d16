// The error of the hemicube against its resolution, its rotation about the normal, and the distance of a source.
//
// There are two subjects. The triangles of Karkanis' scenes have edges in every direction. A square light that is
// parallel to the hemicube's top, with its edges along the rows of pixels, is the worst case: an edge that moves across
// a row of pixel centres gains or loses the whole row. If the same light is rotated by an angle, its edges are like any
// others.
//
// Everything is measured in independent groups, so that slopes have confidence intervals.
#pragma once

#include "experiments/support.h"

namespace exactff::experiments {

struct ResolutionSize {
  std::vector<double> resolutions = {32, 48, 64, 96, 128, 192, 256, 384, 512, 768, 1024};
  std::vector<double> rotations = {0, 5, 10, 15, 20, 25, 30, 35, 40, 45, 50, 55, 60, 65, 70, 75, 80, 85};  // degrees
  std::vector<double> distances = geometric(1.0, 128.0, 15);  // of a light of side 1
  std::size_t groups = 8;  // a group is one scene of Karkanis (seeds 1, 2, ...) or several places below the light
  int triangles = 200;     // of each scene
  int places = 12;         // of the receiver below the light, in each group
};

// The errors of one group at one place along a curve.
using ErrorsAt = std::function<std::vector<double>(std::size_t group, double at)>;

// What to measure along a curve.
struct CurvePlan {
  std::vector<double> at;
  ErrorsAt errors;
};
[[nodiscard]] std::vector<ErrorCurve> error_curves(std::size_t groups, std::span<const CurvePlan> plans, int threads,
                                                   const Hooks& hooks);

// All curves. Errors of the triangles are in F; those of the light are relative to the exact value.
struct ResolutionCurves {
  ErrorCurve triangles_by_resolution, aligned_by_resolution, turned_by_resolution;
  ErrorCurve triangles_by_rotation, light_by_rotation;
  ErrorCurve aligned_by_distance, turned_by_distance;
};
[[nodiscard]] ResolutionCurves resolution_curves(const ResolutionSize& size, int threads, const Hooks& hooks);

[[nodiscard]] Result hemicube_resolution(const ResolutionSize& size, int threads, const Hooks& hooks);
[[nodiscard]] Result hemicube_resolution(const Effort& effort, const Hooks& hooks);

}  // namespace exactff::experiments
