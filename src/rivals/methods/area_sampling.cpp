// Area sampling: n points of the source, uniform in area over all its faces,
//
//   F ~ A/n sum_i V(x, y_i) cos th_r cos th_s / (pi r_i^2).
//
// The unit square is mapped to the source by area, the faces side by side along u, each by its own map that preserves
// ratios of areas. So one point set serves for random, stratified and low-discrepancy sampling.
#include <algorithm>
#include <array>
#include <utility>

#include "adaptive/value_range.h"
#include "methods/method_files.h"
#include "methods/ray_sum.h"
#include "methods/unit_points.h"

namespace exactff::methods {

using namespace adaptive;

namespace {

constexpr std::int64_t kMostSamples = std::int64_t{1} << 24;

PointSet point_set_named(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, PointSet>, 5> kNames = {{{"random", PointSet::kRandom},
                                                                            {"stratified", PointSet::kStratified},
                                                                            {"sobol", PointSet::kSobol},
                                                                            {"halton", PointSet::kHalton},
                                                                            {"r2", PointSet::kR2}}};
  return std::find_if(kNames.begin(), kNames.end(), [&](const auto& entry) { return entry.first == name; })->second;
}

class AreaSampling : public Evaluator {
 public:
  AreaSampling(const SampledScene& sampled, const Scene& /*scene*/, const Settings& settings)
      : rays_(sampled),
        points_(point_set_named(settings.word("pattern")), static_cast<int>(settings.whole("samples"))),
        seed_(static_cast<std::uint64_t>(settings.whole("seed"))) {}

  void look_from(const Receiver& receiver) override {
    const kernel::StandardArithmetic arithmetic;
    rays_.look_from(receiver);
  }

  using Evaluator::form_factor;
  Estimate form_factor(const PreparedSource& prepared) override {
    const kernel::StandardArithmetic arithmetic;
    const auto& source = own<RaySource>(prepared);
    Estimate result;
    if (!(source.area() > 0.0)) return result;  // nothing to sample, or too small for a double
    points_.place(stream_key(rays_.view(), source.selection(), seed_), square_);
    share_out(source);
    for (std::size_t root = 0; root < source.roots.size(); ++root) add_root(source, root);
    const double mean = rays_.take() * (source.area() / static_cast<double>(square_.size()));
    result.form_factor = move_into_range(mean, Formula::kNotNegative);
    result.counters.add("samples", square_.size());
    result.counters.add("rays", rays_.take_rays());
    return result;
  }

 private:
  // Sorts the points by the root that they fall on, and maps them to the unit square of that root.
  void share_out(const RaySource& source) {
    by_root_.resize(source.roots.size());
    if (by_root_.size() == 1) {
      by_root_[0] = square_;
      return;
    }
    for (std::vector<UnitPoint>& points : by_root_) points.clear();
    for (const UnitPoint& p : square_) {
      const std::vector<double>& up_to = source.area_up_to;
      const double area = p.u * source.area();
      const auto after = std::upper_bound(up_to.begin() + 1, up_to.end() - 1, area);
      const auto root = static_cast<std::size_t>(after - up_to.begin()) - 1;
      const double width = up_to[root + 1] - up_to[root];
      const double u = width > 0.0 ? (area - up_to[root]) / width : 0.0;
      by_root_[root].push_back({std::clamp(u, 0.0, 1.0), p.v});
    }
  }

  void add_root(const RaySource& source, std::size_t root) {
    const std::vector<UnitPoint>& points = by_root_[root];
    if (points.empty() || !rays_.aim(source, root, Reach::kVisible, points.size())) return;
    place_by_area(rays_.patch(), points, places_);
    for (std::size_t i = 0; i < points.size(); ++i) {
      rays_.add(places_[i], rays_.kernel(places_[i]));
    }
  }

  RaySum rays_;
  UnitPoints points_;
  std::uint64_t seed_;
  std::vector<UnitPoint> square_;
  std::vector<std::vector<UnitPoint>> by_root_;
  RayEnds places_;
};

}  // namespace

Method area_sampling_method() {
  return {
      .name = "area-sampling",
      .summary = "the mean of integrand times visibility (one shadow ray) over points of the source, uniform in area",
      .source = "P. Shirley, C. Wang and K. Zimmerman, Monte Carlo Techniques for Direct Lighting (1996)",
      .settings = {whole_setting("samples", 64, 1, kMostSamples, "sample points, with one ray to each"),
                   word_setting("pattern", {"random", "stratified", "sobol", "halton", "r2"},
                                "random: independent points; stratified: one in each cell; the others: the start of a "
                                "low-discrepancy sequence, shifted at random"),
                   seed_setting()},
      .prepare = prepare_as<OnScene<SceneForRays, RaySource, AreaSampling>>,
      .can_leave_unit = [](const Settings&) { return true; }};
}

}  // namespace exactff::methods
