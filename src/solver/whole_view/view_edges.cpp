#include "whole_view/view_edges.h"

#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

#include "kernel/lanes.h"
#include "kernel/poll.h"
#include "scene/shaft_tree.h"

namespace exactff::whole_view {

using kernel::kUncertain;
using Edge = Outlines::Edge;
using Outline = Outlines::Outline;

void ViewEdges::find(const visibility::View& view, Wholes wholes) {
  start(view);
  gather(view, wholes);
  windows_.find(outlines_, depths_.all());
  trace_all();
  examine_rivals();
  for (std::size_t i = 0; i < piercings_.size(); ++i) trace_piercing(Piercing(piercings_[i]));
  work_.outlines = whole_.size();
  work_.windows = windows_.count();
  work_.pierced = piercings_.size();
}

// Window by window, so that outlines that follow one another mostly have the same neighbours, which are then in the
// caches.
void ViewEdges::trace_all() {
  traced_.assign(whole_.size(), 0);
  for (std::uint32_t window = 0; window < windows_.count(); ++window) {
    if (window % 64 == 0) kernel::poll();
    for (const Windows::SeenOutline& seen : windows_.seen_in(window)) {
      if (traced_[seen.outline] != 0) continue;
      traced_[seen.outline] = 1;
      trace_outline(seen.outline);
    }
  }
}

void ViewEdges::add_near(OutlineId outline) {
  if (seen_in_[outline] == run_) return;
  seen_in_[outline] = run_;
  near_.push_back(outline);
}

// The outlines of all windows that some of the edges may cross.
void ViewEdges::find_near(OutlineId outline, Lines lines) {
  ++run_;
  near_.clear();
  seen_in_[outline] = run_;
  for (const Windows::WindowPlace& place : windows_.windows_of(outline)) {
    if ((place.lines & lines) == 0) continue;
    const Windows::SeenOutline& own = windows_.seen_at(place);
    for (const Windows::SeenOutline& seen : windows_.seen_in(place.at)) {
      if (!seen.is_beside(own)) add_near(seen.outline);
    }
  }
  for (const Windows::WindowPlace& place : windows_.hidden_by(outline)) {
    if ((place.lines & lines) != 0) add_near(place.at);
  }
}

void ViewEdges::trace_outline(OutlineId id) {
  const Outline outline = outlines_.outline(id);
  Lines seen = 0;
  for (const Windows::WindowPlace& place : windows_.windows_of(id)) seen |= place.lines;
  if (seen == 0) return;
  if (outline.count > kRunCorners) note_rivals(id);
  const unsigned step = visibility::edges_of_run(outline.count);
  for (unsigned at = 0; at < outline.count; at += step) {
    Run run{.owner = id};
    run.first = outline.first + at;
    run.edges = std::min(step, outline.count - at);
    Lines lines = 0;
    for (unsigned k = 0; k < run.edges; ++k) {
      const Lines bit = Lines{1} << std::min(at + k, Windows::kLastLine);
      lines |= bit;
      if ((seen & bit) == 0) continue;
      const EdgeId partner = partner_[run.first + k];
      const bool skip = partner != kNoEdge &&
                        (outlines_.edge(partner).outline < id || whole_[outlines_.edge(partner).outline] == whole_[id]);
      (skip ? run.skipped : run.wanted) |= 1U << k;
    }
    if ((run.wanted | run.skipped) == 0) continue;
    find_near(id, lines);
    set_run(run);
    trace(run);
  }
}

void ViewEdges::set_run(Run& run) const {
  run.corners.set(outlines_, run.first, run.edges);
  const InverseDepth& depth = depths_.of(run.owner);
  run.w = run.corners.dot(depth.slope);
  run.w_error = depth.error * run.corners.size;
}

// All edges of the run, and again if an edge that was to be skipped has a third edge in its plane.
void ViewEdges::trace(Run& run) {
  for (bool again = true; again;) {
    const unsigned wanted = run.wanted;
    run.forced = 0;
    for (unsigned k = 0; k < run.edges; ++k) {
      hidden_[k].clear();
      backgrounds_[k].clear();
    }
    look_at_near(run);
    again = run.forced != 0;
    const unsigned left = run.wanted;
    run.wanted = wanted | run.forced;
    run.skipped &= ~run.forced;
    if (again) continue;
    for (unsigned k = 0; k < run.edges; ++k) {
      if ((left >> k & 1U) != 0) finish(run, k, {kBegin, kEnd});
    }
  }
}

namespace {

unsigned both_ends(unsigned corners) { return corners & (corners >> 1U | corners << 3U) & 15U; }
unsigned ends(unsigned corners) { return (corners | corners >> 1U | corners << 3U) & 15U; }

// What the lines of an outline tell of a run's corners, for cut_run().
struct SharedCorners {
  FourMask id;
  FourMask same{}, reversed{};  // corners of the outline; edges that one of its edges runs back along
  bool apart = false;           // a line has no corner of the run inside

  [[nodiscard]] EXACTFF_INLINE FourMask at(CornerId end) const { return id == kernel::lanes::four_whole(end); }
  EXACTFF_INLINE bool take_line(const FourMask& starts, const FourMask& back, const Four& height,
                                const FourMask& certain) {
    using kernel::lanes::all_lanes;
    same |= starts;
    reversed |= back;
    apart = apart || all_lanes(certain & (height <= 0.0));
    return !all_lanes(certain & (height < 0.0));
  }
};

}  // namespace

// Bit k of a set of edges stands for the edge from corner k to the next one.
EXACTFF_INLINE void ViewEdges::look_at(Run& run, OutlineId by) {
  using namespace kernel::lanes;
  Cuts cuts;
  SharedCorners shared{run.corners.id};
  ++work_.pairs;
  if (!cut_run(run.corners, outlines_, by, 0, shared, cuts)) return;
  const unsigned special = (cuts.unsure | cuts.coincident) & (run.wanted | run.skipped);
  if (shared.apart && special == 0) return;
  cuts.reversed = lane_bits(shared.reversed);
  cuts.same = lane_bits(shared.same);
  const InverseDepth& depth = depths_.of(by);
  const Four difference = run.corners.dot(depth.slope) - run.w;
  const Four error = depth.error * run.corners.size + run.w_error;
  cuts.nearer = lane_bits(difference > error) & ~cuts.same;
  cuts.further = lane_bits(difference < -error) & ~cuts.same;
  const bool clear = (cuts.nearer | cuts.same) == 15U || (cuts.further | cuts.same) == 15U;
  if (!shared.apart && (!clear || cuts.same == 15U) && outlines_.outline(run.owner).count <= kRunCorners) {
    rivals_.emplace_back(std::min(run.owner, by), std::max(run.owner, by));
  }
  for (unsigned bits = (cuts.covered | cuts.coincident | cuts.unsure) & (run.wanted | run.skipped); bits != 0;
       bits &= bits - 1) {
    resolve(run, static_cast<unsigned>(std::countr_zero(bits)), cuts);
  }
}

EXACTFF_CLONES void ViewEdges::look_at_near(Run& run) {
  for (const OutlineId by : near_) look_at(run, by);
}

bool ViewEdges::cover(const Run& run, unsigned k, const Cuts& cuts, Cover& result) {
  if ((cuts.coincident >> k & 1U) != 0) {
    const bool right = (cuts.reversed >> k & 1U) != 0;
    result = {.left = !right, .right = right, .coincides = true, .interval = {kBegin, kEnd}};
    return true;
  }
  if ((cuts.unsure >> k & 1U) != 0) {
    ++work_.undecided;
    return cover_exactly(run.first + k, cuts.by, result);
  }
  result = {.left = true, .right = true, .coincides = false, .interval = interval(cuts.intervals, k)};
  return true;
}

// True if the outline's plane may hold the edge, so that it may be nearer on one side of it only.
bool ViewEdges::may_hold(unsigned k, const Cuts& cuts) { return (ends(cuts.nearer | cuts.further) >> k & 1U) == 0; }

bool ViewEdges::holds(const Run& run, unsigned k, const Cuts& cuts) {
  if (!may_hold(k, cuts)) return false;
  const Edge edge = outlines_.edge(run.first + k);
  return depths_.compare(outlines_, cuts.by, run.owner, edge.a) == 0 &&
         depths_.compare(outlines_, cuts.by, run.owner, edge.b) == 0;
}

void ViewEdges::resolve(Run& run, unsigned k, const Cuts& cuts) {
  const unsigned bit = 1U << k;
  const EdgeId partner = partner_[run.first + k];
  const bool is_partner = partner != kNoEdge && outlines_.edge(partner).outline == cuts.by;
  const bool is_skipped = (run.skipped & bit) != 0;
  if (is_skipped && (cuts.covered & bit) != 0 && !may_hold(k, cuts)) return;
  if ((cuts.coincident & bit) != 0 && is_partner) return;  // known
  Cover found;
  if (!cover(run, k, cuts, found)) return;
  if (is_skipped) {
    if (!is_partner && (found.coincides || holds(run, k, cuts))) run.forced |= bit;
    return;
  }
  if (found.coincides && is_partner) return;
  if (found.left) {
    if ((both_ends(cuts.nearer | cuts.same) & bit) != 0 && (both_ends(cuts.same) & bit) == 0) {
      hide(run, k, found.interval);
      return;
    }
    if ((both_ends(cuts.further | cuts.same) & bit) == 0 || (both_ends(cuts.same) & bit) != 0) {
      hide_where_nearer(run, k, cuts.by, found.interval);
      if ((run.wanted & bit) == 0) return;
    }
  }
  if (!found.right || (partner != kNoEdge && !found.coincides && (cuts.covered & bit) != 0 &&
                       (both_ends(cuts.further | cuts.same) & bit) != 0 && (both_ends(cuts.same) & bit) == 0)) {
    return;  // behind the partner
  }
  backgrounds_[k].push_back({cuts.by, !found.left, found.interval});
}

void ViewEdges::hide(Run& run, unsigned k, const Interval& interval) {
  if (interval.begin.line == Parameter::kAtBegin && interval.end.line == Parameter::kAtEnd) {
    run.wanted &= ~(1U << k);
  } else {
    hidden_[k].push_back(interval);
  }
}

void ViewEdges::hide_where_nearer(Run& run, unsigned k, OutlineId by, const Interval& interval) {
  const EdgeId edge = run.first + k;
  const Order along = order(by, run.owner, edge, run.owner, Side::kLeft);
  if (along.at_a > 0 && along.at_b > 0) return hide(run, k, interval);
  if (along.at_a < 0 && along.at_b < 0) return;
  const Parameter crossing = crossing_of(edge, line_between(by, run.owner));
  Interval nearer = interval;
  if (along.at_a > 0) {
    if (compare(edge, crossing, nearer.end) < 0) nearer.end = crossing;
  } else {
    if (compare(edge, crossing, nearer.begin) > 0) nearer.begin = crossing;
  }
  if (compare(edge, nearer.begin, nearer.end) < 0) hide(run, k, nearer);
}

// What is left of the allowed interval between the hidden ones.
void ViewEdges::finish(const Run& run, unsigned k, const Interval& allowed) {
  const EdgeId edge = run.first + k;
  std::vector<Interval>& hidden = hidden_[k];
  if (hidden.size() > 1) sort(edge, hidden);
  for_each_rest(edge, allowed, hidden, [&](const Interval& rest) { find_right(run, k, rest); });
}

// The nearest background of each part of a visible interval.
void ViewEdges::find_right(const Run& run, unsigned k, const Interval& visible) {
  const EdgeId edge = run.first + k;
  Background first{kNothing, false, visible};
  if (partner_[edge] != kNoEdge) {
    first.outline = outlines_.edge(partner_[edge]).outline;
    first.coincides = true;
  }
  if (backgrounds_[k].empty()) return keep(run, edge, first);
  if (backgrounds_[k].size() == 1 && first.outline == kNothing) {
    return keep_around(run, edge, visible, backgrounds_[k].front());
  }
  envelope_.assign(1, first);
  for (const Background& background : backgrounds_[k]) put_in(run, edge, background);
  std::size_t last = 0;
  for (std::size_t i = 1; i < envelope_.size(); ++i) {
    if (envelope_[i].outline == envelope_[last].outline && envelope_[i].coincides == envelope_[last].coincides) {
      envelope_[last].interval.end = envelope_[i].interval.end;
    } else {
      envelope_[++last] = envelope_[i];
    }
  }
  envelope_.resize(last + 1);
  for (const Background& right : envelope_) keep(run, edge, right);
}

// The only background, and nothing before and after it.
void ViewEdges::keep_around(const Run& run, EdgeId edge, const Interval& visible, const Background& only) {
  const Interval both = common(edge, visible, only.interval);
  if (is_empty(edge, both)) return keep(run, edge, {kNothing, false, visible});
  const Interval before{visible.begin, both.begin}, after{both.end, visible.end};
  if (!is_empty(edge, before)) keep(run, edge, {kNothing, false, before});
  keep(run, edge, {only.outline, only.coincides, both});
  if (!is_empty(edge, after)) keep(run, edge, {kNothing, false, after});
}

// Puts a background in where it is nearer than those found so far.
void ViewEdges::put_in(const Run& run, EdgeId edge, const Background& background) {
  next_envelope_.clear();
  const auto add = [&](const Background& of, const Parameter& begin, const Parameter& end) {
    if (compare(edge, begin, end) < 0) next_envelope_.push_back({of.outline, of.coincides, {begin, end}});
  };
  for (const Background& known : envelope_) {
    const auto [begin, end] = known.interval;
    const Interval both = common(edge, known.interval, background.interval);
    const auto& [from, to] = both;
    if (is_empty(edge, both)) {
      next_envelope_.push_back(known);
      continue;
    }
    add(known, begin, from);
    const Order nearer = known.outline == kNothing
                             ? Order{1, 1}
                             : order(background.outline, known.outline, edge, run.owner, Side::kRight);
    if (nearer.at_a == nearer.at_b) {
      add(nearer.at_a > 0 ? background : known, from, to);
    } else {
      const Parameter crossing = crossing_of(edge, line_between(background.outline, known.outline));
      const Parameter middle = compare(edge, crossing, from) <= 0 ? from
                               : compare(edge, crossing, to) >= 0 ? to
                                                                  : crossing;
      add(nearer.at_a > 0 ? background : known, from, middle);
      add(nearer.at_a > 0 ? known : background, middle, to);
    }
    add(known, to, end);
  }
  envelope_.swap(next_envelope_);
}

void ViewEdges::keep(const Run& run, EdgeId edge, const Background& right) {
  if (run.other != kNothing && right.outline != run.other) return;  // not where this pair is seen
  if (right.coincides && right.outline < run.owner) return;         // its own edge counts
  const bool on_horizon = right.outline == kNothing && run.other == kNothing &&
                          horizon_side_[outlines_.edge(edge).a] == 0 && horizon_side_[outlines_.edge(edge).b] == 0;
  parts_.push_back({edge, right.interval.begin, right.interval.end});
  sides_.push_back({run.owner, right.outline, on_horizon});
}

// --- Gather ---

// Step 1 of view_edges.h.

namespace {

constexpr std::uint32_t kAllBacks = 0xFFFFFFFEU;

// A length of the order of most distances from x.
double usual_distance(const visibility::View& view) {
  constexpr std::size_t kMost = 33;
  const auto vertices = view.scene.vertices();
  std::array<double, kMost> found{};
  std::size_t count = 0;
  const std::size_t step = vertices.size() / kMost + 1;
  for (std::size_t v = 0; v < vertices.size() && count < kMost; v += step) {
    const kernel::Approx3 d = kernel::approx_difference(vertices[v], view.x);
    const double distance = kernel::max_norm(d);
    if (distance > 0.0 && std::isfinite(distance)) found[count++] = distance;
  }
  if (count == 0) return 1.0;
  std::nth_element(found.begin(), found.begin() + count / 2, found.begin() + count);
  return found[count / 2];
}

std::uint32_t whole_of(const Scene& scene, std::uint32_t piece, ViewEdges::Wholes wholes) {
  const FaceId id = scene.pieces()[piece].face;
  const Face& face = scene.face(id);
  if (wholes == ViewEdges::Wholes::kPatches) return static_cast<std::uint32_t>(index_of(face.patch));
  if (wholes == ViewEdges::Wholes::kPlanes && face.shape == FaceShape::kTriangulated) {
    return static_cast<std::uint32_t>(scene.faces().size()) + piece;
  }
  return static_cast<std::uint32_t>(index_of(id));
}

}  // namespace

void ViewEdges::start(const visibility::View& view) {
  scene_ = &view.scene;
  contacts_ = &contacts(view.scene);
  outlines_.start(view.scene, view.x, usual_distance(view));
  outlines_.set_horizon(view.n);
  depths_.start(view.scene, view.x, outlines_.scale_exponent());
  whole_.clear();
  front_.clear();
  horizon_side_.clear();
  crossings_.clear();
  lines_.clear();
  rivals_.clear();
  stacks_.clear();
  piercings_.clear();
  parts_.clear();
  sides_.clear();
  run_ = 0;
  work_ = {};
}

void ViewEdges::gather(const visibility::View& view, Wholes wholes) {
  seen_in_.clear();
  if (view.is_buried) return;
  const std::span<const Piece> pieces = view.scene.pieces();
  kernel::Steps steps("faces", pieces.size());
  // In the order of the tree, so that neighbours in space are neighbours in memory.
  shaft_tree(view.scene).query(view.x, {}, [&](std::uint32_t index) {
    const Piece& piece = pieces[index];
    steps.take();
    if (piece.transparent || view.is_own(index)) return true;
    const int facing = visibility::facing_of(view, piece);
    if (facing == 0) return true;
    const bool back_apart = wholes == Wholes::kFaces || wholes == Wholes::kPlanes;
    add(view, piece, facing > 0 && !back_apart ? kAllBacks : whole_of(view.scene, index, wholes), facing);
    return true;
  });
  find_partners();
  seen_in_.assign(whole_.size(), 0);
}

void ViewEdges::classify_new_corners(const visibility::View& view) {
  while (horizon_side_.size() < outlines_.corner_count()) {
    const auto corner = static_cast<CornerId>(horizon_side_.size());
    int side = outlines_.side_by_filter({view.n.x, view.n.y, view.n.z}, corner);
    if (side == kUncertain) {
      side = kernel::exact_sign_of_dot(view.n, {view.x, outlines_.position(*outlines_.vertex(corner))});
    }
    horizon_side_.push_back(static_cast<std::int8_t>(side));
  }
}

void ViewEdges::add(const visibility::View& view, const Piece& piece, std::uint32_t whole, int facing) {
  outlines_.corners_of(view.scene.corners(piece), corners_);
  classify_new_corners(view);
  bool above = false, below = false;
  for (const CornerId corner : corners_) {
    above = above || horizon_side_[corner] > 0;
    below = below || horizon_side_[corner] < 0;
  }
  if (!above) return;
  if (below) clip();
  if (facing > 0) std::reverse(corners_.begin(), corners_.end());
  static_cast<void>(outlines_.add(corners_, !below));
  depths_.add(piece);
  whole_.push_back(whole);
  front_.push_back(static_cast<std::uint8_t>(facing < 0));
}

// Leaves the part of the ring above the horizon. Pieces that share an edge share its crossing.
void ViewEdges::clip() {
  ring_.clear();
  for (std::size_t c = 0; c < corners_.size(); ++c) {
    const CornerId a = corners_[c], b = corners_[c + 1 < corners_.size() ? c + 1 : 0];
    if (horizon_side_[a] >= 0) ring_.push_back(a);
    if (horizon_side_[a] * horizon_side_[b] >= 0) continue;
    std::uint32_t& crossing = crossings_(a, b);
    if (crossing == PairTable::kNone) {
      crossing = outlines_.add_crossing(Outlines::Plane::kHorizon, *outlines_.vertex(a), *outlines_.vertex(b));
      horizon_side_.push_back(0);
    }
    ring_.push_back(crossing);
  }
  corners_.swap(ring_);
}

// Edges between the same two corners have one line, that of the first. Partners are two such edges that run opposite
// ways, if there is no third.
void ViewEdges::find_partners() {
  const auto edges = outlines_.edges();
  line_.resize(edges.size());
  std::iota(line_.begin(), line_.end(), EdgeId{0});
  partner_.assign(edges.size(), kNoEdge);
  shared_.assign(edges.size(), 0);
  exact_.clear(edges.size());
  table_.clear(std::max<std::size_t>(edges.size(), 1));
  for (EdgeId id = 0; id < edges.size(); ++id) {
    const EdgeId first = table_.add(id, edges);
    if (first == id) continue;
    line_[id] = first;
    const bool is_second = shared_[first] == 0;
    shared_[first] = 1;
    if (is_second && edges[first].a != edges[id].a) {
      partner_[first] = id;
      partner_[id] = first;
    } else if (partner_[first] != kNoEdge) {
      partner_[partner_[first]] = kNoEdge;
      partner_[first] = kNoEdge;
    }
  }
}

}  // namespace exactff::whole_view
