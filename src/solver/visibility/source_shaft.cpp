#include "visibility/source_shaft.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace exactff::visibility {

using kernel::Approx3;

void SourceShaft::set(OutlineId source) {
  source_ = source;
  if (query_.request.culls()) make_half_spaces();
  make_side_planes();
}

std::span<const Outlines::Edge> SourceShaft::edges() const {
  const Outlines::Outline& outline = outlines_.outline(source_);
  return outlines_.edges().subspan(outline.first, outline.count);
}

// The components of an edge's normal err by less than 12u |a||b| = 2^-49.4 |a||b| (outlines.h).
void SourceShaft::make_half_spaces() {
  std::vector<HalfSpace>& half_spaces = memory_.half_spaces;
  half_spaces.clear();
  for (const Outlines::Edge& edge : edges()) {
    half_spaces.push_back({edge.normal, 0.0, 0x1p-49 * outlines_.corner(edge.a).size * outlines_.corner(edge.b).size});
  }
  const Approx3& front = query_.plane.normal.approx;
  half_spaces.push_back({{-front.x, -front.y, -front.z}, 0.0});
  // front . (y - x) >= front . (point - x), a negative number that errs by less than 2^-49 of its terms' magnitudes.
  const Approx3 s = kernel::approx_difference(query_.plane.point, query_.view.x);
  const double terms[] = {front.x * s.x, front.y * s.y, front.z * s.z};
  const double magnitude = std::abs(terms[0]) + std::abs(terms[1]) + std::abs(terms[2]);
  half_spaces.push_back(
      {to_vec3(front), terms[0] + terms[1] + terms[2] - 0x1p-48 * magnitude, 0.0, 0x1p-47 * magnitude});
  memory_.groups.set(half_spaces);
}

// To the half-spaces of the edges, adds those on the other sides of the same planes.
void SourceShaft::narrow() {
  std::vector<HalfSpace>& half_spaces = memory_.half_spaces;
  for (std::size_t side = 0; side < edges().size(); ++side) {
    HalfSpace other = half_spaces[2 * side];
    other.normal = {-other.normal.x, -other.normal.y, -other.normal.z};
    half_spaces.insert(half_spaces.begin(), other);
  }
  memory_.groups.set(half_spaces);
}

// With N and s the normal and a point of the source's plane, as seen from x, the components of N, s and t are known to
// within a relative error of 2u, u = 2^-53, |N| <= 1. The two sums N . t and N . s err by 7u of the magnitudes of their
// terms, at most 3 |t| and 3 |s|, and their difference by u of at most 3 (|t| + |s|) more: in all by
// 24u (|t| + |s|) < 2^-48 (|t| + |s|).
void SourceShaft::make_side_planes() {
  std::vector<SidePlane>& planes = memory_.side_planes;
  planes.clear();
  const Approx3& front = query_.plane.normal.approx;
  const double scale = std::ldexp(1.0, outlines_.scale_exponent());
  const Approx3 d = kernel::approx_difference(query_.plane.point, query_.view.x);
  const Approx3 s{scale * d.x, scale * d.y, scale * d.z};  // scaled first: products of unscaled numbers may underflow
  const double size = std::max({std::abs(s.x), std::abs(s.y), std::abs(s.z)});
  const bool usable = size >= 0x1p-300 && size <= 0x1p300;
  const double offset = front.x * s.x + front.y * s.y + front.z * s.z;
  planes.push_back(
      {to_vec3(front), offset, 0x1p-48, usable ? 0x1p-48 * size : std::numeric_limits<double>::infinity()});
  planes.push_back({{-front.x, -front.y, -front.z}, 0.0, 0x1p-48, 0.0});
  if (!query_.request.culls()) return;
  for (const Outlines::Edge& edge : edges()) planes.push_back({edge.normal, 0.0, edge.error, 0.0});
}

Sides SourceShaft::sides_by_filter() const {
  constexpr std::size_t kFour = 4;
  const std::span<const CornerId> corners = clip_.corners();
  if (corners.size() > kFour) return {};
  FourCorners four;
  for (std::size_t c = 0; c < kFour; ++c) four[c] = &outlines_.corner(corners[std::min(c, corners.size() - 1)]);
  return sides_of(memory_.side_planes, four);
}

Sides SourceShaft::sides_exactly() {
  Sides sides{true, true, true, false, 0};
  const std::span<const CornerId> corners = clip_.corners();
  const auto look = [&](const auto& side) {  // the side of the c-th corner
    std::size_t above = 0;
    for (std::size_t c = 0; c < corners.size(); ++c) above += side(c) > 0 ? 1U : 0U;
    sides.some_above_each = sides.some_above_each && above > 0;
    sides.all_above_each = sides.all_above_each && above == corners.size();
  };
  const std::span<const int> depths = clip_.find_depths();
  sides.some_below_first = std::ranges::any_of(depths, [](int depth) { return depth < 0; });
  look([&](std::size_t c) { return depths[c]; });
  look([&](std::size_t c) { return clip_.toward_sign(corners[c]); });
  if (!query_.request.culls()) return sides;
  for (const Outlines::Edge& edge : edges()) {
    if (!sides.some_above_each) break;
    look([&](std::size_t c) { return outlines_.side(edge, corners[c]); });
  }
  return sides;
}

}  // namespace exactff::visibility
