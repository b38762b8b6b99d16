// An R-tree, built in one step. A query takes the box around the point and keeps what is within the ball. Unlike a grid
// of cells, it works with a tolerance of 0 and with coordinates of any size.
#include "check/position_index.h"

#include <algorithm>
#include <boost/geometry/algorithms/disjoint.hpp>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <boost/geometry/strategies/strategies.hpp>
#include <cmath>
#include <iterator>
#include <utility>

namespace exactff::check {
namespace {

namespace bg = boost::geometry;
using Point = bg::model::point<double, 3, bg::cs::cartesian>;
using Box = bg::model::box<Point>;
using Entry = std::pair<Point, std::uint32_t>;

// Normalises v without overflow or underflow, so that its length is near 1. Zero stays zero.
Vec3 unit(const Vec3& v) {
  const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  if (largest == 0.0) return v;
  const Vec3 scaled{v.x / largest, v.y / largest, v.z / largest};
  const double length = std::hypot(scaled.x, scaled.y, scaled.z);
  return {scaled.x / length, scaled.y / length, scaled.z / length};
}

}  // namespace

struct PositionIndex::Tree {
  bg::index::rtree<Entry, bg::index::linear<16>> entries;
};

PositionIndex::PositionIndex(const Truth& truth, const MatchOptions& options, bool normals)
    : truth_(truth),
      tolerance_(options.tolerance),
      normal_tolerance_(options.normal_tolerance),
      normals_(normals),
      tree_(std::make_unique<Tree>()) {
  std::vector<Entry> entries;
  entries.reserve(truth.rows.size());
  for (std::uint32_t i = 0; i < truth.rows.size(); ++i) {
    const Vec3& p = truth.rows[i].point;
    entries.emplace_back(Point(p.x, p.y, p.z), i);
  }
  tree_->entries = {entries.begin(), entries.end()};
}

PositionIndex::~PositionIndex() = default;

std::vector<std::uint32_t> PositionIndex::near(const Vec3& point, const Vec3& normal, std::uint32_t source) const {
  const double t = tolerance_;
  const Box box({point.x - t, point.y - t, point.z - t}, {point.x + t, point.y + t, point.z + t});
  std::vector<std::pair<double, std::uint32_t>> found;
  for (auto entry = tree_->entries.qbegin(bg::index::intersects(box)); entry != tree_->entries.qend(); ++entry) {
    const TruthRow& row = truth_.rows[entry->second];
    const double away = distance(row.point, point);
    if (row.source != source || away > t) continue;
    if (normals_ && distance(unit(row.normal), unit(normal)) > normal_tolerance_) continue;
    found.emplace_back(away, entry->second);
  }
  std::sort(found.begin(), found.end());
  std::vector<std::uint32_t> rows;
  for (const auto& [away, row] : found) rows.push_back(row);
  return rows;
}

double distance(const Vec3& a, const Vec3& b) { return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z); }

}  // namespace exactff::check
