#include "scene/shaft_tree.h"

#include <cmath>
#include <numeric>

#include "kernel/lanes.h"
#include "kernel/vec.h"
#include "scene/scene.h"

namespace exactff {

using kernel::coordinate;

namespace {

Box joined(const Box& a, const Box& b) {
  return {{std::min(a.low.x, b.low.x), std::min(a.low.y, b.low.y), std::min(a.low.z, b.low.z)},
          {std::max(a.high.x, b.high.x), std::max(a.high.y, b.high.y), std::max(a.high.z, b.high.z)}};
}

// The centre, computed so that it cannot overflow. Only the shape of the tree depends on it.
Vec3 centre(const Box& box) {
  return {0.5 * box.low.x + 0.5 * box.high.x, 0.5 * box.low.y + 0.5 * box.high.y, 0.5 * box.low.z + 0.5 * box.high.z};
}

}  // namespace

int longest_axis(const Box& box) {
  const Vec3 size{0.5 * box.high.x - 0.5 * box.low.x, 0.5 * box.high.y - 0.5 * box.low.y,
                  0.5 * box.high.z - 0.5 * box.low.z};
  return size.x >= size.y ? (size.x >= size.z ? 0 : 2) : (size.y >= size.z ? 1 : 2);
}

void HalfSpaceGroups::set(std::span<const HalfSpace> half_spaces) {
  constexpr HalfSpace kEverything{{}, -1.0};
  groups_.clear();
  for (std::size_t i = 0; i < half_spaces.size(); i += kLanes) {
    Group& group = groups_.emplace_back();
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const HalfSpace& h = i + lane < half_spaces.size() ? half_spaces[i + lane] : kEverything;
      group.x[lane] = h.normal.x;
      group.y[lane] = h.normal.y;
      group.z[lane] = h.normal.z;
      group.offset[lane] = h.offset;
      group.error[lane] = 1.001 * h.error;
      group.blur[lane] = 1.001 * h.blur;
    }
  }
}

// Outside: the largest normal . (y - apex) - offset over the box is proved negative. Inside: the smallest is proved
// positive. With u = 2^-53: each difference is rounded once (u), each product carries 2u of the normal and u of its
// own, three additions 3u of the sum m of magnitudes, the offset 2u: below 9u m in all, against a threshold of 2^-48 m
// = 32u m. Overflow makes m infinite and underflow is excluded by m >= 2^-900; NaN fails every comparison. All these
// cases keep the box and treat it as cut. A further error e of the normal's components adds at most e times the largest
// differences anywhere in the box, whatever their signs.
EXACTFF_CLONES std::uint64_t ShaftTree::crossed_groups(const Box& box, const Vec3& apex,
                                                       std::span<const HalfSpaceGroups::Group> shaft,
                                                       std::uint64_t asked) {
  using namespace kernel::lanes;
  const Vec3 a{box.low.x - apex.x, box.low.y - apex.y, box.low.z - apex.z};
  const Vec3 b{box.high.x - apex.x, box.high.y - apex.y, box.high.z - apex.z};
  const double wide = std::max(std::abs(a.x), std::abs(b.x)), deep = std::max(std::abs(a.y), std::abs(b.y)),
               high = std::max(std::abs(a.z), std::abs(b.z)), reach = wide + deep + high;
  std::uint64_t crossed = 0;
  for (std::size_t g = 0; g < shaft.size(); ++g) {
    const std::uint64_t bit = g < kGroupBits ? std::uint64_t{1} << g : 0;
    if (bit != 0 && (asked & bit) == 0) continue;
    const HalfSpaceGroups::Group& group = shaft[g];
    const Four x = load(group.x.data()), y = load(group.y.data()), z = load(group.z.data()),
               offset = load(group.offset.data());
    const Four largest = larger(x * a.x, x * b.x) + larger(y * a.y, y * b.y) + larger(z * a.z, z * b.z) - offset;
    const Four smallest = smaller(x * a.x, x * b.x) + smaller(y * a.y, y * b.y) + smaller(z * a.z, z * b.z) - offset;
    const Four m = absolute(x) * wide + absolute(y) * deep + absolute(z) * high + absolute(offset);
    const Four error = 0x1p-48 * m + load(group.error.data()) * reach;
    const FourMask usable = (m >= 0x1p-900) & (m <= 0x1p1000);
    if (lane_bits((largest < -error) & usable) != 0) return kOutside;
    if (!all_lanes((smallest > error + load(group.blur.data())) & usable)) crossed |= bit;
  }
  return crossed;
}

bool ShaftTree::certainly_outside(const Box& box, const Vec3& apex, std::span<const HalfSpace> shaft) {
  return crossed_groups(box, apex, HalfSpaceGroups(shaft).groups(), kAllGroups) == kOutside;
}

bool ShaftTree::certainly_inside(const Box& box, const Vec3& apex, const HalfSpace& half_space) {
  return crossed_groups(box, apex, HalfSpaceGroups({&half_space, 1}).groups(), kAllGroups) == 0;
}

ShaftTree::ShaftTree(std::span<const Box> boxes, std::span<const std::uint32_t> ids) : order_(boxes.size()) {
  if (boxes.empty()) return;
  std::iota(order_.begin(), order_.end(), 0U);
  nodes_.reserve(2 * boxes.size() / kLeafSize + 2);
  build(boxes, 0, static_cast<std::uint32_t>(boxes.size()));
  boxes_.reserve(boxes.size());
  for (const std::uint32_t index : order_) boxes_.push_back(boxes[index]);
  if (ids.empty()) return;
  for (std::uint32_t& index : order_) index = ids[index];
}

// Components below this are not divided by: the ray then counts as meeting the slab everywhere.
RaySlabs::RaySlabs(const Vec3& from, const Vec3& along) {
  constexpr double kLeast = 0x1p-500;
  for (int i = 0; i < 3; ++i) {
    const double slope = coordinate(along, i);
    axes_[i] = {coordinate(from, i), std::abs(slope) >= kLeast ? 1.0 / slope : 0.0, slope == 0.0};
  }
}

// The difference, the inverse and the product are each rounded once, so a t is within 3u (1 + 3u), u = 2^-53, of its
// value or within 2^-1074 if it underflows. The bounds are moved outward by more than that. A difference that overflows
// gives an infinite t; the largest double is a lower bound for it.
double RaySlabs::entry(const Box& box) const {
  constexpr double kMore = 1.0 + 0x1p-50, kLess = 1.0 - 0x1p-50, kTiny = 0x1p-1060;
  double near = 0.0, far = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    const Axis& axis = axes_[i];
    const double low = coordinate(box.low, i), high = coordinate(box.high, i);
    if (axis.fixed && (axis.from < low || axis.from > high)) return kMissed;
    if (axis.inverse == 0.0) continue;
    double first = (low - axis.from) * axis.inverse, last = (high - axis.from) * axis.inverse;
    if (axis.inverse < 0.0) std::swap(first, last);
    near = std::max(near, first * (first > 0.0 ? kLess : kMore) - kTiny);
    far = std::min(far, last * (last > 0.0 ? kMore : kLess) + kTiny);
  }
  return near <= far ? std::min(near, std::numeric_limits<double>::max()) : kMissed;
}

// Median split along the longest axis; ties by index, so that the tree is the same on every machine.
void ShaftTree::build(std::span<const Box> boxes, std::uint32_t first, std::uint32_t last) {
  const std::size_t self = nodes_.size();
  Box box = boxes[order_[first]];
  for (std::uint32_t i = first + 1; i < last; ++i) box = joined(box, boxes[order_[i]]);
  nodes_.push_back({box, 0, first, last - first});
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

Box box_of(const Scene& scene, std::span<const std::uint32_t> corners) {
  const Vec3& first = scene.vertices()[corners.front()];
  Box box{first, first};
  for (const std::uint32_t corner : corners) {
    const Vec3& p = scene.vertices()[corner];
    box = joined(box, {p, p});
  }
  return box;
}

const ShaftTree& shaft_tree(const Scene& scene) {
  return SceneInside::data(scene).tree.made_by([&] {
    std::vector<Box> boxes;
    boxes.reserve(scene.pieces().size());
    for (const Piece& piece : scene.pieces()) boxes.push_back(box_of(scene, scene.corners(piece)));
    return ShaftTree(boxes);
  });
}

// --- Extent ---

namespace {

Extent extent_of(const Scene& scene) {
  Extent extent;
  const auto for_each_corner = [&](const auto& take) {
    for (const Piece& piece : scene.pieces()) {
      for (const std::uint32_t v : scene.corners(piece)) take(scene.vertices()[v]);
    }
  };
  for_each_corner([&](const Vec3& p) { extent.largest = std::max(extent.largest, kernel::max_norm(p)); });
  if (extent.largest == 0.0) return extent;
  extent.scale = std::ldexp(1.0, -std::clamp(std::ilogb(extent.largest) + 1, -1022, 1022));
  Box box{{1, 1, 1}, {-1, -1, -1}};
  for_each_corner([&](const Vec3& p) { box.include(kernel::scaled(p, extent.scale)); });
  const Vec3 sides = kernel::difference(box.high, box.low);
  extent.diameter = std::min(std::hypot(sides.x, sides.y, sides.z) / extent.scale, std::numeric_limits<double>::max());
  return extent;
}

}  // namespace

const Extent& extent(const Scene& scene) {
  return SceneInside::data(scene).extent.made_by([&] { return extent_of(scene); });
}

}  // namespace exactff
