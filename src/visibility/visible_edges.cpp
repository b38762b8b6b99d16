#include "visibility/visible_edges.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace exactff::visibility {

using kernel::Integer;
using kernel::sign;
using Edge = Outlines::Edge;
using Outline = Outlines::Outline;

namespace {

using Parameter = VisibleEdges::Parameter;
constexpr Parameter kBegin{Parameter::Kind::kBegin, 0, VisibleEdges::kNowhere, 0.0, 0.0};
constexpr Parameter kEnd{Parameter::Kind::kEnd, 0, VisibleEdges::kNowhere, 1.0, 0.0};

// Pairs cost 1 to 2 us each where nothing tells them apart; as many occluders as make this many cost the Booleans less.
constexpr std::uint64_t kMostUnsortedPairs = 1'000'000;

double dot(const kernel::Approx3& a, const kernel::Approx3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

}  // namespace

bool VisibleEdges::find(std::size_t source_count) {
  parts_.clear();
  stored_.clear();
  drop_inner_edges(source_count);
  grid_.build(outlines_, source_count);
  if (grid_.unsorted_pairs(outlines_) > kMostUnsortedPairs) return false;
  for (EdgeId id = 0; id < outlines_.edges().size(); ++id) {
    if (dropped_[id] == 0) trace(id, source_count);
  }
  return true;
}

bool VisibleEdges::hides_all(OutlineId occluder, std::size_t source_count) {
  const Outline& o = outlines_.outline(occluder);
  const Outline& last = outlines_.outline(static_cast<OutlineId>(source_count - 1));
  for (EdgeId f = o.first; f < o.first + o.count; ++f) {
    for (EdgeId s = 0; s < last.first + last.count; ++s) {
      if (outlines_.side(outlines_.edge(f), outlines_.edge(s).a) < 0) return false;
    }
  }
  return true;
}

// Step 1. Of edges with the same two corners the first is kept, and only if none runs the other way.
void VisibleEdges::drop_inner_edges(std::size_t source_count) {
  constexpr EdgeId kFree = 0xFFFFFFFFU;
  const auto edges = outlines_.edges();
  dropped_.assign(edges.size(), 0);
  const std::size_t mask = std::bit_ceil(2 * edges.size()) - 1;
  slots_.assign(mask + 1, kFree);
  for (OutlineId o = static_cast<OutlineId>(source_count); o < outlines_.outlines().size(); ++o) {
    const Outline& outline = outlines_.outline(o);
    if (!outline.whole) continue;
    for (EdgeId id = outline.first; id < outline.first + outline.count; ++id) {
      const auto [low, high] = std::minmax(edges[id].a, edges[id].b);
      const std::uint64_t key = (std::uint64_t{high} << 32U | low) * 0x9E3779B97F4A7C15U;
      for (std::size_t slot = key >> 32U & mask;; slot = (slot + 1) & mask) {
        if (slots_[slot] == kFree) {
          slots_[slot] = id;
          break;
        }
        const EdgeId first = slots_[slot];
        const bool same = edges[first].a == edges[id].a && edges[first].b == edges[id].b;
        const bool opposite = edges[first].a == edges[id].b && edges[first].b == edges[id].a;
        if (!same && !opposite) continue;
        dropped_[id] = 1;
        if (opposite) dropped_[first] = 1;
        break;
      }
    }
  }
}

// Step 3.
void VisibleEdges::trace(EdgeId id, std::size_t source_count) {
  const Edge& edge = outlines_.edge(id);
  find_allowed(edge, source_count);
  if (allowed_.empty()) return;
  grid_.find_near(outlines_, id, near_);
  if (!find_removed(edge, source_count)) return;
  sort(edge, removed_);
  const bool reversed = edge.outline >= source_count;
  for (const Interval& allowed : allowed_) keep_rest(id, reversed, allowed);
}

// The whole of a source's edge; of an occluder's, what has the source on both sides.
void VisibleEdges::find_allowed(const Edge& edge, std::size_t source_count) {
  allowed_.clear();
  if (edge.outline < source_count) {
    allowed_.push_back({kBegin, kEnd});
    return;
  }
  left_.clear();
  right_.clear();
  Cover found;
  for (OutlineId s = 0; s < source_count; ++s) {
    if (!cover(edge, s, found)) continue;
    if (found.left) left_.push_back(found.interval);
    if (found.right) right_.push_back(found.interval);
  }
  merge(edge, left_);
  merge(edge, right_);
  for (const Interval& a : left_) {
    for (const Interval& b : right_) {
      const Parameter& begin = compare(edge, a.begin, b.begin) >= 0 ? a.begin : b.begin;
      const Parameter& end = compare(edge, a.end, b.end) <= 0 ? a.end : b.end;
      if (compare(edge, begin, end) < 0) allowed_.push_back({begin, end});
    }
  }
}

bool VisibleEdges::find_removed(const Edge& edge, std::size_t source_count) {
  removed_.clear();
  const bool of_source = edge.outline < source_count;
  Cover found;
  const auto remove = [&](OutlineId o, bool same_kind, bool covers_boundary_side) {
    const bool double_of_earlier = same_kind && found.coincides && found.left && o < edge.outline;
    if (!covers_boundary_side && !double_of_earlier) return true;
    removed_.push_back(found.interval);
    return allowed_.size() != 1 || !covers(edge, found.interval, allowed_.front());
  };
  if (of_source) {
    for (OutlineId s = 0; s < source_count; ++s) {
      if (s != edge.outline && cover(edge, s, found) && !remove(s, true, found.right)) return false;
    }
  }
  for (const OutlineId o : near_) {
    if (o == edge.outline || !cover(edge, o, found)) continue;
    if (!remove(o, !of_source, of_source ? found.left : found.right)) return false;
  }
  return true;
}

// The signs of f's heights at both ends of the edge, exactly, and where they differ the crossing.
void VisibleEdges::cut_exactly(const Edge& edge, EdgeId f_id, int& sign_a, int& sign_b, Parameter& crossing) {
  const Edge& f = outlines_.edge(f_id);
  sign_a = outlines_.side(f, edge.a);
  sign_b = outlines_.side(f, edge.b);
  if (sign_a * sign_b >= 0) return;
  Integer l = abs(outlines_.exact_height(f, edge.b)), m = abs(outlines_.exact_height(f, edge.a));
  long l_exponent = 0, m_exponent = 0;
  const double l_mantissa = mpz_get_d_2exp(&l_exponent, l.get_mpz_t());
  const double m_mantissa = mpz_get_d_2exp(&m_exponent, m.get_mpz_t());
  // In the scale of the doubles, which is that of the other crossings.
  const long exponent = l_exponent + outlines_.exponent(edge.b) - m_exponent - outlines_.exponent(edge.a);
  const double l_over_m = std::ldexp(l_mantissa / m_mantissa, static_cast<int>(std::clamp(exponent, -2000L, 2000L)));
  crossing = {Parameter::Kind::kCrossing, f_id, static_cast<std::uint32_t>(stored_.size()), 1.0 / (1.0 + l_over_m),
              0x1p-49};
  stored_.push_back({std::move(l), std::move(m)});
}

bool VisibleEdges::lies_left(const Edge& edge, OutlineId outline) {
  const Outline& o = outlines_.outline(outline);
  for (EdgeId f = o.first; f < o.first + o.count; ++f) {
    const int side = outlines_.side(edge, outlines_.edge(f).a);
    if (side != 0) return side > 0;
  }
  return true;  // an outline without area: cannot be
}

// m / (l + m) errs by at most e / (D - 2e), e being the larger error of the two heights and D = |a| + |b| as computed,
// and by roundings below 2^-51.
VisibleEdges::Parameter VisibleEdges::crossing_at(EdgeId line, double height_a, double height_b, double error) {
  const double size = std::abs(height_a) + std::abs(height_b);
  return {Parameter::Kind::kCrossing, line, kNowhere, std::abs(height_a) / size,
          size > 4.0 * error ? 2.0 * error / size + 0x1p-50 : 2.0};
}

bool VisibleEdges::cover(const Edge& edge, OutlineId outline, Cover& result) {
  const Outline& o = outlines_.outline(outline);
  const Outlines::Corner &a = outlines_.corner(edge.a), &b = outlines_.corner(edge.b);
  Interval& interval = result.interval;
  interval = {kBegin, kEnd};
  result.coincides = false;
  for (EdgeId id = o.first; id < o.first + o.count; ++id) {
    const Edge& f = outlines_.edge(id);
    const double height_a = dot(f.normal, a.t), height_b = dot(f.normal, b.t);
    const double error_a = f.error * a.size, error_b = f.error * b.size;
    int sign_a = height_a > error_a ? 1 : height_a < -error_a ? -1 : 0;
    int sign_b = height_b > error_b ? 1 : height_b < -error_b ? -1 : 0;
    if (sign_a > 0 && sign_b > 0) continue;
    if (sign_a < 0 && sign_b < 0) return false;
    Parameter crossing;
    if (sign_a * sign_b != 0) {
      crossing = crossing_at(id, height_a, height_b, std::max(error_a, error_b));
    } else {
      cut_exactly(edge, id, sign_a, sign_b, crossing);
      if (sign_a <= 0 && sign_b <= 0) {
        if (sign_a < 0 || sign_b < 0) return false;
        result.coincides = true;
        continue;
      }
      if (sign_a >= 0 && sign_b >= 0) continue;
    }
    if (sign_a < 0 && compare(edge, interval.begin, crossing) < 0) interval.begin = crossing;
    if (sign_b < 0 && compare(edge, crossing, interval.end) < 0) interval.end = crossing;
    if (compare(edge, interval.begin, interval.end) >= 0) return false;
  }
  const bool on_left = result.coincides && lies_left(edge, outline);
  result.left = !result.coincides || on_left;
  result.right = !result.coincides || !on_left;
  return true;
}

EdgeParameter VisibleEdges::exact(const Edge& edge, const Parameter& p) {
  switch (p.kind) {
    case Parameter::Kind::kBegin:
      return {1, 0};
    case Parameter::Kind::kEnd:
      return {0, 1};
    case Parameter::Kind::kCrossing:
      break;
  }
  if (p.stored != kNowhere) return stored_[p.stored];
  const Edge& f = outlines_.edge(p.line);
  return {abs(outlines_.exact_height(f, edge.b)), abs(outlines_.exact_height(f, edge.a))};
}

int VisibleEdges::compare_exactly(const Edge& edge, const Parameter& p, const Parameter& q) {
  using Kind = Parameter::Kind;
  if (p.kind == q.kind && (p.kind != Kind::kCrossing || p.line == q.line)) return 0;
  if (p.kind == Kind::kBegin || q.kind == Kind::kEnd) return -1;
  if (p.kind == Kind::kEnd || q.kind == Kind::kBegin) return 1;
  const EdgeParameter a = exact(edge, p), b = exact(edge, q);
  return cmp(a.m * b.l, b.m * a.l) < 0 ? -1 : a.m * b.l == b.m * a.l ? 0 : 1;
}

bool VisibleEdges::covers(const Edge& edge, const Interval& a, const Interval& b) {
  return compare(edge, a.begin, b.begin) <= 0 && compare(edge, a.end, b.end) >= 0;
}

void VisibleEdges::sort(const Edge& edge, std::vector<Interval>& intervals) {
  std::sort(intervals.begin(), intervals.end(),
            [&](const Interval& a, const Interval& b) { return compare(edge, a.begin, b.begin) < 0; });
}

// The union, as disjoint intervals in order.
void VisibleEdges::merge(const Edge& edge, std::vector<Interval>& intervals) {
  if (intervals.size() < 2) return;
  sort(edge, intervals);
  std::size_t last = 0;
  for (std::size_t i = 1; i < intervals.size(); ++i) {
    if (compare(edge, intervals[i].begin, intervals[last].end) > 0) {
      intervals[++last] = intervals[i];
    } else if (compare(edge, intervals[i].end, intervals[last].end) > 0) {
      intervals[last].end = intervals[i].end;
    }
  }
  intervals.resize(last + 1);
}

// What the removed intervals, in order of their beginnings, leave of an allowed one.
void VisibleEdges::keep_rest(EdgeId id, bool reversed, const Interval& allowed) {
  const Edge& edge = outlines_.edge(id);
  Parameter reached = allowed.begin;
  for (const Interval& removed : removed_) {
    if (compare(edge, removed.begin, allowed.end) >= 0) break;
    if (compare(edge, removed.begin, reached) > 0) keep(id, reversed, reached, removed.begin);
    if (compare(edge, removed.end, reached) > 0) reached = removed.end;
  }
  if (compare(edge, reached, allowed.end) < 0) keep(id, reversed, reached, allowed.end);
}

void VisibleEdges::keep(EdgeId id, bool reversed, const Parameter& begin, const Parameter& end) {
  parts_.push_back(reversed ? Part{id, end, begin} : Part{id, begin, end});
}

BoundaryPiece VisibleEdges::exact(const Part& part) {
  const Edge& edge = outlines_.edge(part.edge);
  return {outlines_.exact(edge.a), outlines_.exact(edge.b), exact(edge, part.begin), exact(edge, part.end)};
}

}  // namespace exactff::visibility
