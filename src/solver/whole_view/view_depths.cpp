// Depths along edges, and step 5 of view_edges.h.
#include <algorithm>
#include <array>

#include "kernel/expect.h"
#include "kernel/poll.h"
#include "whole_view/view_edges.h"

namespace exactff::whole_view {

using Edge = Outlines::Edge;
using Outline = Outlines::Outline;

// `owner`: an outline with a corner off the edge's line.
ViewEdges::Order ViewEdges::order(OutlineId p, OutlineId q, EdgeId edge, OutlineId owner, Side side) {
  Order result{depths_.compare(outlines_, p, q, outlines_.edge(edge).a),
               depths_.compare(outlines_, p, q, outlines_.edge(edge).b)};
  if (result.at_a == 0 && result.at_b == 0) {
    const int left = order_beside(p, q, edge, owner);
    const int here = left == 0 ? (comes_first(p, q) ? 1 : -1) : side == Side::kLeft ? left : -left;
    return {here, here};
  }
  if (result.at_a == 0) result.at_a = result.at_b;
  if (result.at_b == 0) result.at_b = result.at_a;
  if (result.at_a == result.at_b) return result;
  const int everywhere = order_everywhere(p, q);
  return everywhere == 0 ? result : Order{everywhere, everywhere};
}

// On the left of an edge along which both planes are equally deep; 0 if they are one plane.
int ViewEdges::order_beside(OutlineId p, OutlineId q, EdgeId edge_id, OutlineId owner) {
  const Edge edge = outlines_.edge(edge_id);
  const Outline outline = outlines_.outline(owner);
  for (EdgeId id = outline.first; id < outline.first + outline.count; ++id) {
    const CornerId corner = outlines_.edge(id).a;
    const int side = outlines_.side(edge, corner);
    if (side != 0) return side * depths_.compare(outlines_, p, q, corner);
  }
  EXACTFF_EXPECT(false);
  return 0;
}

// +1 or -1 if one of the outlines lies on one side of the other's plane, and so is nearer or further wherever both are
// seen; 0 if each crosses the other's plane, or if they lie in one plane.
int ViewEdges::order_everywhere(OutlineId p, OutlineId q) {
  for (const OutlineId of : {p, q}) {
    const Outline outline = outlines_.outline(of);
    bool nearer = false, further = false;
    for (EdgeId id = outline.first; id < outline.first + outline.count; ++id) {
      const int sign = depths_.compare(outlines_, p, q, outlines_.edge(id).a);
      nearer = nearer || sign > 0;
      further = further || sign < 0;
    }
    if (nearer != further) return nearer ? 1 : -1;
  }
  return 0;
}

// The edge in which a piece meets the plane of another one. Requires that its corners lie on both sides of that plane.
EdgeId ViewEdges::line_between(OutlineId p, OutlineId q) {
  std::uint32_t& number = lines_(p, q);
  if (number != PairTable::kNone) return piercings_[number].edge;
  number = static_cast<std::uint32_t>(piercings_.size());
  const Piece& other = depths_.piece(q);
  const Outlines::Plane plane = outlines_.add_plane(depths_.exact_normal(q), outlines_.position(other.frame[0]));
  const auto vertices = scene_->corners(depths_.piece(p));
  std::array<CornerId, 2> ends{};
  std::size_t count = 0;
  std::vector<CornerId>& corners = corners_;
  outlines_.corners_of(vertices, corners);
  for (std::size_t c = 0; c < corners.size() && count < 2; ++c) {
    const std::size_t next = c + 1 < corners.size() ? c + 1 : 0;
    const int here = depths_.compare(outlines_, p, q, corners[c]),
              there = depths_.compare(outlines_, p, q, corners[next]);
    if (here == 0) {
      ends[count++] = corners[c];
    } else if (here * there < 0) {
      ends[count++] = outlines_.add_crossing(plane, *outlines_.vertex(corners[c]), *outlines_.vertex(corners[next]));
    }
  }
  EXACTFF_EXPECT(count == 2);
  const EdgeId edge = outlines_.add_edge(ends[0], ends[1]);
  line_.push_back(edge);
  partner_.push_back(kNoEdge);
  exact_.grow(outlines_.edges().size());
  piercings_.push_back({std::min(p, q), std::max(p, q), edge});
  return edge;
}

// True if a line of q has no corner of p inside.
bool ViewEdges::has_outside(OutlineId p, OutlineId q) {
  return std::ranges::any_of(outlines_.edges_of(outlines_.outline(q)), [&](const Edge& line) {
    return std::ranges::none_of(outlines_.edges_of(outlines_.outline(p)),
                                [&](const Edge& edge) { return outlines_.side(line, edge.a) > 0; });
  });
}

bool ViewEdges::overlap(OutlineId p, OutlineId q) { return !has_outside(p, q) && !has_outside(q, p); }

// Pairs with neither certainly nearer than the other, for outlines of more than four corners.
void ViewEdges::note_rivals(OutlineId id) {
  find_near(id, ~Lines{0});
  const Outline outline = outlines_.outline(id);
  for (const OutlineId by : near_) {
    bool nearer = true, further = true;
    for (EdgeId e = outline.first; e < outline.first + outline.count; ++e) {
      const Outlines::Corner& c = outlines_.corner(outlines_.edge(e).a);
      const InverseDepth &p = depths_.of(by), &q = depths_.of(id);
      const double difference =
          (p.slope.x - q.slope.x) * c.t.x + (p.slope.y - q.slope.y) * c.t.y + (p.slope.z - q.slope.z) * c.t.z;
      const double error = 2.0 * (p.error + q.error) * c.size;
      nearer = nearer && difference > error;
      further = further && difference < -error;
    }
    if (!nearer && !further) rivals_.emplace_back(std::min(id, by), std::max(id, by));
  }
}

void ViewEdges::examine_rivals() {
  const auto windows = windows_.rivals();
  for (const auto& [p, q] : windows) rivals_.emplace_back(std::min(p, q), std::max(p, q));
  std::sort(rivals_.begin(), rivals_.end());
  rivals_.erase(std::unique(rivals_.begin(), rivals_.end()), rivals_.end());
  for (std::size_t i = 0; i < rivals_.size(); ++i) {
    if (i % 256 == 0) kernel::poll();
    examine(rivals_[i].first, rivals_[i].second);
  }
}

void ViewEdges::examine(OutlineId p, OutlineId q) {
  if (!overlap(p, q) || order_everywhere(p, q) != 0) return;
  const Outline outline = outlines_.outline(p);
  for (EdgeId id = outline.first; id < outline.first + outline.count; ++id) {
    if (depths_.compare(outlines_, p, q, outlines_.edge(id).a) == 0) continue;
    static_cast<void>(line_between(p, q));
    return;
  }
  note_stack(p, q);
}

// Of outlines that overlap in one plane. A back beside a front is not seen, and has no form factor to compare.
void ViewEdges::note_stack(OutlineId p, OutlineId q) {
  if (whole_[p] == whole_[q] || !shows_front(p) || !shows_front(q)) return;
  stacks_.push_back(comes_first(p, q) ? Stack{p, q} : Stack{q, p});
}

void ViewEdges::trace_piercing(const Piercing& piercing) {
  const auto& [p, q, edge] = piercing;
  Cover in_p, in_q;
  if (!cover_exactly(edge, p, in_p) || !cover_exactly(edge, q, in_q)) return;
  if (in_p.coincides || in_q.coincides) return;
  const Interval both = common(edge, in_p.interval, in_q.interval);
  if (is_empty(edge, both)) return;
  const bool p_on_left = order_beside(p, q, edge, p) > 0;
  Run run{.owner = p_on_left ? p : q, .other = p_on_left ? q : p, .first = edge, .edges = 1, .wanted = 1};
  ++run_;
  near_.clear();
  seen_in_[p] = seen_in_[q] = run_;
  for (const Windows::WindowPlace& place : windows_.windows_of(p)) {
    const auto seen_here = windows_.seen_in(place.at);
    if (std::ranges::none_of(seen_here,
                             [&, other = q](const Windows::SeenOutline& seen) { return seen.outline == other; }))
      continue;
    for (const Windows::SeenOutline& seen : seen_here) add_near(seen.outline);
  }
  for (const OutlineId of : {p, q}) {
    for (const Windows::WindowPlace& place : windows_.hidden_by(of)) add_near(place.at);
  }
  set_run(run);
  hidden_[0].clear();
  backgrounds_[0].clear();
  backgrounds_[0].push_back({run.other, false, both});
  look_at_near(run);
  if (run.wanted != 0) finish(run, 0, both);
}

}  // namespace exactff::whole_view
