#include "matrix/surroundings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <string>

#include "kernel/plane_through.h"
#include "kernel/poll.h"
#include "matrix/coplanar.h"
#include "scene/scene_copy.h"
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
  std::vector<FaceId> faces;
  for (std::size_t f = 0; f < scene.faces().size(); ++f) {
    if (scene.faces()[f].piece_count > 0) faces.push_back(static_cast<FaceId>(f));
  }
  return faces;
}

// The pieces of a scene and their backs that lie in one oriented plane, as indices of pieces.
struct SharedPlane {
  std::vector<std::uint32_t> fronts, backs;
};

// Pieces that are not transparent.
std::vector<SharedPlane> planes_of(const Scene& scene) {
  SceneCopy copy(scene);
  const Selection backs = copy.add_patch("backs");
  for (const Piece& piece : scene.pieces()) copy.add_face(backs, reversed_corners_of(scene, piece));
  const Scene both = copy.take();
  const auto count = static_cast<std::uint32_t>(scene.pieces().size());
  std::vector<SharedPlane> result;
  for (const visibility::SourcePlane& plane : visibility::group_by_plane(both, faces_with_area(both))) {
    SharedPlane& shared = result.emplace_back();
    for (const std::uint32_t piece : plane.pieces) {
      if (scene.pieces()[piece % count].transparent) continue;
      (piece < count ? shared.fronts : shared.backs).push_back(piece % count);
    }
  }
  return result;
}

// Backs with a front on them are left out. Returns whether others overlap with a front in part.
bool sort_out(const Scene& scene, SharedPlane& plane) {
  const auto pieces = scene.pieces();
  std::erase_if(plane.backs, [&](std::uint32_t back) {
    return std::ranges::any_of(
        plane.fronts, [&](std::uint32_t front) { return have_same_corners(scene, pieces[front], pieces[back]); });
  });
  return std::ranges::any_of(plane.backs, [&](std::uint32_t back) {
    kernel::poll();
    return std::ranges::any_of(plane.fronts,
                               [&](std::uint32_t front) { return overlap(scene, pieces[front], pieces[back]); });
  });
}

}  // namespace

SceneWithBacks with_backs(const Scene& scene) {
  SceneCopy copy(scene);
  std::optional<Selection> backs, both, fronts;
  const auto patch = [&](std::optional<Selection>& selection, const char* name) -> const Selection& {
    if (!selection) selection = copy.add_patch(name);
    return *selection;
  };
  for (SharedPlane& plane : planes_of(scene)) {
    const bool in_part = sort_out(scene, plane);
    for (const std::uint32_t back : plane.backs) {
      const Selection& where = in_part ? patch(both, "backs and fronts") : patch(backs, "backs");
      copy.add_face(where, reversed_corners_of(scene, scene.pieces()[back]));
    }
    for (const std::uint32_t front : plane.fronts) {
      if (!in_part) break;
      copy.add_face(patch(both, "backs and fronts"), corners_of(scene, scene.pieces()[front]));
      copy.add_face(patch(fronts, "fronts"), corners_of(scene, scene.pieces()[front]));
    }
  }
  return {copy.take(), backs, both, fronts};
}

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
  return {copy.take(), sky};
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
// of the scene that is made for them.
ProvedZeros proved_zeros(const Scene& scene, std::span<const Selection> from) {
  const SceneWithBacks made = with_backs(scene);
  std::vector<Sight> backs;
  for (const std::optional<Selection>& patch : {made.backs, made.both}) {
    if (patch) std::ranges::copy(sights_of(made.scene, *patch), std::back_inserter(backs));
  }
  const view_factors::Pairs rows(scene, from, {}, {});
  ProvedZeros zeros;
  for (std::size_t i = 0; i < from.size(); ++i) {
    kernel::poll();
    const std::vector<Sight> own = sights_of(made.scene, {from[i].patch, from[i].face});
    const auto may_see = [&](const Sight& a, const Sight& b) {
      return reaches_before(made.scene, a, b) && reaches_before(made.scene, b, a);
    };
    zeros.back.push_back(std::ranges::none_of(own, [&](const Sight& one) {
      return std::ranges::any_of(backs, [&](const Sight& back) { return may_see(one, back); });
    }));
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
