#include "view_factors/sampled_factor.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <vector>

#include "exactff/exact.h"
#include "kernel/poll.h"
#include "view_factors/factor_bound.h"
#include "view_factors/near_planes.h"
#include "view_factors/strata.h"

namespace exactff::view_factors {
namespace {

constexpr std::size_t kPointsOfStratum = kDraws * kFewestPoints;
constexpr std::size_t kFirstStrata = 54;
static_assert(kFirstStrata >= kFewestStrata);

// F at exact points of a patch. Nothing where rounding matters.
class PointFactors {
 public:
  PointFactors(const ExactScene& scene, const std::vector<Part>& from, const Selection& to)
      : scene_(scene), from_(from), source_(scene.scene, to), near_(from.size()) {}

  std::optional<double> at(const Point& point, std::size_t part) {
    std::optional<NearPlanes>& near = near_[part];
    if (!near) near.emplace(scene_, from_[part]);
    const std::optional<Vec3> rounded = near->round(point);
    if (!rounded) return std::nullopt;
    exact_form_factor(scene_.scene, {.point = *rounded, .normal = near->normal(), .on = near->own(), .id = {}}, source_,
                      {}, factor_);
    return factor_.value;
  }

 private:
  const ExactScene& scene_;
  const std::vector<Part>& from_;
  ExactSource source_;
  std::vector<std::optional<NearPlanes>> near_;  // made when asked for
  FormFactor factor_;
};

// The largest F that distance and slope allow.
class LargestFactors {
 public:
  LargestFactors(const ExactScene& scene, const std::vector<Part>& from, const std::vector<Part>& to)
      : units_(scene.units), from_(from) {
    if (to.size() > kMostParts) return;
    for (const Part& source : to) sources_.push_back({positions_of(source.corners), plane_of(source, units_)});
    bounds_.resize(from.size());
  }

  // From every point of the tile.
  double on(const Tile& tile) {
    if (bounds_.empty()) return 1.0;
    std::vector<FactorBound>& bounds = bounds_[tile.part];
    if (bounds.empty()) {
      const Plane receiver = plane_of(from_[tile.part], units_);
      for (const Source& source : sources_) bounds.emplace_back(source.corners, source.plane, receiver);
    }
    const std::vector<Vec3> corners = corners_of(from_[tile.part], tile, units_);
    double sum = 0.0;
    for (std::size_t i = 0; i < bounds.size() && sum < 1.0; ++i) sum += bounds[i].on(corners);
    return std::min(1.0, sum * kSum);
  }

 private:
  struct Source {
    std::vector<Vec3> corners;
    Plane plane;
  };
  static constexpr std::size_t kMostParts = 256;  // of more, F is only known to be at most 1
  static constexpr double kSum = 1.0 + 0x1p-40;   // more than the roundings of the sum

  const Units& units_;
  const std::vector<Part>& from_;
  std::vector<Source> sources_;
  std::vector<std::vector<FactorBound>> bounds_;  // by part; made when asked for
};

// Of means over the patch.
struct Look {
  StratifiedMean f;
  StratifiedMean unknown;  // what F may be where it is not known
  Ranges ranges;
};

Look look_at(const ExactScene& scene, const std::vector<Part>& from, const Strata& strata, std::size_t number,
             PointFactors& factors, LargestFactors& largest) {
  Look look;
  for (std::size_t s = 0; s < strata.strata.size(); ++s) {
    kernel::poll();
    double range = 0.0;
    for (std::size_t t = strata.strata[s].begin; t < strata.strata[s].end; ++t) {
      range = std::max(range, largest.on(strata.tiles[t]));
    }
    std::array<double, kDraws> means{}, unknown{};
    for (std::size_t d = 0; d < kDraws; ++d) {
      const auto [part, points] = sample(from, strata, number, s, d, scene.units);
      for (const Point& point : points) {
        const std::optional<double> value = factors.at(point, part);
        (value ? means : unknown)[d] += value.value_or(range) / static_cast<double>(points.size());
      }
    }
    const double share = strata.strata[s].area / strata.area;
    look.f.add(means[0], means[1], share);
    look.unknown.add(unknown[0], unknown[1], share);
    look.ranges.add(range, share);
  }
  return look;
}

}  // namespace

SampledMean sampled_mean(const ExactScene& scene, const std::vector<Part>& parts, const PreparedPatch& to,
                         std::size_t budget, double target) {
  std::vector<Part> from;
  for (const Part& part : parts) {
    kernel::poll();
    std::ranges::move(cut_at_contacts(scene, part), std::back_inserter(from));
  }
  std::size_t looks = 1;
  for (std::size_t strata = 4 * kFirstStrata; strata * kPointsOfStratum <= budget; strata *= 4) ++looks;
  PointFactors factors(scene, from, to.selection);
  LargestFactors largest(scene, from, to.parts);
  const double of_shares = error_of_shares(from, scene.units);
  SampledMean result;
  for (std::size_t number = 0, strata = kFirstStrata; number < looks; ++number, strata *= 4) {
    const Strata cut = strata_of(from, strata);
    const Look look = look_at(scene, from, cut, number, factors, largest);
    const double risk = kRisk / static_cast<double>(looks);
    const double error = look.f.error(risk, look.ranges, look.unknown) + of_shares + kRoundedPoints;
    if (error < result.error) result = {look.f.value, error};
    if (result.error <= target) break;
  }
  return result;
}

}  // namespace exactff::view_factors
