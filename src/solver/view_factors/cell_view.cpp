#include "view_factors/cell_view.h"

#include <algorithm>
#include <span>
#include <tuple>

#include "kernel/poll.h"
#include "view_factors/cell.h"

namespace exactff::view_factors {
namespace {

constexpr std::uint64_t kManySigns = 1 << 18;                  // a cell that asks for more is cut by what it has
constexpr std::size_t kManyCandidates = 16;                    // whose events are not worth a count
constexpr std::size_t kFewCandidates = 4;                      // in any cell, some may be covered by others
constexpr std::uint64_t kSignsForAnOrder = 16;                 // the work that it takes
constexpr std::size_t kSource = static_cast<std::size_t>(-1);  // the owner of an edge, beside the occluders

const Edge& next(const Ring& ring, std::size_t i) { return ring[(i + 1) % ring.size()]; }
const Edge& previous(const Ring& ring, std::size_t i) { return ring[(i + ring.size() - 1) % ring.size()]; }

}  // namespace

CellView::CellView(const Sight& sight, PairMemory& memory, std::size_t id) : sight_(sight), memory_(memory), id_(id) {
  for (std::uint32_t o = 0; o < sight.shadow_count(); ++o) reversed_.push_back(reverse_of(sight.shadow(o).ring));
  find_same_edges();
  was_covered_.resize(sight.shadow_count());
  if (!sight.is_of_open()) return;
  for (PointId p = 0; p < sight.points.point_count(); ++p) {
    in_plane_.push_back(side_of(sight.receiver, sight.points[p]) == 0);
  }
}

void CellView::find_same_edges() {
  struct Place {
    LineId line;
    PointId lower, upper;
    std::uint32_t occluder, edge;
    bool from_lower;
  };
  std::vector<Place> places;
  for (std::uint32_t o = 0; o < sight_.shadow_count(); ++o) {
    const Ring& ring = sight_.shadow(o).ring;
    edges_.emplace_back(ring.size());
    for (std::uint32_t i = 0; i < ring.size(); ++i) {
      const auto [lower, upper] = std::minmax(ring[i].from, ring[i].to);
      places.push_back({ring[i].line, lower, upper, o, i, ring[i].from == lower});
    }
  }
  const auto ends_of = [](const Place& p) { return std::tuple(p.line, p.lower, p.upper); };
  std::ranges::sort(places, {}, [&](const Place& p) { return std::tuple(ends_of(p), p.occluder, p.edge); });
  for (std::size_t begin = 0, end = 0; begin < places.size(); begin = end) {
    while (end < places.size() && ends_of(places[end]) == ends_of(places[begin])) {
      same_edges_.push_back({places[end].occluder, places[end].from_lower});
      ++end;
    }
    const EdgeRange range{static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end)};
    for (std::size_t i = begin; i < end; ++i) edges_[places[i].occluder][places[i].edge] = range;
  }
}

std::vector<std::pair<std::uint32_t, std::size_t>> CellView::neighbours_of(std::uint32_t occluder) const {
  std::vector<std::pair<std::uint32_t, std::size_t>> neighbours;
  for (std::size_t side = 0; side < edges_[occluder].size(); ++side) {
    for (std::uint32_t i = edges_[occluder][side].begin; i < edges_[occluder][side].end; ++i) {
      if (same_edges_[i].occluder != occluder) neighbours.emplace_back(same_edges_[i].occluder, side);
    }
  }
  return neighbours;
}

void CellView::note_facing() {
  facing_.assign(sight_.shadow_count(), 0);
  for (const Candidate& candidate : *candidates_) facing_[candidate.occluder] = candidate.facing;
}

// A candidate that lies on the other side of the edge: as seen from the cell, both run counter-clockwise round their
// occluders, in opposite directions. `edge`: by its place in the ring.
std::optional<std::uint32_t> CellView::neighbour_at(std::uint32_t owner, std::size_t edge) const {
  const EdgeRange range = edges_[owner][edge];
  if (range.end - range.begin == 1) return std::nullopt;
  const auto same = std::span(same_edges_).subspan(range.begin, range.end - range.begin);
  const auto own = std::ranges::find(same, owner, &SameEdge::occluder);
  const auto found = std::ranges::find_if(same, [&](const SameEdge& other) {
    const int facing = facing_[other.occluder];
    return facing != 0 && facing != kMixed && (facing == facing_[owner]) == (other.from_lower != own->from_lower);
  });
  if (found == same.end()) return std::nullopt;
  return found->occluder;
}

void CellView::start() {
  memory_.start(id_, sight_.points.line_count(), sight_.points.point_count());
  top_ = 0;
}

void CellView::resume(PairMemory::Way way) {
  top_ = way.size();
  memory_.resume(id_, sight_.points.line_count(), sight_.points.point_count(), std::move(way));
}

PairMemory::Way CellView::way(std::size_t depth) const {
  const auto begin = memory_.way().begin();
  return {begin, begin + static_cast<std::ptrdiff_t>(depth) + 1};
}

Candidates CellView::all_candidates() const {
  Candidates all(sight_.occluders.size());
  for (std::uint32_t i = 0; i < all.size(); ++i) all[i].occluder = i;
  return all;
}

// By the filter at each corner, else by the exact plane.
int CellView::sign_on_cell(LineId line, PointId point) {
  const Points& points = sight_.points;
  const Line& ends = points.line(line);
  const RoundedPlane filter(points[ends.a], points[ends.b], points[point]);
  const Plane* exact = nullptr;
  return common_sign(*cell_, [&](const Point& corner) {
    const int side = filter.side_of(corner);
    if (side != kernel::kUncertain) return side;
    if (exact == nullptr) exact = memory_.plane(points, line, point).get();
    return side_of(*exact, corner);
  });
}

// +1: left of the line, from its first point to its second.
int CellView::raw_side(LineId line, PointId point) {
  const Line& ends = sight_.points.line(line);
  if (point == ends.a || point == ends.b) return 0;
  ++work_;
  int sign = memory_.sign(line, point);
  if (sign == kUnasked) {
    sign = sign_on_cell(line, point);
    memory_.keep_sign(line, point, sign);
  }
  if (sign < kMixed) return sign;
  doubts_.push_back({line, point});
  return kMixed;
}

// +1: the point is seen on the left of the edge.
int CellView::side(const Edge& edge, PointId point) {
  const int raw = raw_side(edge.line, point);
  return raw == kMixed || edge.along ? raw : -raw;
}

// True if all of `other` is seen on the right of an edge of the ring, or on it.
bool CellView::is_beside(const Ring& ring, const Ring& other) {
  return std::ranges::any_of(ring, [&](const Edge& edge) {
    return std::ranges::all_of(other, [&](const Edge& corner) { return side(edge, corner.from) <= 0; });
  });
}

// True if all of `other` is seen inside the ring.
bool CellView::holds(const Ring& ring, const Ring& other) {
  return std::ranges::all_of(ring, [&](const Edge& edge) {
    return std::ranges::all_of(other, [&](const Edge& corner) {
      const int s = side(edge, corner.from);
      return s == 0 || s == 1;
    });
  });
}

const Ring& CellView::ring_of(const Candidate& candidate) const {
  return candidate.facing > 0 ? sight_.shadow(candidate.occluder).ring : reversed_[candidate.occluder];
}

void CellView::consider_cut(const std::shared_ptr<const Plane>& plane) {
  const double share = balance(*cell_, *plane);
  if (share <= best_balance_) return;
  best_balance_ = share;
  best_cut_ = plane;
}

// A plane is made exactly only if its estimate may beat the best one so far.
void CellView::consider_doubts() {
  const Points& points = sight_.points;
  for (const auto& [line, point] : doubts_) {
    if (memory_.sign(line, point) == kMixedAndSeen) continue;
    memory_.keep_sign(line, point, kMixedAndSeen);
    const Line& ends = points.line(line);
    const RoundedPlane estimate(points[ends.a], points[ends.b], points[point]);
    if (balance_at_most(*cell_, estimate) < best_balance_) continue;
    consider_cut(memory_.plane(points, line, point));
  }
  doubts_.clear();
}

// True if the cell is certainly outside all bases of the solid. A cell of one point belongs to another one.
bool CellView::is_outside(const Solid& solid) {
  return cell_->corners.size() > 1 && std::ranges::all_of(solid.bases, [&](const Ring& base) {
           return std::ranges::any_of(base, [&](const Edge& edge) { return side(edge, sight_.apex) == 1; });
         });
}

// True if it shows the cell the back of a closed surface, of which it may turn out to be spare.
bool CellView::is_back(const Candidate& candidate) const {
  const std::uint32_t id = sight_.shadow(candidate.occluder).solid;
  return id != kNoSolid && candidate.facing != kMixed && (candidate.facing > 0) == sight_.solids[id].turned_inside_out;
}

// True if the pieces of its closed surface that show the cell their fronts cover all that the occluder does.
bool CellView::is_spare_back(const Candidate& candidate) {
  return is_back(candidate) && is_outside(sight_.solids[sight_.shadow(candidate.occluder).solid]);
}

// Finds how the occluder faces the cell and whether it can cover anything. True if it hides the whole source. One that
// covers nothing then faces neither side.
bool CellView::sort_out(Candidate& candidate) {
  const Occluder& occluder = sight_.shadow(candidate.occluder);
  std::int8_t& facing = candidate.facing;
  if (facing == kUnasked || facing == kMixed) facing = static_cast<std::int8_t>(sign_inside(*occluder.plane, *cell_));
  bool beside = facing == 0 || is_beside(sight_.source, occluder.ring);
  if (!beside && facing != kMixed) {
    if (!sight_.is_of_open()) {
      beside = is_beside(ring_of(candidate), sight_.source);
      if (!beside && holds(ring_of(candidate), sight_.source)) return true;
    }
    if (!beside && is_spare_back(candidate)) beside = was_covered_[candidate.occluder] = true;
  }
  doubts_.clear();
  if (beside) {
    facing = 0;
  } else if (facing == kMixed) {
    consider_cut({std::shared_ptr<const Plane>(), occluder.plane});
  }
  return false;
}

// True if all of the inner occluder is seen inside the shadow of the outer one and a neighbour of it, as are the two
// triangles of a bent face: on the inner side of every edge but the one between them. Of a polygon, convex or not,
// these half-planes share its kernel.
bool CellView::holds_with_neighbour(const Candidate& outer, std::uint32_t inner) {
  const Ring& ring = ring_of(outer);
  const auto is_inside = [&](const Ring& half, const Edge& shared) {
    return std::ranges::all_of(half, [&](const Edge& e) {
      if (e.line == shared.line && std::minmax(e.from, e.to) == std::minmax(shared.from, shared.to)) return true;
      return std::ranges::all_of(sight_.shadow(inner).ring, [&](const Edge& corner) {
        const int s = side(e, corner.from);
        return s == 0 || s == 1;
      });
    });
  };
  for (std::uint32_t i = 0; i < ring.size(); ++i) {
    const std::uint32_t edge = outer.facing > 0 ? i : static_cast<std::uint32_t>(ring.size()) - 1 - i;
    const std::optional<std::uint32_t> neighbour = neighbour_at(outer.occluder, edge);
    if (!neighbour || *neighbour == inner || is_back({*neighbour, facing_[*neighbour]})) continue;
    if (is_inside(ring, ring[i]) && is_inside(ring_of({*neighbour, facing_[*neighbour]}), ring[i])) return true;
  }
  return false;
}

// Takes out those that another one covers from all of the cell: the union of the shadows is the same without them. A
// back covers nothing here: it may be taken out itself, for a part of the cell, and then others of its surface must be
// there.
void CellView::drop_covered(Candidates& candidates) {
  note_facing();
  for (Candidate& inner : candidates) {
    const auto covers_it = [&](const Candidate& outer) {
      return outer.facing != 0 && outer.facing != kMixed && outer.occluder != inner.occluder && !is_back(outer) &&
             (holds(ring_of(outer), sight_.shadow(inner.occluder).ring) || holds_with_neighbour(outer, inner.occluder));
    };
    if (!std::ranges::any_of(candidates, covers_it)) continue;
    inner.facing = facing_[inner.occluder] = 0;
    was_covered_[inner.occluder] = true;
  }
  doubts_.clear();
  std::erase_if(candidates, [](const Candidate& c) { return c.facing == 0; });
}

// The common part of an edge and of the interval in which its line lies between the lines `in` and `out`.
CellView::Covered CellView::between(const Edge& edge, const Edge& in, const Edge& out) {
  const int from_in = side(in, edge.from), to_in = side(in, edge.to);
  const int from_out = side(out, edge.from), to_out = side(out, edge.to);
  for (const int s : {from_in, to_in, from_out, to_out}) {
    if (s == kMixed) return {Overlap::kUnknown};
  }
  Interval interval{{edge.from, {}}, {edge.to, {}}};
  const bool from_inside = from_in >= 0 && from_out >= 0, to_inside = to_in >= 0 && to_out >= 0;
  if (from_inside ? from_out == 0 : !(from_in < 0 && to_in > 0)) return {Overlap::kNone};
  if (to_inside ? to_in == 0 : !(from_out > 0 && to_out < 0)) return {Overlap::kNone};
  if (!from_inside) interval.from.line = in.line;
  if (!to_inside) interval.to.line = out.line;
  return {from_inside && to_inside ? Overlap::kAll : Overlap::kPart, interval};
}

// The part of the edge inside the ring; if the edge runs along an edge of the ring, the part along that.
CellView::Covered CellView::overlap(const Edge& edge, const Ring& ring, Along& along) {
  along = Along::kNo;
  bool inside = true, known = true;
  std::optional<std::size_t> common;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const int from = side(ring[i], edge.from), to = side(ring[i], edge.to);
    if (from == kMixed || to == kMixed) {
      known = false;
    } else if (from == 0 && to == 0) {
      common = i;
    } else if (from <= 0 && to <= 0) {
      return {Overlap::kNone};
    } else {
      inside = inside && from >= 0 && to >= 0;
    }
  }
  if (common) {
    const int body = side(edge, next(ring, *common).to);
    if (body == kMixed) return {Overlap::kUnknown};
    along = body > 0 ? Along::kSameSide : Along::kOppositeSide;
    const Edge& before = previous(ring, *common);
    const Edge& after = next(ring, *common);
    return body > 0 ? between(edge, before, after) : between(edge, after, before);
  }
  if (known && inside) return {Overlap::kAll, {{edge.from, {}}, {edge.to, {}}}};
  const Edge* in = nullptr;
  const Edge* out = nullptr;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const int here = side(edge, ring[i].from), there = side(edge, ring[i].to);
    if (here == kMixed || there == kMixed) return {Overlap::kUnknown};
    if (here > 0 && there <= 0) in = &ring[i];
    if (here < 0 && there >= 0) out = &ring[i];
  }
  if (in == nullptr || out == nullptr) return {Overlap::kNone};
  return between(edge, *in, *out);
}

// Whether an overlap along a common edge counts as covered: see the rules of the header.
bool CellView::covers(Along along, std::size_t owner, std::size_t other) const {
  if (along == Along::kNo) return true;
  if (owner == kSource) return along == Along::kSameSide;
  return along == Along::kOppositeSide || other < owner;
}

void CellView::look_at_edge(const Edge& edge, std::size_t owner) {
  doubts_.clear();
  intervals_.clear();
  Covered base{Overlap::kAll, {{edge.from, {}}, {edge.to, {}}}};
  Along along = Along::kNo;
  if (owner != kSource) base = overlap(edge, sight_.source, along);
  if (base.kind == Overlap::kNone || (base.kind != Overlap::kUnknown && along != Along::kNo)) return;
  bool known = base.kind != Overlap::kUnknown;
  intervals_.push_back(base.interval);
  for (const Candidate& candidate : *candidates_) {
    const std::size_t other = candidate.occluder;
    if (other == owner) continue;
    const std::size_t doubts = doubts_.size();
    const Covered covered = overlap(edge, ring_of(candidate), along);
    if (covered.kind == Overlap::kUnknown) {
      known = false;
      continue;
    }
    doubts_.resize(doubts);
    if (covered.kind == Overlap::kNone || !covers(along, owner, other)) continue;
    if (covered.kind == Overlap::kAll) return;
    intervals_.push_back(covered.interval);
  }
  if (known) {
    doubts_.clear();
    const std::size_t emitted = parts_.size();
    if (!emit_uncovered(edge, owner == kSource ? 1 : -1)) {
      parts_.resize(emitted);
      find_all_undecided(edge);
    }
  }
  consider_doubts();
}

// Sign of det(N_e, N_g, N_h) on the cell. If two lines share a point v, h = (v, w) or (w, v) say,
// N_g x N_h is a multiple of v - x, and the determinant is a product of two signs of the first kind.
int CellView::order_of_lines(LineId e, LineId g, LineId h) {
  if (e == g || g == h || h == e) return 0;
  const CrossingTriple lines{e, g, h};
  for (int i = 0; i < 3; ++i) {
    const LineId one = lines[i], first = lines[(i + 1) % 3], second = lines[(i + 2) % 3];  // a cyclic permutation
    const Line& p = sight_.points.line(first);
    const Line& q = sight_.points.line(second);
    for (const bool from_v : {true, false}) {
      const PointId v = from_v ? q.a : q.b, w = from_v ? q.b : q.a;
      if (v != p.a && v != p.b) continue;
      const std::size_t doubts = doubts_.size();
      const int at_v = raw_side(one, v), at_w = raw_side(first, w);
      if (at_v == 0 || at_w == 0) {
        doubts_.resize(doubts);
        return 0;
      }
      if (at_v == kMixed || at_w == kMixed) return kMixed;
      return from_v ? at_v * at_w : -at_v * at_w;
    }
  }
  return order_of_apart(lines);
}

// Of three lines without common points. The determinant changes its sign where two of them change places.
int CellView::order_of_apart(CrossingTriple lines) {
  int parity = 1;
  for (const auto& [i, j] : {std::pair(0, 1), std::pair(1, 2), std::pair(0, 1)}) {
    if (lines[i] < lines[j]) continue;
    std::swap(lines[i], lines[j]);
    parity = -parity;
  }
  const auto [place, is_new] = orders_.try_emplace(lines, 0);
  if (is_new) {
    work_ += kSignsForAnOrder;
    place->second = crossing_order(sight_.points, *cell_, lines[0], lines[1], lines[2]);
    if (place->second == kMixed) triples_.push_back(lines);
  }
  return place->second == kMixed ? kMixed : parity * place->second;
}

// True if they are the ends of intervals in a row, none of which is empty.
bool CellView::is_known_before(const End& p, const End& q) const {
  for (const auto& [from, to] : intervals_) {
    if (p != from) continue;
    if (to == q) return true;
    for (const Interval& next : intervals_) {
      if (next.from == to && next.to == q) return true;
    }
  }
  return false;
}

// -1, 0, +1: p is before, at, after q on the edge.
int CellView::order(const Edge& edge, const End& p, const End& q) {
  if (p == q) return 0;
  const auto is_start = [&](const End& end) { return !end.line && end.vertex == edge.from; };
  const auto is_end = [&](const End& end) { return !end.line && end.vertex == edge.to; };
  if (is_start(p) || is_end(q)) return -1;
  if (is_start(q) || is_end(p)) return 1;
  if (is_known_before(p, q)) return -1;
  if (is_known_before(q, p)) return 1;
  const int sign = order_of_lines(edge.line, *p.line, *q.line);
  if (sign == 0 || sign == kMixed) return sign;
  // q is after p iff the edge leaves both lines to the same side and the determinant is positive: with the edge from a
  // to b, the crossing with h is +-N_e x N_h, + if a is on the right of h.
  const int right_of_p = -raw_side(*p.line, edge.from), right_of_q = -raw_side(*q.line, edge.from);
  const int edge_sign = edge.along ? 1 : -1;
  return -edge_sign * sign * right_of_p * right_of_q;
}

// Every order of two crossings on the edge that is undecided, whether or not it has been asked for.
void CellView::find_all_undecided(const Edge& edge) {
  std::vector<LineId> lines;
  for (const Interval& interval : intervals_) {
    for (const End& end : {interval.from, interval.to}) {
      if (end.line) lines.push_back(*end.line);
    }
  }
  for (std::size_t i = 0; i < lines.size(); ++i) {
    for (std::size_t j = i + 1; j < lines.size(); ++j) (void)order_of_lines(edge.line, lines[i], lines[j]);
  }
}

// What lies at `at` or beyond it on the edge. Nothing if an order is undecided.
std::optional<CellView::Ahead> CellView::look_ahead(const Edge& edge, const End& at) {
  Ahead ahead;
  for (const Interval& cover : covers()) {
    const int starts = order(edge, cover.from, at);
    const int ends = order(edge, cover.to, at);
    if (ends == -1 || ends == 0) continue;
    if (starts == kMixed || ends == kMixed) return std::nullopt;
    if (starts <= 0) {
      ahead.covered_to = cover.to;
      return ahead;
    }
    const int nearer = ahead.next_cover ? order(edge, cover.from, *ahead.next_cover) : -1;
    if (nearer == kMixed) return std::nullopt;
    if (nearer < 0) ahead.next_cover = cover.from;
  }
  return ahead;
}

// Goes along the edge from one covered stretch to the next. False if an order is undecided.
bool CellView::emit_uncovered(const Edge& edge, int sign) {
  const Interval base = intervals_.front();
  for (End at = base.from;;) {
    const std::optional<Ahead> ahead = look_ahead(edge, at);
    if (!ahead) return false;
    if (ahead->covered_to) at = *ahead->covered_to;
    const int left = order(edge, at, base.to);
    if (left == kMixed) return false;
    if (left >= 0) return true;
    if (ahead->covered_to) continue;
    const int within = ahead->next_cover ? order(edge, *ahead->next_cover, base.to) : 1;
    if (within == kMixed) return false;
    const bool is_last = within >= 0;
    const End end = is_last ? base.to : *ahead->next_cover;
    parts_.push_back({edge, at, end, sign});
    if (is_last) return true;
    at = end;
  }
}

// False if it stopped early, with a cut.
bool CellView::look_at_edges() {
  const std::uint64_t before = work_;
  const auto look_at_ring = [&](const Ring& ring, const auto& is_left_out, std::size_t owner) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      if (is_left_out(i)) continue;
      if (work_ - before > kManySigns) {
        if (best_cut_ != nullptr) return false;
        kernel::poll();
      }
      look_at_edge(ring[i], owner);
    }
    return true;
  };
  if (!look_at_ring(
          sight_.source, [](std::size_t) { return false; }, kSource))
    return false;
  note_facing();
  return std::ranges::all_of(*candidates_, [&](const Candidate& c) {
    const Ring& ring = ring_of(c);
    const auto is_inner = [&](std::size_t i) {
      return neighbour_at(c.occluder, c.facing > 0 ? i : ring.size() - 1 - i).has_value();
    };
    return look_at_ring(ring, is_inner, c.occluder);
  });
}

std::size_t CellView::count_events(const Cell& cell, const Candidates& candidates) {
  if (candidates.size() > kManyCandidates) return 0;
  memory_.enter(0);
  cell_ = &cell;
  std::size_t count = 0;
  const auto look_at = [&](const Ring& edges, const Ring& corners) {
    for (const Edge& edge : edges) {
      for (const Edge& corner : corners) {
        if (side(edge, corner.from) != kMixed || memory_.sign(edge.line, corner.from) == kMixedAndSeen) continue;
        memory_.keep_sign(edge.line, corner.from, kMixedAndSeen);
        ++count;
      }
    }
  };
  for (const Candidate& candidate : candidates) {
    const Ring& ring = sight_.shadow(candidate.occluder).ring;
    look_at(sight_.source, ring);
    look_at(ring, sight_.source);
  }
  doubts_.clear();
  return count;
}

bool CellView::is_on_horizon(const Edge& edge) const { return in_plane_[edge.from] && in_plane_[edge.to]; }

// Of an end of a part on the horizon: the same for the same direction, as far as it is a vertex in the receiver's
// plane, or an end of a line there.
std::pair<PointId, LineId> CellView::place_on_horizon(const End& end) const {
  if (!end.line) return {end.vertex, 0};
  const Line& line = sight_.points.line(*end.line);
  if (in_plane_[line.a] != in_plane_[line.b]) return {in_plane_[line.a] ? line.a : line.b, 0};
  return {static_cast<PointId>(-1), *end.line};
}

// Shadows lie above the horizon, so its parts follow one another in one sense and have no directions in common.
void CellView::look_at_horizon() {
  has_horizon_ = true;
  std::map<std::pair<PointId, LineId>, std::pair<PointId, LineId>> next;
  for (const BoundaryPart& part : parts_) {
    if (is_on_horizon(part.edge)) next.emplace(place_on_horizon(part.from), place_on_horizon(part.to));
  }
  if (next.empty()) return;
  const auto start = next.begin()->first;
  auto at = start;
  for (std::size_t i = 0; i < next.size(); ++i) {
    const auto found = next.find(at);
    if (found == next.end()) return;
    at = found->second;
    if (at == start && i + 1 < next.size()) return;
  }
  if (at != start) return;
  has_horizon_ = false;
  std::erase_if(parts_, [&](const BoundaryPart& part) { return is_on_horizon(part.edge); });
}

CellView::Outcome CellView::look(const Cell& cell, std::size_t depth, Candidates& candidates) {
  memory_.enter(depth);
  cell_ = &cell;
  candidates_ = &candidates;
  parts_.clear();
  has_horizon_ = false;
  best_cut_.reset();
  best_balance_ = -1.0;
  doubts_.clear();
  triples_.clear();
  orders_.clear();
  for (Candidate& candidate : candidates) {
    if (sort_out(candidate)) {
      best_cut_.reset();
      return Outcome::kKnown;
    }
  }
  std::erase_if(candidates, [](const Candidate& c) { return c.facing == 0; });
  if (best_cut_ != nullptr) return Outcome::kCut;
  if (depth <= top_ + 1 || candidates.size() <= kFewCandidates) drop_covered(candidates);
  if (!look_at_edges()) return Outcome::kCut;
  if (sight_.is_of_open()) look_at_horizon();
  return best_cut_ != nullptr ? Outcome::kCut : !triples_.empty() ? Outcome::kCrossings : Outcome::kKnown;
}

}  // namespace exactff::view_factors
