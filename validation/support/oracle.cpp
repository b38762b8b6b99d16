// Method: everything is translated so that the receiver x is the origin. A fragment is a convex polygon with exact
// rational corners in the plane of some source faces. The part that a face P hides is an intersection of half-spaces
// with the source plane, so P is never projected:
//   y is hidden by a triangle (a,b,c)  <=>  y lies in the cone over it (three planes through x)
//                                           and beyond its plane, seen from x.
// A polygon, with or without holes, is the even-odd sum of the triangles that one fixed corner makes with its edges;
// each fragment has the parity of the triangles that contain it.
// 1. Begin with one fragment that holds all faces of the plane; split it along the cones of the faces and keep what
//    they hold: the source. The sum of its areas is the whole.
// 2. Keep what lies above the horizon. 3. For each other face split along its shadow and drop what that holds.
// 4. The rest is visible: areas exactly, F by Lambert's sum over each fragment (oracle_sum.h).
#include "support/oracle.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <utility>

#include "support/oracle_faces.h"
#include "support/oracle_sum.h"

namespace exactff::validation {

namespace {

struct HalfSpace {  // normal . y > offset
  Vector normal;
  Rational offset;
};

struct Fragment {
  Corners corners;
  bool odd = false;
};
using Fragments = std::vector<Fragment>;

// --- Fragments ---

bool same_oriented_plane(const Polygon& p, const Polygon& q) {
  return is_zero(cross(p.normal, q.normal)) && sgn(dot(p.normal, q.normal)) > 0 &&
         dot(p.normal, q.rings.front().front()) == p.offset;
}

enum class Side { kIn, kOut, kBoth };

std::vector<Rational> heights(const Fragment& fragment, const HalfSpace& half) {
  std::vector<Rational> out;
  for (const Vector& corner : fragment.corners) out.push_back(dot(half.normal, corner) - half.offset);
  return out;
}

Side side_of(const std::vector<Rational>& height) {
  const auto positive = [](const Rational& h) { return sgn(h) > 0; };
  const auto negative = [](const Rational& h) { return sgn(h) < 0; };
  if (std::ranges::none_of(height, positive)) return Side::kOut;
  return std::ranges::none_of(height, negative) ? Side::kIn : Side::kBoth;
}

// The parts of a fragment that the boundary crosses: in first, out second.
std::array<Fragment, 2> split(const Fragment& fragment, const std::vector<Rational>& height) {
  std::array<Fragment, 2> parts{Fragment{{}, fragment.odd}, Fragment{{}, fragment.odd}};
  const std::size_t count = height.size();
  for (std::size_t i = 0, j = 1; i < count; ++i, j = (i + 1) % count) {
    const Vector& a = fragment.corners[i];
    if (sgn(height[i]) >= 0) parts[0].corners.push_back(a);
    if (sgn(height[i]) <= 0) parts[1].corners.push_back(a);
    if (sgn(height[i]) * sgn(height[j]) >= 0) continue;
    const Rational t = height[i] / (height[i] - height[j]);
    const Vector& b = fragment.corners[j];
    const Vector point{a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])};
    for (Fragment& part : parts) part.corners.push_back(point);
  }
  return parts;
}

// Flips the parity of everything in all half-spaces, splitting fragments at their borders.
void toggle(Fragments& fragments, const std::vector<HalfSpace>& halves) {
  Fragments out;
  for (Fragment& fragment : fragments) {
    const auto misses = [&](const HalfSpace& half) { return side_of(heights(fragment, half)) == Side::kOut; };
    if (std::ranges::any_of(halves, misses)) {
      out.push_back(std::move(fragment));
      continue;
    }
    bool gone = false;
    for (std::size_t i = 0; i < halves.size() && !gone; ++i) {
      const std::vector<Rational> height = heights(fragment, halves[i]);
      const Side side = side_of(height);
      gone = side == Side::kOut;
      if (side != Side::kBoth) continue;
      auto [in, rest] = split(fragment, height);
      out.push_back(std::move(rest));
      fragment = std::move(in);
    }
    out.push_back(std::move(fragment));
    if (!gone) out.back().odd = !out.back().odd;
  }
  fragments = std::move(out);
}

// Flips the parity of everything in the cone over the polygon and in `beyond`.
void toggle_cone(Fragments& fragments, const Polygon& polygon, const std::vector<HalfSpace>& beyond) {
  const Vector& a = polygon.rings.front().front();
  for (const std::vector<Vector>& ring : polygon.rings) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Vector& b = ring[i];
      const Vector& c = ring[(i + 1) % ring.size()];
      const int sense = sgn(dot(a, cross(b, c)));
      if (sense == 0) continue;  // the corner a on the edge's line
      std::vector<HalfSpace> halves = beyond;
      for (const Vector& normal : {cross(a, b), cross(b, c), cross(c, a)}) {
        halves.push_back({sense > 0 ? normal : negative(normal), 0});
      }
      toggle(fragments, halves);
    }
  }
}

void keep(Fragments& fragments, bool odd) {
  std::erase_if(fragments, [odd](const Fragment& fragment) { return fragment.odd != odd; });
  for (Fragment& fragment : fragments) fragment.odd = false;
}

// --- One plane ---

int steep_axis(const Vector& normal) { return sgn(normal[0]) != 0 ? 0 : sgn(normal[1]) != 0 ? 1 : 2; }

// The part of the plane over the bounding rectangle of the faces along one axis.
Fragment bounding_fragment(const std::vector<Polygon>& faces) {
  const Polygon& plane = faces.front();
  const int k = steep_axis(plane.normal);
  const int i = (k + 1) % 3;
  const int j = (k + 2) % 3;
  Vector low = plane.rings.front().front();
  Vector high = low;
  for (const Polygon& face : faces) {
    for (const Vector& corner : face.rings.front()) {
      for (int axis = 0; axis < 3; ++axis) low[axis] = std::min(low[axis], corner[axis]);
      for (int axis = 0; axis < 3; ++axis) high[axis] = std::max(high[axis], corner[axis]);
    }
  }
  Fragment fragment;
  for (const auto& [u, v] : {std::array{low[i], low[j]}, {high[i], low[j]}, {high[i], high[j]}, {low[i], high[j]}}) {
    Vector& corner = fragment.corners.emplace_back();
    corner[i] = u;
    corner[j] = v;
    corner[k] = (plane.offset - plane.normal[i] * u - plane.normal[j] * v) / plane.normal[k];
  }
  return fragment;
}

Rational area_along(const Fragments& fragments, int k) {
  Rational sum = 0;
  for (const Fragment& fragment : fragments) {
    Rational part = 0;
    for (std::size_t i = 0; i < fragment.corners.size(); ++i) {
      part += cross(fragment.corners[i], fragment.corners[(i + 1) % fragment.corners.size()])[k];
    }
    sum += abs(part);
  }
  return sum;
}

// Requires a plane that does not contain the receiver.
Fragments union_of(const std::vector<Polygon>& faces) {
  Fragments rest{bounding_fragment(faces)};
  Fragments out;
  for (const Polygon& face : faces) {
    toggle_cone(rest, face, {});
    std::ranges::copy_if(rest, std::back_inserter(out), &Fragment::odd);
    keep(rest, false);
  }
  keep(out, true);
  return out;
}

void hide(Fragments& fragments, const Polygon& occluder) {
  const int sign = sgn(occluder.offset);
  if (sign == 0) return;  // the occluder's plane contains the receiver
  const HalfSpace beyond{sign > 0 ? occluder.normal : negative(occluder.normal), abs(occluder.offset)};
  toggle_cone(fragments, occluder, {beyond});
  keep(fragments, false);
}

// The polygons of the source, gathered by oriented plane, and every polygon of the scene that may hide something.
// Corners are relative to the receiver.
struct Setting {
  std::vector<std::vector<Polygon>> planes;
  std::vector<Polygon> occluders;
  Vector normal;  // of the receiver
};

// Any origin outside the plane is possible.
Rational whole_area(std::vector<Polygon> faces, int axis) {
  if (sgn(faces.front().offset) == 0) {
    const Vector away = faces.front().normal;
    for (Polygon& face : faces) face = shifted(face, away);
  }
  return area_along(union_of(faces), axis);
}

// Faces seen from behind or edge-on contribute nothing.
Fragments visible_part(const Setting& setting, std::vector<Polygon> faces, const std::vector<HalfSpace>& above) {
  std::erase_if(faces, [](const Polygon& face) { return face.own; });
  if (faces.empty() || sgn(faces.front().offset) >= 0) return {};
  Fragments visible = union_of(faces);
  for (const HalfSpace& half : above) {
    toggle(visible, {half});
    keep(visible, true);
  }
  for (const Polygon& polygon : setting.occluders) hide(visible, polygon);
  return visible;
}

Fragments visible_part(const Setting& setting, std::vector<Polygon> faces) {
  return visible_part(setting, std::move(faces), {{setting.normal, 0}});
}

// --- The receiver's own plane ---

bool holds_projection_of_origin(const Polygon& triangle) {
  Vector foot = triangle.normal;
  for (Rational& c : foot) c *= triangle.offset / dot(triangle.normal, triangle.normal);
  const Corners& ring = triangle.rings.front();
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vector side = minus(ring[(i + 1) % ring.size()], ring[i]);
    if (sgn(dot(cross(side, minus(foot, ring[i])), triangle.normal)) < 0) return false;
  }
  return true;
}

// The polygon of a face on which a receiver at the origin lies. A face that is not planar is its triangles.
Polygon polygon_under_origin(std::vector<Polygon> polygons) {
  std::vector<Polygon> holding;
  std::ranges::copy_if(polygons, std::back_inserter(holding), holds_projection_of_origin);
  if (polygons.size() > 1 && !holding.empty()) polygons = std::move(holding);
  const auto squared_distance = [](const Polygon& p) -> Rational {
    return p.offset * p.offset / dot(p.normal, p.normal);
  };
  return *std::ranges::min_element(polygons, {}, squared_distance);
}

bool lie_in_one_plane(const Polygon& p, const Polygon& q) {
  return is_zero(cross(p.normal, q.normal)) && dot(p.normal, q.rings.front().front()) == p.offset;
}

std::vector<Polygon> own_planes(const Scene& scene, const Receiver& receiver) {
  std::vector<Polygon> planes;
  for (const FaceId face : receiver.on) {
    if (auto polygons = polygons_of(scene, face, exact(receiver.point)); !polygons.empty()) {
      planes.push_back(polygon_under_origin(std::move(polygons)));
    }
  }
  return planes;
}

// For each face, which of its polygons lie in one of the planes.
std::vector<std::vector<bool>> polygons_in(const std::vector<Polygon>& planes, const Scene& scene,
                                           const Vector& origin) {
  std::vector<std::vector<bool>> own(scene.faces().size());
  for (std::size_t i = 0; i < own.size() && !planes.empty(); ++i) {
    for (const Polygon& polygon : polygons_of(scene, FaceId{static_cast<std::uint32_t>(i)}, origin)) {
      own[i].push_back(
          std::ranges::any_of(planes, [&](const Polygon& plane) { return lie_in_one_plane(plane, polygon); }));
    }
  }
  return own;
}

std::vector<FaceId> ids(const std::vector<Polygon>& faces) {
  std::vector<FaceId> out;
  for (const Polygon& face : faces) out.push_back(face.face);
  std::ranges::sort(out);
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

void add_to_plane(std::vector<std::vector<Polygon>>& planes, const Polygon& polygon) {
  const auto same = [&](const std::vector<Polygon>& plane) { return same_oriented_plane(plane.front(), polygon); };
  const auto found = std::ranges::find_if(planes, same);
  (found != planes.end() ? *found : planes.emplace_back()).push_back(polygon);
}

Setting make_setting(const Scene& scene, const Receiver& receiver, const Selection& source,
                     const OracleMovement& movement, const Rational& step) {
  Setting setting{{}, {}, exact(receiver.normal)};
  Vector origin = exact(receiver.point), by = exact(movement.along);
  for (Rational& c : by) c *= step;
  if (!movement.place) origin = minus(origin, negative(by));
  const auto polygons = [&](FaceId id) {
    return movement.place ? polygons_of(scene, id, origin, {*movement.place, by}) : polygons_of(scene, id, origin);
  };
  const std::vector<FaceId> chosen = scene.faces_of(source);
  const std::vector<std::vector<bool>> own =
      polygons_in(own_planes(scene, receiver), scene, exact(receiver.point));  // before the movement
  for (std::size_t i = 0; i < scene.faces().size(); ++i) {
    const FaceId id{static_cast<std::uint32_t>(i)};
    std::vector<Polygon> moved = polygons(id);
    for (std::size_t k = 0; k < moved.size(); ++k) {
      Polygon& polygon = moved[k];
      polygon.own = !own[i].empty() && own[i][std::min(k, own[i].size() - 1)];
      if (!scene.face(id).transparent && !polygon.own) setting.occluders.push_back(polygon);
      if (std::ranges::find(chosen, id) != chosen.end()) add_to_plane(setting.planes, polygon);
    }
  }
  return setting;
}

}  // namespace

std::vector<bool> own_pieces(const Scene& scene, const Receiver& receiver) {
  const Vector origin = exact(receiver.point);
  const std::vector<Polygon> planes = own_planes(scene, receiver);
  std::vector<bool> own;
  for (const Piece& piece : scene.pieces()) {
    own.push_back(std::ranges::any_of(planes, [&](const Polygon& plane) {
      return std::ranges::all_of(piece.frame, [&](std::uint32_t v) {
        return dot(plane.normal, minus(exact(scene.vertices()[v]), origin)) == plane.offset;
      });
    }));
  }
  return own;
}

OracleResult oracle(const Scene& scene, const Receiver& receiver, const Selection& source) {
  return oracle(scene, receiver, source, Measure{});
}

OracleResult oracle(const Scene& scene, const Receiver& receiver, const Selection& source, const Measure& measure) {
  const Setting setting = make_setting(scene, receiver, source, {}, 0);
  const Vector up = exact(measure.up);
  std::vector<HalfSpace> above;
  if (!measure.sphere) above.push_back({setting.normal, 0});
  if (measure.kind == MeasureKind::kOvercast) above.push_back({up, 0});
  OracleResult result;
  std::vector<Share> shares;
  std::vector<Corners> polygons;
  for (const std::vector<Polygon>& faces : setting.planes) {
    const Vector& normal = faces.front().normal;
    const int axis = steep_axis(normal);
    Fragments visible = visible_part(setting, faces, above);
    const Share& share = shares.emplace_back(
        Share{area_along(visible, axis), whole_area(faces, axis), dot(normal, normal) / (normal[axis] * normal[axis])});
    result.planes.push_back({ids(faces), share.visible / share.whole});
    for (Fragment& fragment : visible) polygons.push_back(std::move(fragment.corners));
  }
  result.visible_fraction = rounded_share(shares);
  result.zero = polygons.empty();
  if (result.zero) return result;
  using Kind = SumMeasure::Kind;
  const Kind kind = measure.kind == MeasureKind::kOvercast     ? Kind::kOvercast
                    : measure.kind == MeasureKind::kSolidAngle ? Kind::kSolidAngle
                                                               : Kind::kSphere;
  const RoundedSum sum = measure.is_form_factor() ? lambert_sum(polygons, setting.normal)
                                                  : measure_sum(polygons, setting.normal, {kind, up});
  result.value = sum.value;
  result.decimals = sum.decimals;
  result.low = sum.low;
  result.high = sum.high;
  return result;
}

double oracle_slope(const Scene& scene, const Receiver& receiver, const Selection& source,
                    const OracleMovement& movement) {
  constexpr long kBits = 1200;
  constexpr unsigned kStep = 400;
  const Rational step(mpz_class(1), mpz_class(1) << kStep);
  const auto value = [&](const Rational& size) {
    const Setting setting = make_setting(scene, receiver, source, movement, size);
    std::vector<Corners> polygons;
    for (const std::vector<Polygon>& faces : setting.planes) {
      for (Fragment& fragment : visible_part(setting, faces)) polygons.push_back(std::move(fragment.corners));
    }
    if (polygons.empty()) return Rational();
    const SumBounds bounds = bounds_of_lambert_sum(polygons, setting.normal, kBits);
    return Rational((bounds.low + bounds.high) / 2);
  };
  return Rational((value(step) - value(0)) / step).get_d();
}

}  // namespace exactff::validation
