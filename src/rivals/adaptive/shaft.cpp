#include "adaptive/shaft.h"

#include <algorithm>
#include <bit>
#include <numeric>

#include "kernel/expect.h"
#include "kernel/lanes.h"

namespace exactff::adaptive {

using namespace kernel::lanes;

namespace {

constexpr double kFormError = 0x1p-47;    // 64u
constexpr double kUnderflow = 0x1p-1000;  // more than underflow can add to a form

}  // namespace

ShaftSides::ShaftSides(const SubPatch& s) {
  const Four cx = load(s.x), cy = load(s.y), cz = load(s.z);
  const Four ex = next_lane(cx) - cx, ey = next_lane(cy) - cy, ez = next_lane(cz) - cz;
  store(ey * cz - ez * cy, x);
  store(ez * cx - ex * cz, y);
  store(ex * cy - ey * cx, z);
  const double size = highest(larger(larger(absolute(cx), absolute(cy)), absolute(cz)));
  const double longest_edge = highest(larger(larger(absolute(ex), absolute(ey)), absolute(ez)));
  error = kFormError * size * longest_edge;
}

namespace {

inline bool beyond_one_side(std::span<const Vec3> corners, double size, const ShaftSides& sides) {
  const Four x = load(sides.x), y = load(sides.y), z = load(sides.z);
  Four innermost = x * corners[0].x + y * corners[0].y + z * corners[0].z;
  for (const Vec3& t : corners.subspan(1)) {
    const Four inward = x * t.x + y * t.y + z * t.z;
    innermost = inward > innermost ? inward : innermost;
  }
  return lowest(innermost) < -(sides.error * size + kUnderflow);
}

// The same for the box around the corners: cheaper, and enough for most.
inline bool beyond_one_side(const SeenBox& box, const ShaftSides& sides) {
  const Four x = load(sides.x), y = load(sides.y), z = load(sides.z);
  const Four innermost = (x * box.centre.x + y * box.centre.y + z * box.centre.z) +
                         (absolute(x) * box.half.x + absolute(y) * box.half.y + absolute(z) * box.half.z);
  return lowest(innermost) < -(2.0 * sides.error * box.size + kUnderflow);
}

// Centre and half sides err by at most u of the size each, which the doubled bound above covers.
SeenBox box_around(std::span<const Vec3> corners) {
  Vec3 low = corners[0];
  Vec3 high = corners[0];
  for (const Vec3& t : corners) {
    low = {std::min(low.x, t.x), std::min(low.y, t.y), std::min(low.z, t.z)};
    high = {std::max(high.x, t.x), std::max(high.y, t.y), std::max(high.z, t.z)};
  }
  SeenBox box{(low + high) * 0.5, (high - low) * 0.5, 0.0};
  box.size = max_norm(box.centre) + max_norm(box.half);
  return box;
}

}  // namespace

void SeenPolygon::reverse() {
  std::reverse(corners.begin(), corners.end());
  std::reverse(edges.begin(), edges.end());
  std::rotate(edges.begin(), edges.begin() + 1, edges.end());
  for (Vec3& edge : edges) edge = -edge;
  normal.value = -normal.value;
}

void OccluderSet::clear() {
  occluders_.clear();
  forms_.clear();
  corners_.clear();
  boxes_.clear();
  stack_.clear();
}

void OccluderSet::add(const SeenPolygon& polygon, double reach) {
  const std::size_t count = polygon.corners.size();
  occluders_.push_back({static_cast<std::uint32_t>(forms_.size()), static_cast<std::uint32_t>(corners_.size()),
                        static_cast<std::uint32_t>(count)});
  corners_.insert(corners_.end(), polygon.corners.begin(), polygon.corners.end());
  boxes_.push_back(box_around(polygon.corners));
  for (std::size_t j = 0; j < count; ++j) {
    const Vec3& t = polygon.corners[j];
    const Vec3& edge = polygon.edges[j];
    const Vec3 inward = cross(edge, t);
    const double error = kFormError * max_norm(edge) * max_norm(t) * reach + kUnderflow;
    forms_.push_back({inward.x, inward.y, inward.z, 0.0, error});
  }
  const Vec3& normal = polygon.normal.value;
  const Vec3& t = polygon.corners[0];
  const double error = kFormError * max_norm(polygon.normal.magnitude) * (reach + max_norm(t)) + kUnderflow;
  forms_.push_back({normal.x, normal.y, normal.z, dot(normal, t), error});
}

CandidateRange OccluderSet::push_all() {
  const std::size_t first = stack_.size();
  stack_.resize(first + occluders_.size());
  std::iota(stack_.begin() + static_cast<std::ptrdiff_t>(first), stack_.end(), 0U);
  return {first, stack_.size()};
}

CandidateRange OccluderSet::push(std::span<const std::uint32_t> indices) {
  const std::size_t first = stack_.size();
  stack_.insert(stack_.end(), indices.begin(), indices.end());
  return {first, stack_.size()};
}

inline ShaftRelation OccluderSet::relation(std::uint32_t index, const SubPatch& s, const ShaftSides& sides) const {
  if (beyond_one_side(boxes_[index], sides)) return ShaftRelation::kOutside;
  const Occluder& o = occluders_[index];
  const Four x = load(s.x), y = load(s.y), z = load(s.z);
  bool cuts = true;
  for (const Form& f : forms(o)) {
    const Four value = x * f.x + y * f.y + z * f.z - f.offset;
    if (highest(value) < -f.error) return ShaftRelation::kOutside;
    cuts = cuts && lowest(value) > f.error;
  }
  if (cuts) return ShaftRelation::kCuts;
  return beyond_one_side(corners(o), boxes_[index].size, sides) ? ShaftRelation::kOutside : ShaftRelation::kInDoubt;
}

EXACTFF_CLONES
std::optional<CandidateRange> OccluderSet::inherit(CandidateRange parent, const SubPatch& s, const ShaftSides& sides) {
  const std::size_t first = stack_.size();
  stack_.resize(first + parent.size());
  std::uint32_t* next = stack_.data() + first;
  for (std::size_t k = parent.first; k < parent.last; ++k) {
    const ShaftRelation found = relation(stack_[k], s, sides);
    if (found == ShaftRelation::kCuts) {
      stack_.resize(first);
      return std::nullopt;
    }
    if (found == ShaftRelation::kInDoubt) *next++ = stack_[k];
  }
  stack_.resize(static_cast<std::size_t>(next - stack_.data()));
  return CandidateRange{first, stack_.size()};
}

// A ray is hidden by an occluder if no form is negative at its end.
EXACTFF_CLONES
unsigned OccluderSet::hidden_lanes(CandidateRange list, const RayEnds& ends, int first) const {
  EXACTFF_EXPECT(first >= 0 && first % RayEnds::kLanes == 0);
  const auto i = static_cast<std::size_t>(first);
  const Four x0 = load(&ends.x[i]), y0 = load(&ends.y[i]), z0 = load(&ends.z[i]);
  const Four x1 = load(&ends.x[i + 4]), y1 = load(&ends.y[i + 4]), z1 = load(&ends.z[i + 4]);
  FourMask hidden0{}, hidden1{};
  for (std::size_t k = list.first; k < list.last; ++k) {
    FourMask inside0 = ~FourMask{}, inside1 = ~FourMask{};
    for (const Form& f : forms(occluders_[stack_[k]])) {
      inside0 &= x0 * f.x + y0 * f.y + z0 * f.z >= four(f.offset);
      inside1 &= x1 * f.x + y1 * f.y + z1 * f.z >= four(f.offset);
    }
    hidden0 |= inside0;
    hidden1 |= inside1;
    if (all_lanes(hidden0 & hidden1)) break;
  }
  return lane_bits(hidden0) | lane_bits(hidden1) << 4;
}

int OccluderSet::count_visible(CandidateRange list, const RayEnds& ends) const {
  int visible = 0;
  for (int first = 0; first < ends.count; first += RayEnds::kLanes) {
    const int lanes = std::min(RayEnds::kLanes, ends.count - first);
    visible += lanes - std::popcount(hidden_lanes(list, ends, first) & ((1U << lanes) - 1));
  }
  return visible;
}

}  // namespace exactff::adaptive
