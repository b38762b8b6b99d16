#include "view_factors/exact_scene.h"

#include <algorithm>

#include "kernel/poll.h"
#include "scene/closed_surfaces.h"
#include "scene/places.h"

namespace exactff::view_factors {
namespace {

// Without corners that lie between their neighbours on a line.
std::vector<std::uint32_t> true_corners(std::vector<std::uint32_t> corners, const std::vector<Point>& points) {
  for (std::size_t i = 0; i < corners.size() && corners.size() > 2;) {
    const std::size_t count = corners.size();
    const Point& before = points[corners[(i + count - 1) % count]];
    const Point& after = points[corners[(i + 1) % count]];
    if (is_zero(join(before, points[corners[i]], after))) {
      corners.erase(corners.begin() + static_cast<std::ptrdiff_t>(i));
      i = i == 0 ? 0 : i - 1;
    } else {
      ++i;
    }
  }
  return corners;
}

}  // namespace

void Box::include(const Vec3& v) {
  low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
  high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
}

bool Box::is_apart_from(const Box& other) const {
  constexpr double kGap = 0x1p-50;  // no coordinate exceeds 1
  const auto apart = [](double high_end, double low_end) { return high_end + kGap < low_end; };
  return apart(high.x, other.low.x) || apart(high.y, other.low.y) || apart(high.z, other.low.z) ||
         apart(other.high.x, low.x) || apart(other.high.y, low.y) || apart(other.high.z, low.z);
}

Box box_of(std::span<const Point> points) {
  Box box;
  for (const Point& point : points) box.include(point.at);
  return box;
}

ExactScene::ExactScene(const Scene& scene_in)
    : scene(scene_in), units(Units::of(scene_in.vertices())), vertices(scene_in.vertices().size()) {
  const Panels& panels = exactff::panels(scene);
  pieces.reserve(scene.pieces().size());
  for (PanelId id = 0; id < panels.end(); ++id) {
    kernel::poll();
    ExactPiece made = exact_piece(panels.piece(id), panels.corners(id));
    if (panels.is_joined(id)) {
      const std::uint32_t surface = panels.sheet_of(id).surface;
      made.surface = surface == ClosedSurfaces::kNone ? kNoSurface : surface;
    }
    (panels.is_joined(id) ? joined : pieces).push_back(std::move(made));
  }
  const ClosedSurfaces& closed = closed_surfaces(scene);
  surfaces = exact_surfaces(closed, pieces, units);
  if (closed.empty()) return;
  for (std::uint32_t i = 0; i < pieces.size(); ++i) {
    const std::uint32_t surface = closed.of_piece(i);
    if (surface != ClosedSurfaces::kNone) pieces[i].surface = surface;
  }
}

ExactPiece ExactScene::exact_piece(const Piece& piece, std::span<const std::uint32_t> corners) {
  const auto place_of = places(scene);
  ExactPiece made{piece.face, piece.transparent, kNoSurface, {}, {}, {}};
  for (const std::uint32_t corner : corners) {
    const std::uint32_t place = place_of[corner];
    if (sgn(vertices[place].exact[3]) == 0) vertices[place] = point_of(scene.vertices()[place], units);
    made.corners.push_back(place);
    made.box.include(vertices[place].at);
  }
  made.corners = true_corners(std::move(made.corners), vertices);
  made.plane = make_plane(join(vertices[made.corners[0]], vertices[made.corners[1]], vertices[made.corners[2]]), units);
  return made;
}

std::vector<ExactSurface> exact_surfaces(const ClosedSurfaces& closed, std::span<const ExactPiece> pieces,
                                         const Units& units) {
  std::vector<ExactSurface> surfaces;
  if (closed.empty()) return surfaces;
  for (const ClosedSurface& surface : closed.surfaces()) {
    surfaces.push_back({{}, surface.turned_inside_out, {}, {}});
    if (!surface.rim) continue;
    const auto& [a, b, c] = surface.rim->plane;
    surfaces.back().rim = make_plane(join(point_of(a, units), point_of(b, units), point_of(c, units)), units);
  }
  for (std::uint32_t i = 0; i < pieces.size(); ++i) {
    const std::uint32_t surface = closed.of_piece(i);
    if (surface == ClosedSurfaces::kNone) continue;
    surfaces[surface].pieces.push_back(i);
    surfaces[surface].box.include(pieces[i].box.low);
    surfaces[surface].box.include(pieces[i].box.high);
  }
  return surfaces;
}

}  // namespace exactff::view_factors
