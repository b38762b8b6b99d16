// Karkanis' two plots: of every triangle of his kind of scene, the hemicube's form factor against the exact one, and
// the hemicube's absolute error over the exact value against the exact value.
//
// A triangle that the hemicube misses has no place on a logarithmic axis: such triangles are counted, and drawn apart.
#pragma once

#include "experiments/support.h"

namespace exactff::experiments {

struct ScatterSize {
  int scenes = 10;  // seeds 1, 2, ...
  int triangles = 200;
  std::vector<int> resolutions = {100, 200, 400};  // the first is drawn
};

struct ScatterPoint {
  int scene = 1;
  int triangle = 1;
  double exact = 0.0;
  std::vector<double> hemicube;  // by resolution
};

struct ScatterDecade {
  int exponent = 0;  // exact values from 10^exponent to 10^(exponent + 1)
  std::size_t visible = 0;
  std::size_t missed = 0;
  double median = 0.0;  // of |hemicube - exact| / exact
  double p99 = 0.0;
};

// Every triangle of every scene, those that are hidden included.
[[nodiscard]] std::vector<ScatterPoint> scatter_points(const ScatterSize& size, int threads, const study::Hooks& hooks);

// Of the resolution at that place of the list, over the visible triangles; decades without one are left out.
[[nodiscard]] std::vector<ScatterDecade> scatter_decades(std::span<const ScatterPoint> points, std::size_t resolution);

// The form factor of the pixel around the normal, the largest.
[[nodiscard]] double largest_pixel(int resolution);

// The slope of log |error| / exact over log exact, of triangles larger than a pixel; scene by scene. A scene with fewer
// than ten of them has none.
[[nodiscard]] std::vector<double> scatter_slopes(std::span<const ScatterPoint> points, const ScatterSize& size,
                                                 std::size_t resolution);

[[nodiscard]] Result hemicube_scatter(const ScatterSize& size, int threads, const study::Hooks& hooks);
[[nodiscard]] Result hemicube_scatter(const Effort& effort, const study::Hooks& hooks);

}  // namespace exactff::experiments
