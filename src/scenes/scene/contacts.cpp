#include "scene/contacts.h"

#include <algorithm>
#include <boost/container/small_vector.hpp>
#include <set>

#include "kernel/expect.h"
#include "kernel/filter.h"
#include "kernel/numbers.h"
#include "scene/scene.h"
#include "scene/shaft_tree.h"
#include "scene/solids.h"

namespace exactff {
namespace {

using kernel::ExactVec3;

using FaceCorners = std::vector<std::uint32_t>;  // places, in order

class ContactFinder {
 public:
  explicit ContactFinder(const Scene& scene) : scene_(scene), pieces_(scene.pieces()), solids_(scene) {}

  std::map<std::uint32_t, std::vector<std::uint32_t>> find() {
    std::map<std::uint32_t, std::vector<std::uint32_t>> result;
    if (solids_.all().empty()) return result;
    for (std::uint32_t piece = 0; piece < pieces_.size(); ++piece) {
      if (!may_meet_other_solid(piece)) continue;
      std::vector<std::uint32_t> covers = covers_of(piece);
      if (!covers.empty()) result.emplace(piece, std::move(covers));
    }
    return result;
  }
  [[nodiscard]] bool is_of_solid(std::uint32_t piece) const {
    const std::uint32_t solid = solids_.of_piece(piece);
    return solid != Solids::kNone && solids_.all()[solid].sign > 0;
  }

 private:
  [[nodiscard]] Box box(std::uint32_t piece) const { return box_of(scene_, scene_.corners(pieces_[piece])); }

  [[nodiscard]] bool may_meet_other_solid(std::uint32_t piece) const {
    constexpr std::size_t kMany = 32;  // with more, the tree is asked at once
    if (solids_.all().size() > kMany) return true;
    const Box own = box(piece);
    for (std::uint32_t s = 0; s < solids_.all().size(); ++s) {
      if (s != solids_.of_piece(piece) && meet(solids_.all()[s].box, own)) return true;
    }
    return false;
  }

  // Calls take(other) for every other piece whose box meets this one's, and that overlaps it in its plane.
  template <class Take>
  void for_each_in_plane(std::uint32_t piece, const Take& take) const {
    const auto vertex = [&](std::uint32_t v) -> const Vec3& { return scene_.vertices()[v]; };
    const auto& frame = pieces_[piece].frame;
    const kernel::PlaneThrough plane(vertex(frame[0]), vertex(frame[1]), vertex(frame[2]));
    const Box own = box(piece);
    shaft_tree(scene_).visit_where([&](const Box& node, std::size_t) { return meet(node, own); },
                                   [&](std::uint32_t other, std::size_t) {
                                     if (other == piece) return;
                                     const Piece& of = pieces_[other];
                                     const bool in_plane = std::ranges::all_of(
                                         of.frame, [&](std::uint32_t v) { return plane.side_of(vertex(v)) == 0; });
                                     if (in_plane && overlap(scene_, pieces_[piece], of)) take(other);
                                   });
  }

  std::vector<std::uint32_t> covers_of(std::uint32_t piece) {
    std::vector<std::uint32_t> covers, same;  // with the opposite front, and with the same one
    for_each_in_plane(piece, [&](std::uint32_t other) {
      (have_same_front(scene_, pieces_[piece], pieces_[other]) ? same : covers).push_back(other);
    });
    std::erase_if(covers, [&](std::uint32_t cover) { return solids_.of_piece(cover) == Solids::kNone; });
    if (covers.empty()) return covers;
    std::uint32_t own = solids_.of_piece(piece);
    if (own == Solids::kNone) {
      const auto twin = std::ranges::find_if(same, [&](std::uint32_t other) {
        return solids_.of_piece(other) != Solids::kNone && have_same_corners(scene_, pieces_[piece], pieces_[other]);
      });
      if (twin != same.end()) own = solids_.of_piece(*twin);
    }
    std::erase_if(covers, [&](std::uint32_t cover) { return !buries(cover, piece, own); });
    std::ranges::sort(covers);
    return covers;
  }

  // Of a piece of this solid, or of none.
  [[nodiscard]] bool buries(std::uint32_t cover, std::uint32_t piece, std::uint32_t own) {
    const std::uint32_t by = solids_.of_piece(cover);
    const int sign = solids_.all()[by].sign;
    const bool is_of_positive = own != Solids::kNone && solids_.all()[own].sign > 0;
    if (by == own || sign == 0 || (sign < 0 && !is_of_positive)) return false;
    if (are_twins(cover, piece) && (own == Solids::kNone || is_other_side(by, own))) return false;
    return !is_doubled(cover);
  }
  // Whether another piece of its solid overlaps it with the opposite front.
  [[nodiscard]] bool is_doubled(std::uint32_t cover) {
    const auto known = doubled_.find(cover);
    if (known != doubled_.end()) return known->second;
    bool& result = doubled_[cover];
    for_each_in_plane(cover, [&](std::uint32_t other) {
      result = result || (solids_.of_piece(other) == solids_.of_piece(cover) &&
                          !have_same_front(scene_, pieces_[cover], pieces_[other]));
    });
    return result;
  }

  [[nodiscard]] FaceCorners corners_of(FaceId face) const {
    FaceCorners corners;
    for (const auto& ring : scene_.face(face).rings) {
      for (const std::uint32_t v : ring) corners.push_back(places(scene_)[v]);
    }
    std::ranges::sort(corners);
    return corners;
  }
  // Requires that they overlap in one plane.
  [[nodiscard]] bool are_twins(std::uint32_t a, std::uint32_t b) const {
    return have_same_corners(scene_, pieces_[a], pieces_[b]) ||
           corners_of(pieces_[a].face) == corners_of(pieces_[b].face);
  }
  // Whether the faces of the two solids are the same but for their fronts.
  [[nodiscard]] bool is_other_side(std::uint32_t a, std::uint32_t b) {
    const auto [known, is_new] = other_sides_.try_emplace(std::minmax(a, b));
    if (is_new) known->second = faces_of(a) == faces_of(b);
    return known->second;
  }
  [[nodiscard]] std::set<FaceCorners> faces_of(std::uint32_t solid) const {
    std::set<FaceCorners> faces;
    for (const std::uint32_t piece : solids_.all()[solid].pieces) faces.insert(corners_of(pieces_[piece].face));
    return faces;
  }

  const Scene& scene_;
  const std::span<const Piece> pieces_;
  const Solids solids_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, bool> other_sides_;
  std::map<std::uint32_t, bool> doubled_;  // of covers
};

// What a convex piece covers around a point, as seen along the normal of its front: nothing, everything, or a sector
// of at most a half turn, counter-clockwise from `begin` to `end`.
struct Sector {
  enum class Part { kNothing, kSector, kEverything } part = Part::kNothing;
  ExactVec3 begin, end;
};

// Where the projection of x along the normal of the piece lies: 1 inside, -1 outside, 0 near the boundary, as far as
// doubles tell.
//
// Filter, with u = 2^-53 and |.| the largest magnitude of a component: for an edge from a, s = (along x (x - a)) . (e x
// f) with vectors e, f that span the piece. Every difference carries u, so a component of either cross product errs by
// 8u of the product of its two sizes, and is at most twice that product. The three terms of s err by 36u each, and
// their sum by 24u more: in all by less than 2^-45 of the product of the four sizes.
int place_by_filter(const Scene& scene, const Piece& piece, const Vec3& x) {
  using kernel::max_norm, kernel::approx_difference;
  const auto vertex = [&](std::uint32_t v) -> const Vec3& { return scene.vertices()[v]; };
  const kernel::Approx3 e = approx_difference(vertex(piece.frame[1]), vertex(piece.frame[0])),
                        f = approx_difference(vertex(piece.frame[2]), vertex(piece.frame[0]));
  const Vec3 n{e.y * f.z - e.z * f.y, e.z * f.x - e.x * f.z, e.x * f.y - e.y * f.x};
  const auto corners = scene.corners(piece);
  int place = 1;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3& from = vertex(corners[i]);
    const kernel::Approx3 along = approx_difference(vertex(corners[i + 1 == corners.size() ? 0 : i + 1]), from),
                          d = approx_difference(x, from);
    const double s = (along.y * d.z - along.z * d.y) * n.x + (along.z * d.x - along.x * d.z) * n.y +
                     (along.x * d.y - along.y * d.x) * n.z;
    const double size = max_norm(along) * max_norm(d) * max_norm(e) * max_norm(f);
    const bool is_moderate = size >= 0x1p-700 && size <= 0x1p900;
    if (is_moderate && s < -0x1p-45 * size) return -1;
    if (!is_moderate || !(s > 0x1p-45 * size)) place = 0;
  }
  return place;
}

// In a plane with the normal of this piece. The point is projected along it.
class AroundPoint {
 public:
  AroundPoint(const Scene& scene, const Piece& piece, const Vec3& x) : scene_(scene), piece_(piece), x_(x) {}

  // Whether the point lies in the piece or on its boundary.
  [[nodiscard]] bool is_held_by(std::uint32_t piece) {
    const int place = place_by_filter(scene_, scene_.pieces()[piece], x_);
    if (place != 0) return place > 0;
    return sector_of(scene_.corners(scene_.pieces()[piece])).part != Sector::Part::kNothing;
  }
  // Whether the pieces, all with the same front, cover everything around the point.
  [[nodiscard]] bool is_covered(std::span<const std::uint32_t> by) {
    std::vector<Sector> sectors;
    for (const std::uint32_t piece : by) {
      const int place = place_by_filter(scene_, scene_.pieces()[piece], x_);
      if (place > 0) return true;
      if (place < 0) continue;
      Sector sector = sector_of(scene_.corners(scene_.pieces()[piece]));
      if (sector.part == Sector::Part::kEverything) return true;
      if (sector.part == Sector::Part::kSector) sectors.push_back(std::move(sector));
    }
    // Where one ends, another goes on.
    return !sectors.empty() && std::ranges::all_of(sectors, [&](const Sector& ending) {
      return std::ranges::any_of(sectors, [&](const Sector& other) { return goes_on(other, ending.end); });
    });
  }

 private:
  [[nodiscard]] ExactVec3 edge(std::uint32_t from, std::uint32_t to) const {
    return kernel::exact_difference(scene_.vertices()[to], scene_.vertices()[from]).v;
  }
  [[nodiscard]] int turn(const ExactVec3& from, const ExactVec3& to) {
    if (!normal_) normal_ = cross(edge(piece_.frame[0], piece_.frame[1]), edge(piece_.frame[0], piece_.frame[2]));
    return sgn(dot(cross(from, to), *normal_));
  }

  [[nodiscard]] Sector sector_of(std::span<const std::uint32_t> corners) {
    Sector sector;
    sector.part = Sector::Part::kEverything;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const ExactVec3 along = edge(corners[i], corners[i + 1 == corners.size() ? 0 : i + 1]);
      const int side = turn(along, kernel::exact_difference(x_, scene_.vertices()[corners[i]]).v);
      if (side < 0) return {};
      if (side > 0) continue;
      // On this edge, or at the corner with another one.
      ExactVec3 back = along;
      negate(back);
      if (sector.part == Sector::Part::kEverything) {
        sector = {Sector::Part::kSector, along, std::move(back)};
      } else if (const int order = turn(sector.begin, along); order > 0) {
        sector.begin = along;
      } else if (order < 0) {
        sector.end = std::move(back);
      }
    }
    return sector;
  }
  // Whether the sector covers what follows the direction, counter-clockwise.
  [[nodiscard]] bool goes_on(const Sector& sector, const ExactVec3& direction) {
    const int from = turn(sector.begin, direction), to = turn(direction, sector.end);
    if (from == 0) return sgn(dot(sector.begin, direction)) > 0;
    return from > 0 && (to > 0 || turn(sector.begin, sector.end) == 0);
  }

  const Scene& scene_;
  const Piece& piece_;
  const Vec3& x_;
  std::optional<ExactVec3> normal_;  // computed where doubles do not suffice
};

}  // namespace

Contacts::Contacts(const Scene& scene) {
  ContactFinder finder(scene);
  covers_ = finder.find();
  if (covers_.empty()) return;
  is_cover_.assign(scene.pieces().size(), 0);
  is_of_solid_.assign(scene.pieces().size(), 0);
  for (std::uint32_t piece = 0; piece < is_of_solid_.size(); ++piece) {
    is_of_solid_[piece] = finder.is_of_solid(piece) ? 1 : 0;
  }
  for (const auto& [piece, covers] : covers_) {
    for (const std::uint32_t cover : covers) is_cover_[cover] = 1;
  }
}

std::span<const std::uint32_t> Contacts::covers(std::uint32_t piece) const {
  const auto found = covers_.find(piece);
  return found == covers_.end() ? std::span<const std::uint32_t>() : found->second;
}

int Contacts::rank(const Side& side) const {
  if (empty()) return 0;
  if (!side.front) return is_cover_[side.piece] != 0 ? 0 : 1;
  return covers(side.piece).empty() ? 0 : 1 + is_of_solid_[side.piece];
}

bool Contacts::comes_first(const Side& a, const Side& b) const {
  if (a.front == b.front) {
    const int of_a = rank(a), of_b = rank(b);
    return of_a != of_b ? of_a < of_b : a.piece < b.piece;
  }
  const auto& [front, back] = a.front ? std::pair(a, b) : std::pair(b, a);
  const bool is_buried = !empty() && std::ranges::binary_search(covers(front.piece), back.piece);
  return a.front != is_buried;
}

const Contacts& contacts(const Scene& scene) {
  return SceneInside::data(scene).contacts.made_by([&] { return Contacts(scene); });
}

Burial burial_of(const Scene& scene, std::span<const std::uint32_t> pieces, const Vec3& point, const Vec3& normal) {
  const Piece& first = scene.pieces()[pieces.front()];
  const auto at = [&](int i) -> const Vec3& { return scene.vertices()[first.frame[i]]; };
  if (kernel::exact_sign_of_det({at(0), at(1)}, {at(0), at(2)}, {Vec3{}, normal}) <= 0) return {};
  boost::container::small_vector<std::uint32_t, 16> covers;
  for (const std::uint32_t piece : pieces) {
    const auto of_piece = contacts(scene).covers(piece);
    covers.insert(covers.end(), of_piece.begin(), of_piece.end());
  }
  Burial result;
  if (!covers.empty() &&
      AroundPoint(scene, scene.pieces()[covers.front()], point).is_covered({covers.data(), covers.size()})) {
    result.under = scene.pieces()[covers.front()].face;
  } else {
    AroundPoint around(scene, first, point);
    result.is_exposed = std::ranges::any_of(pieces, [&](std::uint32_t piece) { return around.is_held_by(piece); });
  }
  return result;
}

// --- Coplanar ---

// Two convex polygons of a plane have no inner point in common if and only if a line along an edge of one of them
// separates them (the separating axis theorem). The signs are those of a projection along an axis that does not lie in
// the plane, which is one-to-one and keeps lines. They are exact.

namespace {

// The point without the coordinate of the axis.
Vec3 projected(const Vec3& v, int axis) {
  return axis == 0 ? Vec3{v.y, v.z, 0.0} : axis == 1 ? Vec3{v.z, v.x, 0.0} : Vec3{v.x, v.y, 0.0};
}

// Positive if c lies left of the line from a to b.
int side(const Vec3& a, const Vec3& b, const Vec3& c) { return kernel::orientation(a, b, c, {a.x, a.y, 1.0}); }

struct Outline {
  std::vector<Vec3> corners;
  int turn = 0;  // +1: counter-clockwise
};

int turn_of(const Scene& scene, const Piece& piece, int axis) {
  const auto at = [&](int i) { return projected(scene.vertices()[piece.frame[i]], axis); };
  return side(at(0), at(1), at(2));
}

// An axis that does not lie in the piece's plane.
int axis_off(const Scene& scene, const Piece& piece) {
  int axis = 0;
  while (axis < 2 && turn_of(scene, piece, axis) == 0) ++axis;
  return axis;
}

Outline outline_of(const Scene& scene, const Piece& piece, int axis) {
  Outline outline{{}, turn_of(scene, piece, axis)};
  for (const std::uint32_t v : scene.corners(piece)) outline.corners.push_back(projected(scene.vertices()[v], axis));
  return outline;
}

// No corner of `other` lies inside some edge of the outline.
bool has_separating_edge(const Outline& outline, const Outline& other) {
  for (std::size_t i = 0; i < outline.corners.size(); ++i) {
    const Vec3 &a = outline.corners[i], &b = outline.corners[(i + 1) % outline.corners.size()];
    const auto is_inside = [&](const Vec3& c) { return side(a, b, c) * outline.turn > 0; };
    if (std::ranges::none_of(other.corners, is_inside)) return true;
  }
  return false;
}

std::vector<std::uint32_t> sorted_places(const Scene& scene, const Piece& piece) {
  std::vector<std::uint32_t> result;
  for (const std::uint32_t v : scene.corners(piece)) result.push_back(places(scene)[v]);
  std::ranges::sort(result);
  return result;
}

// The boxes of their corners are apart, or only touch.
bool are_boxes_apart(const Scene& scene, const Piece& a, const Piece& b) {
  const auto range = [&](const Piece& piece, double Vec3::*c) {
    const auto [low, high] =
        std::ranges::minmax(scene.corners(piece), {}, [&](std::uint32_t v) { return scene.vertices()[v].*c; });
    return std::pair(scene.vertices()[low].*c, scene.vertices()[high].*c);
  };
  for (double Vec3::*c : {&Vec3::x, &Vec3::y, &Vec3::z}) {
    const auto [low_a, high_a] = range(a, c);
    const auto [low_b, high_b] = range(b, c);
    if (high_a < low_b || high_b < low_a) return true;
  }
  return false;
}

// For a requirement.
[[maybe_unused]] bool are_coplanar(const Scene& scene, const Piece& a, const Piece& b) {
  const auto at = [&](std::uint32_t v) { return scene.vertices()[v]; };
  return std::ranges::all_of(b.frame, [&](std::uint32_t v) {
    return kernel::orientation(at(a.frame[0]), at(a.frame[1]), at(a.frame[2]), at(v)) == 0;
  });
}

}  // namespace

bool overlap(const Scene& scene, const Piece& a, const Piece& b) {
  EXACTFF_EXPECT(are_coplanar(scene, a, b));
  if (are_boxes_apart(scene, a, b)) return false;
  const int axis = axis_off(scene, a);
  const Outline of_a = outline_of(scene, a, axis), of_b = outline_of(scene, b, axis);
  return !has_separating_edge(of_a, of_b) && !has_separating_edge(of_b, of_a);
}

bool have_same_front(const Scene& scene, const Piece& a, const Piece& b) {
  EXACTFF_EXPECT(are_coplanar(scene, a, b));
  const int axis = axis_off(scene, a);
  return turn_of(scene, a, axis) == turn_of(scene, b, axis);
}

bool have_same_corners(const Scene& scene, const Piece& a, const Piece& b) {
  return a.corner_count == b.corner_count && sorted_places(scene, a) == sorted_places(scene, b);
}

}  // namespace exactff
