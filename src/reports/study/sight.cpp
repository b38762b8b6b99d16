#include "study/sight.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "files/parallel.h"
#include "kernel/expect.h"
#include "kernel/vec.h"
#include "study/settings.h"
#include "study/statistics.h"

namespace exactff::study {
namespace {

Sight sight_by(Outcome outcome) {
  switch (outcome) {
    case Outcome::kUnoccluded:
      return Sight::kVisible;
    case Outcome::kPartlyHidden:
      return Sight::kPartly;
    case Outcome::kHiddenByOne:
    case Outcome::kHiddenByUnion:
      return Sight::kHidden;
    case Outcome::kBuried:
    case Outcome::kReceiverFace:
    case Outcome::kBehind:
    case Outcome::kBelowHorizon:
      break;
  }
  return Sight::kNothing;
}

void take_evenly(std::vector<std::size_t>& chosen, const std::vector<std::size_t>& from, std::size_t count) {
  count = std::min(count, from.size());
  for (std::size_t i = 0; i < count; ++i) chosen.push_back(from[(2 * i + 1) * from.size() / (2 * count)]);
}

// --- the profile ---

// The one lattice that all receivers belong to; null if there is none.
const Lattice* lattice_of(const std::vector<Receiver>& receivers) {
  if (receivers.empty() || !receivers.front().cell) return nullptr;
  const Lattice* const lattice = receivers.front().cell->lattice.get();
  const auto on_it = [&](const Receiver& r) { return r.cell && r.cell->lattice.get() == lattice; };
  return std::ranges::all_of(receivers, on_it) ? lattice : nullptr;
}

constexpr int kPoints = 256;
constexpr int kBisections = 20;
constexpr std::size_t kMostCurves = 3;

struct Line {
  const Lattice& lattice;
  int row = 0;
};

std::optional<Line> line_through_penumbra(const Study& study) {
  const Lattice* const lattice = lattice_of(study.request.receivers);
  if (lattice == nullptr || lattice->size.u < 2) return std::nullopt;
  std::map<int, int> partly_by_row;
  for (std::size_t i = 0; i < study.exact.size(); ++i) {
    if (study.exact[i].sight == Sight::kPartly) ++partly_by_row[study.request.receivers[i].cell->row];
  }
  const auto most = std::max_element(partly_by_row.begin(), partly_by_row.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  if (most == partly_by_row.end()) return std::nullopt;
  return Line{*lattice, most->first};
}

class Profiler {
 public:
  Profiler(const Study& study, std::span<const ExactSource> sources, const Hooks& hooks)
      : study_(study), sources_(sources), hooks_(hooks) {
    for (const Selection& source : request().sources) radiosities_.push_back(scene().source_radiosity(source));
  }

  std::optional<Profile> along(const Line& line) {
    take_receivers(line);
    if (profile_.receivers.size() < 2) return std::nullopt;
    profile_.where = "row " + std::to_string(line.row) + " of " + name_of(scene(), line.lattice.region);
    find_exact();
    find_kinks();
    add_curves();
    return std::move(profile_);
  }

 private:
  [[nodiscard]] const Request& request() const { return study_.request; }
  [[nodiscard]] const Scene& scene() const { return *request().scene; }

  void take_receivers(const Line& line) {
    const GridSize size = line.lattice.size;
    const GridSize finer{size.u * std::max(1, kPoints / size.u), size.v};
    for (Receiver& receiver : grid_receivers(scene(), std::span(&line.lattice.region, 1), finer)) {
      if (receiver.cell->row == line.row) profile_.receivers.push_back(std::move(receiver));
    }
    for (const Receiver& receiver : profile_.receivers) {
      profile_.position.push_back(kernel::distance(receiver.point, profile_.receivers.front().point));
    }
  }

  [[nodiscard]] double radiosity(const Receiver& receiver, const std::vector<double>& form_factors) const {
    Rgb sum;
    for (std::size_t s = 0; s < form_factors.size(); ++s) add(sum, times(radiosities_[s], form_factors[s]));
    return times(scene().receiver_reflectance(receiver.on), sum).largest();
  }

  void find_exact() {
    const std::size_t count = profile_.receivers.size();
    profile_.exact.resize(count);
    sights_.resize(count);
    files::parallel_for(count, request().threads, "profile", hooks_, [&](std::size_t i) {
      const Receiver& receiver = profile_.receivers[i];
      std::vector<double> values;
      for (const ExactSource& source : sources_) {
        const FormFactor result = exact_form_factor(scene(), receiver, source);
        values.push_back(result.value);
        sights_[i].push_back(sight_of(result));
      }
      profile_.exact[i] = radiosity(receiver, values);
    });
  }

  [[nodiscard]] Receiver between(std::size_t i, double t) const {
    Receiver receiver = profile_.receivers[i];
    const Vec3 &p = receiver.point, &q = profile_.receivers[i + 1].point;
    receiver.point = kernel::along(p, kernel::difference(q, p), t);
    return receiver;
  }

  // Finds by bisection a kink between two points whose sights differ.
  void find_kinks() {
    for (std::size_t i = 0; i + 1 < profile_.receivers.size(); ++i) {
      if (sights_[i] == sights_[i + 1]) continue;
      double low = 0.0, high = 1.0;
      for (int step = 0; step < kBisections; ++step) {
        const double middle = 0.5 * (low + high);
        (sights(scene(), between(i, middle), sources_) == sights_[i] ? low : high) = middle;
      }
      profile_.kinks.push_back(profile_.position[i] + low * (profile_.position[i + 1] - profile_.position[i]));
    }
  }

  // The middle rungs of the most common methods.
  void add_curves() {
    for (const char* wanted : {"adaptive", "hemicube", "area-sampling"}) {
      const auto& ladders = study_.methods.ladders;
      const auto found = std::find_if(ladders.begin(), ladders.end(), [&](const Ladder& ladder) {
        return ladder.rungs.front().method->name == wanted;
      });
      if (found != ladders.end() && profile_.others.size() < kMostCurves) add_curve(*found);
    }
  }

  void add_curve(const Ladder& ladder) {
    const std::size_t rung = ladder.rungs.size() / 2;
    const methods::Choice& choice = ladder.rungs[rung];
    const PreparedMethod prepared(*choice.method, scene(), request().sources);
    ReadySetting setting(prepared, choice.settings);
    Profile::Curve curve{rung_name(ladder, rung), {}};
    for (const Receiver& receiver : profile_.receivers) {
      std::vector<double> values;
      for (const methods::Estimate& one : setting.look_from(receiver)) values.push_back(one.form_factor);
      curve.radiosity.push_back(radiosity(receiver, values));
    }
    profile_.others.push_back(std::move(curve));
  }

  const Study& study_;
  std::span<const ExactSource> sources_;
  const Hooks& hooks_;
  std::vector<Rgb> radiosities_;
  std::vector<std::vector<Sight>> sights_;
  Profile profile_;
};

}  // namespace

Sight sight_of(const FormFactor& result) {
  Sight sight = Sight::kNothing;
  for (const PlaneRecord& plane : result.planes) sight = joined(sight, sight_by(plane.outcome));
  return sight;
}

Sight joined(Sight a, Sight b) {
  if (a == Sight::kNothing) return b;
  if (b == Sight::kNothing || a == b) return a;
  return Sight::kPartly;
}

bool needs_rays(const FormFactor& result) {
  return std::any_of(result.planes.begin(), result.planes.end(), [](const PlaneRecord& plane) {
    return plane.outcome == Outcome::kPartlyHidden || plane.outcome == Outcome::kHiddenByUnion;
  });
}

std::vector<std::size_t> choose_receivers(const std::vector<ExactRow>& exact, std::size_t count) {
  std::vector<std::size_t> partly, visible;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    if (exact[i].sight == Sight::kPartly) partly.push_back(i);
    if (exact[i].sight == Sight::kVisible) visible.push_back(i);
  }
  const std::size_t of_visible = std::max(count / 3, count - std::min(count, partly.size()));
  std::vector<std::size_t> chosen;
  take_evenly(chosen, visible, of_visible);
  take_evenly(chosen, partly, count - chosen.size());
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

std::string_view to_string(Sight sight) {
  constexpr std::array<std::string_view, 4> kNames = {"faces away", "hidden", "partly hidden", "visible"};
  return kNames[static_cast<std::size_t>(sight)];
}

std::vector<Sight> sights(const Scene& scene, const Receiver& receiver, std::span<const ExactSource> sources) {
  std::vector<Sight> result;
  for (const ExactSource& source : sources) result.push_back(sight_of(exact_form_factor(scene, receiver, source)));
  return result;
}

std::variant<Profile, LeftOut> find_profile(const Study& study, std::span<const ExactSource> sources,
                                            const Hooks& hooks) {
  EXACTFF_EXPECT(study.exact.size() == study.request.receivers.size());
  const auto line = line_through_penumbra(study);
  if (auto profile = line ? Profiler(study, sources, hooks).along(*line) : std::nullopt) return *std::move(profile);
  return LeftOut{"penumbra profile",
                 "the receivers are not one grid on one quadrilateral on which some see a source partly"};
}

// --- Silent errors ---

// Silent errors of sampling: leaves whose rays all agreed although the leaf is partly visible.
//
//   1. Find the plane of the source that holds the leaf.
//   2. Drop the axis along which that plane's normal is longest: ratios of areas are preserved.
//   3. Clip every loop of the visible region by the leaf's sides, one after the other (Sutherland and Hodgman 1974).
//      The clipped loop may run back along a side of the leaf, which adds no area.
//   4. V = area of the visible part / area of the part above the horizon. If V is strictly between 0 and 1, the leaf is
//      a silent error.
// These counts are for a report and use rounded coordinates. No value depends on them.

namespace {

constexpr double kNegligible = 1e-9;

struct FlatPoint {
  double u = 0.0;
  double v = 0.0;
};
using Polygon = std::vector<FlatPoint>;

// Coordinates in the plane, relative to `origin`; the axis of the largest normal component is dropped.
FlatPoint flattened(const Vec3& p, const Vec3& origin, const Vec3& normal) {
  const Vec3 d = kernel::difference(p, origin);
  const double x = std::abs(normal.x), y = std::abs(normal.y), z = std::abs(normal.z);
  if (x >= y && x >= z) return {d.y, d.z};
  return y >= z ? FlatPoint{d.z, d.x} : FlatPoint{d.x, d.y};
}

Polygon flattened(const std::vector<Vec3>& corners, const Vec3& origin, const Vec3& normal) {
  Polygon polygon;
  for (const Vec3& corner : corners) polygon.push_back(flattened(corner, origin, normal));
  return polygon;
}

double signed_area(const Polygon& polygon) {
  double twice = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const FlatPoint& a = polygon[i];
    const FlatPoint& b = polygon[(i + 1) % polygon.size()];
    twice += a.u * b.v - a.v * b.u;
  }
  return 0.5 * twice;
}

// Positive if p is to the left of the line from a to b.
double side_of(const FlatPoint& p, const FlatPoint& a, const FlatPoint& b) {
  return (b.u - a.u) * (p.v - a.v) - (b.v - a.v) * (p.u - a.u);
}

Polygon left_part(const Polygon& polygon, const FlatPoint& a, const FlatPoint& b) {
  Polygon kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const FlatPoint& p = polygon[i];
    const FlatPoint& q = polygon[(i + 1) % polygon.size()];
    const double side_p = side_of(p, a, b);
    const double side_q = side_of(q, a, b);
    if (side_p >= 0.0) kept.push_back(p);
    if ((side_p > 0.0 && side_q < 0.0) || (side_p < 0.0 && side_q > 0.0)) {
      const double t = side_p / (side_p - side_q);
      kept.push_back({p.u + t * (q.u - p.u), p.v + t * (q.v - p.v)});
    }
  }
  return kept;
}

double clipped_area(Polygon polygon, const Polygon& convex) {
  for (std::size_t i = 0; i < convex.size() && !polygon.empty(); ++i) {
    polygon = left_part(polygon, convex[i], convex[(i + 1) % convex.size()]);
  }
  return std::abs(signed_area(polygon));
}

std::vector<Vec3> corners_of(const Leaf& leaf) {
  return {leaf.corners.begin(), leaf.corners.begin() + leaf.corner_count};
}

// The distance of the leaf from the plane, in units of the normal; infinite if the leaf faces the other way.
double misfit(const std::vector<Vec3>& leaf, const PlaneDrawing& plane) {
  const Vec3 front = kernel::cross(kernel::difference(leaf[1], leaf[0]), kernel::difference(leaf[2], leaf[0]));
  if (plane.source.empty() || kernel::dot(front, plane.normal) <= 0.0) return std::numeric_limits<double>::infinity();
  double worst = 0.0;
  for (const Vec3& corner : leaf) {
    worst = std::max(
        worst, std::abs(kernel::dot(plane.normal, kernel::difference(corner, plane.source.front().corners.front()))));
  }
  return worst / kernel::length(plane.normal);
}

void judge(const Leaf& leaf, const std::vector<PlaneDrawing>& truth, SampledVerdict& verdict) {
  const std::vector<Vec3> corners = corners_of(leaf);
  const PlaneDrawing* plane = plane_of(leaf, truth);
  if (plane == nullptr) return;
  const double whole = area_inside(plane->clipped_source, corners, plane->normal);
  if (!(whole > 0.0)) return;
  const double visible = area_inside(plane->visible, corners, plane->normal) / whole;
  const bool none = visible <= kNegligible;
  const bool all = visible >= 1.0 - kNegligible;
  if (!none && !all) ++verdict.silent;
  if (leaf.reason == LeafReason::kSampledVisible ? none : all) ++verdict.wrong;
  const double sampled = leaf.reason == LeafReason::kSampledVisible ? 1.0 : 0.0;
  const double truth_here = none ? 0.0 : all ? 1.0 : visible;
  verdict.error += leaf.form_factor * (sampled - truth_here);
}

}  // namespace

const PlaneDrawing* plane_of(const Leaf& leaf, const std::vector<PlaneDrawing>& planes) {
  const std::vector<Vec3> corners = corners_of(leaf);
  const PlaneDrawing* best = nullptr;
  double smallest = std::numeric_limits<double>::infinity();
  for (const PlaneDrawing& plane : planes) {
    const double distance = misfit(corners, plane);
    if (distance < smallest) {
      smallest = distance;
      best = &plane;
    }
  }
  return best;
}

double area_inside(const std::vector<Loop>& loops, const std::vector<Vec3>& convex, const Vec3& normal) {
  Polygon window = flattened(convex, convex.front(), normal);
  if (signed_area(window) < 0.0) window = Polygon(window.rbegin(), window.rend());
  double area = 0.0;
  for (const Loop& loop : loops) {
    const double part = clipped_area(flattened(loop.corners, convex.front(), normal), window);
    area += loop.hole ? -part : part;
  }
  return area;
}

SampledVerdict judge_leaves(const std::vector<Leaf>& leaves, const std::vector<PlaneDrawing>& truth) {
  SampledVerdict verdict;
  for (const Leaf& leaf : leaves) {
    const bool sampled = leaf.reason == LeafReason::kSampledVisible || leaf.reason == LeafReason::kSampledHidden;
    if (sampled) judge(leaf, truth, verdict);
  }
  return verdict;
}

}  // namespace exactff::study
