// Area sampling: n points of the source, uniform in area over all its faces,
//
//   F ~ A/n sum_i V(x, y_i) cos th_r cos th_s / (pi r_i^2).
//
// The unit square is mapped to the source by area, the faces side by side along u, each by its own map that preserves
// ratios of areas. So one point set serves for random, stratified and low-discrepancy sampling.
//
// In the same way the points can be uniform in the solid angle W of what x sees of the source's unoccluded part above
// the horizon:
//
//   F ~ W/n sum_i V(x, y_i) cos th_r / pi.
#include <algorithm>
#include <array>
#include <utility>

#include "adaptive/value_range.h"
#include "methods/method_files.h"
#include "methods/ray_sum.h"
#include "methods/solid_angle.h"
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
        by_solid_angle_(settings.word("measure") == "solid-angle"),
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
    const double measure = by_solid_angle_ ? add_by_solid_angle(source) : add_by_area(source);
    result.form_factor =
        move_into_range(rays_.take() * (measure / static_cast<double>(square_.size())), Formula::kNotNegative);
    result.counters.add("samples", square_.size());
    result.counters.add("rays", rays_.take_rays());
    return result;
  }

 private:
  double add_by_area(const RaySource& source) {
    share_out(source.area_up_to);
    for (std::size_t root = 0; root < source.roots.size(); ++root) add_root(source, root);
    return source.area();
  }

  // `up_to`: the measure of all parts before each part; the last entry is the measure of all. Sorts the points by the
  // part that they fall on, and maps them to the unit square of that part.
  void share_out(const std::vector<double>& up_to) {
    by_part_.resize(up_to.size() - 1);
    if (by_part_.size() == 1) {
      by_part_[0] = square_;
      return;
    }
    for (std::vector<UnitPoint>& points : by_part_) points.clear();
    for (const UnitPoint& p : square_) {
      const double measure = p.u * up_to.back();
      const auto after = std::upper_bound(up_to.begin() + 1, up_to.end() - 1, measure);
      const auto part = static_cast<std::size_t>(after - up_to.begin()) - 1;
      const double width = up_to[part + 1] - up_to[part];
      const double u = width > 0.0 ? (measure - up_to[part]) / width : 0.0;
      by_part_[part].push_back({std::clamp(u, 0.0, 1.0), p.v});
    }
  }

  void add_root(const RaySource& source, std::size_t root) {
    const std::vector<UnitPoint>& points = by_part_[root];
    if (points.empty() || !rays_.aim(source, root, Reach::kVisible, points.size())) return;
    place_by_area(rays_.patch(), points, places_);
    for (std::size_t i = 0; i < points.size(); ++i) {
      rays_.add(places_[i], rays_.kernel(places_[i]));
    }
  }

  // The parts of the source above the horizon, each with its root. Returns their solid angle.
  double find_parts(const RaySource& source) {
    parts_.clear();
    units_.clear();
    first_part_.assign(1, 0);
    angle_up_to_.assign(1, 0.0);
    for (std::size_t root = 0; root < source.roots.size(); ++root) {
      if (rays_.look_at(source, root, Reach::kVisible)) add_parts();
      while (angle_up_to_.size() <= parts_.size()) {
        angle_up_to_.push_back(angle_up_to_.back() + parts_[angle_up_to_.size() - 1].solid_angle());
      }
      first_part_.push_back(parts_.size());
    }
    return angle_up_to_.back();
  }

  // In a unit in which the farthest corner is at a distance of about 1, so that no square underflows.
  void add_parts() {
    polygon_ = rays_.polygon();
    double farthest = 0.0;
    for (const Vec3& corner : polygon_) farthest = std::max(farthest, max_norm(corner));
    if (farthest == 0.0) return;
    const int exponent = std::ilogb(farthest);
    for (Vec3& c : polygon_)
      c = {std::scalbn(c.x, -exponent), std::scalbn(c.y, -exponent), std::scalbn(c.z, -exponent)};
    add_solid_angle_parts(polygon_, std::scalbn(rays_.height(), -exponent), parts_);
    units_.resize(parts_.size(), std::ldexp(1.0, exponent));
  }

  double add_by_solid_angle(const RaySource& source) {
    const double solid_angle = find_parts(source);
    if (!(solid_angle > 0.0)) return 0.0;
    share_out(angle_up_to_);
    for (std::size_t root = 0; root < source.roots.size(); ++root) {
      if (first_part_[root] == first_part_[root + 1]) continue;
      if (!rays_.aim(source, root, Reach::kVisible, square_.size())) continue;
      for (std::size_t k = first_part_[root]; k < first_part_[root + 1]; ++k) add_part(k);
    }
    return solid_angle;
  }

  void add_part(std::size_t k) {
    for (const UnitPoint& at : by_part_[k]) {
      const Vec3 point = parts_[k].point_at(at);
      rays_.add(point * units_[k], rays_.cosine_kernel(point));
    }
  }

  RaySum rays_;
  UnitPoints points_;
  bool by_solid_angle_;
  std::uint64_t seed_;
  std::vector<UnitPoint> square_;
  std::vector<std::vector<UnitPoint>> by_part_;
  RayEnds places_;
  std::vector<Vec3> polygon_;
  std::vector<SolidAnglePart> parts_;
  std::vector<double> units_;            // of the coordinates of each part
  std::vector<std::size_t> first_part_;  // of each root; the last entry is the number of parts
  std::vector<double> angle_up_to_;
};

}  // namespace

Method area_sampling_method() {
  return {
      .name = "area-sampling",
      .summary = "the mean of integrand times visibility (one shadow ray) over points of the source",
      .source =
          "P. Shirley, C. Wang and K. Zimmerman, Monte Carlo Techniques for Direct Lighting (1996); by solid angle: "
          "J. Arvo (1995) and C. Ureña, M. Fajardo and A. King (2013)",
      .settings = {whole_setting("samples", 64, 1, kMostSamples, "sample points, with one ray to each"),
                   word_setting("pattern", {"random", "stratified", "sobol", "halton", "r2"},
                                "random: independent points; stratified: one in each cell; the others: the start of a "
                                "low-discrepancy sequence, shifted at random"),
                   word_setting("measure", {"area", "solid-angle"},
                                "the points are uniform in the source's area, or in the solid angle that x sees"),
                   seed_setting()},
      .prepare = prepare_as<OnScene<SceneForRays, RaySource, AreaSampling>>,
      .can_leave_unit = [](const Settings&) { return true; }};
}

}  // namespace exactff::methods
