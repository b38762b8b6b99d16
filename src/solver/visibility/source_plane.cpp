#include "visibility/source_plane.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <string>

#include "scene/contacts.h"
#include "visibility/polygon_sets.h"

namespace exactff::visibility {

namespace {

ExactVec3 front_normal(const Scene& scene, const Piece& piece) {
  const auto vertices = scene.vertices();
  const Vec3& a = vertices[piece.frame[0]];
  ExactVec3 normal = cross(kernel::exact_difference(vertices[piece.frame[1]], a).v,
                           kernel::exact_difference(vertices[piece.frame[2]], a).v);
  make_primitive(normal);
  return normal;
}

// One text for one oriented plane: the primitive normal N and the number N . p of any point p in it.
std::string plane_key(const ExactVec3& normal, const Vec3& point) {
  const ScaledVec3 p = kernel::exact_vector(point);
  Integer offset = dot(normal, p.v);
  long exponent = 0;
  if (sign(offset) != 0) {
    const mp_bitcnt_t zeros = mpz_scan1(offset.get_mpz_t(), 0);
    offset >>= zeros;
    exponent = p.exponent + static_cast<long>(zeros);
  }
  std::string key;
  for (const Integer* number : {&normal.x, &normal.y, &normal.z, static_cast<const Integer*>(&offset)})
    key += number->get_str(32) + ' ';
  return key + std::to_string(exponent);
}

// Of a sheet that is not all in the plane, as when one of its faces is selected, the pieces remain, and of one that is
// buried in part.
std::vector<PanelId> panels_of(const SourcePlane& plane) {
  const Panels& all = *plane.scene_panels;
  const std::vector<std::uint32_t>& pieces = plane.pieces;
  if (all.empty() || !plane.covers.empty()) return pieces;
  std::vector<PanelId> result;
  std::map<std::uint32_t, bool> is_whole;  // by sheet
  for (const std::uint32_t piece : pieces) {
    const std::uint32_t index = all.sheet_of_piece(piece);
    if (index == Panels::kNoSheet) {
      result.push_back(piece);
      continue;
    }
    const Sheet& sheet = all.sheets()[index];
    const auto [known, is_new] = is_whole.try_emplace(index);
    if (is_new) known->second = std::ranges::includes(pieces, sheet.pieces);
    if (!known->second) result.push_back(piece);
    for (PanelId k = 0; is_new && known->second && k < sheet.panel_count; ++k) result.push_back(sheet.first_panel + k);
  }
  std::ranges::sort(result);
  return result;
}

void set_covers(const Scene& scene, SourcePlane& plane) {
  std::set<std::uint32_t> covers;
  for (const std::uint32_t piece : plane.pieces) {
    const auto of_piece = contacts(scene).covers(piece);
    covers.insert(of_piece.begin(), of_piece.end());
  }
  plane.covers.assign(covers.begin(), covers.end());
}

// Whether a cover overlaps a piece that it does not bury.
bool have_conflict(const Scene& scene, const SourcePlane& plane) {
  return std::ranges::any_of(plane.pieces, [&](std::uint32_t piece) {
    const auto own = contacts(scene).covers(piece);
    return std::ranges::any_of(plane.covers, [&](std::uint32_t cover) {
      return !std::ranges::binary_search(own, cover) && overlap(scene, scene.pieces()[piece], scene.pieces()[cover]);
    });
  });
}

// A part of the plane.
SourcePlane only(const Scene& scene, const SourcePlane& plane, std::vector<std::uint32_t> pieces) {
  SourcePlane part = plane;
  part.pieces = std::move(pieces);
  part.faces.clear();
  for (const std::uint32_t piece : part.pieces) {
    const FaceId face = scene.pieces()[piece].face;
    if (part.faces.empty() || part.faces.back() != face) part.faces.push_back(face);
  }
  set_covers(scene, part);
  return part;
}

void split_buried(const Scene& scene, const SourcePlane& plane, std::vector<SourcePlane>& result) {
  std::vector<std::uint32_t> buried, others;
  for (const std::uint32_t piece : plane.pieces) {
    (contacts(scene).covers(piece).empty() ? others : buried).push_back(piece);
  }
  if (!others.empty()) result.push_back(only(scene, plane, others));
  for (const std::uint32_t piece : buried) {
    SourcePlane& part = result.emplace_back(only(scene, plane, {piece}));
    std::ranges::copy_if(others, std::back_inserter(part.elsewhere), [&](std::uint32_t other) {
      return overlap(scene, scene.pieces()[piece], scene.pieces()[other]);
    });
    part.covers.insert(part.covers.end(), part.elsewhere.begin(), part.elsewhere.end());
    others.push_back(piece);
  }
}

std::vector<SourcePlane> with_covers(const Scene& scene, std::vector<SourcePlane> planes) {
  std::vector<SourcePlane> result;
  for (SourcePlane& plane : planes) {
    set_covers(scene, plane);
    if (plane.covers.empty() || !have_conflict(scene, plane)) {
      result.push_back(std::move(plane));
    } else {
      split_buried(scene, plane, result);
    }
  }
  return result;
}

}  // namespace

std::vector<SourcePlane> group_by_plane(const Scene& scene, const std::vector<FaceId>& faces) {
  std::vector<SourcePlane> planes;
  std::map<std::string, std::size_t> index_of_key;
  for (const FaceId id : faces) {
    const Face& face = scene.face(id);
    for (std::uint32_t p = face.first_piece; p < face.first_piece + face.piece_count; ++p) {
      const Piece& piece = scene.pieces()[p];
      const Vec3& point = scene.vertices()[piece.frame[0]];
      ExactVec3 normal = front_normal(scene, piece);
      const auto [entry, is_new] = index_of_key.try_emplace(plane_key(normal, point), planes.size());
      if (is_new) {
        const FineNormal fine = fine_normal(normal);
        const Vec3 &second = scene.vertices()[piece.frame[1]], &third = scene.vertices()[piece.frame[2]];
        planes.push_back({&panels(scene),
                          {},
                          {},
                          {},
                          {},
                          {},
                          kernel::make_direction(std::move(normal)),
                          fine,
                          point,
                          second,
                          third});
      }
      SourcePlane& plane = planes[entry->second];
      if (plane.faces.empty() || plane.faces.back() != id) plane.faces.push_back(id);
      plane.pieces.push_back(p);
    }
  }
  if (!contacts(scene).empty()) planes = with_covers(scene, std::move(planes));
  for (SourcePlane& plane : planes) plane.panels = panels_of(plane);
  return planes;
}

int side_of(const SourcePlane& plane, const Vec3& x) {
  const int filtered = sign_of_dot(plane.normal.approx, kernel::approx_difference(x, plane.point));
  return filtered != kUncertain ? filtered : kernel::orientation(plane.point, plane.second, plane.third, x);
}

namespace {

Polygon2 projected(const Scene& scene, std::span<const std::uint32_t> corners, int axis, bool reverse) {
  Polygon2 polygon;
  for (const std::uint32_t corner : corners) {
    const Vec3& p = scene.vertices()[corner];
    const double coordinates[] = {p.x, p.y, p.z};
    polygon.push_back(
        {kernel::to_rational(coordinates[(axis + 1) % 3]), kernel::to_rational(coordinates[(axis + 2) % 3])});
  }
  if (reverse) std::reverse(polygon.begin(), polygon.end());
  return polygon;
}

// Maps the bounding box of all polygons to the unit square; returns the area of the box.
Rational normalise(std::vector<Polygon2>& polygons) {
  Point2 low = polygons.front().front();
  Point2 high = low;
  for (const Polygon2& polygon : polygons) {
    for (const Point2& p : polygon) {
      low = {std::min(low.u, p.u), std::min(low.v, p.v)};
      high = {std::max(high.u, p.u), std::max(high.v, p.v)};
    }
  }
  const Rational width = high.u - low.u;
  const Rational height = high.v - low.v;
  for (Polygon2& polygon : polygons) {
    for (Point2& p : polygon) p = {(p.u - low.u) / width, (p.v - low.v) / height};
  }
  return width * height;
}

// The pieces of one face do not overlap, nor do the panels of one sheet.
bool certainly_do_not_overlap(const SourcePlane& plane) {
  if (plane.faces.size() == 1) return true;
  const Panels& all = *plane.scene_panels;
  const PanelId first = plane.panels.front();
  return all.is_joined(first) && all.sheet_of(first).panel_count == plane.panels.size();
}

}  // namespace

ProjectedArea union_area(const Scene& scene, const SourcePlane& plane) {
  const int axis = longest_axis(plane.normal.exact);
  const bool reverse = sign(plane.normal.exact[axis]) < 0;
  std::vector<Polygon2> polygons;
  for (const PanelId panel : plane.panels) {
    polygons.push_back(projected(scene, plane.scene_panels->corners(panel), axis, reverse));
  }
  Rational doubled;
  if (certainly_do_not_overlap(plane)) {
    for (const Polygon2& polygon : polygons) doubled += doubled_area(polygon);
  } else {
    const Rational box = normalise(polygons);
    doubled = box * doubled_area(join(polygons));
  }
  return {doubled / 2, axis};
}

bool is_covered(const Scene& scene, std::uint32_t piece, std::span<const std::uint32_t> by) {
  if (by.empty()) return false;
  const int axis = longest_axis(front_normal(scene, scene.pieces()[piece]));
  std::vector<Polygon2> polygons;
  const auto add = [&](std::uint32_t id) {
    const Piece& one = scene.pieces()[id];
    polygons.push_back(projected(scene, scene.corners(one), axis, sign(front_normal(scene, one)[axis]) < 0));
  };
  add(piece);
  std::ranges::for_each(by, add);
  normalise(polygons);
  return difference(std::span(polygons).first(1), std::span(polygons).subspan(1)).empty();
}

namespace {

bool overlap(const Scene& scene, const SourcePlane& plane) {
  if (certainly_do_not_overlap(plane)) return false;
  const ProjectedArea all = union_area(scene, plane);
  Rational sum;
  for (const std::uint32_t piece : plane.pieces) {
    const bool reverse = sign(plane.normal.exact[all.axis]) < 0;
    sum += doubled_area(projected(scene, scene.corners(scene.pieces()[piece]), all.axis, reverse));
  }
  return sum != 2 * all.area;
}

}  // namespace

std::vector<SourcePlane> split_by_face(const Scene& scene, const SourcePlane& plane) {
  if (plane.faces.size() == 1 || overlap(scene, plane)) return {plane};
  std::vector<SourcePlane> result;
  for (const FaceId face : plane.faces) {
    SourcePlane& one = result.emplace_back(plane);
    one.faces = {face};
    std::erase_if(one.pieces, [&](std::uint32_t piece) { return scene.pieces()[piece].face != face; });
    set_covers(scene, one);
    one.panels = panels_of(one);
    const auto& frame = scene.pieces()[one.pieces.front()].frame;
    one.point = scene.vertices()[frame[0]];
    one.second = scene.vertices()[frame[1]];
    one.third = scene.vertices()[frame[2]];
  }
  return result;
}

}  // namespace exactff::visibility
