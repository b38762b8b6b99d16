#include "matrix/surroundings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "kernel/filter.h"
#include "kernel/poll.h"
#include "scene/closed_surfaces.h"
#include "scene/contacts.h"
#include "scene/scene_copy.h"
#include "scene/selections.h"
#include "text/refuse.h"
#include "view_factors/pairs.h"
#include "visibility/source_plane.h"

namespace exactff::matrix {
namespace {

std::vector<std::uint32_t> corners_of(const Scene& scene, const Piece& piece) {
  const auto corners = scene.corners(piece);
  return {corners.begin(), corners.end()};
}

std::vector<std::uint32_t> reversed_corners_of(const Scene& scene, const Piece& piece) {
  std::vector<std::uint32_t> corners = corners_of(scene, piece);
  std::ranges::reverse(corners);
  return corners;
}

std::vector<FaceId> faces_with_area(const Scene& scene) {
  return faces_where(scene, [](const Face& face) { return face.piece_count > 0; });
}

bool belongs_to(const ClosedSurfaces& surfaces, std::uint32_t piece) {
  return !surfaces.empty() && surfaces.of_piece(piece) != ClosedSurfaces::kNone;
}

constexpr std::size_t kMostOverlaps = 16;  // planes beyond share patches with others

// The pieces of a scene and their backs that lie in one oriented plane, as indices of pieces.
struct SharedPlane {
  std::vector<std::uint32_t> fronts, backs;
};

bool have_same_plane(const Scene& scene, std::uint32_t a, std::uint32_t b) {
  const Piece &one = scene.pieces()[a], &other = scene.pieces()[b];
  const auto at = [&](int i) -> const Vec3& { return scene.vertices()[one.frame[i]]; };
  const kernel::PlaneThrough plane(at(0), at(1), at(2));
  return std::ranges::all_of(other.frame, [&](std::uint32_t v) { return plane.side_of(scene.vertices()[v]) == 0; }) &&
         have_same_front(scene, one, other);
}

// Pieces that are not transparent.
std::vector<SharedPlane> planes_of(const Scene& scene) {
  SceneCopy copy(scene);
  const Selection backs = copy.add_patch("backs");
  for (const Piece& piece : scene.pieces()) copy.add_face(backs, reversed_corners_of(scene, piece));
  const Scene both = copy.take();
  const auto count = static_cast<std::uint32_t>(scene.pieces().size());
  std::vector<SharedPlane> result;
  std::optional<std::uint32_t> last;
  for (const visibility::SourcePlane& plane : visibility::group_by_plane(both, faces_with_area(both))) {
    // Where something is buried, a plane may come in parts, one after the other.
    if (!last || !have_same_plane(both, *last, plane.pieces.front())) result.emplace_back();
    last = plane.pieces.front();
    SharedPlane& shared = result.back();
    for (const std::uint32_t piece : plane.pieces) {
      if (scene.pieces()[piece % count].transparent) continue;
      (piece < count ? shared.fronts : shared.backs).push_back(piece % count);
    }
  }
  return result;
}

// Backs that fronts cover are left out. Returns whether others overlap with a front.
bool sort_out(const Scene& scene, SharedPlane& plane) {
  const auto pieces = scene.pieces();
  bool some_overlap = false;
  std::erase_if(plane.backs, [&](std::uint32_t back) {
    kernel::poll();
    std::vector<std::uint32_t> on_it;
    for (const std::uint32_t front : plane.fronts) {
      if (have_same_corners(scene, pieces[front], pieces[back])) return true;
      if (overlap(scene, pieces[front], pieces[back])) on_it.push_back(front);
    }
    const bool is_hidden = visibility::is_covered(scene, back, on_it);
    some_overlap = some_overlap || (!is_hidden && !on_it.empty());
    return is_hidden;
  });
  return some_overlap;
}

}  // namespace

std::vector<Selection> of_any_scene(std::span<const Selection> patches) {
  std::vector<Selection> result(patches.begin(), patches.end());
  for (Selection& patch : result) patch.scene = kAnyScene;
  return result;
}

SceneWithBacks with_backs(const Scene& scene) {
  const ClosedSurfaces surfaces(scene, ClosedSurfaces::Edges::kCutAtJunctions);
  const auto is_of_closed = [&](std::uint32_t piece) { return belongs_to(surfaces, piece); };
  SceneCopy copy(scene);
  std::array<std::optional<Selection>, 2> backs;  // of closed surfaces, and others
  std::vector<SceneWithBacks::Overlap> overlaps;
  std::size_t planes = 0;  // with an overlap
  const auto turn = [&](const Selection& patch, std::uint32_t back) {
    copy.add_face(patch, reversed_corners_of(scene, scene.pieces()[back]));
  };
  for (SharedPlane& plane : planes_of(scene)) {
    if (!sort_out(scene, plane)) {
      if (plane.backs.empty()) continue;
      // All of a plane go to one patch, where they count once if they overlap.
      const bool are_of_closed = std::ranges::all_of(plane.backs, is_of_closed);
      std::optional<Selection>& patch = backs[are_of_closed ? 0 : 1];
      if (!patch) patch = copy.add_patch(are_of_closed ? "backs of closed surfaces" : "backs");
      for (const std::uint32_t back : plane.backs) turn(*patch, back);
      continue;
    }
    if (overlaps.size() < kMostOverlaps) {
      const std::string number = std::to_string(overlaps.size());
      overlaps.push_back({copy.add_patch("backs on fronts " + number), copy.add_patch("backs and fronts " + number),
                          copy.add_patch("fronts " + number)});
    }
    const auto& [turned, both, fronts] = overlaps[planes++ % kMostOverlaps];
    for (const std::uint32_t back : plane.backs) {
      turn(turned, back);
      turn(both, back);
    }
    for (const std::uint32_t front : plane.fronts) {
      copy.add_face(both, corners_of(scene, scene.pieces()[front]));
      copy.add_face(fronts, corners_of(scene, scene.pieces()[front]));
    }
  }
  SceneWithBacks result{copy.take(), {}, std::move(overlaps)};
  for (const std::optional<Selection>& patch : backs) {
    if (patch) result.whole.push_back(*patch);
  }
  return result;
}

SceneWithSides with_sides(const Scene& scene) {
  const ClosedSurfaces surfaces(scene, ClosedSurfaces::Edges::kCutAtJunctions);
  SceneCopy copy(scene);
  std::optional<Selection> all, closed_backs, others;
  const auto add = [&](std::optional<Selection>& patch, const char* name, const std::vector<std::uint32_t>& corners) {
    if (!patch) patch = copy.add_patch(name);
    copy.add_face(*patch, corners);
  };
  for (std::uint32_t p = 0; p < scene.pieces().size(); ++p) {
    const Piece& piece = scene.pieces()[p];
    if (piece.transparent) continue;
    const std::vector<std::uint32_t> front = corners_of(scene, piece), back = reversed_corners_of(scene, piece);
    add(all, "all sides", front);
    add(all, "all sides", back);
    if (surfaces.empty()) continue;
    add(others, "other sides", front);
    belongs_to(surfaces, p) ? add(closed_backs, "backs of closed surfaces", back) : add(others, "other sides", back);
  }
  return {copy.take(), all, closed_backs, others};
}

namespace {

// Of points on a line: whether the third does not lie beyond the second, as seen from the first.
bool runs_back(const Vec3& first, const Vec3& second, const Vec3& third) {
  const auto along = [&](double Vec3::*c) { return (second.*c < first.*c) != (third.*c < second.*c); };
  return (first.x != second.x && along(&Vec3::x)) || (first.y != second.y && along(&Vec3::y)) ||
         (first.z != second.z && along(&Vec3::z));
}

// Round a hole in a plane: its corners, counter-clockwise as seen from the surface. Empty if the edges are those of
// several holes, or of one that is not convex.
std::vector<std::uint32_t> convex_hole(const Scene& scene, const ClosedSurface::Rim& rim) {
  constexpr std::size_t kMostCorners = 256;
  if (rim.edges.size() > kMostCorners) return {};
  std::map<std::uint32_t, std::uint32_t> next(rim.edges.begin(), rim.edges.end());
  if (next.size() != rim.edges.size()) return {};
  std::vector<std::uint32_t> ring;
  for (std::uint32_t at = rim.edges.front().first; ring.size() < next.size(); at = next[at]) {
    if (!next.contains(at) || std::ranges::find(ring, at) != ring.end()) return {};
    ring.push_back(at);
  }
  // No edge runs back along the one before, and the corners lie on one side of every edge: of the plane through it and
  // a point off the hole's plane.
  const auto at = [&](std::size_t i) -> const Vec3& { return scene.vertices()[ring[i % ring.size()]]; };
  const auto apex = std::ranges::find_if(scene.vertices(), [&](const Vec3& v) {
    return kernel::PlaneThrough(rim.plane[0], rim.plane[1], rim.plane[2]).side_of(v) > 0;
  });
  int turn = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const kernel::PlaneThrough side(at(i), at(i + 1), *apex);
    if (side.side_of(at(i + 2)) == 0 && runs_back(at(i), at(i + 1), at(i + 2))) return {};
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const int sign = side.side_of(at(k));
      if (sign * turn < 0) return {};
      if (sign != 0) turn = sign;
    }
  }
  if (turn > 0) std::ranges::reverse(ring);
  return ring;
}

// Every piece that hides anything reaches before the plane, and none behind it.
bool lies_before(const Scene& scene, const ClosedSurface::Rim& rim) {
  const kernel::PlaneThrough plane(rim.plane[0], rim.plane[1], rim.plane[2]);
  return std::ranges::all_of(scene.pieces(), [&](const Piece& piece) {
    if (piece.transparent) return true;
    bool is_before = false;
    for (const std::uint32_t corner : scene.corners(piece)) {
      const int side = plane.side_of(scene.vertices()[corner]);
      if (side < 0) return false;
      is_before = is_before || side > 0;
    }
    return is_before;
  });
}

std::vector<SceneWithSky::Window> add_windows(const Scene& scene, SceneCopy& copy) {
  std::vector<SceneWithSky::Window> windows;
  const ClosedSurfaces surfaces(scene, ClosedSurfaces::Edges::kCutAtJunctions);
  for (std::size_t s = 0; s < surfaces.surfaces().size(); ++s) {
    const std::optional<ClosedSurface::Rim>& rim = surfaces.surfaces()[s].rim;
    if (!rim || !lies_before(scene, *rim)) continue;
    const std::vector<std::uint32_t> ring = convex_hole(scene, *rim);
    if (ring.empty()) continue;
    windows.push_back({s, copy.add_patch("window " + std::to_string(s))});
    copy.add_face(windows.back().patch, ring);
  }
  return windows;
}

}  // namespace

// Not much larger than the scene, so that bounds of roundings, which go by the largest coordinate, stay as small.
SceneWithSky with_sky(const Scene& scene) {
  constexpr double kWider = 1.25;  // roundings do not matter
  std::array<double, 3> centre{};
  double half = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto at = [&](const Vec3& v) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; };
    const auto [low, high] = std::ranges::minmax(scene.vertices(), {}, at);
    centre[axis] = 0.5 * at(low) + 0.5 * at(high);
    half = std::max(half, 0.5 * at(high) - 0.5 * at(low));
  }
  SceneCopy copy(scene);
  const Selection sky = copy.add_patch("sky");
  std::array<std::uint32_t, 8> corners{};  // the bits of their number tell on which sides they lie
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto at = [&](std::size_t axis) {
      return centre[axis] + ((i >> axis & 1) != 0 ? kWider * half : -kWider * half);
    };
    const Vec3 corner{at(0), at(1), at(2)};
    if (!std::isfinite(corner.x) || !std::isfinite(corner.y) || !std::isfinite(corner.z)) {
      text::refuse("the scene is too large for a sky around it", "doubles end near 1.8e308", "scale the scene down");
    }
    corners[i] = copy.add_vertex(corner);
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t one = std::size_t{1} << (axis + 1) % 3, two = std::size_t{1} << (axis + 2) % 3,
                      far = std::size_t{1} << axis;
    copy.add_face(sky, {corners[0], corners[one], corners[one + two], corners[two]});
    copy.add_face(sky, {corners[far], corners[far + two], corners[far + one + two], corners[far + one]});
  }
  std::vector<SceneWithSky::Window> windows = add_windows(scene, copy);
  return {copy.take(), sky, std::move(windows)};
}

namespace {

struct Sight {
  const Piece* piece;
  kernel::PlaneThrough plane;
};

std::vector<Sight> sights_of(const Scene& scene, const Selection& selection) {
  std::vector<Sight> sights;
  const auto vertex = [&](std::uint32_t v) -> const Vec3& { return scene.vertices()[v]; };
  for (const FaceId face : scene.faces_of(selection)) {
    for (const Piece& piece : scene.pieces_of(face)) {
      sights.push_back({&piece, {vertex(piece.frame[0]), vertex(piece.frame[1]), vertex(piece.frame[2])}});
    }
  }
  return sights;
}

// False if all of `to` lies behind the plane of `from`, or in it.
bool reaches_before(const Scene& scene, const Sight& from, const Sight& to) {
  return std::ranges::any_of(scene.corners(*to.piece),
                             [&](std::uint32_t v) { return from.plane.side_of(scene.vertices()[v]) > 0; });
}

}  // namespace

// A point of a piece sees the front of another only if each reaches before the plane of the other. The backs are fronts
// of the scene that is made for them, where closed surfaces may hide them, too.
ProvedZeros proved_zeros(const Scene& scene, std::span<const Selection> from) {
  const SceneWithBacks made = with_backs(scene);
  std::vector<Selection> columns = made.whole;
  for (const SceneWithBacks::Overlap& overlap : made.overlaps) columns.push_back(overlap.turned);
  std::vector<std::vector<Sight>> backs;
  for (const Selection& column : columns) backs.push_back(sights_of(made.scene, column));
  const view_factors::Pairs rows(made.scene, of_any_scene(from), columns, {}, view_factors::Columns::kBacks);
  ProvedZeros zeros;
  for (std::size_t i = 0; i < from.size(); ++i) {
    kernel::poll();
    const std::vector<Sight> own = sights_of(made.scene, {from[i].patch, from[i].face});
    const auto may_see = [&](const Sight& a, const Sight& b) {
      return reaches_before(made.scene, a, b) && reaches_before(made.scene, b, a);
    };
    const auto sees_some_of = [&](std::size_t column) {
      return rows.may_see(i, column) && std::ranges::any_of(own, [&](const Sight& one) {
               return std::ranges::any_of(backs[column], [&](const Sight& back) { return may_see(one, back); });
             });
    };
    bool sees = false;
    for (std::size_t column = 0; column < columns.size() && !sees; ++column) sees = sees_some_of(column);
    zeros.back.push_back(!sees);
    zeros.open.push_back(rows.is_enclosed(i));
  }
  return zeros;
}

bool have_fronts_in_common(const Scene& scene) {
  const auto patch_of = [&](std::uint32_t piece) { return scene.face(scene.pieces()[piece].face).patch; };
  for (const visibility::SourcePlane& plane : visibility::group_by_plane(scene, faces_with_area(scene))) {
    for (std::size_t i = 0; i < plane.pieces.size(); ++i) {
      kernel::poll();
      for (std::size_t j = 0; j < i; ++j) {
        const std::uint32_t a = plane.pieces[i], b = plane.pieces[j];
        if (patch_of(a) != patch_of(b) && overlap(scene, scene.pieces()[a], scene.pieces()[b])) return true;
      }
    }
  }
  return false;
}

}  // namespace exactff::matrix
