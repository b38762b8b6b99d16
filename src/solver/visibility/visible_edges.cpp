#include "visibility/visible_edges.h"

#include <limits>
#include <numeric>

#include "kernel/lanes.h"
#include "kernel/poll.h"

namespace exactff::visibility {

using kernel::dot;
using Edge = Outlines::Edge;
using Outline = Outlines::Outline;

// --- Cover choice ---

namespace {

constexpr std::size_t kFewest = 8, kMost = 128;
constexpr std::size_t kLargestPerChosen = 4;  // this many times as many occluders are looked at as may be chosen
constexpr double kInwards = 0x1p-6;           // from a corner or an edge to the middle

constexpr double kLeastCosine = 0x1p-8;  // the cosine, more or less, of the angle to the plane across the view
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Approx3 sum_of(const Approx3& a, const Approx3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }

Approx3 between(const Approx3& a, const Approx3& b, double share_of_b) {
  const double s = 1.0 - share_of_b;
  return {s * a.x + share_of_b * b.x, s * a.y + share_of_b * b.y, s * a.z + share_of_b * b.z};
}

}  // namespace

std::size_t CoverChoice::most_of(std::size_t occluders) {
  return std::clamp(static_cast<std::size_t>(std::sqrt(static_cast<double>(occluders))), kFewest, kMost);
}

bool CoverChoice::start(const Outlines& outlines, std::size_t source_count) {
  chosen_.clear();
  most_ = most_of(outlines.outlines().size() - source_count);
  find_points(outlines, source_count);
  if (!corners_seem_hidden(outlines, source_count) || !find_largest(outlines, source_count)) return false;
  const auto hidden = [&](const Approx3& point) {
    return std::ranges::any_of(chosen_, [&](OutlineId o) { return seems_hidden(outlines, o, point); });
  };
  const auto hidden_by_one_more = [&](const Approx3& point) { return hidden(point) || add_for(outlines, point); };
  return std::ranges::all_of(points_, hidden_by_one_more) && std::ranges::all_of(corners_, hidden_by_one_more);
}

// Of each piece: a point near every corner, one near the middle of every edge, and its middle.
void CoverChoice::find_points(const Outlines& outlines, std::size_t source_count) {
  corners_.clear();
  points_.clear();
  across_view_ = {};
  for (OutlineId s = 0; s < source_count; ++s) {
    const Outline& outline = outlines.outline(s);
    const auto corner = [&](std::uint32_t k) -> const Approx3& {
      return outlines.corner(outlines.edge(outline.first + k % outline.count).a).t;
    };
    Approx3 sum;
    for (std::uint32_t k = 0; k < outline.count; ++k) sum = sum_of(sum, corner(k));
    const Approx3 middle = between({}, sum, 1.0 / outline.count);
    points_.push_back(middle);
    for (std::uint32_t k = 0; k < outline.count; ++k) {
      corners_.push_back(between(corner(k), middle, kInwards));
      points_.push_back(between(between(corner(k), corner(k + 1), 0.5), middle, kInwards));
    }
    across_view_ = sum_of(across_view_, middle);
  }
}

// Occluders inside the source hide none of its corners. Where something is visible, this is mostly the end.
bool CoverChoice::corners_seem_hidden(const Outlines& outlines, std::size_t source_count) {
  across_.clear();
  for (auto o = static_cast<OutlineId>(source_count); o < outlines.outlines().size(); ++o) {
    if (!outlines.outline(o).inside_source) across_.push_back(o);
  }
  return std::ranges::all_of(corners_, [&](const Approx3& corner) {
    return std::ranges::any_of(across_, [&](OutlineId o) { return seems_hidden(outlines, o, corner); });
  });
}

// Corners are shared by neighbours: one division for each.
void CoverChoice::find_depths(const Outlines& outlines) {
  const Vec3 view = kernel::to_vec3(across_view_);
  inverse_depths_.resize(outlines.corner_count());
  for (CornerId corner = 0; corner < inverse_depths_.size(); ++corner) {
    const Outlines::Corner& c = outlines.corner(corner);
    const double along = dot(view, c.t);
    inverse_depths_[corner] = along >= kLeastCosine * c.size ? 1.0 / along : kInfinity;
  }
}

// In the plane with the normal across_view_, where the normal's product with every point is 1. Infinite or NaN where a
// corner is not ahead.
double CoverChoice::size(const Outlines& outlines, OutlineId id) const {
  const Outline& outline = outlines.outline(id);
  const auto edges = outlines.edges().subspan(outline.first, outline.count);
  const Approx3& a = outlines.corner(edges.front().a).t;
  double doubled = 0.0;
  double last = inverse_depths_[edges[1].a];
  for (const Outlines::Edge& edge : edges.subspan(1, edges.size() - 2)) {
    const double next = inverse_depths_[edge.b];
    doubled += dot(edge.normal, a) * last * next;
    last = next;
  }
  return std::abs(doubled) * inverse_depths_[edges.front().a];
}

bool CoverChoice::find_largest(const Outlines& outlines, std::size_t source_count) {
  find_depths(outlines);
  double whole = 0.0;
  for (OutlineId s = 0; s < source_count; ++s) whole += size(outlines, s);
  if (!(whole > 0.0 && whole < kInfinity)) return false;
  largest_.clear();
  float most = 0.0F;
  for (auto o = static_cast<OutlineId>(source_count); o < outlines.outlines().size(); ++o) {
    const double shadow = size(outlines, o);
    largest_.emplace_back(shadow < whole ? static_cast<float>(shadow / whole) : 1.0F, o);
    most = std::max(most, largest_.back().first);
  }
  if (most * static_cast<float>(most_) < 1.0F) return false;
  const auto larger = [](const Shadow& a, const Shadow& b) { return a > b; };
  const std::size_t kept = std::min(kLargestPerChosen * most_, largest_.size());
  std::ranges::nth_element(largest_, largest_.begin() + static_cast<std::ptrdiff_t>(kept), larger);
  largest_.resize(kept);
  std::ranges::sort(largest_, larger);
  float sum = 0.0F;
  for (std::size_t i = 0; i < std::min(most_, kept); ++i) sum += largest_[i].first;
  return sum >= 1.0F;
}

void CoverChoice::take_all(const Outlines& outlines, std::size_t source_count) {
  chosen_.clear();
  largest_.clear();
  for (auto o = static_cast<OutlineId>(source_count); o < outlines.outlines().size(); ++o) chosen_.push_back(o);
  most_ = chosen_.size();
}

bool CoverChoice::add_for(const Outlines& outlines, const Approx3& direction) {
  if (chosen_.size() == most_) return false;
  const auto hides = [&](OutlineId o) { return seems_hidden(outlines, o, direction); };
  if (std::ranges::any_of(chosen_, hides)) return false;
  const auto found = std::ranges::find_if(largest_, hides, &Shadow::second);
  if (found == largest_.end()) return false;
  chosen_.push_back(found->second);
  return true;
}

bool CoverChoice::seems_hidden(const Outlines& outlines, OutlineId by, const Approx3& direction) {
  return std::ranges::all_of(outlines.edges_of(outlines.outline(by)),
                             [&](const Edge& edge) { return dot(edge.normal, direction) > 0.0; });
}

// --- Visible edges ---

namespace {

// Pairs per edge. At about 8 ns each, they take as long as the Booleans take for an edge.
constexpr std::uint64_t kMostUnsortedPairs = 6'000;

// Between two polls: less than a millisecond by the filter, some milliseconds in exact arithmetic.
constexpr std::uint64_t kPairsPerPoll = 8'192;

// Counts four bits. std::popcount is a function call where the processor may lack the instruction.
std::uint64_t bit_count(unsigned bits) { return (0x4332322132212110U >> (4 * bits)) & 0xFU; }

}  // namespace

void VisibleEdges::start() {
  const std::size_t edges = outlines_.edges().size();
  parts_.clear();
  pairs_ = undecided_pairs_ = next_poll_ = 0;
  exact_.clear(edges);
  dropped_.assign(edges, 0);
  line_.resize(edges);
  std::iota(line_.begin(), line_.end(), EdgeId{0});
}

bool VisibleEdges::find(std::size_t source_count) {
  start();
  by_cover_ = false;
  // a. Silhouettes.
  drop_inner_edges(source_count);
  // b. The grid.
  kernel::poll();
  grid_.build(outlines_, source_count, dropped_);
  if (grid_.unsorted_pairs(outlines_) > kMostUnsortedPairs * outlines_.edges().size()) return false;
  // c. and d. Edge by edge.
  for (const OutlineId o : grid_.in_order(outlines_.outlines().size())) trace_outline(o, source_count);
  return true;
}

bool VisibleEdges::find_cover(std::size_t source_count) {
  parts_.clear();
  return choice_.start(outlines_, source_count) && cover_hides_all(source_count);
}

bool VisibleEdges::all_cover(std::size_t source_count) {
  choice_.take_all(outlines_, source_count);
  return cover_hides_all(source_count);
}

// The boundary of what the cover leaves visible is empty, and so that is, too: it is not the whole sphere.
bool VisibleEdges::cover_hides_all(std::size_t source_count) {
  start();
  by_cover_ = true;
  for (OutlineId s = 0; s < source_count; ++s) {
    if (!hide(s, source_count)) return false;
  }
  for (std::size_t i = 0; i < choice_.chosen().size(); ++i) {
    if (!hide(choice_.chosen()[i], source_count)) return false;
  }
  return true;
}

// Adds to the cover until no edge of the outline is visible; false if that fails.
bool VisibleEdges::hide(OutlineId id, std::size_t source_count) {
  const auto length = [](const Part& part) { return std::abs(part.end.value - part.begin.value); };
  for (trace_outline(id, source_count); !parts_.empty(); trace_outline(id, source_count)) {
    const Part longest = *std::ranges::max_element(parts_, {}, length);
    parts_.clear();
    if (!choice_.add_for(outlines_, direction_in_view(longest, id < source_count))) return false;
  }
  return true;
}

// An estimate: beside the middle of the part, on the side that seems visible.
Approx3 VisibleEdges::direction_in_view(const Part& part, bool of_source) const {
  constexpr double kAside = 0x1p-20;
  const Edge& edge = outlines_.edge(part.edge);
  const Outlines::Corner &a = outlines_.corner(edge.a), &b = outlines_.corner(edge.b);
  const double m = 0.5 * (part.begin.value + part.end.value), l = 1.0 - m;
  const Vec3& n = edge.normal;
  const double step =
      (of_source ? kAside : -kAside) * (a.size + b.size) / (std::abs(n.x) + std::abs(n.y) + std::abs(n.z));
  return {l * a.t.x + m * b.t.x + step * n.x, l * a.t.y + m * b.t.y + step * n.y, l * a.t.z + m * b.t.z + step * n.z};
}

// Of edges with the same two corners the first is kept, and only if none runs the other way. It represents the
// line of all of them, so that no arithmetic is needed to see that crossings with it are equal.
void VisibleEdges::drop_inner_edges(std::size_t source_count) {
  const auto edges = outlines_.edges();
  if (!outlines_.has_shared_corners()) return;
  table_.clear(edges.size());
  for (OutlineId o = static_cast<OutlineId>(source_count); o < outlines_.outlines().size(); ++o) {
    const Outline& outline = outlines_.outline(o);
    if (!outline.whole) continue;
    for (EdgeId id = outline.first; id < outline.first + outline.count; ++id) {
      const EdgeId first = table_.add(id, edges);
      if (first == id) continue;
      dropped_[id] = 1;
      if (edges[first].a != edges[id].a) dropped_[first] = 1;  // it runs the other way
      line_[id] = first;
    }
  }
}

EXACTFF_INLINE void VisibleEdges::trace(Run& run, std::size_t source_count) {
  // c. The intervals that outlines cover.
  find_allowed(run, source_count);
  if (run.wanted == 0) return;
  near_ = by_cover_ ? choice_.chosen() : grid_.find_near(outlines_, run.first, run.wanted);
  find_removed(run, source_count);
  // d. Sweep over them.
  for (unsigned k = 0; k < run.edges; ++k) {
    if ((run.wanted >> k & 1U) == 0) continue;
    const EdgeId id = run.first + k;
    if (removed_[k].size() > 1) sort(id, removed_[k]);
    for_each_rest(id, interval(run.left, k), removed_[k], [&](const Interval& rest) {
      parts_.push_back(run.of_source ? Part{id, rest.begin, rest.end} : Part{id, rest.end, rest.begin});
    });
  }
}

void VisibleEdges::poll() {
  next_poll_ = pairs_ + kPairsPerPoll;
  kernel::poll();
}

// Run by run.
EXACTFF_CLONES void VisibleEdges::trace_outline(OutlineId id, std::size_t source_count) {
  const Outline& outline = outlines_.outline(id);
  const unsigned step = edges_of_run(outline.count);
  Run run{.outline = id, .of_source = id < source_count};
  for (unsigned at = 0; at < outline.count; at += step) {
    run.first = outline.first + at;
    run.edges = std::min(step, outline.count - at);
    run.wanted = 0;
    for (unsigned k = 0; k < run.edges; ++k) run.wanted |= (dropped_[run.first + k] == 0 ? 1U : 0U) << k;
    if (run.wanted == 0) continue;
    run.corners.set(outlines_, run.first, run.edges);
    trace(run, source_count);
    if (pairs_ >= next_poll_) poll();
  }
}

EXACTFF_INLINE void VisibleEdges::cut(const Run& run, OutlineId outline, LaneCuts& cuts, Outlines::LineBits skipped) {
  UnknownCorners shared;
  static_cast<void>(cut_run(run.corners, outlines_, outline, skipped, shared, cuts));
  pairs_ += bit_count(run.wanted);
  undecided_pairs_ += bit_count(cuts.unsure & run.wanted);
}

void VisibleEdges::set(LaneParameters& parameters, unsigned k, const Parameter& parameter) {
  parameters.value[k] = parameter.value;
  parameters.error[k] = parameter.error;
  parameters.line[k] = parameter.line;
}

// The whole edge if it belongs to the source or lies inside it; otherwise the part with the source on both sides.
EXACTFF_INLINE void VisibleEdges::find_allowed(Run& run, std::size_t source_count) {
  for (unsigned k = 0; k < run.edges; ++k) removed_[k].clear();
  run.left = whole_edges();
  if (run.of_source || outlines_.outline(run.outline).inside_source) return;
  if (source_count > 1) {
    find_allowed_in_union(run, source_count);
    return;
  }
  LaneCuts cuts;
  cut(run, 0, cuts, outlines_.outline(run.outline).within_lines);
  run.left = cuts.intervals;
  for (unsigned bits = cuts.unsure & run.wanted; bits != 0; bits &= bits - 1) {
    const auto k = static_cast<unsigned>(std::countr_zero(bits));
    Cover found;
    if (!cover_exactly(run.first + k, 0, found) || !found.left || !found.right) continue;
    set(run.left.begin, k, found.interval.begin);
    set(run.left.end, k, found.interval.end);
    cuts.covered |= 1U << k;
  }
  run.wanted &= cuts.covered;
}

EXACTFF_CLONES void VisibleEdges::find_allowed_in_union(Run& run, std::size_t source_count) {
  for (unsigned k = 0; k < run.edges; ++k) {
    left_[k].clear();
    right_[k].clear();
  }
  LaneCuts cuts;
  Cover found;
  for (OutlineId s = 0; s < source_count; ++s) {
    cut(run, s, cuts);
    for (unsigned k = 0; k < run.edges; ++k) {
      if ((run.wanted >> k & 1U) == 0 || !cover(run, k, cuts, found)) continue;
      if (found.left) left_[k].push_back(found.interval);
      if (found.right) right_[k].push_back(found.interval);
    }
  }
  for (unsigned k = 0; k < run.edges; ++k) {
    if ((run.wanted >> k & 1U) != 0) allow_common(run, k);
  }
}

// The parts with the source on the left and on the right. The intervals between such parts count as removed.
void VisibleEdges::allow_common(Run& run, unsigned k) {
  const EdgeId edge = run.first + k;
  merge(edge, left_[k]);
  merge(edge, right_[k]);
  bool some = false;
  for (const Interval& a : left_[k]) {
    for (const Interval& b : right_[k]) {
      const Interval both = common(edge, a, b);
      if (is_empty(edge, both)) continue;
      if (some) {
        removed_[k].push_back({parameter(run.left.end, k), both.begin});
      } else {
        set(run.left.begin, k, both.begin);
      }
      set(run.left.end, k, both.end);
      some = true;
    }
  }
  if (!some) run.wanted &= ~(1U << k);
}

// Removes from each edge the part that the outline covers on the side that must not be covered, or where the outline
// coincides with it and comes first. Edges with nothing left are no longer wanted.
EXACTFF_INLINE void VisibleEdges::remove(Run& run, const LaneCuts& cuts, bool same_kind) {
  const bool left_matters = run.of_source && !same_kind;
  Cover found;
  const unsigned unclear = take_off_by_filter(run, cuts) | cuts.unsure;
  for (unsigned bits = unclear & run.wanted; bits != 0; bits &= bits - 1) {
    const auto k = static_cast<unsigned>(std::countr_zero(bits));
    if (!cover(run, k, cuts, found)) continue;
    const bool double_of_earlier = same_kind && found.coincides && found.left && cuts.by < run.outline;
    if ((left_matters ? found.left : found.right) || double_of_earlier) take_off(run, k, found.interval);
  }
}

// Occluders are processed a few at a time, so that the processor can work on the next cut while it resolves the
// previous one.
EXACTFF_INLINE void VisibleEdges::find_removed(Run& run, std::size_t source_count) {
  LaneCuts cuts;
  for (OutlineId s = 0; run.of_source && s < source_count && run.wanted != 0; ++s) {
    if (s == run.outline) continue;
    cut(run, s, cuts);
    remove(run, cuts, true);
  }
  const bool skips_inner = run.of_source && source_count == 1;  // outlines inside the source meet none of its edges
  for (std::span<const OutlineId> rest = near_; !rest.empty() && run.wanted != 0;) {
    const std::size_t taken = std::min(kBatch, rest.size());
    std::size_t count = 0;
    for (const OutlineId o : rest.first(taken)) {
      if (o == run.outline || (skips_inner && outlines_.outline(o).inside_source)) continue;
      cut(run, o, batch_[count]);
      count += ((batch_[count].covered | batch_[count].unsure) & run.wanted) != 0 ? 1U : 0U;
    }
    for (std::size_t i = 0; i < count && run.wanted != 0; ++i) remove(run, batch_[i], !run.of_source);
    rest = rest.subspan(taken);
  }
}

// Does for all covered edges what take_off does for one. Returns the edges for which the filter cannot decide, such as
// where crossings coincide. An edge's own ends have difference 0 and error 0.
//
// Begins and ends: by how much the removed interval starts and stops after the remaining one. At begin and at end: how
// far the removed interval extends over each end of the remaining one.
EXACTFF_INLINE unsigned VisibleEdges::take_off_by_filter(Run& run, const LaneCuts& cuts) {
  using namespace kernel::lanes;
  const auto& [begin, end] = run.left;
  const auto& [off_begin, off_end] = cuts.intervals;
  const Four begins = off_begin.value - begin.value, begins_error = off_begin.error + begin.error;
  const Four ends = off_end.value - end.value, ends_error = off_end.error + end.error;
  const Four at_begin = off_end.value - begin.value, at_begin_error = off_end.error + begin.error;
  const Four at_end = end.value - off_begin.value, at_end_error = end.error + off_begin.error;
  const FourMask from_begin = -begins >= begins_error, after_begin = begins > begins_error;
  const FourMask to_end = ends >= ends_error, before_end = -ends > ends_error;
  const FourMask apart = (-at_begin >= at_begin_error) | (-at_end >= at_end_error);
  const FourMask meets_begin = from_begin & before_end & (at_begin > at_begin_error);
  const FourMask meets_end = to_end & after_begin & (at_end > at_end_error);
  const FourMask all = from_begin & to_end, within = after_begin & before_end;
  const unsigned sure = lane_bits(apart | meets_begin | meets_end | all | within);
  const FourMask covered = (four_whole(cuts.covered) & FourMask{1, 2, 4, 8}) != 0;
  replace(run.left.begin, covered & meets_begin, off_end);
  replace(run.left.end, covered & meets_end, off_begin);
  run.wanted &= ~(cuts.covered & lane_bits(all));
  for (unsigned bits = cuts.covered & lane_bits(within) & run.wanted; bits != 0; bits &= bits - 1) {
    const auto k = static_cast<unsigned>(std::countr_zero(bits));
    removed_[k].push_back(interval(cuts.intervals, k));
  }
  return cuts.covered & ~sure;
}

// Removes an interval from an end of the remaining one, or keeps it for the sweep if it lies within.
void VisibleEdges::take_off(Run& run, unsigned k, const Interval& off) {
  const EdgeId edge = run.first + k;
  const auto [begin, end] = interval(run.left, k);
  const bool from_begin = compare(edge, off.begin, begin) <= 0, to_end = compare(edge, off.end, end) >= 0;
  if (from_begin && compare(edge, off.end, begin) <= 0) return;
  if (to_end && compare(edge, off.begin, end) >= 0) return;
  if (from_begin && to_end) {
    run.wanted &= ~(1U << k);
  } else if (from_begin) {
    set(run.left.begin, k, off.end);
  } else if (to_end) {
    set(run.left.end, k, off.begin);
  } else {
    removed_[k].push_back(off);
  }
}

bool VisibleEdges::cover(const Run& run, unsigned k, const LaneCuts& cuts, Cover& result) {
  if ((cuts.unsure >> k & 1U) != 0) return cover_exactly(run.first + k, cuts.by, result);
  if ((cuts.covered >> k & 1U) == 0) return false;
  result = {.left = true, .right = true, .coincides = false, .interval = interval(cuts.intervals, k)};
  return true;
}

// The union, as disjoint intervals in order.
void VisibleEdges::merge(EdgeId edge, std::vector<Interval>& intervals) {
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

}  // namespace exactff::visibility
