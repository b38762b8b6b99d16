#include "visibility/piece_clip.h"

#include <algorithm>
#include <cmath>

namespace exactff::visibility {

using kernel::kUncertain;

ClippedSource PieceClip::add_source() {
  const kernel::Approx3 s = kernel::approx_difference(plane_.point, view_.x);
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

}  // namespace exactff::visibility
