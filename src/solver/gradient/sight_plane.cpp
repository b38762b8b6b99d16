#include "gradient/sight_plane.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "kernel/expect.h"
#include "kernel/poll.h"
#include "kernel/vec.h"
#include "scene/scene.h"

namespace exactff::gradient {

SightPlane::SightPlane(const PlaneQuery& query, Profile& profile, const Outlines::Edge& edge,
                       const VertexMotions* motions)
    : SightDirections(profile.outlines(), edge), query_(query), profile_(profile), motions_(motions) {}

// --- What meets the plane ---

RationalVec3 SightPlane::nearness_of(const Vec3& a, const Vec3& b, const Vec3& c) const {
  const ExactVec3 m = cross(kernel::exact_difference(b, a).v, kernel::exact_difference(c, a).v);
  const kernel::ScaledVec3 arrow = kernel::exact_difference(a, query_.view.x);
  const Rational height = kernel::times_power_of_two(Rational(dot(m, arrow.v)), arrow.exponent);
  return to_rational(m) * Rational(1 / height);
}

RationalVec3 SightPlane::nearness_of(std::uint32_t piece) const {
  const auto& frame = query_.view.scene.pieces()[piece].frame;
  const auto vertices = query_.view.scene.vertices();
  return nearness_of(vertices[frame[0]], vertices[frame[1]], vertices[frame[2]]);
}

// If the outline lies on one side, every edge in the plane is an element of its own.
void SightPlane::add_outline(OutlineId id) {
  Outlines& outlines = profile_.outlines();
  const std::vector<int> sides = sides_of(outlines, id);
  Element element;
  element.side = side_of(sides);
  element.is_source = id < profile_.source_count();
  element.piece = profile_.pieces()[id];
  if (element.side == 0) {
    auto arc = arc_of(outlines, id, sides);
    if (!arc) return;
    element.from = std::move(arc->first);
    element.to = std::move(arc->second);
    elements_.push_back(std::move(element));
    return;
  }
  const EdgeId first = outlines.outline(id).first;
  for (std::size_t c = 0; c < sides.size(); ++c) {
    if (sides[c] != 0 || sides[(c + 1) % sides.size()] != 0) continue;
    const Outlines::Edge edge = outlines.edge(first + static_cast<EdgeId>(c));
    element.from = outlines.exact(edge.a);
    element.to = outlines.exact(edge.b);
    if (turn(element.from, element.to) < 0) std::swap(element.from, element.to);
    if (motions_ != nullptr) {
      element.line =
          element.is_source ? motions_->line_of_source(outlines, edge) : motions_->line_of_occluder(outlines, edge);
      element.touches = !element.is_source && element.line && motions_->is_in_source_plane(element.line->first) &&
                        motions_->is_in_source_plane(element.line->second);
    }
    elements_.push_back(element);
  }
}

// Edges of a piece in the source's plane that hide nothing now.
void SightPlane::add_meeting(std::uint32_t piece) {
  Outlines& outlines = profile_.outlines();
  const auto corners = query_.view.scene.corners(query_.view.scene.pieces()[piece]);
  std::vector<int> sides;
  for (const std::uint32_t corner : corners) sides.push_back(outlines.side(edge_, outlines.corner_at(corner)));
  const auto beside = std::ranges::find_if(sides, [](int side) { return side != 0; });
  if (beside == sides.end()) return;  // seen edge-on, it hides nothing to first order
  for (std::size_t c = 0; c < sides.size(); ++c) {
    const std::size_t next = (c + 1) % sides.size();
    if (sides[c] != 0 || sides[next] != 0) continue;
    if (!motions_->is_in_source_plane(corners[c]) || !motions_->is_in_source_plane(corners[next])) continue;
    Element element;
    element.side = *beside;
    element.touches = true;
    element.present = false;
    element.from = outlines.exact(outlines.corner_at(corners[c]));
    element.to = outlines.exact(outlines.corner_at(corners[next]));
    if (turn(element.from, element.to) < 0) std::swap(element.from, element.to);
    element.line = motions_->pair_of(corners[c], corners[next]);
    elements_.push_back(std::move(element));
  }
}

SightPlane::Sheet SightPlane::sheet_of(std::uint32_t index) const {
  const Scene& scene = query_.view.scene;
  const auto corners = scene.corners(scene.pieces()[index]);
  const RationalVec3 x = to_rational(query_.view.x);
  Sheet sheet;
  sheet.piece = index;
  for (std::size_t c = 0; c < corners.size(); ++c) {
    const std::uint32_t p = corners[c], q = corners[c + 1 == corners.size() ? 0 : c + 1];
    const Vec3 &a = scene.vertices()[p], &b = scene.vertices()[q];
    sheet.places.push_back(places(scene)[p]);
    sheet.corners.push_back(kernel::exact_difference(a, query_.view.x).v);
    const RationalVec3 along = to_rational(b) - to_rational(a), pole = cross(to_rational(a) - x, along);
    if (is_zero(pole)) continue;  // x sees this side end-on
    Sheet::Side side{sheet.corners.back(),
                     kernel::exact_difference(b, query_.view.x).v,
                     cross(along, pole) * Rational(1 / dot(pole, pole)),
                     {}};
    if (turn(side.from, side.to) < 0) std::swap(side.from, side.to);
    if (motions_ != nullptr) {
      side.motions = motions_->of_line(normal_, motions_->pair_of(p, q));
    } else {
      side.motions.push_back({Motion::kAll, side.nearness, {}});
    }
    sheet.sides.push_back(std::move(side));
  }
  return sheet;
}

void SightPlane::set_motions(Element& element) const {
  if (motions_ == nullptr) {
    element.motions.push_back({Motion::kAll, element.is_source ? source_nearness_ : nearness_of(element.piece), {}});
  } else if (element.line) {
    element.motions = motions_->of_line(normal_, *element.line);
  } else if (!element.is_source) {
    element.motions = motions_->of_cut(normal_, element.piece);
  }
}

// The directions in which the source lies in or beside the plane. False if it does not along an arc.
bool SightPlane::find_range() {
  bool some = false;
  for (const Element& element : elements_) {
    if (!element.is_source) continue;
    if (!some || turn(element.from, first_) > 0) first_ = element.from;
    if (!some || turn(last_, element.to) > 0) last_ = element.to;
    some = true;
  }
  return some;
}

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

// False: nothing of the source is seen along an arc.
bool SightPlane::gather() {
  const auto& [view, plane, request] = query_;
  source_nearness_ = nearness_of(plane.point, plane.second, plane.third);
  source_motions_ = {{Motion::kAll, source_nearness_, {}}};
  for (OutlineId id = 0; id < profile_.outlines().outlines().size(); ++id) {
    add_outline(id);
    if (id + 1 == profile_.source_count() && !find_range()) return false;
  }
  for (const std::uint32_t piece : profile_.meeting()) add_meeting(piece);
  std::erase_if(elements_, [&](Element& element) { return !clamp(element.from, element.to); });
  // Occluders on both sides come first: where one of them is, nothing else counts.
  std::stable_partition(elements_.begin(), elements_.end(),
                        [](const Element& e) { return !e.is_source && e.side == 0; });
  for (Element& element : elements_) {
    if (element.side != 0) set_motions(element);
  }
  Outlines& outlines = profile_.outlines();
  const auto in_plane = [&](std::uint32_t v) { return outlines.side(edge_, outlines.corner_at(v)) == 0; };
  for (const std::uint32_t index : profile_.sheets()) {
    const Piece& piece = view.scene.pieces()[index];
    if (std::ranges::all_of(piece.frame, in_plane) && !holds_x(view, piece)) sheets_.push_back(sheet_of(index));
  }
  return true;
}

// --- Arcs ---

// Adds the directions inside the range in which two of the lines meet.
void SightPlane::add_meetings(const std::vector<const RationalVec3*>& lines, std::vector<ExactVec3>& breaks) const {
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

void SightPlane::sort(std::vector<ExactVec3>& directions) const {
  std::ranges::sort(directions, [&](const ExactVec3& p, const ExactVec3& q) { return turn(p, q) > 0; });
}

// Between two of them, the same elements are there, in the same orders.
std::vector<ExactVec3> SightPlane::breaks() const {
  std::vector<ExactVec3> result;
  std::map<std::uint32_t, std::vector<const RationalVec3*>> shares;  // by what moves
  const auto add = [&](const Motions& motions) {
    for (const Motion& motion : motions) shares[motion.place].push_back(&motion.share);
  };
  for (const Element& element : elements_) {
    result.push_back(element.from);
    result.push_back(element.to);
    add(element.motions);
  }
  // Where a sheet passes the source's plane, it begins to be cut.
  auto& nearnesses = shares[Motion::kAll];
  nearnesses.push_back(&source_nearness_);
  for (const Sheet& sheet : sheets_) {
    for (const ExactVec3& corner : sheet.corners) {
      if (is_between(first_, last_, corner)) result.push_back(corner);
    }
    for (const Sheet::Side& side : sheet.sides) {
      nearnesses.push_back(&side.nearness);
      add(side.motions);
    }
  }
  for (const auto& [place, lines] : shares) add_meetings(lines, result);
  sort(result);
  return result;
}

template <class Visit>
void SightPlane::for_each_arc(const std::vector<ExactVec3>& breaks, const Visit& visit) const {
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
    kernel::poll();
    if (turn(breaks[i], breaks[i + 1]) > 0 && !visit(breaks[i], breaks[i + 1])) return;
  }
}

// --- What changes ---

// From its near to its far side.
std::optional<SightPlane::Chord> SightPlane::chord_of(const Sheet& sheet, const ExactVec3& t) const {
  const RationalVec3 w = to_rational(t);
  Chord chord;
  for (const Sheet::Side& side : sheet.sides) {
    if (!is_between(side.from, side.to, t)) continue;
    const Rational u = dot(side.nearness, w);
    if (chord.near == nullptr || u > chord.u_near) {
      chord.near = &side;
      chord.u_near = u;
    }
    if (chord.far == nullptr || u < chord.u_far) {
      chord.far = &side;
      chord.u_far = u;
    }
  }
  if (chord.near == nullptr || chord.u_near == chord.u_far) return std::nullopt;
  chord.sheet = &sheet;
  return chord;
}

// Finds what is there at t. False if nothing of the source is, or if an occluder covers all of it.
bool SightPlane::look_at(const ExactVec3& t) {
  active_.clear();
  chords_.clear();
  bool some_source = false;
  for (const Element& element : elements_) {
    if (!is_between(element.from, element.to, t)) continue;
    if (!element.is_source && element.side == 0) return false;
    some_source = some_source || element.is_source;
    active_.push_back(&element);
  }
  if (!some_source) return false;
  const Rational u_source = dot(source_nearness_, to_rational(t));
  for (const Sheet& sheet : sheets_) {
    std::optional<Chord> chord = chord_of(sheet, t);
    if (!chord || chord->u_near <= u_source) continue;  // behind the source's plane
    chord->is_cut = chord->u_far < u_source;
    chords_.push_back(*std::move(chord));
  }
  return true;
}

namespace {

// f at both ends of an arc, since it is linear in between. If x moves, u in its middle, as the order and the sign of
// all u are the same along all of it.
struct Form {
  RationalVec3 begin, end;

  [[nodiscard]] bool equals(const Form& other) const {
    return is_zero(begin - other.begin) && is_zero(end - other.end);
  }
  void add(const Form& other, int times) {
    begin = begin + other.begin * Rational(times);
    end = end + other.end * Rational(times);
  }
};

Form form_of(const std::vector<Motion>& motions, std::uint32_t place, const RationalVec3& begin,
             const RationalVec3& end) {
  Form f;
  for (const Motion& one : motions) {
    if (one.place != place) continue;
    if (place == Motion::kAll) {
      f.begin.x = dot(one.share, begin);
    } else {
      f.add({one.turn * dot(one.share, begin), one.turn * dot(one.share, end)}, 1);
    }
  }
  return f;
}

}  // namespace

// What is seen after a movement: the lines that bound it, by their numbers, with signs.
struct SightPlane::Change {
  std::vector<int> counts;
  bool below = false, above = false;
};

struct SightPlane::Verdict {
  bool is_kink = false;
  std::vector<const Motions*> lines;  // of the different f
  std::vector<int> counts;            // in M, of each of them; in the first order
  std::vector<int> counts_back;       // in the last that was tried
  bool is_zero = true;                // M, in the first order
};

// Requires look_at(begin + end).
SightPlane::Verdict SightPlane::judge(std::uint32_t place, const ExactVec3& begin, const ExactVec3& end) const {
  const RationalVec3 p = to_rational(place == Motion::kAll ? begin + end : begin);
  const RationalVec3 q = place == Motion::kAll ? RationalVec3() : to_rational(end), n = to_rational(normal_);
  Verdict verdict;
  std::vector<Form> forms;  // different
  const auto number_of = [&](const Motions& motions) {
    Form f = form_of(motions, place, p, q);
    const auto found = std::ranges::find_if(forms, [&](const Form& other) { return other.equals(f); });
    if (found != forms.end()) return static_cast<std::size_t>(found - forms.begin());
    forms.push_back(std::move(f));
    verdict.lines.push_back(&motions);
    return forms.size() - 1;
  };
  std::vector<std::pair<const Element*, std::size_t>> lines;
  for (const Element* element : active_) {
    lines.emplace_back(element, element->side == 0 || element->motions.empty() ? 0 : number_of(element->motions));
  }
  std::vector<std::pair<std::size_t, std::size_t>> chords;
  for (const Chord& chord : chords_) {
    const bool ends_at_source = chord.is_cut && place == Motion::kAll;
    chords.emplace_back(number_of(chord.near->motions),
                        number_of(ends_at_source ? source_motions_ : chord.far->motions));
  }
  if (forms.empty()) return verdict;

  enum class Touching { kAsNow, kAll, kNone };
  const std::size_t count = forms.size();
  const auto change = [&](const std::vector<std::size_t>& rank, Touching touching) {
    const auto is_visible = [&](std::size_t slot) {  // between the ranks slot - 1 and slot
      bool source = false;
      for (const auto& [element, at] : lines) {
        const bool above = rank[at] < slot;
        const bool inside = element->side == 0 || (element->side > 0) == above;
        if (element->is_source) {
          source = source || inside;
          continue;
        }
        const bool counts =
            !element->touches || touching == Touching::kAsNow ? element->present : touching == Touching::kAll;
        if (counts && inside) return false;
      }
      for (std::size_t i = 0; i < chords.size(); ++i) {
        if (chords_[i].is_cut && touching == Touching::kNone) continue;
        const auto [low, high] = std::minmax(rank[chords[i].first], rank[chords[i].second]);
        if (low < slot && slot <= high) return false;
      }
      return source;
    };
    Change result;
    result.counts.assign(count, 0);
    std::vector<std::size_t> at_rank(count);
    for (std::size_t i = 0; i < count; ++i) at_rank[rank[i]] = i;
    for (std::size_t slot = 0; slot <= count; ++slot) {
      if (!is_visible(slot)) continue;
      if (slot < count) ++result.counts[at_rank[slot]];
      if (slot > 0) --result.counts[at_rank[slot - 1]];
      if (slot == 0) result.below = true;
      if (slot == count) result.above = true;
    }
    return result;
  };

  // All orders, or those two of multiples of N.
  constexpr std::size_t kMost = 6;
  std::vector<std::vector<std::size_t>> ranks;
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto add_order = [&] {
    std::vector<std::size_t>& rank = ranks.emplace_back(count);
    for (std::size_t i = 0; i < count; ++i) rank[order[i]] = i;
  };
  const auto is_multiple = [&](const Form& f) { return is_zero(cross(f.begin, n)) && is_zero(cross(f.end, n)); };
  if (place == Motion::kAll || std::ranges::all_of(forms, is_multiple)) {
    std::vector<Rational> in_the_middle;
    for (const Form& f : forms) in_the_middle.push_back(place == Motion::kAll ? f.begin.x : dot(f.begin + f.end, n));
    std::ranges::sort(order, {}, [&](std::size_t i) -> const Rational& { return in_the_middle[i]; });
    add_order();
    std::ranges::reverse(order);
    add_order();
  } else if (count > kMost) {
    verdict.is_kink = true;
    return verdict;
  } else {
    do add_order();
    while (std::ranges::next_permutation(order).found);
  }
  const auto total = [&](const Change& one) {
    Form sum;
    for (std::size_t i = 0; i < count; ++i) sum.add(forms[i], one.counts[i]);
    return sum;
  };
  const Change first = change(ranks.front(), Touching::kAsNow);
  const Form result = total(first);
  const bool concerned = is_concerned(place, begin, end);
  verdict.counts = first.counts;
  verdict.is_zero = result.equals({});
  for (const std::vector<std::size_t>& rank : ranks) {
    for (const Touching touching : {Touching::kAsNow, Touching::kAll, Touching::kNone}) {
      if (touching != Touching::kAsNow && !concerned) continue;
      const Change other = change(rank, touching);
      verdict.counts_back = other.counts;
      if (other.below == first.below && other.above == first.above && total(other).equals(result)) continue;
      verdict.is_kink = true;
      return verdict;
    }
  }
  return verdict;
}

// --- If x moves ---

// Nullopt if nothing changes.
std::optional<SightArc> SightPlane::arc_between(const ExactVec3& begin, const ExactVec3& end) {
  if (!look_at(begin + end)) return std::nullopt;
  const Verdict verdict = judge(Motion::kAll, begin, end);
  SightArc arc{begin, end, {}, {}, verdict.is_kink, !chords_.empty(), {}};
  for (std::size_t i = 0; i < verdict.lines.size(); ++i) {
    const RationalVec3& nearness = verdict.lines[i]->front().share;
    arc.gain_back = arc.gain_back + nearness * Rational(verdict.counts[i]);
    arc.gain_ahead = arc.gain_ahead - nearness * Rational(verdict.counts_back[i]);
  }
  if (!arc.is_kink && is_zero(arc.gain_back) && is_zero(arc.gain_ahead)) return std::nullopt;
  for (const Element* element : active_) {
    if (!element->is_source) arc.pieces.push_back(element->piece);
  }
  for (const Chord& chord : chords_) arc.pieces.push_back(chord.sheet->piece);
  return arc;
}

std::vector<SightArc> SightPlane::arcs(Extent extent) {
  std::vector<SightArc> result;
  if (!gather()) return result;
  for_each_arc(breaks(), [&](const ExactVec3& begin, const ExactVec3& end) {
    if (std::optional<SightArc> arc = arc_between(begin, end)) result.push_back(*std::move(arc));
    return extent == Extent::kAll || result.empty() || !result.back().is_kink;
  });
  return result;
}

// If x moves to the front, s = -u: a piece hides what lies behind it if it covers s above its own, that is, on the side
// of N, or on both sides. One on the other side does not.
std::optional<SightArc> SightPlane::arc_of_source(const ExactVec3& begin, const ExactVec3& end) const {
  const ExactVec3 t = begin + end;
  const RationalVec3 w = to_rational(t);
  const RationalVec3* hidden_from = nullptr;
  Rational u_hidden;
  for (const Element& element : elements_) {
    if (element.side < 0 || !is_between(element.from, element.to, t)) continue;
    const RationalVec3& nearness = element.motions.front().share;
    const Rational u = dot(nearness, w);
    if (hidden_from == nullptr || u > u_hidden) {
      hidden_from = &nearness;
      u_hidden = u;
    }
  }
  struct Strip {
    const RationalVec3 *near, *far;
    Rational u_near, u_far;
  };
  std::vector<Strip> seen;
  for (const Sheet& sheet : sheets_) {
    const std::optional<Chord> chord = chord_of(sheet, t);
    if (!chord || (hidden_from != nullptr && chord->u_near <= u_hidden)) continue;
    const bool is_hidden = hidden_from != nullptr && chord->u_far < u_hidden;
    seen.push_back({&chord->near->nearness, is_hidden ? hidden_from : &chord->far->nearness, chord->u_near,
                    is_hidden ? u_hidden : chord->u_far});
  }
  if (seen.empty()) return std::nullopt;
  // The length of their union, from the far end.
  std::ranges::sort(seen, [](const Strip& p, const Strip& q) { return p.u_far < q.u_far; });
  SightArc arc{begin, end, {}, {}, true, true, {}};
  const RationalVec3* reached = seen.front().far;
  Rational u_reached = seen.front().u_far;
  for (const Strip& strip : seen) {
    if (strip.u_near <= u_reached) continue;
    arc.gain_ahead = arc.gain_ahead + (*strip.near - (strip.u_far > u_reached ? *strip.far : *reached));
    reached = strip.near;
    u_reached = strip.u_near;
  }
  return arc;
}

std::vector<SightArc> SightPlane::arcs_of_source_edge_on() {
  const auto& [view, plane, request] = query_;
  const ExactVec3 n = view.normal().exact;
  last_ = cross(normal_, n);
  first_ = last_;
  negate(first_);
  EXACTFF_EXPECT(!kernel::is_zero(last_));
  for (OutlineId id = 0; id < profile_.outlines().outlines().size(); ++id) add_outline(id);
  for (Element& element : elements_) set_motions(element);
  for (const std::uint32_t piece : plane.pieces) sheets_.push_back(sheet_of(piece));
  std::vector<ExactVec3> breaks;
  std::vector<const RationalVec3*> lines;
  const auto add_break = [&](const ExactVec3& t) {
    if (sign(dot(n, t)) > 0) breaks.push_back(t);
  };
  for (const Element& element : elements_) {
    add_break(element.from);
    add_break(element.to);
    lines.push_back(&element.motions.front().share);
  }
  for (const Sheet& sheet : sheets_) {
    for (const ExactVec3& corner : sheet.corners) add_break(corner);
    for (const Sheet::Side& side : sheet.sides) lines.push_back(&side.nearness);
  }
  // The range is a half turn: directions in which lines meet are found for all of it, and its ends are added last, as
  // they have no order of their own.
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
  std::vector<SightArc> result;
  if (breaks.empty()) return result;
  sort(breaks);
  breaks.insert(breaks.begin(), first_);
  breaks.push_back(last_);
  for_each_arc(breaks, [&](const ExactVec3& begin, const ExactVec3& end) {
    if (std::optional<SightArc> arc = arc_of_source(begin, end)) result.push_back(*std::move(arc));
    return true;
  });
  return result;
}

// --- If vertices move ---

// False if no two lines that move in different ways lie at one place, and none lies in the source's plane.
bool SightPlane::may_have_kinks() const {
  if (!sheets_.empty()) return true;
  std::vector<const Element*> lines;
  for (const Element& element : elements_) {
    if (element.motions.empty()) continue;
    if (element.touches) return true;
    lines.push_back(&element);
  }
  for (std::size_t i = 0; i < lines.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Element &p = *lines[i], &q = *lines[j];
      const bool move_alike = p.line && p.line == q.line;
      if (!move_alike && turn(p.from, q.to) > 0 && turn(q.from, p.to) > 0) return true;
    }
  }
  return false;
}

// The vertices that move what is there.
std::vector<std::uint32_t> SightPlane::movers() const {
  std::vector<std::uint32_t> result;
  const auto add = [&](const Motions& motions) {
    for (const Motion& one : motions) result.push_back(one.place);
  };
  bool follows_source = false;
  for (const Element* element : active_) {
    add(element->motions);
    follows_source = follows_source || element->touches;
  }
  for (const Chord& chord : chords_) {
    add(chord.near->motions);
    add(chord.far->motions);
    if (!chord.is_cut) continue;
    result.insert(result.end(), chord.sheet->places.begin(), chord.sheet->places.end());
    follows_source = true;
  }
  if (follows_source) result.insert(result.end(), motions_->source_frame().begin(), motions_->source_frame().end());
  std::ranges::sort(result);
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

// Whether a movement of the vertex lifts an edge in the source's plane from it, or sinks it, or where a sheet meets it.
bool SightPlane::is_concerned(std::uint32_t place, const ExactVec3& begin, const ExactVec3& end) const {
  if (place == Motion::kAll) return false;
  bool some = false;
  for (const Element* element : active_) {
    if (!element->touches) continue;
    if (std::ranges::find(element->motions, place, &Motion::place) != element->motions.end()) return true;
    some = true;
  }
  for (const Chord& chord : chords_) {
    if (!chord.is_cut) continue;
    if (std::ranges::find(chord.sheet->places, place) != chord.sheet->places.end()) return true;
    some = true;
  }
  if (!some) return false;
  for (int corner = 0; corner < 3; ++corner) {
    const RationalVec3& share = motions_->source_share(corner);
    const bool rests = sign(dot(share, to_rational(begin))) == 0 && sign(dot(share, to_rational(end))) == 0;
    if (motions_->source_frame()[corner] == place && !rests) return true;
  }
  return false;
}

SightPlane::OfVertices SightPlane::judge_vertices() {
  OfVertices result;
  for_each_arc(breaks(), [&](const ExactVec3& begin, const ExactVec3& end) {
    if (!look_at(begin + end)) return true;
    for (const std::uint32_t place : movers()) {
      const Verdict verdict = judge(place, begin, end);
      if (verdict.is_kink) result.kinks.push_back(place);
      if (verdict.is_kink || verdict.is_zero) continue;
      for (std::size_t i = 0; i < verdict.lines.size(); ++i) {
        for (const Motion& one : *verdict.lines[i]) {
          if (one.place != place || verdict.counts[i] == 0) continue;
          result.arcs.push_back({place, {begin, end, one.share}, one.turn * Rational(verdict.counts[i])});
        }
      }
    }
    return true;
  });
  return result;
}

SightPlane::OfVertices SightPlane::of_vertices() { return gather() ? judge_vertices() : OfVertices(); }

std::vector<std::uint32_t> SightPlane::kinks_of_vertices() {
  return gather() && may_have_kinks() ? judge_vertices().kinks : std::vector<std::uint32_t>();
}

}  // namespace exactff::gradient
