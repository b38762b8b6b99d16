#include "gradient/kinks.h"

#include <algorithm>
#include <utility>

#include "kernel/expect.h"
#include "kernel/poll.h"
#include "kernel/vec.h"

namespace exactff::gradient {

using kernel::ExactVec3;
using kernel::Integer;
using kernel::Rational;
using kernel::RationalVec3;
using kernel::sign;
using kernel::to_rational;
using visibility::CornerId;
using visibility::EdgeId;
using visibility::OutlineId;
using visibility::Outlines;
using visibility::PieceClip;
using visibility::PlaneQuery;
using visibility::Silhouettes;
using visibility::View;

// --- Kink proof ---

namespace {

bool is_on_horizon(const View& view, Outlines& outlines, EdgeId id) {
  const Outlines::Edge edge = outlines.edge(id);
  const kernel::ExactVec3 n = view.normal().exact;
  return kernel::sign(dot(n, outlines.exact(edge.a))) == 0 && kernel::sign(dot(n, outlines.exact(edge.b))) == 0;
}

}  // namespace

bool KinkProof::excludes_kinks(const PlaneQuery& query) {
  if (query.request.engine == Engine::kBoolean || !searches_silhouettes(query)) return false;
  const std::size_t sources = PieceClip(query, outlines_, memory_.clip).add_source().count;
  if (sources == 0) return true;
  Silhouettes silhouettes(query, outlines_, memory_);
  PlaneRecord uncounted;
  silhouettes.gather(sources, uncounted);
  if (silhouettes.some_edge_on()) return false;
  groups_.clear();
  for (EdgeId id = 0; id < outlines_.edges().size(); ++id) groups_.add(outlines_, id);
  return groups_.for_each(outlines_, [&](std::span<const EdgeId> group) {
    return are_on_one_line(outlines_, group) || is_on_horizon(query.view, outlines_, group.front());
  });
}

// --- Sight plane ---

SightPlane::SightPlane(const PlaneQuery& query, Profile& profile, const Outlines::Edge& edge)
    : SightDirections(profile.outlines(), edge), query_(query), profile_(profile) {}

// Cuts an interval of directions by the range that matters. False if nothing is left.
bool SightPlane::clamp(ExactVec3& from, ExactVec3& to) const {
  if (!is_between(first_, last_, from)) {
    if (!is_between(from, to, first_)) return false;
    from = first_;
  }
  if (!is_between(first_, last_, to)) {
    if (!is_between(from, to, last_)) return false;
    to = last_;
  }
  return turn(from, to) > 0;
}

// --- What meets the plane ---

RationalVec3 SightPlane::nearness_of(const Vec3& a, const Vec3& b, const Vec3& c) const {
  const ExactVec3 m = cross(kernel::exact_difference(b, a).v, kernel::exact_difference(c, a).v);
  const kernel::ScaledVec3 arrow = kernel::exact_difference(a, query_.view.x);
  const Rational height = kernel::times_power_of_two(Rational(dot(m, arrow.v)), arrow.exponent);
  return to_rational(m) * Rational(1 / height);
}

// Nullopt unless the piece meets the plane along an arc.
std::optional<SightPlane::Stripe> SightPlane::stripe_of(OutlineId id) {
  Outlines& outlines = profile_.outlines();
  const std::vector<int> sides = sides_of(outlines, id);
  auto arc = arc_of(outlines, id, sides);
  if (!arc) return std::nullopt;
  Stripe stripe;
  stripe.from = std::move(arc->first);
  stripe.to = std::move(arc->second);
  stripe.side = side_of(sides);
  stripe.is_source = id < profile_.source_count();
  stripe.piece = profile_.pieces()[id];
  return stripe;
}

void SightPlane::find_nearness(Stripe& stripe) const {
  if (stripe.is_source) {
    stripe.nearness = source_nearness_;
  } else {
    const Piece& piece = query_.view.scene.pieces()[stripe.piece];
    const auto vertices = query_.view.scene.vertices();
    stripe.nearness = nearness_of(vertices[piece.frame[0]], vertices[piece.frame[1]], vertices[piece.frame[2]]);
  }
}

bool SightPlane::lies_in_plane(std::uint32_t piece) {
  Outlines& outlines = profile_.outlines();
  const auto& frame = query_.view.scene.pieces()[piece].frame;
  return std::ranges::all_of(frame, [&](std::uint32_t v) { return outlines.side(edge_, outlines.corner_at(v)) == 0; });
}

SightPlane::Sheet SightPlane::sheet_of(std::uint32_t index) const {
  const Scene& scene = query_.view.scene;
  const auto corners = scene.corners(scene.pieces()[index]);
  const RationalVec3 x = to_rational(query_.view.x);
  Sheet sheet;
  sheet.piece = index;
  for (std::size_t c = 0; c < corners.size(); ++c) {
    const Vec3 &a = scene.vertices()[corners[c]], &b = scene.vertices()[corners[c + 1 == corners.size() ? 0 : c + 1]];
    sheet.corners.push_back(kernel::exact_difference(a, query_.view.x).v);
    const RationalVec3 p = to_rational(a) - x, t = to_rational(b) - to_rational(a), pole = cross(p, t);
    if (is_zero(pole)) continue;  // x sees this side end-on
    Sheet::Side side{kernel::exact_difference(a, query_.view.x).v, kernel::exact_difference(b, query_.view.x).v,
                     cross(t, pole) * Rational(1 / dot(pole, pole))};
    if (turn(side.from, side.to) < 0) std::swap(side.from, side.to);
    sheet.sides.push_back(std::move(side));
  }
  return sheet;
}

// The directions in which the source lies in or beside the plane. False if it does not along an arc.
bool SightPlane::find_range() {
  bool some = false;
  for (const Stripe& stripe : stripes_) {
    if (!stripe.is_source) continue;
    if (!some || turn(stripe.from, first_) > 0) first_ = stripe.from;
    if (!some || turn(last_, stripe.to) > 0) last_ = stripe.to;
    some = true;
  }
  return some;
}

// Adds the directions inside the range in which two of the lines meet.
void SightPlane::add_meetings(std::vector<const RationalVec3*> lines, std::vector<ExactVec3>& breaks) const {
  const RationalVec3 a = to_rational(first_), b = to_rational(last_), n = to_rational(normal_);
  const auto key = [&](const RationalVec3* g) { return std::pair(dot(*g, a), dot(*g, b)); };
  std::vector<std::pair<std::pair<Rational, Rational>, const RationalVec3*>> distinct;
  for (const RationalVec3* g : lines) distinct.emplace_back(key(g), g);
  std::ranges::sort(
      distinct, {}, [](const auto& entry) -> const auto& { return entry.first; });
  const auto same = [](const auto& p, const auto& q) { return p.first == q.first; };
  distinct.erase(std::unique(distinct.begin(), distinct.end(), same), distinct.end());
  for (std::size_t i = 0; i < distinct.size(); ++i) {
    kernel::poll();
    for (std::size_t j = i + 1; j < distinct.size(); ++j) {
      const auto& [at_first, at_last] = distinct[i].first;
      const auto& [other_first, other_last] = distinct[j].first;
      if (cmp(at_first, other_first) * cmp(at_last, other_last) >= 0) continue;
      ExactVec3 t = direction_of(cross(n, *distinct[i].second - *distinct[j].second));
      if (!is_between(first_, last_, t)) negate(t);
      breaks.push_back(std::move(t));
    }
  }
}

// --- What changes ---

// From its near to its far side, before the source's plane.
std::optional<SightPlane::Chord> SightPlane::chord_of(const Sheet& sheet, const ExactVec3& t) const {
  const RationalVec3 w = to_rational(t);
  std::optional<Chord> chord;
  Rational near, far;
  for (const Sheet::Side& side : sheet.sides) {
    if (!is_between(side.from, side.to, t)) continue;
    const Rational u = dot(side.nearness, w);
    if (!chord) {
      chord = {&side.nearness, &side.nearness, sheet.piece};
      near = far = u;
    } else if (u > near) {
      chord->near = &side.nearness;
      near = u;
    } else if (u < far) {
      chord->far = &side.nearness;
      far = u;
    }
  }
  if (!chord || near == far) return std::nullopt;
  return chord;
}

namespace {

// A line beside a direction: its u, and which s it covers, if x moves so that s = u.
struct Cover {
  const RationalVec3* nearness;
  Rational u;
  int side;
};
struct Strip {
  const RationalVec3 *near, *far;
  Rational u_near, u_far;
};

// M if s = way u, way = 1 or -1.
RationalVec3 gain(const std::vector<Cover>& covers, const std::vector<Strip>& strips, int way) {
  struct Place {
    Rational s;
    const RationalVec3* nearness;
  };
  std::vector<Place> places;
  for (const Cover& cover : covers) places.push_back({cover.u * way, cover.nearness});
  for (const Strip& strip : strips) {
    places.push_back({strip.u_near * way, strip.near});
    places.push_back({strip.u_far * way, strip.far});
  }
  RationalVec3 result;
  if (places.empty()) return result;
  std::ranges::sort(places, [](const Place& p, const Place& q) { return p.s < q.s; });
  const auto add = [&](const Place& place, int times) { result = result + *place.nearness * Rational(times * way); };
  const auto none = [&](int side) {
    return std::ranges::none_of(covers, [&](const Cover& c) { return c.side == side; });
  };
  if (none(1)) add(places.back(), -1);
  if (none(-1)) add(places.front(), 1);
  for (std::size_t i = 0; i + 1 < places.size(); ++i) {
    const Rational &low = places[i].s, &high = places[i + 1].s;
    if (low == high) continue;
    const bool covered =
        std::ranges::any_of(covers,
                            [&](const Cover& c) { return c.side > 0 ? c.u * way <= low : c.u * way >= high; }) ||
        std::ranges::any_of(strips, [&](const Strip& strip) {
          const Rational p = strip.u_near * way, q = strip.u_far * way;
          return std::min(p, q) <= low && high <= std::max(p, q);
        });
    if (covered) continue;
    add(places[i + 1], 1);
    add(places[i], -1);
  }
  return result;
}

}  // namespace

// Nullopt if nothing changes at t.
std::optional<SightArc> SightPlane::judge(const ExactVec3& t) const {
  const RationalVec3 w = to_rational(t);
  bool source_above = false, source_below = false;
  std::vector<Cover> covers;
  std::vector<std::uint32_t> pieces;
  for (const Stripe& stripe : stripes_) {
    if (!is_between(stripe.from, stripe.to, t)) continue;
    if (stripe.is_source) {
      source_above = source_above || stripe.side >= 0;
      source_below = source_below || stripe.side <= 0;
    } else if (stripe.side == 0) {
      return std::nullopt;
    } else {
      covers.push_back({&stripe.nearness, dot(stripe.nearness, w), stripe.side});
      pieces.push_back(stripe.piece);
    }
  }
  if (!source_above && !source_below) return std::nullopt;
  const Rational u_source = dot(source_nearness_, w);
  if (source_above != source_below) covers.push_back({&source_nearness_, u_source, source_above ? -1 : 1});
  std::vector<Strip> strips;
  for (const Sheet& sheet : sheets_) {
    const std::optional<Chord> chord = chord_of(sheet, t);
    if (!chord) continue;
    Strip strip{chord->near, chord->far, dot(*chord->near, w), dot(*chord->far, w)};
    if (strip.u_near <= u_source) continue;
    if (strip.u_far < u_source) {
      strip.u_far = u_source;
      strip.far = &source_nearness_;
    }
    strips.push_back(std::move(strip));
    pieces.push_back(sheet.piece);
  }
  SightArc arc;
  arc.gain_back = gain(covers, strips, 1);
  arc.gain_ahead = gain(covers, strips, -1);
  arc.is_kink = dot(arc.gain_back + arc.gain_ahead, w) != 0;
  if (!arc.is_kink && is_zero(arc.gain_back) && is_zero(arc.gain_ahead)) return std::nullopt;
  arc.edge_on = !strips.empty();
  arc.pieces = std::move(pieces);
  return arc;
}

template <class Judge>
std::vector<SightArc> SightPlane::judge_all(std::vector<ExactVec3> breaks, const Judge& judge, Extent extent) const {
  std::ranges::sort(breaks, [&](const ExactVec3& p, const ExactVec3& q) { return turn(p, q) > 0; });
  std::vector<SightArc> result;
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
    kernel::poll();
    if (turn(breaks[i], breaks[i + 1]) <= 0) continue;
    if (std::optional<SightArc> arc = judge(breaks[i] + breaks[i + 1])) {
      arc->begin = breaks[i];
      arc->end = breaks[i + 1];
      result.push_back(std::move(*arc));
      if (extent == Extent::kUpToKink && result.back().is_kink) break;
    }
  }
  return result;
}

std::vector<SightArc> SightPlane::arcs(Extent extent) {
  const auto& [view, plane, request] = query_;
  source_nearness_ = nearness_of(plane.point, plane.second, plane.third);
  stripes_.clear();
  for (OutlineId o = 0; o < profile_.outlines().outlines().size(); ++o) {
    if (std::optional<Stripe> stripe = stripe_of(o)) stripes_.push_back(std::move(*stripe));
    if (o + 1 == profile_.source_count() && !find_range()) return {};
  }
  std::erase_if(stripes_, [&](Stripe& stripe) { return !clamp(stripe.from, stripe.to); });
  // Those on both sides come first: where one of them is, nothing else counts.
  const auto others = std::stable_partition(stripes_.begin(), stripes_.end(),
                                            [](const Stripe& s) { return !s.is_source && s.side == 0; });
  std::for_each(others, stripes_.end(), [&](Stripe& stripe) { find_nearness(stripe); });
  sheets_.clear();
  for (const std::uint32_t piece : profile_.sheets()) {
    if (lies_in_plane(piece) && !holds_x(view, view.scene.pieces()[piece])) sheets_.push_back(sheet_of(piece));
  }
  std::vector<ExactVec3> breaks;
  std::vector<const RationalVec3*> lines{&source_nearness_};
  for (const Stripe& stripe : stripes_) {
    breaks.push_back(stripe.from);
    breaks.push_back(stripe.to);
    if (stripe.side != 0) lines.push_back(&stripe.nearness);
  }
  for (const Sheet& sheet : sheets_) {
    for (const ExactVec3& corner : sheet.corners) {
      if (is_between(first_, last_, corner)) breaks.push_back(corner);
    }
    for (const Sheet::Side& side : sheet.sides) lines.push_back(&side.nearness);
  }
  add_meetings(std::move(lines), breaks);
  return judge_all(
      std::move(breaks), [&](const ExactVec3& t) { return judge(t); }, extent);
}

// --- The source edge-on ---

// If x moves to the front, s = -u: a piece hides what lies behind it if it covers s above its own, that is, on the side
// of N, or on both sides. One on the other side does not.
std::optional<SightArc> SightPlane::judge_source(const ExactVec3& t) const {
  const RationalVec3 w = to_rational(t);
  const RationalVec3* hidden_from = nullptr;
  Rational u_hidden;
  SightArc arc;
  for (const Stripe& stripe : stripes_) {
    if (stripe.side < 0 || !is_between(stripe.from, stripe.to, t)) continue;
    const Rational u = dot(stripe.nearness, w);
    if (hidden_from == nullptr || u > u_hidden) {
      hidden_from = &stripe.nearness;
      u_hidden = u;
    }
  }
  std::vector<Strip> seen;
  for (const Sheet& sheet : source_sheets_) {
    const std::optional<Chord> chord = chord_of(sheet, t);
    if (!chord) continue;
    Strip strip{chord->near, chord->far, dot(*chord->near, w), dot(*chord->far, w)};
    if (hidden_from != nullptr && strip.u_near <= u_hidden) continue;
    if (hidden_from != nullptr && strip.u_far < u_hidden) {
      strip.u_far = u_hidden;
      strip.far = hidden_from;
    }
    seen.push_back(std::move(strip));
  }
  if (seen.empty()) return std::nullopt;
  // The length of their union, from the far end.
  std::ranges::sort(seen, [](const Strip& p, const Strip& q) { return p.u_far < q.u_far; });
  const RationalVec3* reached = seen.front().far;
  Rational u_reached = seen.front().u_far;
  for (const Strip& strip : seen) {
    if (strip.u_near <= u_reached) continue;
    const RationalVec3& from = strip.u_far > u_reached ? *strip.far : *reached;
    arc.gain_ahead = arc.gain_ahead + (*strip.near - from);
    reached = strip.near;
    u_reached = strip.u_near;
  }
  arc.is_kink = arc.edge_on = true;
  return arc;
}

std::vector<SightArc> SightPlane::arcs_of_source_edge_on() {
  const auto& [view, plane, request] = query_;
  const ExactVec3 n = view.normal().exact;
  last_ = cross(normal_, n);
  first_ = last_;
  negate(first_);
  EXACTFF_EXPECT(!kernel::is_zero(last_));
  stripes_.clear();
  source_sheets_.clear();
  for (OutlineId o = 0; o < profile_.outlines().outlines().size(); ++o) {
    if (std::optional<Stripe> stripe = stripe_of(o)) stripes_.push_back(std::move(*stripe));
  }
  for (Stripe& stripe : stripes_) find_nearness(stripe);
  for (const std::uint32_t piece : plane.pieces) source_sheets_.push_back(sheet_of(piece));
  std::vector<ExactVec3> breaks;
  std::vector<const RationalVec3*> lines;
  const auto add_break = [&](const ExactVec3& t) {
    if (sign(dot(n, t)) > 0) breaks.push_back(t);
  };
  for (const Stripe& stripe : stripes_) {
    add_break(stripe.from);
    add_break(stripe.to);
    lines.push_back(&stripe.nearness);
  }
  for (const Sheet& sheet : source_sheets_) {
    for (const ExactVec3& corner : sheet.corners) add_break(corner);
    for (const Sheet::Side& side : sheet.sides) lines.push_back(&side.nearness);
  }
  // The range is a half turn: directions in which lines meet are found for all of it, and the ends come last.
  const RationalVec3 normal = to_rational(normal_);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    for (std::size_t j = i + 1; j < lines.size(); ++j) {
      const RationalVec3 t = cross(normal, *lines[i] - *lines[j]);
      if (is_zero(t)) continue;
      ExactVec3 direction = direction_of(t);
      if (sign(dot(n, direction)) < 0) negate(direction);
      add_break(direction);
    }
  }
  if (breaks.empty()) return {};
  std::ranges::sort(breaks, [&](const ExactVec3& p, const ExactVec3& q) { return turn(p, q) > 0; });
  std::vector<SightArc> result =
      judge_all({first_, breaks.front()}, [&](const ExactVec3& t) { return judge_source(t); });
  const ExactVec3 end = breaks.back();
  for (auto* part : {&breaks}) {
    for (SightArc& arc : judge_all(*part, [&](const ExactVec3& t) { return judge_source(t); })) {
      result.push_back(std::move(arc));
    }
  }
  for (SightArc& arc : judge_all({end, last_}, [&](const ExactVec3& t) { return judge_source(t); })) {
    result.push_back(std::move(arc));
  }
  return result;
}

// --- Kinks ---

void KinkSearch::note(KinkReason reason, const Scene& scene, std::span<const std::uint32_t> pieces) {
  if (kink_) return;
  kink_.emplace(Kink{reason, {}});
  for (const std::uint32_t piece : pieces) kink_->faces.push_back(scene.pieces()[piece].face);
  std::ranges::sort(kink_->faces);
  kink_->faces.erase(std::unique(kink_->faces.begin(), kink_->faces.end()), kink_->faces.end());
}

void KinkSearch::find(const PlaneQuery& query, bool is_visible, Extent extent) {
  kink_.reset();
  planes_.clear();
  judged_.clear();
  const visibility::View& view = query.view;
  const visibility::SourcePlane& plane = query.plane;
  if (view.is_own(plane.pieces.front())) return;
  const int side = side_of(plane, view.x);
  if (side > 0) find_around_source(query, is_visible, extent);
  if (side == 0) find_edge_on(query);
}

// --- The source edge-on ---

namespace {

// Two vertices of a piece whose plane holds x, which x does not see in line.
std::pair<std::uint32_t, std::uint32_t> apart(const visibility::View& view, const Piece& piece) {
  const auto arrow = [&](std::uint32_t v) { return kernel::exact_difference(view.scene.vertices()[v], view.x).v; };
  for (int i = 0; i < 3; ++i) {
    const std::uint32_t p = piece.frame[i], q = piece.frame[(i + 1) % 3];
    if (!is_zero(cross(arrow(p), arrow(q)))) return {p, q};
  }
  EXACTFF_EXPECT(false);  // the three would lie on a line
  return {};
}

}  // namespace

void KinkSearch::find_edge_on(const PlaneQuery& query) {
  const visibility::View& view = query.view;
  const visibility::SourcePlane& plane = query.plane;
  const auto holds = [&](std::uint32_t piece) { return holds_x(view, view.scene.pieces()[piece]); };
  const bool on_source = std::ranges::any_of(plane.pieces, holds);
  const ExactVec3 n = view.normal().exact;
  if (is_zero(cross(plane.normal.exact, n))) {  // it is the horizon
    if (on_source && sign(dot(plane.normal.exact, n)) < 0) note(KinkReason::kOnFace, view.scene, plane.pieces);
    return;
  }
  if (on_source) return note(KinkReason::kOnFace, view.scene, plane.pieces);
  profile_.gather_around_plane(query);
  const Piece& piece = view.scene.pieces()[plane.pieces.front()];
  const auto [p, q] = apart(view, piece);
  Outlines& outlines = profile_.outlines();
  const CornerId a = outlines.corner_at(p), b = outlines.corner_at(q);
  const bool reversed = sign(dot(cross(outlines.exact(b), outlines.exact(a)), plane.normal.exact)) < 0;
  SightPlane sight(query, profile_, reversed ? outlines.line_through(b, a) : outlines.line_through(a, b));
  std::vector<SightArc> arcs = sight.arcs_of_source_edge_on();
  if (arcs.empty()) return;
  note(profile_.touching() ? KinkReason::kOnFace : KinkReason::kSourceEdgeOn, view.scene, plane.pieces);
  planes_.push_back({sight.normal(), std::move(arcs)});
}

// --- The source before x ---

void KinkSearch::find_around_source(const PlaneQuery& query, bool is_visible, Extent extent) {
  visibility::BoundaryRequest request = query.request;
  request.culling = ShaftCulling::kTree;
  const PlaneQuery closed{query.view, query.plane, request};
  if (proof_.excludes_kinks(closed)) return;
  profile_.gather(closed);
  if (profile_.source_count() == 0 || profile_.stays_hidden()) return;
  const std::optional<std::uint32_t>& touching = profile_.touching();
  if (!(touching && is_visible)) {
    find_open_edges();
    if (judge_sheets(closed, extent)) static_cast<void>(judge_groups(closed, extent));
    if (!(touching && kink_)) return;
  }
  kink_.reset();
  note(KinkReason::kOnFace, query.view.scene, std::span(&*touching, 1));
}

// 2. Edges without a piece on both sides, in the order of their numbers.
void KinkSearch::find_open_edges() {
  const Outlines& outlines = profile_.outlines();
  const auto edges = outlines.edges();
  sides_.assign(edges.size(), 0);
  table_.clear(std::max<std::size_t>(edges.size(), 1));
  const EdgeId first_occluder = profile_.source_count() < outlines.outlines().size()
                                    ? outlines.outline(static_cast<OutlineId>(profile_.source_count())).first
                                    : static_cast<EdgeId>(edges.size());
  groups_.clear();
  for (EdgeId id = 0; id < first_occluder; ++id) groups_.add(outlines, id);
  for (EdgeId id = first_occluder; id < edges.size(); ++id) {
    const EdgeId first = table_.add(id, edges);
    sides_[first] = static_cast<std::uint8_t>(sides_[first] | (edges[first].a == edges[id].a ? 1U : 2U));
  }
  for (EdgeId id = first_occluder; id < edges.size(); ++id) {
    if (sides_[id] == 1) groups_.add(outlines, id);
  }
}

// 3. and 4. False: stopped.
bool KinkSearch::judge_groups(const PlaneQuery& query, Extent extent) {
  Outlines& outlines = profile_.outlines();
  const kernel::Approx3 n{query.view.n.x, query.view.n.y, query.view.n.z};
  return groups_.for_each(outlines, [&](std::span<const EdgeId> group) {
    const Outlines::Edge edge = outlines.edge(group.front());
    const bool is_on_horizon = outlines.side_by_filter(n, edge.a) == 0 && outlines.side_by_filter(n, edge.b) == 0;
    if (!is_on_horizon && !are_on_one_line(outlines, group)) judge(query, edge, extent);
    return !(kink_ && extent == Extent::kFirst);
  });
}

bool KinkSearch::judge_sheets(const PlaneQuery& query, Extent extent) {
  Outlines& outlines = profile_.outlines();
  for (const std::uint32_t sheet : profile_.sheets()) {
    kernel::poll();
    const auto [p, q] = apart(query.view, query.view.scene.pieces()[sheet]);
    judge(query, outlines.line_through(outlines.corner_at(p), outlines.corner_at(q)), extent);
    if (kink_ && extent == Extent::kFirst) return false;
  }
  return true;
}

bool KinkSearch::is_judged(const ExactVec3& normal) const {
  return std::ranges::any_of(judged_, [&](const ExactVec3& other) { return is_zero(cross(normal, other)); });
}

void KinkSearch::judge(const PlaneQuery& query, const Outlines::Edge& edge, Extent extent) {
  SightPlane sight(query, profile_, edge);
  if (is_judged(sight.normal()) || is_zero(cross(sight.normal(), query.view.normal().exact))) return;
  judged_.push_back(sight.normal());
  std::vector<SightArc> arcs =
      sight.arcs(extent == Extent::kFirst ? SightPlane::Extent::kUpToKink : SightPlane::Extent::kAll);
  const auto kink = std::ranges::find_if(arcs, &SightArc::is_kink);
  if (kink == arcs.end()) return;
  note(kink->edge_on ? KinkReason::kEdgeOn : KinkReason::kCoincident, query.view.scene, kink->pieces);
  planes_.push_back({sight.normal(), std::move(arcs)});
}

}  // namespace exactff::gradient
