#include "visibility/silhouettes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "kernel/expect.h"
#include "kernel/poll.h"
#include "scene/edges.h"
#include "scene/scene.h"
#include "scene/shaft_tree.h"

namespace exactff::visibility {

using Edge = Outlines::Edge;

namespace {

constexpr std::uint64_t kEdgesPerPoll = 4'096;

bool some_positive(const std::vector<int>& depths) {
  return std::ranges::any_of(depths, [](int depth) { return depth > 0; });
}

}  // namespace

bool searches_silhouettes(const PlaneQuery& query) {
  if (!query.plane.covers.empty()) return false;
  constexpr double kLeastSaving = 4.0;
  const BoundaryRequest& request = query.request;
  if (request.silhouettes == Silhouetting::kNever || !request.culls() || request.only_occluders != nullptr)
    return false;
  return request.silhouettes == Silhouetting::kAlways || edges_per_silhouette(query.view.scene) >= kLeastSaving;
}

Silhouettes::Silhouettes(const PlaneQuery& query, Outlines& outlines, SilhouetteMemory& memory)
    : query_(query),
      outlines_(outlines),
      memory_(memory),
      clip_(query, outlines, memory.clip),
      shaft_(query, clip_, outlines, memory.shaft),
      edges_(scene_edges(query.view.scene)) {}

void Silhouettes::gather(std::size_t source_count, PlaneRecord& record) {
  const Scene& scene = query_.view.scene;
  record_ = &record;
  first_ = static_cast<EdgeId>(outlines_.edges().size());
  some_edge_on_ = false;
  memory_.jumps.clear();
  memory_.cut_rings.clear();
  memory_.crossings.clear();
  memory_.known_edges.clear(edges_.size());
  memory_.known_pieces.clear(scene.pieces().size());
  memory_.facing.resize(scene.pieces().size());
  for (OutlineId source = 0; source < source_count; ++source) {
    shaft_.set(source);
    // The front of the source's plane in a group of its own.
    constexpr HalfSpace kEverything{{}, -1.0};
    std::vector<HalfSpace>& order = memory_.order;
    order = {shaft_.front(), kEverything, kEverything, kEverything};
    const auto others = shaft_.half_space_list();
    order.insert(order.end(), others.begin(), others.end() - 1);
    memory_.groups.set(order);
    edges_.query(query_.view.x, memory_.groups, [&](std::uint32_t edge, bool in_front) { visit(edge, in_front); });
  }
  for (const PlaneId plane : query_.view.own.planes()) {
    const auto own = query_.view.own.pieces_in(plane);
    if (facing_of(query_.view, scene.pieces()[own.front()]) == 0) continue;  // on neither side of any edge
    for (const std::uint32_t piece : own) visit_edges_of(scene.pieces()[piece]);
  }
  for (const std::uint32_t piece : query_.plane.pieces) visit_edges_of(scene.pieces()[piece]);
}

void Silhouettes::visit_edges_of(const Piece& piece) {
  if (piece.transparent) return;
  for (const std::uint32_t edge : edges_.of_piece(piece)) visit(edge, false);
}

void Silhouettes::visit(std::uint32_t scene_edge, bool in_front) {
  if (memory_.known_edges.is_set(scene_edge)) return;
  memory_.known_edges.set(scene_edge);
  if (++record_->tree_edges % kEdgesPerPoll == 0) kernel::poll();
  int jump = 0;
  for (const EdgeUse& use : edges_.uses(scene_edge)) {
    const int facing = facing_of_piece(use.piece(), in_front);
    jump += use.upwards() ? facing : -facing;
  }
  if (jump == 0) return;
  const SceneEdge& edge = edges_.edge(scene_edge);
  if (in_front) {
    add(outlines_.corner_at(edge.a), outlines_.corner_at(edge.b), jump);
    return;
  }
  const int depth_a = clip_.depth_sign(edge.a), depth_b = clip_.depth_sign(edge.b);
  if (depth_a + depth_b < 0 || (depth_a == 0 && depth_b < 0)) return;
  const CornerId a = depth_a < 0 ? crossing(edge.a, edge.b) : outlines_.corner_at(edge.a);
  const CornerId b = depth_b < 0 ? crossing(edge.a, edge.b) : outlines_.corner_at(edge.b);
  add(a, b, jump);
}

void Silhouettes::add(CornerId a, CornerId b, int jump) {
  outlines_.add_edge(a, b);
  memory_.jumps.push_back(jump);
}

CornerId Silhouettes::crossing(std::uint32_t p, std::uint32_t q) {
  const auto place = places(query_.view.scene);
  const std::uint32_t low = std::min(place[p], place[q]), high = std::max(place[p], place[q]);
  const auto [at, is_new] = memory_.crossings.try_emplace(std::uint64_t{high} << 32U | low);
  if (is_new) at->second = outlines_.add_crossing(Outlines::Plane::kSource, low, high);
  return at->second;
}

int Silhouettes::facing(std::uint32_t piece) { return facing_of_piece(piece, false); }

// `in_front`: the piece certainly lies on x's side of the source's plane.
int Silhouettes::facing_of_piece(std::uint32_t index, bool in_front) {
  std::int8_t& known = memory_.facing[index];
  if (memory_.known_pieces.is_set(index)) return known;
  memory_.known_pieces.set(index);
  known = 0;
  if (!may_occlude(query_.view, query_.plane, query_.request, index)) return 0;
  const Piece& piece = query_.view.scene.pieces()[index];
  const int facing = facing_of(query_.view, piece);
  if (facing == 0) {
    if (!in_front) find_depths(piece);
    some_edge_on_ = some_edge_on_ || in_front || some_positive(memory_.clip.depths);
    return 0;
  }
  if (!in_front && !is_before_source(piece, index, facing)) return 0;
  ++record_->candidates;
  known = static_cast<std::int8_t>(facing);
  return facing;
}

void Silhouettes::find_depths(const Piece& piece) {
  std::vector<int>& depths = memory_.clip.depths;
  depths.clear();
  for (const std::uint32_t corner : query_.view.scene.corners(piece)) depths.push_back(clip_.depth_sign(corner));
}

// Whether a part of the piece is. If that is not all of it, cuts it.
bool Silhouettes::is_before_source(const Piece& piece, std::uint32_t index, int facing) {
  find_depths(piece);
  const std::vector<int>& depths = memory_.clip.depths;
  if (!some_positive(depths)) return false;
  if (std::ranges::any_of(depths, [](int depth) { return depth < 0; })) add_cut(piece, index, facing);
  return true;
}

void Silhouettes::add_cut(const Piece& piece, std::uint32_t index, int facing) {
  const auto corners = query_.view.scene.corners(piece);
  const std::vector<int>& depths = memory_.clip.depths;
  std::vector<CornerId>& ring = memory_.cut_rings[index];
  std::vector<std::size_t> on_plane;  // places in the ring
  for (std::size_t c = 0; c < corners.size(); ++c) {
    const std::size_t next = (c + 1) % corners.size();
    if (depths[c] >= 0) {
      if (depths[c] == 0) on_plane.push_back(ring.size());
      ring.push_back(outlines_.corner_at(corners[c]));
    }
    if (depths[c] * depths[next] < 0) {
      on_plane.push_back(ring.size());
      ring.push_back(crossing(corners[c], corners[next]));
    }
  }
  ++record_->clipped;
  // The ring has two corners on the plane, next to one another; the cut runs from the first to the second.
  const std::size_t first = (on_plane[0] + 1) % ring.size() == on_plane[1] ? on_plane[0] : on_plane[1];
  add(ring[first], ring[(first + 1) % ring.size()], facing);
}

std::span<const CornerId> Silhouettes::corners_of(std::uint32_t index) {
  if (const auto cut = memory_.cut_rings.find(index); cut != memory_.cut_rings.end()) return cut->second;
  outlines_.corners_of(query_.view.scene.corners(query_.view.scene.pieces()[index]), memory_.clip.corners);
  return memory_.clip.corners;
}

// --- Occluder count ---

Approx3 between(const Outlines::Corner& a, const Outlines::Corner& b, double t) {
  const double l = 1.0 - t;
  return {l * a.t.x + t * b.t.x, l * a.t.y + t * b.t.y, l * a.t.z + t * b.t.z};
}

namespace {

// Two directions about orthogonal to d and to each other, with components of at most 1.
void find_axes(const Approx3& d, Approx3& u, Approx3& v) {
  const double x = std::abs(d.x), y = std::abs(d.y), z = std::abs(d.z);
  u = x <= y && x <= z ? Approx3{0.0, -d.z, d.y} : y <= z ? Approx3{d.z, 0.0, -d.x} : Approx3{-d.y, d.x, 0.0};
  const auto normalise = [](Approx3& a) {
    const double size = kernel::max_norm(a);
    a = {a.x / size, a.y / size, a.z / size};
  };
  normalise(u);
  v = {d.y * u.z - d.z * u.y, d.z * u.x - d.x * u.z, d.x * u.y - d.y * u.x};
  normalise(v);
}

}  // namespace

std::optional<OccluderCount::Counts> OccluderCount::beside(EdgeId id, double t) {
  const Edge edge = outlines_.edge(id);
  const Outlines::Corner &a = outlines_.corner(edge.a), &b = outlines_.corner(edge.b);
  const Approx3 d = between(a, b, t);
  const double size = kernel::max_norm(d);
  if (!(a.size == a.size && b.size == b.size && size > 0.0)) return std::nullopt;
  // The point lies within 2^-49 (|a| + |b|) of d. For a vector u with components of at most 1, u . p is below `error`
  // |p|, and u less (u . p) p / |p|^2 is a normal that is orthogonal to p.
  Approx3 u, v;
  find_axes(d, u, v);
  const double error = 0x1p-45 * (a.size + b.size) / size;
  const Vec3 n{u.x, u.y, u.z}, m{v.x, v.y, v.z};
  const auto turned = [](const Vec3& w) { return Vec3{-w.x, -w.y, -w.z}; };
  const std::array<HalfSpace, 6> around{{{n, 0.0, error},
                                         {turned(n), 0.0, error},
                                         {m, 0.0, error},
                                         {turned(m), 0.0, error},
                                         silhouettes_.front(),
                                         silhouettes_.toward()}};
  const HalfSpaceGroups ray(around);
  Counts counts;
  bool clear = true;
  const std::size_t edges = outlines_.edges().size();
  shaft_tree(query_.view.scene).query_with_inside(query_.view.x, ray, [&](std::uint32_t piece, bool /*inside*/) {
    const int facing = silhouettes_.facing(piece);
    if (facing == 0) return true;
    const std::optional<int> side = sides_of(piece, facing, id, t);
    clear = side.has_value() && outlines_.edges().size() == edges;
    if (!clear) return false;
    counts.left += (*side & 1) != 0 ? 1 : 0;
    counts.right += (*side & 2) != 0 ? 1 : 0;
    return true;
  });
  return clear ? std::optional(counts) : std::nullopt;
}

// What the piece covers beside the point: 1 on its left, 2 on its right. Nullopt if doubles do not tell.
std::optional<int> OccluderCount::sides_of(std::uint32_t piece, int facing, EdgeId id, double t) {
  const Edge edge = outlines_.edge(id);
  const auto corners = silhouettes_.corners_of(piece);
  const double l = 1.0 - t;
  int covered = 3;
  for (std::size_t c = 0; c < corners.size(); ++c) {
    const CornerId from = corners[c], to = corners[c + 1 == corners.size() ? 0 : c + 1];
    const Edge line = outlines_.line_through(from, to);
    const Height a = outlines_.height(line, edge.a), b = outlines_.height(line, edge.b);
    const double first = l * a.value, second = t * b.value, height = first + second;
    const double error = l * a.error + t * b.error + 0x1p-50 * (std::abs(first) + std::abs(second));
    int side = height > error ? 1 : height < -error ? -1 : 0;
    if (side == 0) {
      const int side_a = outlines_.side(line, edge.a), side_b = outlines_.side(line, edge.b);
      if (side_a * side_b < 0) return std::nullopt;
      side = side_a != 0 ? side_a : side_b;
    }
    if (side * facing > 0) return 0;
    if (side != 0) continue;
    // The piece's side lies along the edge: the piece is where its other corners are.
    int other = 0;
    for (std::size_t k = 0; k < corners.size() && other == 0; ++k) other = outlines_.side(edge, corners[k]);
    covered &= other > 0 ? 1 : 2;
  }
  return covered;
}

// --- Silhouette walk ---

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
  for_each_rest(edge, {begin, end}, off_, [&](const Interval& rest) {
    parts_.push_back(kind > 0 ? Part{edge, rest.begin, rest.end} : Part{edge, rest.end, rest.begin});
  });
}

}  // namespace exactff::visibility
