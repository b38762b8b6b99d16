#include "gradient/vertex_gradient.h"

#include <algorithm>
#include <string>
#include <utility>

#include "gradient/gradient.h"
#include "kernel/expect.h"
#include "kernel/poll.h"
#include "kernel/vec.h"

namespace exactff::gradient {

void VertexGradient::start(const View& view) {
  normal_ = view.n;
  quick_.start(view.n);
  sums_.clear();
  kinks_.clear();
  arcs_.clear();
  frames_.clear();
}

// 1. False: no vertex moves anything.
bool VertexGradient::gather(const PlaneQuery& query) {
  if (query.view.is_own(query.plane.pieces.front())) return false;
  if (side_of(query.plane, query.view.x) <= 0) return false;
  profile_.gather(query, Profile::Extent::kMeeting);
  return profile_.source_count() > 0 && !profile_.stays_hidden();
}

void VertexGradient::add(const PlaneQuery& query, const ArcSection& seen) {
  frames_.push_back(frame_of(query.view.scene, query.plane.pieces.front()));
  if (!gather(query)) return;
  const VertexMotions motions(query);
  find_kinks(query, motions, !seen.empty());
  if (seen.empty()) return;
  if (seen.is_by_edges()) {
    add_quickly(motions, seen);
  } else {
    add_by_planes(query, motions, seen);  // in balls alone
    for (const auto& [place, arcs] : arcs_) sums_[place].decline();
  }
}

// --- 2. Where there is no derivative ---

// For certain: beyond a side of each of the source's outlines.
bool VertexGradient::is_beside_source(CornerId a, CornerId b) const {
  const std::array ends{a, b};
  for (OutlineId o = 0; o < profile_.source_count(); ++o) {
    if (!profile_.outlines().are_beside(o, ends)) return false;
  }
  return true;
}

// Whether the lines move in different ways, or lie in the source's plane.
bool VertexGradient::differ(const VertexMotions& motions, std::span<const EdgeId> group) {
  const Outlines& outlines = profile_.outlines();
  const auto line_of = [&](EdgeId id) {
    const Outlines::Edge& edge = outlines.edge(id);
    return is_of_source(edge) ? motions.line_of_source(outlines, edge) : motions.line_of_occluder(outlines, edge);
  };
  const auto first = line_of(group.front());
  return std::ranges::any_of(group, [&](EdgeId id) {
    const auto line = line_of(id);
    if (in_source_plane_.contains(id)) return true;
    return id != group.front() && (!line || line != first);
  });
}

void VertexGradient::find_kinks(const PlaneQuery& query, const VertexMotions& motions, bool is_visible) {
  Outlines& outlines = profile_.outlines();
  const Scene& scene = query.view.scene;
  in_source_plane_.clear();
  for (EdgeId id = 0; id < outlines.edges().size(); ++id) {
    if (is_of_source(outlines.edge(id))) continue;
    const auto line = motions.line_of_occluder(outlines, outlines.edge(id));
    if (line && motions.is_in_source_plane(line->first) && motions.is_in_source_plane(line->second)) {
      in_source_plane_.insert(id);
    }
  }
  std::vector<EdgeId> meeting;
  for (const std::uint32_t piece : profile_.meeting()) {
    const auto corners = scene.corners(scene.pieces()[piece]);
    for (std::size_t c = 0; c < corners.size(); ++c) {
      const std::uint32_t p = corners[c], q = corners[(c + 1) % corners.size()];
      if (!motions.is_in_source_plane(p) || !motions.is_in_source_plane(q)) continue;
      const CornerId a = outlines.corner_at(p), b = outlines.corner_at(q);
      if (!is_beside_source(a, b)) meeting.push_back(outlines.add_edge(a, b));
    }
    if (!is_visible || !overlaps_source(motions, corners)) continue;
    // It hides nothing until it moves.
    for (const std::uint32_t corner : corners) kinks_.insert(motions.pair_of(corner, corner).first);
    kinks_.insert(motions.source_frame().begin(), motions.source_frame().end());
  }
  in_source_plane_.insert(meeting.begin(), meeting.end());
  // Edges without a piece on both sides, and those in the source's plane.
  groups_.add_open(outlines, profile_.source_count(), [&](EdgeId id) { return in_source_plane_.contains(id); });
  const ExactVec3 horizon = query.view.normal().exact;
  const auto visit = [&](std::span<const EdgeId> group) {
    if (!differ(motions, group)) return true;
    SightPlane sight(query, profile_, outlines.edge(group.front()), &motions);
    if (is_zero(cross(sight.normal(), horizon))) return true;
    const std::vector<std::uint32_t> kinks = sight.kinks_of_vertices();
    kinks_.insert(kinks.begin(), kinks.end());
    return true;
  };
  groups_.for_each(outlines, visit, 1);
}

// A piece in the source's plane that lies over a part of the source: no side of either separates them.
bool VertexGradient::overlaps_source(const VertexMotions& motions, std::span<const std::uint32_t> vertices) {
  Outlines& outlines = profile_.outlines();
  if (!std::ranges::all_of(vertices, [&](std::uint32_t v) { return motions.is_in_source_plane(v); })) return false;
  std::vector<CornerId> corners;
  for (const std::uint32_t vertex : vertices) corners.push_back(outlines.corner_at(vertex));
  const auto separates = [&](const Outlines::Edge& edge, const auto& inner, const auto& outer) {
    const auto side = [&](CornerId corner) { return outlines.side(edge, corner); };
    const bool inside = std::ranges::any_of(inner, [&](CornerId corner) { return side(corner) > 0; });
    return std::ranges::none_of(outer, [&](CornerId corner) { return inside ? side(corner) > 0 : side(corner) < 0; });
  };
  for (OutlineId o = 0; o < profile_.source_count(); ++o) {
    const Outlines::Outline outline = outlines.outline(o);
    std::vector<CornerId> source;
    for (EdgeId id = outline.first; id < outline.first + outline.count; ++id) source.push_back(outlines.edge(id).a);
    bool apart = false;
    for (std::size_t c = 0; c < source.size() && !apart; ++c) {
      apart = separates(outlines.line_through(source[c], source[(c + 1) % source.size()]), source, corners);
    }
    for (std::size_t c = 0; c < corners.size() && !apart; ++c) {
      apart = separates(outlines.line_through(corners[c], corners[(c + 1) % corners.size()]), corners, source);
    }
    if (!apart) return true;
  }
  return false;
}

// --- 3. The arcs ---

bool VertexGradient::is_of_source(const Outlines::Edge& edge) const {
  return edge.outline != Outlines::kNone && edge.outline < profile_.source_count();
}

namespace {

// Whether the component of (a - x) x (b - x) is 0 for certain, as where the line runs along the axis.
bool is_certainly_zero(const Vec3& a, const Vec3& b, const Vec3& x, int axis) {
  const auto at = [axis](const Vec3& v) {
    return axis == 0 ? std::pair(v.y, v.z) : axis == 1 ? std::pair(v.z, v.x) : std::pair(v.x, v.y);
  };
  const auto p = at(a), q = at(b), o = at(x);
  return p == q || (p.first == o.first && q.first == o.first) || (p.second == o.second && q.second == o.second);
}

}  // namespace

bool VertexGradient::is_of_source(const ArcLine& line) const {
  return line.outline != Outlines::kNone && line.outline < profile_.source_count();
}

std::optional<VertexMotions::VertexPair> VertexGradient::vertices_of(const VertexMotions& motions,
                                                                     const ArcSection& seen,
                                                                     const ArcLine& line) const {
  const ArcCorner &a = seen.corners[line.a], &b = seen.corners[line.b];
  return is_of_source(line) ? motions.line_of_source({a.p, a.q}, {b.p, b.q})
                            : motions.line_of_occluder({a.p, a.q}, {b.p, b.q}, line.whole);
}

// The lines that a plane cuts are left to the balls.
void VertexGradient::add_quickly(const VertexMotions& motions, const ArcSection& seen) {
  quick_.for_each_share(seen, [&](const Arc& arc, const auto& line, const auto& shares, const auto& ends) {
    const ArcLine& of = seen.lines[arc.line];
    const ArcCorner &a = seen.corners[ends.first], &b = seen.corners[ends.second];
    const auto vertices = vertices_of(motions, seen, of);
    if (vertices && a.is_vertex() && b.is_vertex()) {
      const Vec3 &p = seen.vertices[a.p], &q = seen.vertices[b.p];
      const auto add = [&](std::uint32_t vertex, const auto& share) {
        Sums& sums = sums_[motions.pair_of(vertex, vertex).first];
        for (int axis = 0; axis < 3; ++axis) {
          if (is_certainly_zero(p, q, seen.x, axis)) continue;
          const kernel::double_double::Bounded c{line.cross.c[axis].hi, line.cross.c[axis].lo, line.cross.error};
          sums.value[axis] = sums.value[axis] + contour::times_power(c * share, seen.scale_exponent);
          sums.has_terms[axis] = true;
        }
      };
      add(a.p, shares.a);
      add(b.p, shares.b);
    } else if (vertices) {
      sums_[vertices->first].decline();
      sums_[vertices->second].decline();
    } else if (!is_of_source(of)) {
      for (const std::uint32_t place : motions.frame_of_piece(piece_of_cut(motions, seen, of))) {
        sums_[place].decline();
      }
      for (const std::uint32_t place : motions.source_frame()) sums_[place].decline();
    }
  });
}

// The piece of the profile that the source's plane cuts between the same vertices.
std::uint32_t VertexGradient::piece_of_cut(const VertexMotions& motions, const ArcSection& seen,
                                           const ArcLine& line) const {
  const Outlines& own = profile_.outlines();
  const auto segment = [&](CornerId corner) {
    const auto [p, q] = own.segment(corner);
    return motions.pair_of(p, q);
  };
  const ArcCorner &a = seen.corners[line.a], &b = seen.corners[line.b];
  const std::pair wanted = std::minmax({motions.pair_of(a.p, a.q), motions.pair_of(b.p, b.q)});
  for (auto id = static_cast<OutlineId>(profile_.source_count()); id < own.outlines().size(); ++id) {
    const Outlines::Outline& outline = own.outline(id);
    for (EdgeId e = outline.first; !outline.whole && e < outline.first + outline.count; ++e) {
      const auto p = segment(own.edge(e).a), q = segment(own.edge(e).b);
      if (std::minmax({p, q}) == wanted) return profile_.pieces()[id];
    }
  }
  EXACTFF_EXPECT(false);
  return 0;
}

void VertexGradient::add_by_edges(const VertexMotions& motions, const ArcSection& seen) {
  const visibility::ExactArcs exact(seen);
  for (const Arc& arc : seen.arcs) {
    kernel::poll();
    const ArcLine& of = seen.lines[arc.line];
    const auto line = vertices_of(motions, seen, of);
    if (is_of_source(of) && !line) continue;  // on the horizon
    const BoundaryPiece piece = exact(arc);
    ExactVec3 begin = piece.from(), end = piece.to();
    const ExactVec3 pole = cross(begin, end);
    if (is_zero(pole)) continue;
    const std::vector<Motion> motion =
        line ? motions.of_line(pole, *line) : motions.of_cut(pole, piece_of_cut(motions, seen, of));
    for (const Motion& one : motion) arcs_[one.place].push_back({one.place, {begin, end, one.share}, one.turn});
  }
}

void VertexGradient::add_by_planes(const PlaneQuery& query, const VertexMotions& motions, const ArcSection& seen) {
  for_each_plane(seen, query.view.normal().exact, [&](const ExactVec3& pole) {
    SightPlane sight(query, profile_, profile_.edge_in_plane(pole), &motions);
    for (VertexArc& arc : sight.of_vertices().arcs) arcs_[arc.place].push_back(std::move(arc));
  });
}

void VertexGradient::add_exactly(const PlaneQuery& query, const ArcSection& seen) {
  if (!seen.is_by_edges() || seen.empty() || !gather(query)) return;
  add_by_edges(VertexMotions(query), seen);
}

// --- Results ---

bool VertexGradient::finish(int cap, Gradient& result) {
  result.vertices.clear();
  result.frames = frames_;
  for (const std::uint32_t place : kinks_) sums_[place];
  bool done = true;
  for (const auto& [place, sums] : sums_) {
    VertexDerivative& vertex = result.vertices.emplace_back();
    vertex.vertex = place;
    vertex.is_kink = kinks_.contains(place);
    for (int axis = 0; axis < 3; ++axis) {
      Derivative& derivative = vertex.position[axis];
      if (vertex.is_kink) {
        set_none(derivative);
        continue;
      }
      if (!sums.has_terms[axis]) {
        set_zero(derivative);
        continue;
      }
      const contour::QuickGradient::Value value = quick_.sum().over_turn_and_length(sums.value[axis]);
      if (cap >= kQuickBits && is_determined(value.hi, value.lo, value.error, derivative)) continue;
      derivative.status = DerivativeStatus::kEnclosed;  // so far
      done = false;
    }
  }
  return done;
}

namespace {

// Joins arcs of one line, with their turns.
std::vector<VertexArc> joined_arcs(const std::vector<VertexArc>& arcs) {
  std::map<std::string, std::vector<const VertexArc*>> by_turn;
  for (const VertexArc& one : arcs) {
    by_turn[one.turn.x.get_str(32) + ' ' + one.turn.y.get_str(32) + ' ' + one.turn.z.get_str(32)].push_back(&one);
  }
  std::vector<VertexArc> result;
  for (const auto& [text, group] : by_turn) {
    std::vector<MovingArc> of_turn;
    for (const VertexArc* one : group) of_turn.push_back(one->arc);
    for (MovingArc& arc : contour::joined(std::move(of_turn))) {
      result.push_back({group.front()->place, std::move(arc), group.front()->turn});
    }
  }
  return result;
}

}  // namespace

void VertexGradient::certify(int cap, Gradient& result) {
  const ExactVec3 n = kernel::make_direction(kernel::exact_vector(normal_).v).exact;
  const auto factor = [&](long bits) { return over_turn_and_length(n, bits); };
  for (VertexDerivative& vertex : result.vertices) {
    const auto is_open = [](const Derivative& d) { return d.status == DerivativeStatus::kEnclosed; };
    if (std::ranges::none_of(vertex.position, is_open)) continue;
    const std::vector<VertexArc> arcs = joined_arcs(arcs_[vertex.vertex]);
    for (int axis = 0; axis < 3; ++axis) {
      if (!is_open(vertex.position[axis])) continue;
      ArcSum sum;
      for (const VertexArc& one : arcs) {
        const ExactVec3 c = cross(one.arc.begin, one.arc.end);
        sum.add_weighted(one.arc, n, one.turn[axis] * Rational(c[longest_axis(c)]));
      }
      gradient::certify(sum, factor, cap, vertex.position[axis]);
    }
  }
  std::erase_if(result.vertices, [](const VertexDerivative& vertex) {
    return std::ranges::all_of(vertex.position, [](const auto& d) { return d.status == DerivativeStatus::kZero; });
  });
}

}  // namespace exactff::gradient
