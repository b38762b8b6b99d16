#include "gradient/vertex_sight.h"

#include <algorithm>
#include <numeric>

#include "kernel/expect.h"
#include "kernel/poll.h"
#include "scene/scene.h"

namespace exactff::gradient {

using kernel::ExactVec3;
using kernel::Rational;
using kernel::RationalVec3;
using kernel::sign;
using kernel::to_rational;
using visibility::CornerId;
using visibility::EdgeId;
using visibility::OutlineId;
using visibility::Outlines;
using visibility::PlaneQuery;

// --- Vertex motion ---

namespace {

const Rational& component(const RationalVec3& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

}  // namespace

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

VertexMotions::VertexMotions(const visibility::PlaneQuery& query)
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

std::vector<VertexMotion> VertexMotions::of_line(const ExactVec3& N, const VertexPair& line) const {
  const RationalVec3 a = point(line.first), b = point(line.second), pole = cross(a, b);
  const Rational inverse = 1 / dot(pole, pole);
  const RationalVec3 turn = to_rational(N) * Rational(1 / Rational(N[longest_axis(N)]));
  return {{line.first, cross(b, pole) * inverse, turn}, {line.second, cross(pole, a) * inverse, turn}};
}

std::vector<VertexMotion> VertexMotions::of_cut(const ExactVec3& N, std::uint32_t piece) const {
  const Frame face = make_frame(frame_of(scene_, piece));
  const Rational inverse = 1 / component(face.nearness - source_.nearness, longest_axis(N));
  std::vector<VertexMotion> result;
  for (std::size_t i = 0; i < 3; ++i) result.push_back({face.places[i], face.shares[i], face.nearness * inverse});
  for (std::size_t i = 0; i < 3; ++i) {
    result.push_back({source_.places[i], source_.shares[i], source_.nearness * Rational(-inverse)});
  }
  return result;
}

// --- Vertex sight ---

VertexSight::VertexSight(const PlaneQuery& query, Profile& profile, const VertexMotions& motions,
                         const Outlines::Edge& edge)
    : SightDirections(profile.outlines(), edge), query_(query), profile_(profile), motions_(motions) {
  for (int corner = 0; corner < 3; ++corner) source_nearness_ = source_nearness_ + motions.source_share(corner);
}

// --- What meets the plane ---

// If the outline lies on one side, every edge in the plane is an element of its own.
void VertexSight::add_outline(OutlineId id) {
  Outlines& outlines = profile_.outlines();
  const std::vector<int> sides = sides_of(outlines, id);
  const bool of_source = id < profile_.source_count();
  Element element;
  element.kind = of_source ? Element::Kind::kSource : Element::Kind::kOccluder;
  element.side = side_of(sides);
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
    const auto line = of_source ? motions_.line_of_source(outlines, edge) : motions_.line_of_occluder(outlines, edge);
    element.touches =
        !of_source && line && motions_.is_in_source_plane(line->first) && motions_.is_in_source_plane(line->second);
    element.motion = line        ? motions_.of_line(normal_, *line)
                     : of_source ? Motion{}
                                 : motions_.of_cut(normal_, profile_.pieces()[id]);
    elements_.push_back(element);
  }
}

// Edges of a piece in the source's plane that hide nothing now.
void VertexSight::add_meeting(std::uint32_t piece) {
  Outlines& outlines = profile_.outlines();
  const auto corners = query_.view.scene.corners(query_.view.scene.pieces()[piece]);
  std::vector<int> sides;
  for (const std::uint32_t corner : corners) sides.push_back(outlines.side(edge_, outlines.corner_at(corner)));
  const auto beside = std::ranges::find_if(sides, [](int side) { return side != 0; });
  if (beside == sides.end()) return;  // seen edge-on, it hides nothing to first order
  for (std::size_t c = 0; c < sides.size(); ++c) {
    const std::size_t next = (c + 1) % sides.size();
    if (sides[c] != 0 || sides[next] != 0) continue;
    if (!motions_.is_in_source_plane(corners[c]) || !motions_.is_in_source_plane(corners[next])) continue;
    Element element;
    element.kind = Element::Kind::kOccluder;
    element.side = *beside;
    element.touches = true;
    element.present = false;
    element.from = outlines.exact(outlines.corner_at(corners[c]));
    element.to = outlines.exact(outlines.corner_at(corners[next]));
    if (turn(element.from, element.to) < 0) std::swap(element.from, element.to);
    element.motion = motions_.of_line(normal_, motions_.pair_of(corners[c], corners[next]));
    elements_.push_back(std::move(element));
  }
}

void VertexSight::add_sheet(std::uint32_t index) {
  Outlines& outlines = profile_.outlines();
  const Scene& scene = query_.view.scene;
  const Piece& piece = scene.pieces()[index];
  const auto in_plane = [&](std::uint32_t v) { return outlines.side(edge_, outlines.corner_at(v)) == 0; };
  if (!std::ranges::all_of(piece.frame, in_plane) || holds_x(query_.view, piece)) return;
  const auto corners = scene.corners(piece);
  Sheet sheet;
  for (std::size_t c = 0; c < corners.size(); ++c) {
    const std::uint32_t p = corners[c], q = corners[(c + 1) % corners.size()];
    sheet.places.push_back(places(scene)[p]);
    sheet.corners.push_back(kernel::exact_difference(scene.vertices()[p], query_.view.x).v);
    SheetSide side{kernel::exact_difference(scene.vertices()[p], query_.view.x).v,
                   kernel::exact_difference(scene.vertices()[q], query_.view.x).v,
                   {},
                   {}};
    if (turn(side.from, side.to) == 0) continue;  // x sees this side end-on
    if (turn(side.from, side.to) < 0) std::swap(side.from, side.to);
    side.motion = motions_.of_line(normal_, motions_.pair_of(p, q));
    side.nearness = side.motion[0].share + side.motion[1].share;
    sheet.sides.push_back(std::move(side));
  }
  sheets_.push_back(std::move(sheet));
}

bool VertexSight::find_range() {
  bool some = false;
  for (const Element& element : elements_) {
    if (element.kind != Element::Kind::kSource) continue;
    if (!some || turn(element.from, first_) > 0) first_ = element.from;
    if (!some || turn(last_, element.to) > 0) last_ = element.to;
    some = true;
  }
  return some;
}

// Between two of them, the same elements are there, in the same orders.
std::vector<ExactVec3> VertexSight::breaks() const {
  std::vector<ExactVec3> result;
  const auto add = [&](const ExactVec3& t) {
    if (is_between(first_, last_, t)) result.push_back(t);
  };
  const auto add_zero = [&](const RationalVec3& g) {  // where g . t = 0
    const RationalVec3 t = cross(to_rational(normal_), g);
    if (is_zero(t)) return;
    ExactVec3 direction = direction_of(t);
    add(direction);
    negate(direction);
    add(direction);
  };
  std::vector<const Motion*> all;
  for (const Element& element : elements_) {
    add(element.from);
    add(element.to);
    if (!element.motion.empty()) all.push_back(&element.motion);
  }
  for (const Sheet& sheet : sheets_) {
    for (const ExactVec3& corner : sheet.corners) add(corner);
    for (const SheetSide& side : sheet.sides) {
      all.push_back(&side.motion);
      add_zero(side.nearness - source_nearness_);
    }
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    kernel::poll();
    for (std::size_t j = 0; j < i; ++j) {
      for (const VertexMotion& p : *all[i]) {
        for (const VertexMotion& q : *all[j]) {
          if (p.place == q.place) add_zero(p.share - q.share);
        }
      }
    }
  }
  std::ranges::sort(result, [&](const ExactVec3& p, const ExactVec3& q) { return turn(p, q) > 0; });
  return result;
}

// --- What changes ---

// From its near to its far side. Nullopt if all of it is behind the source's plane.
std::optional<VertexSight::Strip> VertexSight::strip_of(const Sheet& sheet, const ExactVec3& t) const {
  const RationalVec3 w = to_rational(t);
  Strip strip;
  Rational near, far;
  for (const SheetSide& side : sheet.sides) {
    if (!is_between(side.from, side.to, t)) continue;
    const Rational u = dot(side.nearness, w);
    if (strip.near == nullptr || u > near) {
      strip.near = &side;
      near = u;
    }
    if (strip.far == nullptr || u < far) {
      strip.far = &side;
      far = u;
    }
  }
  const Rational source = dot(source_nearness_, w);
  if (strip.near == nullptr || near == far || near <= source) return std::nullopt;
  strip.is_cut = far < source;
  strip.sheet = &sheet;
  return strip;
}

// False if no two lines that move in different ways lie at one place, and none lies in the source's plane.
bool VertexSight::may_have_kinks() const {
  if (!sheets_.empty()) return true;
  std::vector<const Element*> lines;
  for (const Element& element : elements_) {
    if (element.side == 0 || element.motion.empty()) continue;
    if (turn(first_, element.to) <= 0 || turn(element.from, last_) <= 0) continue;
    if (element.touches) return true;
    lines.push_back(&element);
  }
  const auto move_alike = [](const Motion& p, const Motion& q) {
    return p.size() == 2 && q.size() == 2 && p[0].place == q[0].place && p[1].place == q[1].place;
  };
  for (std::size_t i = 0; i < lines.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Element &p = *lines[i], &q = *lines[j];
      if (!move_alike(p.motion, q.motion) && turn(p.from, q.to) > 0 && turn(q.from, p.to) > 0) return true;
    }
  }
  return false;
}

void VertexSight::judge(Extent extent) {
  Outlines& outlines = profile_.outlines();
  const auto count = static_cast<OutlineId>(outlines.outlines().size());
  for (OutlineId id = 0; id < count; ++id) {
    add_outline(id);
    if (id + 1 == profile_.source_count() && !find_range()) return;
  }
  for (const std::uint32_t piece : profile_.meeting()) add_meeting(piece);
  for (const std::uint32_t piece : profile_.sheets()) add_sheet(piece);
  if (extent == Extent::kKinks && !may_have_kinks()) return;
  const std::vector<ExactVec3> all = breaks();
  for (std::size_t i = 0; i + 1 < all.size(); ++i) {
    kernel::poll();
    if (turn(all[i], all[i + 1]) > 0) judge_at(all[i], all[i + 1]);
  }
  std::ranges::sort(kinks_);
  kinks_.erase(std::unique(kinks_.begin(), kinks_.end()), kinks_.end());
}

void VertexSight::judge_at(const ExactVec3& begin, const ExactVec3& end) {
  const ExactVec3 t = begin + end;
  active_.clear();
  bool some_source = false;
  for (const Element& element : elements_) {
    if (!is_between(element.from, element.to, t)) continue;
    const bool of_source = element.kind == Element::Kind::kSource;
    if (!of_source && element.side == 0) return;
    some_source = some_source || of_source;
    active_.push_back(&element);
  }
  if (!some_source) return;
  strips_.clear();
  std::vector<std::uint32_t> movers;
  const auto add = [&](const Motion& motion) {
    for (const VertexMotion& one : motion) movers.push_back(one.place);
  };
  bool follows_source = false;
  for (const Element* element : active_) {
    add(element->motion);
    follows_source = follows_source || element->touches;
  }
  for (const Sheet& sheet : sheets_) {
    const std::optional<Strip> strip = strip_of(sheet, t);
    if (!strip) continue;
    strips_.push_back(*strip);
    add(strip->near->motion);
    add(strip->far->motion);
    if (strip->is_cut) movers.insert(movers.end(), sheet.places.begin(), sheet.places.end());
    follows_source = follows_source || strip->is_cut;
  }
  if (follows_source) movers.insert(movers.end(), motions_.source_frame().begin(), motions_.source_frame().end());
  std::ranges::sort(movers);
  movers.erase(std::unique(movers.begin(), movers.end()), movers.end());
  for (const std::uint32_t place : movers) judge_vertex(place, begin, end);
}

// Whether a movement of the vertex lifts an edge in the source's plane from it, or sinks it, or where a sheet meets it.
bool VertexSight::is_concerned(std::uint32_t place, const ExactVec3& begin, const ExactVec3& end) const {
  const auto moves = [&](const Motion& motion) {
    return std::ranges::any_of(motion, [&](const VertexMotion& one) { return one.place == place; });
  };
  bool some = false;
  for (const Element* element : active_) {
    if (!element->touches) continue;
    if (moves(element->motion)) return true;
    some = true;
  }
  for (const Strip& strip : strips_) {
    if (!strip.is_cut) continue;
    if (std::ranges::find(strip.sheet->places, place) != strip.sheet->places.end()) return true;
    some = true;
  }
  if (!some) return false;
  for (int corner = 0; corner < 3; ++corner) {
    const RationalVec3& share = motions_.source_share(corner);
    const bool rests = sign(dot(share, to_rational(begin))) == 0 && sign(dot(share, to_rational(end))) == 0;
    if (motions_.source_frame()[corner] == place && !rests) return true;
  }
  return false;
}

namespace {

// f at both ends of an arc: it is linear in between.
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

Form form_of(const std::vector<VertexMotion>& motion, std::uint32_t place, const RationalVec3& begin,
             const RationalVec3& end) {
  Form f;
  for (const VertexMotion& one : motion) {
    if (one.place == place) f.add({one.turn * dot(one.share, begin), one.turn * dot(one.share, end)}, 1);
  }
  return f;
}

}  // namespace

void VertexSight::judge_vertex(std::uint32_t place, const ExactVec3& begin, const ExactVec3& end) {
  const RationalVec3 p = to_rational(begin), q = to_rational(end), n = to_rational(normal_);
  // The different f.
  std::vector<Form> forms;
  std::vector<const Motion*> motion_of;
  const auto index_of = [&](const Motion& motion) {
    Form f = form_of(motion, place, p, q);
    const auto found = std::ranges::find_if(forms, [&](const Form& other) { return other.equals(f); });
    if (found != forms.end()) return static_cast<std::size_t>(found - forms.begin());
    forms.push_back(std::move(f));
    motion_of.push_back(&motion);
    return forms.size() - 1;
  };
  struct Place {
    const Element* element;
    std::size_t at;
  };
  std::vector<Place> lines;
  for (const Element* element : active_) {
    lines.push_back({element, element->side == 0 || element->motion.empty() ? 0 : index_of(element->motion)});
  }
  std::vector<std::pair<std::size_t, std::size_t>> strips;
  for (const Strip& strip : strips_) strips.emplace_back(index_of(strip.near->motion), index_of(strip.far->motion));
  if (forms.empty()) return;

  enum class Touching { kAsNow, kAll, kNone };
  const auto change = [&](const std::vector<std::size_t>& rank, Touching touching) {
    const std::size_t count = forms.size();
    const auto is_visible = [&](std::size_t slot) {  // between the ranks slot - 1 and slot
      bool source = false;
      for (const auto& [element, at] : lines) {
        const bool above = rank[at] < slot;
        const bool inside = element->side == 0 || (element->side > 0) == above;
        if (element->kind == Element::Kind::kSource) {
          source = source || inside;
          continue;
        }
        const bool counts =
            !element->touches || touching == Touching::kAsNow ? element->present : touching == Touching::kAll;
        if (counts && inside) return false;
      }
      for (std::size_t s = 0; s < strips.size(); ++s) {
        if (strips_[s].is_cut && touching == Touching::kNone) continue;
        const auto [low, high] = std::minmax(rank[strips[s].first], rank[strips[s].second]);
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
  const std::size_t count = forms.size();
  constexpr std::size_t kMost = 6;
  std::vector<std::vector<std::size_t>> ranks;
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  const bool scalar =
      std::ranges::all_of(forms, [&](const Form& f) { return is_zero(cross(f.begin, n)) && is_zero(cross(f.end, n)); });
  const auto add_order = [&] {
    std::vector<std::size_t>& rank = ranks.emplace_back(count);
    for (std::size_t i = 0; i < count; ++i) rank[order[i]] = i;
  };
  if (scalar) {
    const auto in_the_middle = [&](std::size_t i) { return dot(forms[i].begin + forms[i].end, n); };
    std::ranges::sort(order, {}, in_the_middle);
    add_order();
    std::ranges::reverse(order);
    add_order();
  } else if (count > kMost) {
    kinks_.push_back(place);
    return;
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
  for (const std::vector<std::size_t>& rank : ranks) {
    for (const Touching touching : {Touching::kAsNow, Touching::kAll, Touching::kNone}) {
      if (touching != Touching::kAsNow && !concerned) continue;
      const Change other = change(rank, touching);
      if (other.below == first.below && other.above == first.above && total(other).equals(result)) continue;
      kinks_.push_back(place);
      return;
    }
  }
  if (result.equals({})) return;
  for (std::size_t i = 0; i < count; ++i) {
    if (first.counts[i] == 0) continue;
    for (const VertexMotion& one : *motion_of[i]) {
      if (one.place != place) continue;
      arcs_.push_back({place, {begin, end, one.share}, one.turn * Rational(first.counts[i])});
    }
  }
}

}  // namespace exactff::gradient
