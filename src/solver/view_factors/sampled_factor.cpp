#include "view_factors/sampled_factor.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "exactff/exact.h"
#include "kernel/poll.h"
#include "kernel/vec.h"
#include "view_factors/factor_bound.h"
#include "view_factors/looks.h"
#include "view_factors/near_planes.h"
#include "view_factors/patch_parts.h"
#include "view_factors/point_factors.h"

namespace exactff::view_factors {
namespace {

// The largest F if nothing hides any of the source.
class LargestFactors {
 public:
  LargestFactors(const ExactScene& scene, const std::vector<Part>& from, const std::vector<Part>& to)
      : units_(scene.units), from_(from), to_(to), bounds_(from.size()) {}

  // From every point of the tile.
  double on(const Tile& tile) { return on(tile.part, corners_of(from_[tile.part], tile, units_)); }
  // From every point of the convex hull of these points of a part.
  double on(std::size_t part, std::span<const Vec3> corners) {
    if (to_.size() > kMostParts) return 1.0;
    if (bounds_[part].empty()) prepare(part);
    double sum = 0.0;
    for (const UnhiddenBound& bound : bounds_[part]) {
      sum += bound.on(corners);
      if (sum >= 1.0) return 1.0;
    }
    return std::min(1.0, sum * kSum);
  }

 private:
  static constexpr std::size_t kMostParts = 256;  // of more, F is only known to be at most 1
  static constexpr double kSum = 1.0 + 0x1p-40;   // more than the roundings of the sum

  void prepare(std::size_t part) {
    const Plane receiver = plane_of(from_[part], units_);
    for (const Part& source : to_) {
      bounds_[part].emplace_back(positions_of(source.corners), plane_of(source, units_), receiver);
    }
  }

  const Units& units_;
  const std::vector<Part>&from_, &to_;
  std::vector<std::vector<UnhiddenBound>> bounds_;  // by part; made when asked for
};

std::vector<Part> fragments_of(const ExactScene& scene, const std::vector<Part>& parts) {
  std::vector<Part> fragments;
  for (const Part& part : parts) {
    kernel::poll();
    std::ranges::move(cut_at_contacts(scene, part), std::back_inserter(fragments));
  }
  return fragments;
}

// F at points of a patch.
class FactorOfPatch : public SampledFunction {
 public:
  FactorOfPatch(const ExactScene& scene, const PreparedPatch& from, const PreparedPatch& to)
      : SampledFunction(fragments_of(scene, from.parts)),
        scene_(scene),
        source_(scene.scene, to.selection),
        near_(parts().size()),
        factors_(scene.scene),
        largest_(scene, parts(), to.parts) {}

  [[nodiscard]] double range(const Tile& tile) override { return largest_.on(tile); }
  [[nodiscard]] std::optional<double> at(const Point& point, std::size_t part) override {
    std::optional<NearPlanes>& near = near_[part];
    if (!near) near.emplace(scene_, parts()[part]);
    return factors_.at(point, *near, source_);
  }
  [[nodiscard]] std::uint64_t effort() const override { return factors_.effort(); }

 private:
  const ExactScene& scene_;
  ExactSource source_;
  std::vector<std::optional<NearPlanes>> near_;  // made when asked for
  PointFactors factors_;
  LargestFactors largest_;
};

Vec3 middle_of(std::span<const Vec3> corners) {
  Vec3 sum;
  for (const Vec3& corner : corners) sum = {sum.x + corner.x, sum.y + corner.y, sum.z + corner.z};
  return kernel::scaled(sum, 1.0 / static_cast<double>(corners.size()));
}

// Over a few strata, of the bounds at their middles: smaller strata have hardly smaller ones.
double mean_of_bounds(const ExactScene& scene, const PreparedPatch& from, const PreparedPatch& to) {
  LargestFactors largest(scene, from.parts, to.parts);
  const Strata strata = strata_of(from.parts, kFewestStrata);
  double sum = 0.0;
  for (const Stratum& stratum : strata.strata) {
    const Tile& tile = strata.tiles[stratum.begin];
    const Vec3 middle = middle_of(corners_of(from.parts[tile.part], tile, scene.units));
    sum += stratum.area / strata.area * largest.on(tile.part, {&middle, 1});
  }
  return sum;
}

}  // namespace

class SampledMean::Looking {
 public:
  Looking(const ExactScene& scene, const PreparedPatch& from, const PreparedPatch& to)
      : function_(scene, from, to), looks(function_, scene.units, kRiskOfPatch, 0) {}

 private:
  FactorOfPatch function_;

 public:
  Looks looks;
};

SampledMean::SampledMean(const ExactScene& scene, const PreparedPatch& from, const PreparedPatch& to, std::size_t most,
                         double ratio)
    : scene_(scene),
      from_(from),
      to_(to),
      most_(std::max(most, kPointsOfFirstLook)),
      ratio_(ratio),
      range_(mean_of_bounds(scene, from, to)) {}
SampledMean::~SampledMean() = default;

double SampledMean::lower() const { return std::max(0.0, value_ - error_); }
double SampledMean::upper() const { return std::min(1.0, value_ + error_); }

bool SampledMean::may_reach(double width, std::uint64_t effort) const {
  const double points = points_for(range_, width / ratio_, kRiskOfPatch);
  const std::uint64_t of_point = looking_ ? looking_->looks.effort_of_point() : kLeastEffort;
  return points <= static_cast<double>(most_) && points * static_cast<double>(of_point) <= static_cast<double>(effort);
}

// The first one tells what the others are predicted from.
bool SampledMean::look(std::uint64_t effort) {
  if (looking_ == nullptr) {
    looking_ = std::make_unique<Looking>(scene_, from_, to_);
  } else if (!looking_->looks.prepare(next_width(width()) / ratio_, effort, most_)) {
    return false;
  }
  take_look();
  return true;
}

void SampledMean::look_with_the_rest(double width) {
  Looks& looks = looking_->looks;
  if (looks.prepare_for_all(most_) && looks.expected_width() * ratio_ < width) take_look();
}

void SampledMean::take_look() {
  const auto [value, found] = looking_->looks.look();
  const double least = least_width(range_, looking_->looks.strata(), kRiskOfPatch);
  const double error = std::max({found, 0.5 * least, least - value});
  if (!(error < error_)) return;
  value_ = value;
  error_ = error;
}

}  // namespace exactff::view_factors
