#include "scene/shaft_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "scene/scene_data.h"

namespace exactff {

namespace {

Box joined(const Box& a, const Box& b) {
  return {{std::min(a.low.x, b.low.x), std::min(a.low.y, b.low.y), std::min(a.low.z, b.low.z)},
          {std::max(a.high.x, b.high.x), std::max(a.high.y, b.high.y), std::max(a.high.z, b.high.z)}};
}

// The centre, computed so that it cannot overflow. Only the shape of the tree depends on it.
Vec3 centre(const Box& box) {
  return {0.5 * box.low.x + 0.5 * box.high.x, 0.5 * box.low.y + 0.5 * box.high.y, 0.5 * box.low.z + 0.5 * box.high.z};
}

double coordinate(const Vec3& p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

int longest_axis(const Box& box) {
  const Vec3 size{0.5 * box.high.x - 0.5 * box.low.x, 0.5 * box.high.y - 0.5 * box.low.y,
                  0.5 * box.high.z - 0.5 * box.low.z};
  return size.x >= size.y ? (size.x >= size.z ? 0 : 2) : (size.y >= size.z ? 1 : 2);
}

// The largest sum of magnitudes of y - apex over the box.
double reach(const Box& box, const Vec3& apex) {
  return std::max(std::abs(box.low.x - apex.x), std::abs(box.high.x - apex.x)) +
         std::max(std::abs(box.low.y - apex.y), std::abs(box.high.y - apex.y)) +
         std::max(std::abs(box.low.z - apex.z), std::abs(box.high.z - apex.z));
}

// The largest normal . (y - apex) - offset over the box is proved negative. With u = 2^-53: each difference is
// rounded once (u), each product carries 2u of the normal and u of its own, three additions 3u of the sum m of
// magnitudes, the offset 2u: below 9u m in all, against a threshold of 2^-48 m = 32u m. Overflow makes m infinite
// and underflow is excluded by m >= 2^-900; NaN fails every comparison: each keeps the box. A further error e of the
// normal's components adds at most e times the largest differences anywhere in the box, whatever their signs.
bool certainly_outside_one(const Box& box, const Vec3& apex, const HalfSpace& h) {
  const double dx = (h.normal.x > 0.0 ? box.high.x : box.low.x) - apex.x;
  const double dy = (h.normal.y > 0.0 ? box.high.y : box.low.y) - apex.y;
  const double dz = (h.normal.z > 0.0 ? box.high.z : box.low.z) - apex.z;
  const double x = h.normal.x * dx, y = h.normal.y * dy, z = h.normal.z * dz;
  const double m = std::abs(x) + std::abs(y) + std::abs(z) + std::abs(h.offset);
  const double slack = h.error == 0.0 ? 0.0 : 1.001 * h.error * reach(box, apex);
  return x + y + z - h.offset < -0x1p-48 * m - slack && m >= 0x1p-900 && m <= 0x1p1000;
}

// The smallest normal . (y - apex) - offset over the box as computed, without proof: what is taken to be inside is
// kept.
bool is_inside(const Box& box, const Vec3& apex, const HalfSpace& h) {
  const double dx = (h.normal.x > 0.0 ? box.low.x : box.high.x) - apex.x;
  const double dy = (h.normal.y > 0.0 ? box.low.y : box.high.y) - apex.y;
  const double dz = (h.normal.z > 0.0 ? box.low.z : box.high.z) - apex.z;
  return h.normal.x * dx + h.normal.y * dy + h.normal.z * dz >= h.offset;
}

}  // namespace

std::uint64_t ShaftTree::crossed_half_spaces(const Box& box, const Vec3& apex, std::span<const HalfSpace> shaft,
                                             std::uint64_t asked) {
  std::uint64_t crossed = 0;
  for (std::size_t i = 0; i < shaft.size(); ++i) {
    const std::uint64_t bit = std::uint64_t{1} << std::min<std::size_t>(i, 62);
    if (i < 62 && (asked & bit) == 0) continue;
    if (certainly_outside_one(box, apex, shaft[i])) return kOutside;
    if (i < 62 && !is_inside(box, apex, shaft[i])) crossed |= bit;
  }
  return crossed;
}

bool ShaftTree::certainly_outside(const Box& box, const Vec3& apex, std::span<const HalfSpace> shaft) {
  return crossed_half_spaces(box, apex, shaft, kAllHalfSpaces) == kOutside;
}

ShaftTree::ShaftTree(std::span<const Box> boxes) : order_(boxes.size()) {
  if (boxes.empty()) return;
  std::iota(order_.begin(), order_.end(), 0U);
  nodes_.reserve(2 * boxes.size() / kLeafSize + 2);
  build(boxes, 0, static_cast<std::uint32_t>(boxes.size()));
  boxes_.reserve(boxes.size());
  for (const std::uint32_t index : order_) boxes_.push_back(boxes[index]);
}

// Median split along the longest axis; ties by index, so that the tree is one and the same everywhere.
void ShaftTree::build(std::span<const Box> boxes, std::uint32_t first, std::uint32_t last) {
  const std::size_t self = nodes_.size();
  Box box = boxes[order_[first]];
  for (std::uint32_t i = first + 1; i < last; ++i) box = joined(box, boxes[order_[i]]);
  nodes_.push_back({box, 0, first, last - first <= kLeafSize ? last - first : 0});
  if (last - first <= kLeafSize) return;
  const int axis = longest_axis(box);
  const std::uint32_t middle = first + (last - first) / 2;
  std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + last,
                   [&](std::uint32_t a, std::uint32_t b) {
                     const double ca = coordinate(centre(boxes[a]), axis);
                     const double cb = coordinate(centre(boxes[b]), axis);
                     return ca < cb || (ca == cb && a < b);
                   });
  build(boxes, first, middle);
  nodes_[self].right = static_cast<std::uint32_t>(nodes_.size());
  build(boxes, middle, last);
}

namespace {

Box box_of(const Scene& scene, const Piece& piece) {
  const auto corners = scene.corners(piece);
  const Vec3& first = scene.vertices()[corners.front()];
  Box box{first, first};
  for (const std::uint32_t corner : corners) {
    const Vec3& p = scene.vertices()[corner];
    box = joined(box, {p, p});
  }
  return box;
}

}  // namespace

const ShaftTree& shaft_tree(const Scene& scene) {
  const Scene::Data& data = scene.data();
  std::call_once(data.tree_built, [&] {
    std::vector<Box> boxes;
    boxes.reserve(scene.pieces().size());
    for (const Piece& piece : scene.pieces()) boxes.push_back(box_of(scene, piece));
    data.tree = ShaftTree(boxes);
  });
  return data.tree;
}

}  // namespace exactff
