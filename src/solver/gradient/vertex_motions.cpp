#include "gradient/vertex_motions.h"

#include <algorithm>

#include "kernel/expect.h"
#include "scene/scene.h"

namespace exactff::gradient {

using kernel::ExactVec3;
using kernel::Rational;
using kernel::RationalVec3;
using kernel::to_rational;
using visibility::Outlines;

namespace {

const Rational& component(const RationalVec3& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

}  // namespace

std::array<std::uint32_t, 3> frame_of(const Scene& scene, std::uint32_t index) {
  const Piece& piece = scene.pieces()[index];
  const Face& face = scene.face(piece.face);
  const std::span<const std::uint32_t> corners =
      face.shape == FaceShape::kPlanar ? std::span<const std::uint32_t>(face.rings.front()) : scene.corners(piece);
  std::vector<std::uint32_t> ring;
  for (const std::uint32_t corner : corners) ring.push_back(places(scene)[corner]);
  std::ranges::sort(ring);
  ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
  const auto arrow = [&](std::uint32_t place) {
    return kernel::exact_difference(scene.vertices()[place], scene.vertices()[ring[0]]).v;
  };
  const ExactVec3 second = arrow(ring[1]);
  const auto third =
      std::find_if(ring.begin() + 2, ring.end(), [&](auto place) { return !is_zero(cross(second, arrow(place))); });
  EXACTFF_EXPECT(third != ring.end());
  return {ring[0], ring[1], *third};
}

VertexMotions::VertexMotions(const visibility::PlaneQuery& query)
    : scene_(query.view.scene), plane_(query.plane), places_(places(scene_)), x_(to_rational(query.view.x)) {
  source_ = make_frame(frame_of(scene_, plane_.pieces.front()));
}

RationalVec3 VertexMotions::point(std::uint32_t vertex) const { return to_rational(scene_.vertices()[vertex]) - x_; }

// Requires that the plane does not hold x.
VertexMotions::Frame VertexMotions::make_frame(const std::array<std::uint32_t, 3>& corners) const {
  const RationalVec3 a = point(corners[0]), b = point(corners[1]), c = point(corners[2]);
  const Rational inverse = 1 / dot(a, cross(b, c));
  Frame result;
  result.places = corners;
  result.shares = {cross(b, c) * inverse, cross(c, a) * inverse, cross(a, b) * inverse};
  result.nearness = result.shares[0] + result.shares[1] + result.shares[2];
  return result;
}

VertexMotions::VertexPair VertexMotions::pair_of(std::uint32_t p, std::uint32_t q) const {
  return std::minmax(places_[p], places_[q]);
}

bool VertexMotions::is_in_source_plane(std::uint32_t vertex) const {
  return kernel::orientation(plane_.point, plane_.second, plane_.third, scene_.vertices()[vertex]) == 0;
}

std::array<std::uint32_t, 3> VertexMotions::frame_of_piece(std::uint32_t piece) const {
  return frame_of(scene_, piece);
}

std::optional<VertexMotions::VertexPair> VertexMotions::line_of_source(const Segment& a, const Segment& b) const {
  const VertexPair p = pair_of(a.first, a.second), q = pair_of(b.first, b.second);
  const auto is_end = [](std::uint32_t place, const VertexPair& pair) {
    return place == pair.first || place == pair.second;
  };
  if (a.first == a.second && b.first == b.second) return pair_of(a.first, b.first);
  if (a.first == a.second) return is_end(p.first, q) ? std::optional(q) : std::nullopt;
  if (b.first == b.second) return is_end(q.first, p) ? std::optional(p) : std::nullopt;
  return std::nullopt;
}

// A convex outline that is cut lies on both sides of the source's plane, so that an edge with both ends in this plane
// is the cut.
std::optional<VertexMotions::VertexPair> VertexMotions::line_of_occluder(const Segment& a, const Segment& b,
                                                                         bool whole) const {
  const auto line = line_of_source(a, b);
  if (line && !whole && is_in_source_plane(line->first) && is_in_source_plane(line->second)) return std::nullopt;
  return line;
}

std::vector<Motion> VertexMotions::of_line(const ExactVec3& N, const VertexPair& line) const {
  const RationalVec3 a = point(line.first), b = point(line.second), pole = cross(a, b);
  const Rational inverse = 1 / dot(pole, pole);
  const RationalVec3 turn = to_rational(N) * Rational(1 / Rational(N[longest_axis(N)]));
  return {{line.first, cross(b, pole) * inverse, turn}, {line.second, cross(pole, a) * inverse, turn}};
}

std::vector<Motion> VertexMotions::of_cut(const ExactVec3& N, std::uint32_t piece) const {
  const Frame face = make_frame(frame_of(scene_, piece));
  const Rational inverse = 1 / component(face.nearness - source_.nearness, longest_axis(N));
  std::vector<Motion> result;
  for (std::size_t i = 0; i < 3; ++i) result.push_back({face.places[i], face.shares[i], face.nearness * inverse});
  for (std::size_t i = 0; i < 3; ++i) {
    result.push_back({source_.places[i], source_.shares[i], source_.nearness * Rational(-inverse)});
  }
  return result;
}

}  // namespace exactff::gradient
