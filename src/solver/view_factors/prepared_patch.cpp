#include "view_factors/prepared_patch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <tuple>

#include "kernel/gauss.h"
#include "kernel/vec.h"
#include "scene/contacts.h"
#include "text/refuse.h"
#include "visibility/source_plane.h"

namespace exactff::view_factors {
namespace {

bool is_partly_buried(const Scene& scene, const Selection& patch) {
  if (contacts(scene).empty()) return false;
  return std::ranges::any_of(scene.faces_of(patch), [&](FaceId face) {
    const std::uint32_t first = scene.face(face).first_piece;
    for (std::uint32_t piece = first; piece < first + scene.face(face).piece_count; ++piece) {
      if (!contacts(scene).covers(piece).empty()) return true;
    }
    return false;
  });
}

bool is_opaque(const Scene& scene, const Selection& patch) {
  return std::ranges::none_of(scene.faces_of(patch), [&](FaceId face) { return scene.face(face).transparent; });
}

}  // namespace

PreparedPatch::PreparedPatch(const ExactScene& scene, const Selection& patch, Columns what_it_is)
    : selection(patch),
      parts(parts_of(scene, patch)),
      exposed_share{.centre = 1.0},
      enclosed_area(enclosed_area_of(parts, scene.units)),
      opaque(is_opaque(scene.scene, patch)),
      what(what_it_is) {
  std::tie(unit_area, area) = areas_of(scene, patch, parts);
  whole_area = area;
  if (is_partly_buried(scene.scene, patch)) leave_out_buried(scene);
}

void PreparedPatch::leave_out_buried(const ExactScene& scene) {
  parts = parts_of(scene, selection, PartsOf::kExposed);
  if (parts.empty()) {
    exposed_share = {};
    return;
  }
  const kernel::Disc whole = enclosed_area;
  enclosed_area = enclosed_area_of(parts, scene.units);
  exposed_share = enclosed_area / whole;
  std::tie(unit_area, area) = areas_of(scene, selection, parts);
}

double counted_area(const PreparedPatch& from, const PreparedPatch& to) {
  return to.what == Columns::kPatches ? std::min(from.unit_area, to.unit_area) : from.unit_area;
}

bool are_reciprocal(const PreparedPatch& column) { return !column.surrounds(); }

double largest_factor(const PreparedPatch& i, const PreparedPatch& j) {
  const kernel::Disc ratio = j.enclosed_area / i.enclosed_area;
  return are_reciprocal(j) && i.opaque && is_finite(ratio) ? std::min(1.0, upper_end(ratio)) : 1.0;
}

bool are_separated(const SeenParts& seen, const PreparedPatch& row, std::size_t i, const PreparedPatch& column,
                   std::size_t j) {
  return column.what == Columns::kBacks &&
         are_separated(row.seen.windings(seen, row.parts)[i], column.seen.windings(seen, column.parts)[j]);
}

// --- Patch parts ---

namespace {

// A part with the tables that clipping needs.
struct Clippable {
  Points points;
  Ring ring;

  Clippable(const Part& part, const Units& units) : points(units) {
    std::vector<PointId> corners;
    for (const Point& corner : part.corners) corners.push_back(points.add(corner));
    ring = points.ring(corners);
  }
  [[nodiscard]] Part part(const Part& whole, const Ring& of) const {
    Part result{whole.face, whole.panel, {}, false};
    for (const Edge& edge : of) result.corners.push_back(points[edge.from]);
    return result;
  }
};

// The planes through the sides of a convex polygon, perpendicular to it; positive outside.
std::vector<Plane> sides_of(const Part& part, const Units& units) {
  const Clippable clippable(part, units);
  const Plane plane = plane_of(part, units);
  std::vector<Plane> sides;
  for (const auto& side : cell_of(clippable.points, clippable.ring, plane).sides) sides.push_back(*side);
  return sides;
}

// What of the part lies outside the convex polygon with these sides.
std::vector<Part> outside(const Part& part, const std::vector<Plane>& sides, const Units& units) {
  Clippable rest(part, units);
  std::vector<Part> result;
  for (std::uint32_t i = 0; i < sides.size(); ++i) {
    const Ring beyond = rest.points.clip(rest.ring, sides[i], 2 * i);
    if (!beyond.empty()) result.push_back(rest.part(part, beyond));
    rest.ring = rest.points.clip(rest.ring, make_plane(opposite(sides[i].exact), units), 2 * i);
    if (rest.ring.empty()) return result;
  }
  return result;
}

std::vector<Part> outside(const std::vector<Part>& parts, const std::vector<Plane>& sides, const Units& units) {
  std::vector<Part> result;
  for (const Part& part : parts) {
    for (Part& kept : outside(part, sides, units)) result.push_back(std::move(kept));
  }
  return result;
}

Part whole(const ExactScene& scene, PanelId panel) {
  const ExactPiece& piece = scene.panel(panel);
  Part part{piece.face, panel, {}, true};
  for (const std::uint32_t corner : piece.corners) part.corners.push_back(scene.vertices[corner]);
  return part;
}

// A segment in which a piece that reaches in front of a part's plane meets it.
struct Contact {
  const Plane* plane;  // of the piece
  Box box;
  double half_length;
};

std::optional<Contact> contact(const ExactScene& scene, PanelId index, const Plane& plane) {
  const ExactPiece& piece = scene.panel(index);
  constexpr double kInner = 1.0 - 0x1p-20;  // what only the segment's ends touch is not cut
  const auto side = [&](std::uint32_t corner) { return side_of(plane, scene.vertices[corner]); };
  if (std::ranges::none_of(piece.corners, [&](std::uint32_t c) { return side(c) > 0; })) return std::nullopt;
  if (std::ranges::all_of(piece.corners, [&](std::uint32_t c) { return side(c) > 0; })) return std::nullopt;
  Clippable front(whole(scene, index), scene.units);
  front.ring = front.points.clip(front.ring, plane, 0);
  std::vector<Vec3> met;
  for (const Edge& edge : front.ring) {
    if (side_of(plane, front.points[edge.from]) == 0) met.push_back(front.points[edge.from].at);
  }
  if (met.size() != 2) return std::nullopt;
  const Vec3 way = kernel::scaled(kernel::difference(met[1], met[0]), 0.5);
  const Vec3 middle = kernel::difference(met[1], way), inner = kernel::scaled(way, kInner);
  Contact result{&piece.plane, {}, view_factors::length(way)};
  result.box.include(kernel::difference(middle, inner));
  result.box.include(kernel::difference(middle, kernel::scaled(inner, -1.0)));
  return result;
}

bool is_on_both_sides(const Part& part, const Plane& plane) {
  const auto has_corner_on = [&](int side) {
    return std::ranges::any_of(part.corners, [&](const Point& corner) { return side_of(plane, corner) == side; });
  };
  return has_corner_on(-1) && has_corner_on(1);
}

// Those that may cut the part, the longest first.
std::vector<Contact> contacts(const ExactScene& scene, const Part& part) {
  const Plane& plane = plane_of(scene, part);
  const Box box = box_of(part.corners);
  std::vector<Contact> result;
  for (std::uint32_t index = 0; index < scene.pieces.size(); ++index) {
    const ExactPiece& piece = scene.pieces[index];
    if (piece.transparent || piece.box.is_apart_from(box)) continue;
    if (!is_on_both_sides(part, piece.plane)) continue;
    const std::optional<Contact> one = contact(scene, index, plane);
    if (one && !one->box.is_apart_from(box)) result.push_back(*one);
  }
  std::ranges::stable_sort(result, std::ranges::greater(), &Contact::half_length);
  return result;
}

// The parts of a polygon on both sides of the plane.
std::vector<Part> cut(const Part& part, const Plane& plane, const Units& units) {
  std::vector<Part> result;
  for (const Homogeneous& towards : {plane.exact, opposite(plane.exact)}) {
    Clippable clippable(part, units);
    const Ring ring = clippable.points.clip(clippable.ring, make_plane(towards, units), 0);
    if (!ring.empty()) result.push_back(clippable.part(part, ring));
  }
  return result;
}

std::array<kernel::Rational, 3> exact_difference(const Point& a, const Point& b) {
  std::array<kernel::Rational, 3> result;
  for (std::size_t i = 0; i < 3; ++i) {
    result[i] = kernel::Rational(a.exact[i] * b.exact[3] - b.exact[i] * a.exact[3], a.exact[3] * b.exact[3]);
    result[i].canonicalize();
  }
  return result;
}

// By an exact square, whose root is enclosed. Of what is cut from a part, of which there is much, in doubles.
kernel::Disc enclosed_area(const Part& part, const Units& units) {
  if (part.is_cut) {
    const std::vector<Vec3> ring = positions_of(part.corners);
    return {area(ring), 2.0 * error_of_area(ring)};
  }
  constexpr long kBits = 128;
  std::array<kernel::Rational, 3> sum;
  for (std::size_t i = 2; i < part.corners.size(); ++i) {
    const auto b = exact_difference(part.corners[i - 1], part.corners[0]);
    const auto c = exact_difference(part.corners[i], part.corners[0]);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t l = (k + 1) % 3, m = (k + 2) % 3;
      sum[k] += b[l] * c[m] - b[m] * c[l];
    }
  }
  const kernel::Rational square = sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2];
  const kernel::Rational of_half = kernel::times_power_of_two(square, -4 * units.shift - 2);
  return kernel::to_disc(sqrt(kernel::to_ball(of_half, kBits)));
}

}  // namespace

std::vector<Part> parts_of(const ExactScene& scene, const Selection& patch, PartsOf what) {
  const Panels& panels = exactff::panels(scene.scene);
  // Pieces of one face, and panels of one sheet.
  const auto never_overlap = [&](PanelId a, PanelId b) {
    if (panels.is_joined(a) != panels.is_joined(b)) return false;
    return panels.is_joined(a) ? panels.sheet_of_joined(a) == panels.sheet_of_joined(b)
                               : scene.pieces[a].face == scene.pieces[b].face;
  };
  std::vector<Part> result;
  for (const visibility::SourcePlane& plane : visibility::group_by_plane(scene.scene, scene.scene.faces_of(patch))) {
    std::vector<PanelId> earlier;
    for (const PanelId panel : plane.panels) {
      std::vector<Part> left{whole(scene, panel)};
      for (const PanelId other : earlier) {
        if (never_overlap(panel, other) || scene.panel(panel).box.is_apart_from(scene.panel(other).box)) continue;
        left = outside(left, sides_of(whole(scene, other), scene.units), scene.units);
      }
      for (const std::uint32_t cover : what == PartsOf::kExposed ? plane.covers : plane.elsewhere) {
        if (!scene.panel(panel).box.is_apart_from(scene.pieces[cover].box)) {
          left = outside(left, sides_of(whole(scene, cover), scene.units), scene.units);
        }
      }
      earlier.push_back(panel);
      result.insert(result.end(), left.begin(), left.end());
    }
  }
  return result;
}

Plane plane_of(const Part& part, const Units& units) {
  return make_plane(join(part.corners[0], part.corners[1], part.corners[2]), units);
}

std::vector<Part> cut_at_contacts(const ExactScene& scene, const Part& part) {
  constexpr std::size_t kMostCuts = 8;  // into at most 37 fragments
  std::size_t cuts = 0;
  std::vector<Part> fragments{part};
  for (const Contact& line : contacts(scene, part)) {
    std::vector<Part> finer;
    for (Part& fragment : fragments) {
      std::vector<Part> halves;
      if (!line.box.is_apart_from(box_of(fragment.corners))) halves = cut(fragment, *line.plane, scene.units);
      if (halves.size() < 2) {
        finer.push_back(std::move(fragment));
        continue;
      }
      for (Part& half : halves) {
        half.is_cut = true;
        finer.push_back(std::move(half));
      }
    }
    if (finer.size() > fragments.size()) ++cuts;
    fragments = std::move(finer);
    if (cuts == kMostCuts) break;
  }
  return fragments;
}

double area_of(const std::vector<Part>& parts) {
  double sum = 0.0;
  for (const Part& part : parts) sum += area(positions_of(part.corners));
  return sum;
}

kernel::Disc enclosed_area_of(const std::vector<Part>& parts, const Units& units) {
  kernel::Disc sum;
  for (const Part& part : parts) sum = sum + enclosed_area(part, units);
  return sum;
}

double error_of_shares(const std::vector<Part>& parts, const Units& units) {
  double radii = 0.0, sum = 0.0;
  for (const Part& part : parts) {
    const kernel::Disc exact = part.weight * enclosed_area(part, units);
    radii += exact.radius + std::abs(part.weight * area(positions_of(part.corners)) - exact.centre);
    sum += exact.centre;
  }
  return sum > radii ? 2.0 * radii / (sum - radii) : 1.0;
}

std::pair<double, double> areas_of(const ExactScene& scene, const Selection& patch, const std::vector<Part>& parts) {
  const double unit_area = area_of(parts);
  const double area = std::ldexp(unit_area, static_cast<int>(2 * (scene.units.exponent + scene.units.shift)));
  if (!(unit_area > 0.0)) {
    text::refuse("patch " + scene.scene.name_of(patch) +
                     " has no area, or none in double precision beside the rest of the scene",
                 "a view factor is a mean over the patch", "leave the patch out");
  }
  if (!(area > 0.0 && std::isfinite(area))) {
    text::refuse("patch " + scene.scene.name_of(patch) + " has no area that a double can hold: it is " +
                     (area > 0.0 ? "above 1.8e308" : "below 4.9e-324"),
                 "areas are part of the result", "scale the scene; view factors do not depend on its unit of length");
  }
  return {unit_area, area};
}

}  // namespace exactff::view_factors
