#include "view_factors/sampled_factor.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "exactff/exact.h"
#include "kernel/poll.h"
#include "kernel/vec.h"
#include "view_factors/looks.h"
#include "view_factors/near_planes.h"
#include "view_factors/patch_parts.h"
#include "view_factors/point_factors.h"

namespace exactff::view_factors {
namespace {

constexpr double kLeastOfChanges = 1.0;  // as a range: less than half of what a term of two numbers is

struct Fragments {
  std::vector<Part> parts;
  std::vector<std::size_t> of;  // by fragment: the part
};

Fragments fragments_of(const ExactScene& scene, const std::vector<Part>& parts) {
  Fragments result;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    kernel::poll();
    std::ranges::move(cut_at_contacts(scene, parts[p]), std::back_inserter(result.parts));
    result.of.resize(result.parts.size(), p);
  }
  return result;
}

// F at points of a patch.
class FactorOfPatch : public SampledFunction {
 public:
  // Keeps a reference to the bounds.
  FactorOfPatch(const ExactScene& scene, const PreparedPatch& from, const PreparedPatch& to, PatchBounds& bounds)
      : FactorOfPatch(scene, to, bounds, fragments_of(scene, from.parts)) {}

  [[nodiscard]] Span span(const Tile& tile, bool is_alone) override {
    return bounds_.on(part_of_[tile.part], parts()[tile.part], tile, is_alone);
  }
  [[nodiscard]] std::optional<double> at(const Point& point, std::size_t part) override {
    std::optional<NearPlanes>& near = near_[part];
    if (!near) near.emplace(scene_, parts()[part]);
    return factors_.at(point, *near, source_);
  }
  [[nodiscard]] std::uint64_t effort() const override { return factors_.effort(); }

 private:
  FactorOfPatch(const ExactScene& scene, const PreparedPatch& to, PatchBounds& bounds, Fragments fragments)
      : SampledFunction(std::move(fragments.parts)),
        scene_(scene),
        part_of_(std::move(fragments.of)),
        source_(scene.scene, to.selection),
        near_(parts().size()),
        factors_(scene.scene),
        bounds_(bounds) {}

  const ExactScene& scene_;
  std::vector<std::size_t> part_of_;  // by fragment
  ExactSource source_;
  std::vector<std::optional<NearPlanes>> near_;  // made when asked for
  PointFactors factors_;
  PatchBounds& bounds_;
};

}  // namespace

class SampledMean::Looking {
 public:
  Looking(const ExactScene& scene, const PreparedPatch& from, const PreparedPatch& to, PatchBounds& bounds)
      : function_(scene, from, to, bounds), looks(function_, scene.units, kRiskOfPatch, 0) {}

 private:
  FactorOfPatch function_;

 public:
  Looks looks;
};

SampledMean::SampledMean(const ExactScene& scene, const SeenParts& seen, const PreparedPatch& from,
                         const PreparedPatch& to, std::size_t most, double ratio)
    : scene_(scene),
      from_(from),
      to_(to),
      most_(std::max(most, kPointsOfFirstLook)),
      ratio_(ratio),
      largest_(largest_factor(from, to)),
      bounds_(scene, seen, from, to),
      known_{0.0, largest_},
      value_(0.5 * largest_),
      lower_(0.0),
      upper_(largest_) {
  const Strata strata = strata_of(from.parts, kFewestStrata);
  for (const Stratum& stratum : strata.strata) {
    const Tile& tile = strata.tiles[stratum.begin];
    const Sides sides = sides_of(from.parts[tile.part], tile);
    const Vec3 middle = sides.at(middle_of(tile));
    Span span = bounds_.about(tile.part, middle);
    span.change *= kernel::distance(middle, sides.origin);
    samples_.push_back({stratum.area / strata.area, span});
  }
}
SampledMean::~SampledMean() = default;

// From the mean of the ranges or, where they are less, the changes within strata of the same size. Those that are split
// where changes are large have a smaller mean, but not below the power mean of 2/3.
double SampledMean::least_width(double strata) const {
  double sum = 0.0;
  for (const Sample& sample : samples_) {
    const double change = sample.span.change * std::sqrt(static_cast<double>(samples_.size()) / strata);
    sum += sample.share * std::pow(std::min(sample.span.range, kLeastOfChanges * change), 2.0 / 3.0);
  }
  return view_factors::least_width(std::pow(sum, 1.5), static_cast<std::size_t>(strata), kRiskOfPatch);
}

bool SampledMean::may_reach(double width, std::uint64_t effort) const {
  const std::uint64_t of_point = looking_ ? looking_->looks.effort_of_point() : kLeastEffort;
  const double points = std::min(static_cast<double>(most_), static_cast<double>(effort / of_point));
  return points >= 2.0 && least_width(points / kDraws) * ratio_ <= width;
}

// The first one tells what the others are predicted from.
bool SampledMean::look(std::uint64_t effort) {
  if (looking_ == nullptr) {
    looking_ = std::make_unique<Looking>(scene_, from_, to_, bounds_);
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

// All looks hold together, so what they have in common does, too. It is widened within what the factor can be.
void SampledMean::take_look() {
  const auto [value, error] = looking_->looks.look();
  const double lower = std::max(known_.lower, value - error), upper = std::min(known_.upper, value + error);
  if (lower <= upper) known_ = {lower, upper};
  const double strata = static_cast<double>(std::min(looking_->looks.strata(), most_ / kDraws));
  const double width = std::min(std::max(known_.upper - known_.lower, least_width(strata)), largest_);
  lower_ = std::clamp(0.5 * (known_.lower + known_.upper - width), 0.0, largest_ - width);
  upper_ = std::clamp(lower_ + width, known_.upper, largest_);
  lower_ = std::min(lower_, known_.lower);
  value_ = std::clamp(value, lower_, upper_);
}

}  // namespace exactff::view_factors
