#include "visibility/silhouette_walk.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kernel/expect.h"
#include "kernel/poll.h"

namespace exactff::visibility {

using Edge = Outlines::Edge;
using kernel::Approx3;

namespace {

constexpr std::uint64_t kMeetingsPerPoll = 8'192;

// The items of a sorted list with this key.
template <class Item, class Key, class KeyOf>
std::span<Item> with_key(std::vector<Item>& sorted, Key key, KeyOf key_of) {
  const auto first = std::ranges::lower_bound(sorted, key, {}, key_of);
  return {first, std::ranges::upper_bound(first, sorted.end(), key, {}, key_of)};
}

double dot(const Approx3& a, const Approx3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

}  // namespace

bool SilhouetteWalk::find(const PlaneQuery& query, PlaneRecord& record) {
  query_ = &query;
  parts_.clear();
  some_hidden_ = false;
  pairs_ = undecided_pairs_ = next_poll_ = 0;
  source_ = PieceClip(query, outlines_, memory_.clip).add_source();
  source_edges_ = static_cast<EdgeId>(outlines_.edges().size());
  silhouettes_.emplace(query, outlines_, memory_);
  silhouettes_->gather(source_.count, record);
  start();
  find_stretches();
  find_meetings();
  std::ranges::sort(events_, {}, [](const Event& event) { return std::pair(event.edge, event.by); });
  const auto same = [](const Event& a, const Event& b) { return a.edge == b.edge && a.by == b.by; };
  events_.erase(std::unique(events_.begin(), events_.end(), same), events_.end());  // of edges with several stretches
  std::ranges::stable_sort(removed_, {}, [](const Stretch& stretch) { return stretch.edge; });
  record.silhouettes = stretches_.size() - source_edges_;
  find_ends();
  return trace_all();
}

void SilhouetteWalk::start() {
  const std::size_t edges = outlines_.edges().size();
  stretches_.clear();
  removed_.clear();
  events_.clear();
  touched_.assign(outlines_.corner_count(), 0);
  exact_.clear(edges);
  line_.resize(edges);
  std::iota(line_.begin(), line_.end(), EdgeId{0});
}

// 1. The parts of each edge that may bound V.
void SilhouetteWalk::find_stretches() {
  for (EdgeId edge = 0; edge < source_edges_; ++edge) add_source_edge(edge);
  for (EdgeId edge = source_edges_; edge < line_.size(); ++edge) {
    Cover found;
    if (source_.count > 1) {
      add_stretches_in_union(edge);
    } else if (cover_exactly(edge, 0, found) && found.left && found.right) {
      stretches_.push_back({edge, found.interval});
    }
  }
}

// The stretches end wherever a piece of the source begins or ends. So the inside of each stretch is inside the source:
// it does not pass through a corner of the source's outline, beside which silhouettes may lie that are outside.
void SilhouetteWalk::add_stretches_in_union(EdgeId edge) {
  covers_.clear();
  places_.clear();
  Cover found;
  for (OutlineId s = 0; s < source_.count; ++s) {
    if (!cover_exactly(edge, s, found)) continue;
    covers_.push_back(found);
    places_.push_back(found.interval.begin);
    places_.push_back(found.interval.end);
  }
  std::ranges::sort(places_, [&](const Parameter& p, const Parameter& q) { return compare(edge, p, q) < 0; });
  for (std::size_t i = 0; i + 1 < places_.size(); ++i) {
    const Parameter &begin = places_[i], &end = places_[i + 1];
    if (compare(edge, begin, end) == 0) continue;
    const auto on = [&](bool Cover::*side) {
      return std::ranges::any_of(covers_, [&](const Cover& cover) {
        return cover.*side && compare(edge, cover.interval.begin, begin) <= 0 &&
               compare(edge, end, cover.interval.end) <= 0;
      });
    };
    if (on(&Cover::left) && on(&Cover::right)) stretches_.push_back({edge, {begin, end}});
  }
}

// An edge of S_k bounds V where no S_l covers its right, and none with a lower index coincides on the same side.
void SilhouetteWalk::add_source_edge(EdgeId edge) {
  stretches_.push_back({edge, {kBegin, kEnd}});
  const OutlineId own = outlines_.edge(edge).outline;
  for (OutlineId s = 0; s < source_.count; ++s) {
    Cover found;
    if (s == own || !cover_exactly(edge, s, found)) continue;
    if (found.right || (found.coincides && found.left && s < own)) removed_.push_back({edge, found.interval});
  }
}

// 2. Where edges meet.
void SilhouetteWalk::find_meetings() {
  make_images();
  std::ranges::sort(images_, [](const Image& a, const Image& b) {
    return a.low_u != b.low_u ? a.low_u < b.low_u : a.stretch < b.stretch;
  });
  for (std::size_t i = 0; i < images_.size(); ++i) {
    const Image& a = images_[i];
    for (std::size_t j = i + 1; j < images_.size() && images_[j].low_u <= a.high_u; ++j) {
      const Image& b = images_[j];
      if (b.low_v > a.high_v || b.high_v < a.low_v) continue;
      const EdgeId e = stretches_[a.stretch].edge, g = stretches_[b.stretch].edge;
      if (e != g && !(is_of_source(e) && is_of_source(g))) meet(std::min(e, g), std::max(e, g));
      if (pairs_ >= next_poll_) {
        next_poll_ = pairs_ + kMeetingsPerPoll;
        kernel::poll();
      }
    }
  }
}

// The images are those of a projection along the middle of the source.
void SilhouetteWalk::make_images() {
  Approx3 middle;
  for (EdgeId edge = 0; edge < source_edges_; ++edge) {
    const Approx3& t = outlines_.corner(outlines_.edge(edge).a).t;
    const double size = kernel::max_norm(t);
    middle = {middle.x + t.x / size, middle.y + t.y / size, middle.z + t.z / size};
  }
  const double size = kernel::max_norm(middle);
  ahead_ = {middle.x / size, middle.y / size, middle.z / size};
  find_axes(ahead_, axis_u_, axis_v_);
  images_.clear();
  for (std::uint32_t i = 0; i < stretches_.size(); ++i) {
    images_.push_back(image_of(stretches_[i]));
    images_.back().stretch = i;
  }
}

// A point of the edge with a parameter within `error` of t lies within r = 2 (error + 2^-50) (|a| + |b|) of the
// computed one, component by component. Each dot product then errs by less than 4 r, and a quotient U / W by less than
// 4 r (1 + |U / W|) / (W - 4 r). The ends bound the image, since lines have lines as images.
SilhouetteWalk::Image SilhouetteWalk::image_of(const Stretch& stretch) const {
  constexpr double kUnbounded = std::numeric_limits<double>::infinity();
  const Edge& edge = outlines_.edge(stretch.edge);
  const Outlines::Corner &a = outlines_.corner(edge.a), &b = outlines_.corner(edge.b);
  Image image{kUnbounded, -kUnbounded, kUnbounded, -kUnbounded, 0};
  for (const Parameter& end : {stretch.interval.begin, stretch.interval.end}) {
    const Approx3 d = between(a, b, end.value);
    const double r = 2.0 * (static_cast<double>(end.error) + 0x1p-50) * (a.size + b.size), w = dot(ahead_, d);
    if (!(w > 16.0 * r)) return {-kUnbounded, kUnbounded, -kUnbounded, kUnbounded, 0};
    const double u = dot(axis_u_, d) / w, v = dot(axis_v_, d) / w, slack = 8.0 * r / w + 0x1p-48;
    const double slack_u = slack * (1.0 + std::abs(u)), slack_v = slack * (1.0 + std::abs(v));
    image.low_u = std::min(image.low_u, u - slack_u);
    image.high_u = std::max(image.high_u, u + slack_u);
    image.low_v = std::min(image.low_v, v - slack_v);
    image.high_v = std::max(image.high_v, v + slack_v);
  }
  return image;
}

// Requires e < g.
void SilhouetteWalk::meet(EdgeId e, EdgeId g) {
  ++pairs_;
  const Edge first = outlines_.edge(e), second = outlines_.edge(g);
  const int second_a = outlines_.side(first, second.a), second_b = outlines_.side(first, second.b);
  if (second_a * second_b > 0) return;
  if (second_a == 0 && second_b == 0) {
    if (!is_of_source(e)) coincide(e, g);
    return;
  }
  const int first_a = outlines_.side(second, first.a), first_b = outlines_.side(second, first.b);
  note_touch(first, second, first_a, first_b);
  note_touch(second, first, second_a, second_b);
  if (first_a * first_b < 0) add_event(e, g, first_a, second_a, second_b);
  if (second_a * second_b < 0 && !is_of_source(e)) add_event(g, e, second_a, first_a, first_b);
}

// Marks ends of e that lie on g's line, unless they are ends of g. `e_a`, `e_b`: the sides of g that they are on.
void SilhouetteWalk::note_touch(const Edge& e, const Edge& g, int e_a, int e_b) {
  if (e_a == 0 && e.a != g.a && e.a != g.b) touched_[e.a] = 1;
  if (e_b == 0 && e.b != g.a && e.b != g.b) touched_[e.b] = 1;
}

// Requires that e has its ends strictly on different sides of g. `from`: on which side it begins. `side_a`, `side_b`:
// of g's ends beside e, not both 0 and not both on one side.
void SilhouetteWalk::add_event(EdgeId e, EdgeId g, int from, int side_a, int side_b) {
  if (from * side_a > 0 || from * side_b < 0) return;  // they meet in opposite directions
  const int change = from > 0 ? silhouettes_->jump(g) : -silhouettes_->jump(g);
  events_.push_back(
      {e, g, crossing_of(e, g), side_a > 0 || side_b > 0 ? change : 0, side_a < 0 || side_b < 0 ? change : 0});
}

// A corner off the edge's line. Some corner of the source is, since the source has area.
CornerId SilhouetteWalk::corner_beside(const Edge& edge) {
  for (EdgeId s = 0; s < source_edges_; ++s) {
    const CornerId corner = outlines_.edge(s).a;
    if (outlines_.side(edge, corner) != 0) return corner;
  }
  EXACTFF_EXPECT(false);
  return 0;
}

// Where silhouettes on one line overlap, e represents both: removes that from g. Requires e < g.
//
// An end of one lies along the other where a line through the end and a corner off it crosses the other.
void SilhouetteWalk::coincide(EdgeId e, EdgeId g) {
  const Edge first = outlines_.edge(e), second = outlines_.edge(g);
  const CornerId beside = corner_beside(second);
  // Of an edge with ends on the sides a and b of such a line.
  const auto meets = [&](int a, int b, const Edge& edge) {
    if (a * b > 0 || (a == 0 && b == 0)) return false;
    return (a != 0 ? a : -b) == outlines_.side(edge, beside);  // else the two meet in opposite directions
  };
  std::vector<Parameter>& common = places_;  // ends of both, as places of g
  common.clear();
  for (const CornerId end : {first.a, first.b}) {
    const EdgeId line = outlines_.add_edge(end, beside);
    line_.push_back(line);
    exact_.grow(line_.size());
    const Edge through = outlines_.edge(line);
    const int a = outlines_.side(through, second.a), b = outlines_.side(through, second.b);
    if (a * b < 0 && meets(a, b, second)) common.push_back(crossing_of(g, line));
  }
  for (const bool begins : {true, false}) {
    const Edge through = outlines_.line_through(begins ? second.a : second.b, beside);
    const int a = outlines_.side(through, first.a), b = outlines_.side(through, first.b);
    if (meets(a, b, first)) common.push_back(begins ? kBegin : kEnd);
  }
  if (common.size() < 2) return;
  for (const CornerId corner : {first.a, first.b, second.a, second.b}) touched_[corner] = 1;
  const auto before = [&](const Parameter& p, const Parameter& q) { return compare(g, p, q) < 0; };
  const auto [least, largest] = std::ranges::minmax_element(common, before);
  if (before(*least, *largest)) removed_.push_back({g, {*least, *largest}});
}

// A point in the widest gap between the ends of the stretch and the events inside it, which are in order.
std::optional<double> SilhouetteWalk::clear_point(const Stretch& stretch) const {
  double widest = 0.0, middle = 0.0;
  const auto look = [&](const Parameter& from, const Parameter& to) {
    const double low = from.value + static_cast<double>(from.error) + 0x1p-49;
    const double high = to.value - static_cast<double>(to.error) - 0x1p-49;
    if (!(high - low > widest)) return;
    widest = high - low;
    middle = low + 0.5 * (high - low);
  };
  const Parameter* from = &stretch.interval.begin;
  for (const Event& event : along_) {
    look(*from, event.at);
    from = &event.at;
  }
  look(*from, stretch.interval.end);
  return widest > 0.0 ? std::optional(middle) : std::nullopt;
}

// 4. Along the stretches.
void SilhouetteWalk::find_ends() {
  ends_.clear();
  for (std::uint32_t i = 0; i < stretches_.size(); ++i) {
    const auto& [edge, interval, at_begin, at_end] = stretches_[i];
    const Edge& on = outlines_.edge(edge);
    if (interval.begin.line == Parameter::kAtBegin && touched_[on.a] == 0) ends_.push_back({on.a, i, true});
    if (interval.end.line == Parameter::kAtEnd && touched_[on.b] == 0) ends_.push_back({on.b, i, false});
  }
  std::ranges::stable_sort(ends_, {}, &End::corner);
}

bool SilhouetteWalk::trace_all() {
  done_.assign(stretches_.size(), 0);
  for (std::uint32_t seed = 0; seed < stretches_.size(); ++seed) {
    waiting_.assign(1, seed);
    while (!waiting_.empty()) {
      const std::uint32_t next = waiting_.back();
      waiting_.pop_back();
      if (done_[next] != 0) continue;
      done_[next] = 1;
      if (!trace(next)) return false;
    }
  }
  return true;
}

// c behind an end of a stretch holds before the other stretch that ends there, if there is just one.
void SilhouetteWalk::go_on(std::uint32_t index, bool at_begin, const Counts& counts) {
  const Stretch& stretch = stretches_[index];
  const Parameter& end = at_begin ? stretch.interval.begin : stretch.interval.end;
  if (end.line != (at_begin ? Parameter::kAtBegin : Parameter::kAtEnd)) return;
  const Edge& edge = outlines_.edge(stretch.edge);
  const auto here = with_key(ends_, at_begin ? edge.a : edge.b, &End::corner);
  if (here.size() != 2) return;
  const End& other = here[0].stretch == index && here[0].is_begin == at_begin ? here[1] : here[0];
  Stretch& next = stretches_[other.stretch];
  if (done_[other.stretch] != 0 || is_of_source(stretch.edge) != is_of_source(next.edge)) return;
  const Counts there = other.is_begin != at_begin ? counts : Counts{counts.right, counts.left};
  (other.is_begin ? next.at_begin : next.at_end) = there;
  waiting_.push_back(other.stretch);
}

// A silhouette that leaves an edge of the source to its left.
void SilhouetteWalk::enter(EdgeId edge, EdgeId from, const Counts& counts) {
  const Edge &line = outlines_.edge(from), &on = outlines_.edge(edge);
  const auto stretches = with_key(stretches_, edge, &Stretch::edge);
  for (Stretch& stretch : stretches) {
    const auto index = static_cast<std::uint32_t>(&stretch - stretches_.data());
    if (done_[index] != 0) continue;
    if (stretch.interval.begin.line == from && outlines_.side(line, on.b) > 0) {
      stretch.at_begin = counts;
    } else if (stretch.interval.end.line == from && outlines_.side(line, on.a) > 0) {
      stretch.at_end = counts;
    } else {
      continue;
    }
    waiting_.push_back(index);
  }
}

// Requires the events inside the stretch, in order.
std::optional<SilhouetteWalk::Counts> SilhouetteWalk::counts_at_begin(const Stretch& stretch) {
  if (stretch.at_begin) return stretch.at_begin;
  std::optional<Counts> c = stretch.at_end;
  double behind = 1.0;
  if (!c) {
    const std::optional<double> t = clear_point(stretch);
    if (!t) return std::nullopt;
    behind = *t;
    c = OccluderCount(*query_, outlines_, *silhouettes_).beside(stretch.edge, *t);
    if (!c) return std::nullopt;
  }
  for (const Event& event : along_) {
    if (event.at.value > behind) break;
    c->left -= event.left;
    c->right -= event.right;
  }
  return c;
}

bool SilhouetteWalk::trace(std::uint32_t index) {
  const Stretch stretch = stretches_[index];
  const EdgeId edge = stretch.edge;
  off_.clear();
  for (const Stretch& removed : with_key(removed_, edge, &Stretch::edge)) off_.push_back(removed.interval);
  sort(edge, off_);
  if (std::ranges::any_of(off_, [&](const Interval& off) {
        return compare(edge, off.begin, stretch.interval.begin) <= 0 &&
               compare(edge, stretch.interval.end, off.end) <= 0;
      })) {
    return true;
  }
  along_.clear();
  for (const Event& event : with_key(events_, edge, &Event::edge)) {
    if (compare(edge, stretch.interval.begin, event.at) < 0 && compare(edge, event.at, stretch.interval.end) < 0) {
      along_.push_back(event);
    }
  }
  std::ranges::stable_sort(along_, [&](const Event& a, const Event& b) { return compare(edge, a.at, b.at) < 0; });
  const std::optional<Counts> at_begin = counts_at_begin(stretch);
  if (!at_begin) return false;
  Counts c = *at_begin;
  const auto kind_of = [&] {
    EXACTFF_EXPECT(c.left >= 0 && (c.right >= 0 || is_of_source(edge)));
    some_hidden_ = some_hidden_ || c.left > 0 || (c.right > 0 && !is_of_source(edge));
    if (is_of_source(edge)) return c.left == 0 ? 1 : 0;
    return (c.left == 0 ? 1 : 0) - (c.right == 0 ? 1 : 0);
  };
  Parameter begin = stretch.interval.begin;
  int kind = kind_of();
  bool alone = true;
  for (std::size_t i = 0; i < along_.size(); ++i) {
    const Event& event = along_[i];
    const int left_before = c.left;
    c.left += event.left;
    c.right += event.right;
    const bool more = i + 1 < along_.size() && compare(edge, event.at, along_[i + 1].at) == 0;
    if (is_of_source(edge) && alone && !more && event.left != 0) {
      const bool from_left = event.left == silhouettes_->jump(event.by);
      enter(event.by, edge, from_left ? Counts{left_before, c.left} : Counts{c.left, left_before});
    }
    alone = !more;
    if (more) continue;
    const int next = kind_of();
    if (next == kind) continue;
    keep(stretch, kind, begin, event.at);
    begin = event.at;
    kind = next;
  }
  keep(stretch, kind, begin, stretch.interval.end);
  go_on(index, true, *at_begin);
  go_on(index, false, c);
  return true;
}

// Without what another edge represents.
void SilhouetteWalk::keep(const Stretch& stretch, int kind, const Parameter& begin, const Parameter& end) {
  if (kind == 0) return;
  const EdgeId edge = stretch.edge;
  const auto add = [&](const Parameter& from, const Parameter& to) {
    if (compare(edge, from, to) < 0) parts_.push_back(kind > 0 ? Part{edge, from, to} : Part{edge, to, from});
  };
  Parameter reached = begin;
  for (const Interval& off : off_) {
    if (compare(edge, off.begin, end) >= 0) break;
    add(reached, off.begin);
    if (compare(edge, off.end, reached) > 0) reached = off.end;
  }
  add(reached, end);
}

}  // namespace exactff::visibility
