#include "visibility/source_shaft.h"

#include <cmath>
#include <limits>

#include "kernel/lanes.h"

namespace exactff::visibility {

// --- Side planes ---

using namespace kernel::lanes;

EXACTFF_CLONES Sides sides_of(std::span<const SidePlane> planes, const FourCorners& corners) {
  constexpr unsigned kAll = 15;
  const auto& [a, b, c, d] = corners;
  const Four x{a->t.x, b->t.x, c->t.x, d->t.x}, y{a->t.y, b->t.y, c->t.y, d->t.y}, z{a->t.z, b->t.z, c->t.z, d->t.z},
      size{a->size, b->size, c->size, d->size};
  Sides sides{true, true, true, false, 0};
  bool is_first = true;
  Outlines::LineBits bit = 1;  // 0 after the 32nd plane
  for (const SidePlane& plane : planes) {
    const Four height = plane.normal.x * x + plane.normal.y * y + plane.normal.z * z - plane.offset;
    const Four error = plane.error_per_size * size + plane.error;
    const unsigned above = lane_bits(height > error), below = lane_bits(-height > error);
    if (below == kAll) return {true, false, false, is_first, 0, true};  // one plane is enough, whatever the others say
    sides.certain = sides.certain && (above | below) == kAll;
    sides.some_above_each = sides.some_above_each && above != 0;
    sides.all_above_each = sides.all_above_each && above == kAll;
    if (is_first) sides.some_below_first = below != 0;
    if (above == kAll) sides.wholly_above |= bit;
    is_first = false;
    bit <<= 1U;
  }
  return sides;
}

// --- Piece clip ---

ClippedSource PieceClip::add_source() {
  const Approx3 s = kernel::approx_difference(plane_.point, view_.x);
  outlines_.start(view_.scene, view_.x, std::max({std::abs(s.x), std::abs(s.y), std::abs(s.z)}));
  outlines_.set_source_plane(plane_.normal.exact, plane_.fine_normal, plane_.point);
  const Panels& all = *plane_.scene_panels;
  ClippedSource source;
  for (const PanelId panel : by_pieces_ ? plane_.pieces : plane_.panels) {
    if (add_above_horizon(all.corners(panel), source)) ++source.count;
  }
  return source;
}

int PieceClip::horizon_side(CornerId corner) const {
  const int filtered = outlines_.side_by_filter({view_.n.x, view_.n.y, view_.n.z}, corner);
  if (filtered != kUncertain) return filtered;
  return kernel::exact_sign_of_dot(view_.n, {view_.x, outlines_.position(*outlines_.vertex(corner))});
}

// False if nothing with an interior is left.
bool PieceClip::add_above_horizon(std::span<const std::uint32_t> corners, ClippedSource& source) {
  take(corners);
  std::vector<int>& depths = memory_.depths;
  depths.clear();
  for (const CornerId corner : memory_.corners) depths.push_back(horizon_side(corner));
  const bool above = std::ranges::any_of(depths, [](int depth) { return depth > 0; });
  const bool below = std::ranges::any_of(depths, [](int depth) { return depth < 0; });
  if (below || !above) source.is_cut = true;
  if (!above) return false;
  if (below) {
    outlines_.set_horizon(view_.n);
    add_part_above(Outlines::Plane::kHorizon, false);
  } else {
    outlines_.add(memory_.corners, true);
  }
  return true;
}

std::span<const int> PieceClip::find_depths() {
  memory_.depths.clear();
  for (const CornerId corner : memory_.corners) memory_.depths.push_back(depth_sign(*outlines_.vertex(corner)));
  return memory_.depths;
}

int PieceClip::depth_sign(std::uint32_t vertex) const {
  const Vec3& v = outlines_.position(vertex);
  const int filtered = kernel::sign_of_dot(plane_.normal.approx, kernel::approx_difference(v, plane_.point));
  return filtered != kUncertain ? filtered : kernel::orientation(plane_.point, plane_.second, plane_.third, v);
}

int PieceClip::toward_sign(CornerId corner) const {
  const int filtered = outlines_.side_by_filter(plane_.normal.approx, corner);
  if (filtered != kUncertain) return -filtered;
  const Vec3& v = outlines_.position(*outlines_.vertex(corner));
  return -kernel::exact_sign_of_det({plane_.point, plane_.second}, {plane_.point, plane_.third}, {view_.x, v});
}

OutlineId PieceClip::add_occluder(bool is_cut, int facing) {
  if (is_cut) {
    find_depths();
    return add_part_above(Outlines::Plane::kSource, facing > 0);
  }
  if (facing > 0) std::reverse(memory_.corners.begin(), memory_.corners.end());
  return outlines_.add(memory_.corners, true);
}

// The part where depths are not negative.
OutlineId PieceClip::add_part_above(Outlines::Plane plane, bool mirrored) {
  const std::vector<CornerId>& corners = memory_.corners;
  const std::vector<int>& depths = memory_.depths;
  std::vector<CornerId>& ring = memory_.ring;
  ring.clear();
  for (std::size_t c = 0; c < corners.size(); ++c) {
    const std::size_t next = (c + 1) % corners.size();
    if (depths[c] >= 0) ring.push_back(corners[c]);
    if (depths[c] * depths[next] < 0) ring.push_back(outlines_.add_crossing(plane, vertices_[c], vertices_[next]));
  }
  if (mirrored) std::reverse(ring.begin(), ring.end());
  return outlines_.add(ring, false);
}

// --- Source shaft ---

void SourceShaft::set(OutlineId source) {
  source_ = source;
  if (query_.request.culls()) make_half_spaces();
  make_side_planes();
}

std::span<const Outlines::Edge> SourceShaft::edges() const {
  const Outlines::Outline& outline = outlines_.outline(source_);
  return outlines_.edges().subspan(outline.first, outline.count);
}

void SourceShaft::make_half_spaces() {
  std::vector<HalfSpace>& half_spaces = memory_.half_spaces;
  half_spaces.clear();
  for (const Outlines::Edge& edge : edges()) {
    half_spaces.push_back(
        {edge.normal, 0.0, kernel::kCrossError * outlines_.corner(edge.a).size * outlines_.corner(edge.b).size});
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

void SourceShaft::make_side_planes() {
  constexpr double kError = kernel::kDotDifferenceError;
  std::vector<SidePlane>& planes = memory_.side_planes;
  planes.clear();
  const Approx3& front = query_.plane.normal.approx;
  const double scale = std::ldexp(1.0, outlines_.scale_exponent());
  const Approx3 d = kernel::approx_difference(query_.plane.point, query_.view.x);
  const Approx3 s{scale * d.x, scale * d.y, scale * d.z};  // scaled first: products of unscaled numbers may underflow
  const double size = std::max({std::abs(s.x), std::abs(s.y), std::abs(s.z)});
  const double offset = front.x * s.x + front.y * s.y + front.z * s.z;
  planes.push_back({to_vec3(front), offset, kError,
                    kernel::is_moderate(size) ? kError * size : std::numeric_limits<double>::infinity()});
  planes.push_back({{-front.x, -front.y, -front.z}, 0.0, kError, 0.0});
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
