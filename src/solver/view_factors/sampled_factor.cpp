#include "view_factors/sampled_factor.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <vector>

#include "exactff/exact.h"
#include "kernel/poll.h"
#include "view_factors/near_planes.h"
#include "view_factors/strata.h"

namespace exactff::view_factors {
namespace {

constexpr std::size_t kPointsOfStratum = kDraws * kFewestPoints;
constexpr std::size_t kFirstStrata = 54;
static_assert(kFirstStrata >= kFewestStrata);

// F at exact points of a patch, with an error where rounding matters.
class PointFactors {
 public:
  PointFactors(const ExactScene& scene, const std::vector<Part>& from, const Selection& to)
      : scene_(scene), from_(from), source_(scene.scene, to), near_(from.size()) {}

  struct Value {
    double value, error;
  };
  Value at(const Point& point, std::size_t part) {
    std::optional<NearPlanes>& near = near_[part];
    if (!near) near.emplace(scene_, from_[part]);
    const std::optional<Vec3> rounded = near->round(point);
    if (!rounded) return {0.5, 0.5};
    exact_form_factor(scene_.scene, {.point = *rounded, .normal = near->normal(), .on = near->own(), .id = {}}, source_,
                      {}, factor_);
    return {factor_.value, 0.0};
  }

 private:
  const ExactScene& scene_;
  const std::vector<Part>& from_;
  ExactSource source_;
  std::vector<std::optional<NearPlanes>> near_;  // made when asked for
  FormFactor factor_;
};

// Of means over the patch.
struct Look {
  StratifiedMean f;
  double unknown = 0.0;  // of the error of F
};

Look look_at(const ExactScene& scene, const std::vector<Part>& from, const Strata& strata, std::size_t number,
             PointFactors& factors) {
  Look look;
  for (std::size_t s = 0; s < strata.strata.size(); ++s) {
    kernel::poll();
    std::array<double, kDraws> means{};
    double unknown = 0.0;
    for (std::size_t d = 0; d < kDraws; ++d) {
      const auto [part, points] = sample(from, strata, number, s, d, scene.units);
      for (const Point& point : points) {
        const auto [value, error] = factors.at(point, part);
        means[d] += value / static_cast<double>(points.size());
        unknown += error / static_cast<double>(kDraws * points.size());
      }
    }
    const double share = strata.strata[s].area / strata.area;
    look.f.add(means[0], means[1], share);
    look.unknown += unknown * share;
  }
  return look;
}

}  // namespace

SampledIntegral sampled_integral(const ExactScene& scene, const std::vector<Part>& parts, const Selection& to,
                                 std::size_t budget, double target) {
  std::vector<Part> from;
  for (const Part& part : parts) {
    kernel::poll();
    std::ranges::move(cut_at_contacts(scene, part), std::back_inserter(from));
  }
  std::size_t looks = 1;
  for (std::size_t strata = 4 * kFirstStrata; strata * kPointsOfStratum <= budget; strata *= 4) ++looks;
  PointFactors factors(scene, from, to);
  const double area = area_of(from);
  SampledIntegral result{0.5 * area, 0.5 * area};
  for (std::size_t number = 0, strata = kFirstStrata; number < looks; ++number, strata *= 4) {
    const Strata cut = strata_of(from, strata);
    const Look look = look_at(scene, from, cut, number, factors);
    const double error = (look.unknown + look.f.error(kRisk / static_cast<double>(looks), cut)) * area;
    if (error < result.error) result = {look.f.value * area, error};
    if (result.error <= target) break;
  }
  return result;
}

}  // namespace exactff::view_factors
