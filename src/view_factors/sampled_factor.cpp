#include "view_factors/sampled_factor.h"

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "exactff/exact.h"
#include "kernel/poll.h"
#include "view_factors/near_planes.h"
#include "view_factors/strata.h"

namespace exactff::view_factors {
namespace {

constexpr std::size_t kTriples = 2;  // of a stratum
constexpr std::size_t kPointsOfStratum = 3 * kTriples;

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
    const std::optional<Vec3> rounded = near->rounded(point);
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
  double points = 0.0;
};

Look look_at(const ExactScene& scene, const std::vector<Part>& from, const Strata& strata, std::size_t number,
             PointFactors& factors) {
  Look look;
  for (std::size_t s = 0; s < strata.strata.size(); ++s) {
    kernel::poll();
    const Stratum& stratum = strata.strata[s];
    std::array<double, kTriples> means{};
    double unknown = 0.0;
    for (std::size_t t = 0; t < kTriples; ++t) {
      Draws draws(number, s, t);
      const SmallTriangle& triangle = drawn(strata, stratum, draws);
      for (const Point& point : triple_in(from[triangle.part], triangle, draws, scene.units)) {
        const auto [value, error] = factors.at(point, triangle.part);
        means[t] += value / 3.0;
        unknown += error / static_cast<double>(kPointsOfStratum);
      }
    }
    const double share = stratum.area / strata.area;
    look.f.add(means[0], means[1], share);
    look.unknown += unknown * share;
  }
  look.points = static_cast<double>(strata.strata.size() * kPointsOfStratum);
  return look;
}

}  // namespace

SampledIntegral sampled_integral(const ExactScene& scene, const std::vector<Part>& from, const Selection& to,
                                 std::size_t budget, double target) {
  std::size_t looks = 1;
  for (std::size_t strata = 4 * kFewestStrata; strata * kPointsOfStratum <= budget; strata *= 4) ++looks;
  PointFactors factors(scene, from, to);
  const double area = area_of(from);
  SampledIntegral result{0.5 * area, 0.5 * area};
  for (std::size_t number = 0, strata = kFewestStrata; number < looks; ++number, strata *= 4) {
    const Strata cut = strata_of(from, strata);
    const Look look = look_at(scene, from, cut, number, factors);
    const double error = (look.unknown + look.f.error(kRisk / static_cast<double>(looks), look.points, cut)) * area;
    if (error < result.error) result = {look.f.value * area, error};
    if (result.error <= target) break;
  }
  return result;
}

}  // namespace exactff::view_factors
