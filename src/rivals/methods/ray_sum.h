// Sums of weights over the points of a source that x sees: the common core of all methods that trace single rays.
//
// For one root of the source at a time, either a short list of occluders is gathered from its shaft and tested directly
// in double, or Embree tests the whole scene. Gathering costs as much as some rays, so the list may be about as long as
// the number of rays to trace, and is given up beyond that.
#pragma once

#include <cstdint>
#include <vector>

#include "adaptive/sampled_scene.h"
#include "adaptive/sub_patch.h"
#include "exactff/methods.h"

namespace exactff::methods {

// One plane of a source, seen from the front and from behind.
struct RayPlane {
  adaptive::SourcePlane front;
  adaptive::SourcePlane back;
  Vec3 unit_normal;                  // front
  std::vector<std::uint32_t> close;  // pieces not in the plane that single precision cannot separate from it
};

struct RaySource : PreparedSource {
  RaySource(const adaptive::SampledScene& sampled, const Scene& scene, const Selection& selection);

  std::vector<adaptive::SourceRoot> roots;
  std::vector<RayPlane> planes;
  std::vector<double> area_up_to;  // total area of the roots before the k-th; the last entry is that of all; scaled

  [[nodiscard]] double area() const { return area_up_to.back(); }
};

// The scene of methods that trace rays. The ray structure is built here, so that its time is not part of a timed call,
// but only if a list can get long.
struct SceneForRays : adaptive::SampledScene {
  explicit SceneForRays(const Scene& scene);
};

// The points that count. kVisible: those of the definition. kEverything: all, on both sides of the source and also
// below the horizon.
enum class Reach { kVisible, kEverything };

class RaySum {
 public:
  static constexpr double kLargestKernel = 0x1p900;

  explicit RaySum(const adaptive::SampledScene& scene) : scene_(scene) {}

  void look_from(const Receiver& receiver);
  [[nodiscard]] const adaptive::ReceiverView& view() const { return view_; }

  // The part of a root that counts, clipped by the horizon, is polygon() afterwards, unless this is false: none counts.
  [[nodiscard]] bool look_at(const RaySource& source, std::size_t root, Reach reach);
  // The same, and selects the root for about `points` visibility queries.
  [[nodiscard]] bool aim(const RaySource& source, std::size_t root, Reach reach, std::size_t points);
  [[nodiscard]] const adaptive::SubPatch& patch() const { return patch_; }     // the root, relative to x, unclipped
  [[nodiscard]] double height() const { return height_; }                      // of x above its plane; negative behind
  [[nodiscard]] const std::vector<Vec3>& polygon() const { return polygon_; }  // convex, corners relative to x

  // cos th_r cos th_s / (pi r^2) at a point of the root, 0 below the horizon. Requires a root that was aimed at with
  // Reach::kVisible, so that x is not behind it. At most kLargestKernel, so that no sum of it overflows.
  [[nodiscard]] double kernel(const Vec3& point) const;
  // cos th_r / pi at a point, 0 below the horizon.
  [[nodiscard]] double cosine_kernel(const Vec3& point) const;

  // Cuts every root of the source that counts into splits x splits parts and calls add(part, key) for each, with its
  // own key for random numbers. `points` is the number of queries in each part. Returns the number of parts.
  template <class Add>
  std::uint64_t for_each_part(const RaySource& source, Reach reach, int splits, std::uint64_t key, int points,
                              const Add& add) {
    const auto parts = static_cast<std::size_t>(splits) * static_cast<std::size_t>(splits);
    std::uint64_t count = 0;
    for (std::size_t root = 0; root < source.roots.size(); ++root) {
      key = kernel::split_mix(key, 0);
      if (!aim(source, root, reach, parts * static_cast<std::size_t>(points))) continue;
      split_evenly(patch_, splits, parts_);
      for (std::size_t i = 0; i < parts_.size(); ++i) add(parts_[i], kernel::split_mix(key, i));
      count += parts_.size();
    }
    return count;
  }

  // Adds `weight` to the sum if x sees the point.
  void add(const Vec3& point, double weight);
  // The sum since the last call; infinite where its terms are too large.
  [[nodiscard]] double take();
  // Rays traced since the last call.
  [[nodiscard]] std::uint64_t take_rays();

 private:
  static constexpr int kBlock = 256;

  [[nodiscard]] double kernel_near_x(const Vec3& point) const;
  [[nodiscard]] bool clip(Reach reach);
  void gather(const RayPlane& plane, Reach reach, std::size_t points);
  void gather_from_all(const RayPlane& plane, const adaptive::SourcePlane& seen, adaptive::Horizon horizon);
  void trace();
  [[nodiscard]] unsigned hidden_lanes(int first) const;

  const adaptive::SampledScene& scene_;
  adaptive::ReceiverView view_;
  double height_ = 0.0;
  adaptive::SubPatch patch_;
  std::vector<adaptive::SubPatch> parts_;
  std::vector<Vec3> polygon_, clipped_;
  std::vector<std::uint32_t> pieces_;
  adaptive::Gathered gathered_;
  adaptive::CandidateRange list_;
  adaptive::Blockers blockers_;
  bool asks_embree_ = false;
  adaptive::RayEnds ends_;
  std::vector<double> weights_;
  double sum_ = 0.0;
  std::uint64_t rays_ = 0;
};

}  // namespace exactff::methods
