// The ends of shadow rays: points of a sub-patch, uniform over its area.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "adaptive/sub_patch.h"
#include "exactff/adaptive.h"
#include "kernel/split_mix.h"

namespace exactff::adaptive {

// Ray ends relative to the receiving point, by coordinate. Padded to a multiple of kLanes by repeating the last one.
struct RayEnds {
  static constexpr int kLanes = 8;
  std::vector<double> x;
  std::vector<double> y;
  std::vector<double> z;
  int count = 0;
  int padded_count = 0;

  void resize(int rays);
  void set(std::size_t i, const Vec3& end) {
    x[i] = end.x;
    y[i] = end.y;
    z[i] = end.z;
  }
  [[nodiscard]] Vec3 operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }
};

inline constexpr double kUnit32 = 0x1p-32;

// A point of the unit square.
struct UnitPoint {
  double u = 0.0;
  double v = 0.0;
};

// Back into [0, 1) from [0, 2).
inline double wrapped(double u) { return u >= 1.0 ? u - 1.0 : u; }

// Number `index` of the stream `key`, each coordinate in [0, 1).
inline UnitPoint random_point(std::uint64_t key, std::uint64_t index) {
  const std::uint64_t bits = kernel::split_mix(key, index);
  return {static_cast<double>(static_cast<std::int64_t>(bits >> 32)) * kUnit32,
          static_cast<double>(static_cast<std::int64_t>(bits & 0xffffffffU)) * kUnit32};
}

// The images of the points under a map to the sub-patch that preserves ratios of areas. Fills `ends`, padding included.
void place_by_area(const SubPatch& s, std::span<const UnitPoint> points, RayEnds& ends);

// The points of the unit square that a pattern prescribes for n rays, and their images on sub-patches.
class SamplePlan {
 public:
  // kCentre makes one ray and ignores `rays`. Any number of jittered or regular cells of area 1/n: about sqrt(n) rows,
  // each as high as its share of the cells. kLowDiscrepancy: Hammersley's points, shifted modulo 1 by a random vector
  // per sub-patch (Cranley and Patterson 1976).
  void prepare(SamplePattern pattern, int rays);

  [[nodiscard]] int ray_count() const { return static_cast<int>(cells_.size()); }

  // Random numbers come from the stream `key` alone. `ends` must have been resized to ray_count().
  void place(const SubPatch& s, std::uint64_t key, RayEnds& ends) const;

 private:
  struct Cell {
    double u, v;  // low corner
    double width, height;
  };
  template <class Map>
  void place_by(const Map& map, std::uint64_t key, RayEnds& ends) const;
  void make_rows(int rays);
  void make_hammersley(int rays);

  SamplePattern pattern_ = SamplePattern::kJittered;
  int rays_ = 0;
  std::vector<Cell> cells_;
};

}  // namespace exactff::adaptive
