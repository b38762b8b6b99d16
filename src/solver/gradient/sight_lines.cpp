#include "gradient/sight_lines.h"

#include <array>
#include <cmath>
#include <limits>

#include "kernel/expect.h"
#include "kernel/vec.h"
#include "scene/scene.h"

namespace exactff::gradient {

namespace {

constexpr std::uint32_t kPiecesPerPoll = 1'024;

}  // namespace

// Of one outline of the source, with what looks at pieces in it.
struct Profile::Shaft {
  const PlaneQuery& query;
  PieceClip& clip;
  visibility::SourceShaft& sides;
  OutlineId source = 0;
};

void Profile::start() {
  pieces_.clear();
  sheets_.clear();
  meeting_.clear();
  touching_.reset();
  source_count_ = 0;
  stays_hidden_ = false;
}

void Profile::gather(const PlaneQuery& query, Extent extent) {
  start();
  with_meeting_ = extent == Extent::kMeeting;
  PieceClip clip(query, outlines_, clip_);
  source_count_ = clip.add_source().count;
  for (const std::uint32_t piece : query.plane.pieces) {
    if (pieces_.size() < source_count_) pieces_.push_back(piece);
  }
  seen_.clear(query.view.scene.pieces().size());
  visibility::SourceShaft sides(query, clip, outlines_, shaft_);
  std::uint32_t visited = 0;
  for (OutlineId source = 0; source < source_count_ && !stays_hidden_; ++source) {
    sides.set(source);
    Shaft shaft{query, clip, sides, source};
    for_each_candidate(query.view, sides.half_spaces(), ShaftCulling::kTree, [&](std::uint32_t index, bool inside) {
      if (++visited % kPiecesPerPoll == 0) kernel::poll();
      if (!seen_.is_set(index) && may_occlude(query.view, query.plane, query.request, index)) {
        visit(shaft, index, inside);
      }
      return !stays_hidden_;
    });
  }
  for (std::size_t c = 0; c < query.plane.covers.size() && source_count_ > 0 && !stays_hidden_; ++c) {
    const std::uint32_t cover = query.plane.covers[c];
    clip.take(query.view.scene.corners(query.view.scene.pieces()[cover]));
    const OutlineId outline = clip.add_occluder(false, facing_of(query.view, query.view.scene.pieces()[cover]));
    pieces_.push_back(cover);
    stays_hidden_ = outlines_.cover(outline, source_count_, 1);
  }
}

// `inside`: the piece lies inside the shaft.
void Profile::visit(Shaft& shaft, std::uint32_t index, bool inside) {
  const PlaneQuery& query = shaft.query;
  const Piece& piece = query.view.scene.pieces()[index];
  shaft.clip.take(query.view.scene.corners(piece));
  const visibility::Sides sides = inside ? visibility::kInsideShaft : shaft.sides.sides_by_filter();
  if (sides.beside || (!sides.certain && outlines_.are_beside(shaft.source, shaft.clip.corners()))) return;
  seen_.set(index);
  bool some_before = sides.certain && sides.some_above_each, some_behind = sides.some_below_first;
  if (!some_before) {
    const std::span<const int> depths = shaft.clip.find_depths();
    some_before = std::ranges::any_of(depths, [](int depth) { return depth > 0; });
    some_behind = std::ranges::any_of(depths, [](int depth) { return depth < 0; });
    if (!some_before) {
      if (with_meeting_ && std::ranges::count(depths, 0) > 1) meeting_.push_back(index);
      return;
    }
  }
  const int facing = facing_of(query.view, piece);
  if (facing == 0) {
    sheets_.push_back(index);
    if (!touching_ && holds_x(query.view, piece)) touching_ = index;
    return;
  }
  const OutlineId outline = shaft.clip.add_occluder(some_behind, facing);
  pieces_.push_back(index);
  stays_hidden_ = outlines_.cover(outline, source_count_, 1);
}

Outlines::Edge Profile::edge_in_plane(const ExactVec3& normal) {
  const kernel::Approx3 rounded = kernel::approx(normal);
  const auto holds = [&](CornerId corner) {
    const int filtered = outlines_.side_by_filter(rounded, corner);
    if (filtered != kernel::kUncertain) return filtered == 0;
    return sign(dot(normal, outlines_.exact(corner))) == 0;
  };
  const auto found = std::ranges::find_if(outlines_.edges(),
                                          [&](const Outlines::Edge& edge) { return holds(edge.a) && holds(edge.b); });
  EXACTFF_EXPECT(found != outlines_.edges().end());
  return *found;
}

void Profile::gather_around_plane(const PlaneQuery& query) {
  start();
  const View& view = query.view;
  const visibility::SourcePlane& plane = query.plane;
  outlines_.start(view.scene, view.x, kernel::max_norm(kernel::approx_difference(plane.second, plane.point)));
  outlines_.set_source_plane(plane.normal.exact, plane.fine_normal, plane.point);
  const Vec3 front = kernel::to_vec3(plane.normal.approx), back{-front.x, -front.y, -front.z};
  const std::array<HalfSpace, 2> slab{{{front, 0.0}, {back, 0.0}}};
  PieceClip clip(query, outlines_, clip_);
  std::vector<CornerId> corners;
  for_each_candidate(view, HalfSpaceGroups(slab), ShaftCulling::kTree, [&](std::uint32_t index, bool /*inside*/) {
    const Piece& piece = view.scene.pieces()[index];
    if (!may_occlude(view, plane, query.request, index)) return true;
    if (facing_of(view, piece) == 0) {
      if (!touching_ && holds_x(view, piece)) touching_ = index;
      return true;
    }
    clip.take(view.scene.corners(piece));
    corners.assign(clip.corners().begin(), clip.corners().end());
    outlines_.add(corners, true);
    pieces_.push_back(index);
    return true;
  });
}

bool holds_x(const View& view, const Piece& piece) {
  const auto vertices = view.scene.vertices();
  const auto corners = view.scene.corners(piece);
  const auto arrow = [&](std::uint32_t v) { return kernel::exact_difference(vertices[v], view.x).v; };
  const ExactVec3 normal = cross(kernel::exact_difference(vertices[piece.frame[1]], vertices[piece.frame[0]]).v,
                                 kernel::exact_difference(vertices[piece.frame[2]], vertices[piece.frame[0]]).v);
  for (std::size_t c = 0; c < corners.size(); ++c) {
    const ExactVec3 p = arrow(corners[c]), q = arrow(corners[c + 1 == corners.size() ? 0 : c + 1]);
    if (sign(dot(normal, cross(p, q))) < 0) return false;
  }
  return true;
}

// --- Sight directions ---

SightDirections::SightDirections(Outlines& outlines, const Outlines::Edge& edge)
    : edge_(edge), normal_(cross(outlines.exact(edge.b), outlines.exact(edge.a))) {
  make_primitive(normal_);
}

int SightDirections::turn(const ExactVec3& p, const ExactVec3& q) const { return sign(dot(normal_, cross(p, q))); }

bool SightDirections::is_between(const ExactVec3& from, const ExactVec3& to, const ExactVec3& t) const {
  return turn(from, t) >= 0 && turn(t, to) >= 0;
}

std::vector<int> SightDirections::sides_of(Outlines& outlines, OutlineId id) const {
  const Outlines::Outline outline = outlines.outline(id);
  std::vector<int> sides;
  for (EdgeId e = outline.first; e < outline.first + outline.count; ++e) {
    sides.push_back(outlines.side(edge_, outlines.edge(e).a));
  }
  return sides;
}

int SightDirections::side_of(std::span<const int> sides) {
  const bool some_above = std::ranges::any_of(sides, [](int side) { return side > 0; });
  const bool some_below = std::ranges::any_of(sides, [](int side) { return side < 0; });
  return some_above && some_below ? 0 : some_above ? 1 : -1;
}

std::optional<std::pair<ExactVec3, ExactVec3>> SightDirections::arc_of(Outlines& outlines, OutlineId id,
                                                                       std::span<const int> sides) const {
  const EdgeId first = outlines.outline(id).first;
  std::vector<ExactVec3> ends;
  for (std::size_t c = 0; c < sides.size(); ++c) {
    const Outlines::Edge edge = outlines.edge(first + static_cast<EdgeId>(c));
    if (sides[c] == 0) ends.push_back(outlines.exact(edge.a));
    if (sides[c] * sides[(c + 1) % sides.size()] >= 0) continue;
    const ExactVec3 p = outlines.exact(edge.a), q = outlines.exact(edge.b);
    ends.push_back(p * abs(dot(normal_, q)) + q * abs(dot(normal_, p)));
  }
  if (ends.size() < 2) return std::nullopt;
  const auto is_before = [&](const ExactVec3& p, const ExactVec3& q) { return turn(p, q) > 0; };
  const std::pair arc{*std::ranges::min_element(ends, is_before), *std::ranges::max_element(ends, is_before)};
  return turn(arc.first, arc.second) > 0 ? std::optional(arc) : std::nullopt;
}

// --- Sight groups ---

namespace {

// A direction in general position.
constexpr Vec3 kAnywhere{0.5398041762934, 0.2874930211667, 0.7911734960021};

}  // namespace

// The number of the plane with the normal N is |N . c| / |N| for a fixed vector c of about unit length. The components
// of N are known to within e = kCrossError |a||b| (kernel/filter.h). So its error is below 2 sqrt(3) e / |N| + 8u, for
// which edge.error / |N| + 2^-48 is more than enough.
void SightGroups::add(const Outlines& outlines, EdgeId id) {
  const Outlines::Edge& edge = outlines.edge(id);
  const double length = std::sqrt(kernel::dot(edge.normal, edge.normal));
  const double number = std::abs(kernel::dot(edge.normal, kAnywhere)) / length;
  const double error = edge.error / length + 0x1p-48;
  constexpr double kUnbounded = std::numeric_limits<double>::infinity();
  if (error < 0x1p-10 && number <= 2.0) {
    entries_.push_back({number - error, number + error, id});
  } else {
    entries_.push_back({-kUnbounded, kUnbounded, id});
  }
}

bool are_on_one_line(const Outlines& outlines, std::span<const EdgeId> group) {
  const auto ends_of = [&](EdgeId id) {
    const Outlines::Edge& edge = outlines.edge(id);
    return std::pair(outlines.vertex(edge.a), outlines.vertex(edge.b));
  };
  const auto ends = ends_of(group.front());
  if (!ends.first || !ends.second) return false;
  const Vec3& origin = outlines.position(*ends.first);
  const ExactVec3 along = kernel::exact_difference(outlines.position(*ends.second), origin).v;
  return std::ranges::all_of(group, [&](EdgeId id) {
    const auto [a, b] = ends_of(id);
    const auto is_on_line = [&](std::uint32_t v) {
      return v == *ends.first || v == *ends.second ||
             is_zero(cross(along, kernel::exact_difference(outlines.position(v), origin).v));
    };
    return a && b && is_on_line(*a) && is_on_line(*b);
  });
}

// --- Vertex motions ---

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

VertexMotions::VertexMotions(const PlaneQuery& query)
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
  const Rational inverse = 1 / (face.nearness - source_.nearness)[longest_axis(N)];
  std::vector<Motion> result;
  for (std::size_t i = 0; i < 3; ++i) result.push_back({face.places[i], face.shares[i], face.nearness * inverse});
  for (std::size_t i = 0; i < 3; ++i) {
    result.push_back({source_.places[i], source_.shares[i], source_.nearness * Rational(-inverse)});
  }
  return result;
}

}  // namespace exactff::gradient
