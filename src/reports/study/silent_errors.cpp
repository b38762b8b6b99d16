// Silent errors of sampling: leaves whose rays all agreed although the leaf is partly visible.
//
//   1. Find the plane of the source that holds the leaf.
//   2. Drop the axis along which that plane's normal is longest: ratios of areas are preserved.
//   3. Clip every loop of the visible region by the leaf's sides, one after the other (Sutherland and Hodgman 1974).
//      The clipped loop may run back along a side of the leaf, which adds no area.
//   4. V = area of the visible part / area of the part above the horizon. If V is strictly between 0 and 1, the leaf is
//      a silent error.
// These counts are for a report and use rounded coordinates. No value depends on them.
#include "study/silent_errors.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/vec.h"

namespace exactff::study {
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
