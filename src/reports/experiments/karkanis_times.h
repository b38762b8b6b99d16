// Karkanis' timings: the time for all patches seen from one point, against the number of patches.
//
// For 50, 100, 200 and 500 triangles he measured 0.2 s, 2.8 s, 300 s and about 8 h on a 300 MHz Pentium II, in floating
// point. Here every triangle of such a scene is the source in turn, and its form factor is certified, with and without
// the shaft that excludes most of the other triangles. For comparison: the hemicube, which computes all sources in one
// pass, and rays.
#pragma once

#include <cstdint>

#include "experiments/support.h"

namespace exactff::experiments {

struct TimesSize {
  std::vector<int> triangles = {50, 100, 200, 500, 1000, 2000, 5000, 10000};
  int same_bits_up_to = 500;     // triangles: up to here, values with and without the shaft are compared
  double budget = 20.0;          // seconds; a measurement without the shaft that would take longer is left out
  int rays = 10'000;             // to each patch
  std::size_t ray_patches = 16;  // timed patches, extrapolated to all
  std::vector<int> affordable = {1,   4,    16,  64,
                                 256, 1024, 4096};  // rays to each patch, to find how many take as long as exact
  int affordable_at = 200;                          // triangles
};

// Results that are the same on every run.
struct WorkRow {
  int triangles = 0;
  std::size_t visible = 0;
  double sum = 0.0;                                     // of the form factors
  std::uint64_t looked_at = 0;                          // pairs of a source and a face that the shaft's tree leaves
  std::optional<std::uint64_t> looked_at_without = {};  // the same without the shaft, if compared
  std::optional<std::size_t> differences = {};          // values that differ without the shaft, if compared
};
[[nodiscard]] WorkRow work_row(int triangles, bool compare);

// Seconds for all patches.
struct TimeRow {
  int triangles = 0;
  double with_shaft = 0.0;
  std::optional<double> without_shaft = {};
  double hemicube = 0.0;
  double rays = 0.0;
};

// ln(t1 / t0) / ln(n1 / n0)
[[nodiscard]] double local_exponent(int n0, double t0, int n1, double t1);

[[nodiscard]] Result karkanis_times(const TimesSize& size, const Hooks& hooks);
[[nodiscard]] Result karkanis_times(const Effort& effort, const Hooks& hooks);

}  // namespace exactff::experiments
