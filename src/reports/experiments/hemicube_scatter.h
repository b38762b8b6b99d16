// Karkanis' two plots. For every triangle of scenes like his: the hemicube's form factor against the exact one, and the
// hemicube's absolute error divided by the exact value, against the exact value.
//
// A triangle that the hemicube misses has no place on a logarithmic axis. Such triangles are counted and drawn
// separately.
#pragma once

#include "experiments/support.h"

namespace exactff::experiments {

struct ScatterSize {
  int scenes = 10;  // seeds 1, 2, ...
  int triangles = 200;
  std::vector<int> resolutions = {100, 200, 400};  // the first one is drawn
};

struct ScatterPoint {
  int scene = 1;
  int triangle = 1;
  double exact = 0.0;
  std::vector<double> hemicube;  // indexed by resolution
};

struct ScatterDecade {
  int exponent = 0;  // exact values from 10^exponent to 10^(exponent + 1)
  std::size_t visible = 0;
  std::size_t missed = 0;
  double median = 0.0;  // of |hemicube - exact| / exact
  double p99 = 0.0;
};

// Every triangle of every scene, including hidden ones.
[[nodiscard]] std::vector<ScatterPoint> scatter_points(const ScatterSize& size, int threads, const Hooks& hooks);

// Results for one resolution (an index into the list), over the visible triangles. Decades without a triangle are left
// out.
[[nodiscard]] std::vector<ScatterDecade> scatter_decades(std::span<const ScatterPoint> points, std::size_t resolution);

// The form factor of the pixel around the normal, which is the largest one.
[[nodiscard]] double largest_pixel(int resolution);

// For each scene, the slope of log(|error| / exact) over log(exact), for triangles larger than a pixel. Scenes with
// fewer than ten such triangles are left out.
[[nodiscard]] std::vector<double> scatter_slopes(std::span<const ScatterPoint> points, const ScatterSize& size,
                                                 std::size_t resolution);

[[nodiscard]] Result hemicube_scatter(const ScatterSize& size, int threads, const Hooks& hooks);
[[nodiscard]] Result hemicube_scatter(const Effort& effort, const Hooks& hooks);

}  // namespace exactff::experiments
