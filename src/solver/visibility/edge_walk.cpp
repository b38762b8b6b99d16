#include "visibility/edge_walk.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/poll.h"
#include "scene/closed_surfaces.h"
#include "scene/scene_data.h"
#include "visibility/plane_frame.h"

namespace exactff::visibility {

using kernel::Approx3;
using kernel::kUncertain;
using kernel::Rational;
using kernel::Ring;

namespace {

constexpr unsigned kSidePlanesBeforeEdges = 2;
constexpr std::uint64_t kCandidatesPerPoll = 1'024;
constexpr Sides kInside{.certain = true, .some_above_each = true, .all_above_each = true};

double largest(const Approx3& a) { return std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z)}); }

class EdgeWalk {
 public:
  EdgeWalk(const View& view, const SourcePlane& plane, const Request& request, EdgeWorkspace& workspace)
      : view_(view),
        plane_(plane),
        request_(request),
        pieces_(view.scene.pieces()),
        vertices_(view.scene.vertices()),
        surfaces_(closed_surfaces(view.scene)),
        work_(workspace),
        outlines_(work_.edges.outlines()) {}

  std::optional<PlaneVisibility> run() {
    result_.record.outcome = find_outcome();
    if (gave_up_) return std::nullopt;
    if (request_.fraction) result_.fraction = fraction();
    return std::move(result_);
  }

 private:
  Outcome find_outcome();
  bool gather_source();
  bool add_above_horizon(const Piece& piece);
  [[nodiscard]] int horizon_side(CornerId corner);
  // Whether a proof that all is hidden may end the search before every candidate has been looked at.
  [[nodiscard]] bool may_stop_early() const { return culls() && !request_.list_cutters; }
  [[nodiscard]] bool hidden_by_few();
  [[nodiscard]] bool hidden_as_before();
  void add_if_between(const Piece& piece);
  [[nodiscard]] bool one_hides_all();
  void note_pairs();
  bool gather_occluders();
  [[nodiscard]] bool culls() const { return request_.culling == ShaftCulling::kTree; }
  void start_run();
  bool visit(std::uint32_t piece, OutlineId source, bool inside);
  void find_corners(std::span<const std::uint32_t> vertices) { outlines_.corners_of(vertices, work_.corners); }
  [[nodiscard]] Sides sides(OutlineId source);
  [[nodiscard]] bool is_left_out(std::uint32_t piece, int facing);
  [[nodiscard]] bool may_leave_out_backs(std::uint32_t surface) const;
  [[nodiscard]] bool has_piece_in(const Face& face, std::uint32_t surface) const;
  void make_shaft(OutlineId source);
  void make_side_planes(OutlineId source);
  [[nodiscard]] Sides sides_by_filter();
  [[nodiscard]] Sides sides_exactly(OutlineId source);
  [[nodiscard]] int depth_sign(std::uint32_t vertex) const;
  [[nodiscard]] int toward_sign(CornerId corner);
  [[nodiscard]] int facing(const Piece& piece) const;
  void find_depths();
  OutlineId add_occluder(std::span<const std::uint32_t> vertices, bool is_cut, bool mirrored);
  OutlineId add_part_above(Outlines::Plane plane, std::span<const std::uint32_t> vertices, bool mirrored);
  [[nodiscard]] Rational fraction();

  const View& view_;
  const SourcePlane& plane_;
  const Request& request_;
  const std::span<const Piece> pieces_;
  const std::span<const Vec3> vertices_;
  const ClosedSurfaces& surfaces_;
  EdgeWorkspace& work_;
  Outlines& outlines_;
  PlaneVisibility result_;
  std::size_t source_count_ = 0;
  bool gave_up_ = false;
  bool gathered_all_ = true;  // the receiver lies on none of the source's faces
};

Outcome EdgeWalk::find_outcome() {
  // 1. Cull.
  if (std::none_of(plane_.pieces.begin(), plane_.pieces.end(),
                   [&](std::uint32_t p) { return !view_.is_own(pieces_[p].face); })) {
    return Outcome::kReceiverFace;
  }
  if (side_of(plane_, view_.x) <= 0) return Outcome::kBehind;
  // 2. Clip by the receiver's horizon.
  if (!gather_source()) return Outcome::kBelowHorizon;
  if (hidden_as_before()) return Outcome::kHiddenByUnion;
  // 3. and 5. Candidates in the shaft.
  PlaneRecord& record = result_.record;
  if (!gather_occluders()) {
    record.cover = 1;
    return Outcome::kHiddenByOne;
  }
  // 4., 6. and 7. Find the visible parts of every edge, unless a few occluders hide them all.
  const bool hidden = hidden_by_few();
  gave_up_ = !hidden && !work_.edges.find(source_count_);
  result_.boundary = VisibleBoundary(work_.edges);
  note_pairs();
  record.edges = work_.edges.parts().size();
  record.source_joined = source_count_ > 1;
  if (record.candidates == 0) return Outcome::kUnoccluded;
  if (!result_.boundary.empty()) return Outcome::kPartlyHidden;
  record.cover = hidden ? work_.edges.cover().size() : record.candidates;
  return Outcome::kHiddenByUnion;
}

void EdgeWalk::note_pairs() {
  result_.record.pairs = work_.edges.pairs();
  result_.record.undecided_pairs = work_.edges.undecided_pairs();
}

// By candidates that are gathered.
bool EdgeWalk::hidden_by_few() {
  if (!may_stop_early() || work_.outline_pieces.size() < request_.fewest_to_cover) return false;
  if (!work_.edges.find_cover(source_count_)) return false;
  if (request_.remembers_covers) {
    const auto piece_of = [&](OutlineId o) { return work_.outline_pieces[o - source_count_]; };
    work_.covers.set(plane_.pieces.front(), work_.edges.cover(), piece_of);
  }
  return true;
}

// By the pieces that hid the plane from the receiver before, and by no single one. If not, nothing has changed.
bool EdgeWalk::hidden_as_before() {
  const auto remembered = work_.covers.of(plane_.pieces.front());
  if (remembered.empty() || !request_.remembers_covers || !may_stop_early()) return false;
  for (const std::uint32_t index : remembered) {
    if (index < pieces_.size() && may_occlude(view_, plane_, request_, index)) add_if_between(pieces_[index]);
  }
  PlaneRecord record = result_.record;
  record.cover_remembered = true;
  record.source_joined = source_count_ > 1;
  record.cover = record.candidates = record.tree_candidates = outlines_.outlines().size() - source_count_;
  if (record.cover > 0 && work_.edges.all_cover(source_count_) && !one_hides_all()) {
    result_.record = std::move(record);
    note_pairs();
    return true;
  }
  work_.covers.forget(plane_.pieces.front());
  result_ = {};
  source_count_ = 0;
  (void)gather_source();
  return false;
}

// Adds the part of the piece between x and the source's plane, if there is any.
void EdgeWalk::add_if_between(const Piece& piece) {
  const auto vertices = view_.scene.corners(piece);
  find_corners(vertices);
  find_depths();
  const auto some = [](const auto& of, const auto& is_so) { return std::any_of(of.begin(), of.end(), is_so); };
  if (!some(work_.depths, [](int depth) { return depth > 0; })) return;
  if (!some(work_.corners, [&](CornerId corner) { return toward_sign(corner) > 0; })) return;
  const int facing = this->facing(piece);
  if (facing == 0) return;
  const bool is_cut = some(work_.depths, [](int depth) { return depth < 0; });
  if (is_cut) ++result_.record.clipped;
  add_occluder(vertices, is_cut, facing > 0);
}

bool EdgeWalk::one_hides_all() {
  start_run();
  make_shaft(0);
  for (std::size_t side = 0; side < outlines_.outline(0).count; ++side) {
    HalfSpace other = work_.half_spaces[2 * side];
    other.normal = {-other.normal.x, -other.normal.y, -other.normal.z};
    work_.half_spaces.insert(work_.half_spaces.begin(), other);
  }
  work_.shaft.set(work_.half_spaces);
  make_side_planes(0);
  bool hidden = false;
  for_each_candidate(view_, work_.shaft, request_.culling, [&](std::uint32_t piece, bool /*inside*/) {
    hidden = visit(piece, 0, false);
    return !hidden;
  });
  return hidden;
}

bool EdgeWalk::gather_source() {
  outlines_.start(view_.scene, view_.x, largest(kernel::approx_difference(plane_.point, view_.x)));
  outlines_.set_source_plane(plane_.normal.exact, plane_.fine_normal, plane_.point);
  for (const std::uint32_t index : plane_.pieces) {
    const Piece& piece = pieces_[index];
    if (view_.is_own(piece.face)) {
      gathered_all_ = false;
    } else if (add_above_horizon(piece)) {
      ++source_count_;
    }
  }
  return source_count_ > 0;
}

int EdgeWalk::horizon_side(CornerId corner) {
  const int filtered = outlines_.side_by_filter({view_.n.x, view_.n.y, view_.n.z}, corner);
  if (filtered != kUncertain) return filtered;
  return kernel::exact_sign_of_dot(view_.n, {view_.x, vertices_[*outlines_.vertex(corner)]});
}

// False if nothing with an interior is left.
bool EdgeWalk::add_above_horizon(const Piece& piece) {
  const auto vertices = view_.scene.corners(piece);
  find_corners(vertices);
  work_.depths.clear();
  for (const CornerId corner : work_.corners) work_.depths.push_back(horizon_side(corner));
  const auto some = [&](const auto& is_so) { return std::any_of(work_.depths.begin(), work_.depths.end(), is_so); };
  const bool above = some([](int depth) { return depth > 0; }), below = some([](int depth) { return depth < 0; });
  if (below || !above) result_.record.horizon_clipped = true;
  if (!above) return false;
  if (below) {
    outlines_.set_horizon(view_.n);
    add_part_above(Outlines::Plane::kHorizon, vertices, false);
  } else {
    outlines_.add(work_.corners, true);
  }
  return true;
}

// Half-spaces for the tree. The components of an edge's normal err by less than 12u |a||b| = 2^-49.4 |a||b|
// (outlines.h).
void EdgeWalk::make_shaft(OutlineId source) {
  work_.half_spaces.clear();
  const Outlines::Outline& outline = outlines_.outline(source);
  for (EdgeId id = outline.first; id < outline.first + outline.count; ++id) {
    const Outlines::Edge& edge = outlines_.edge(id);
    work_.half_spaces.push_back(
        {edge.normal, 0.0, 0x1p-49 * outlines_.corner(edge.a).size * outlines_.corner(edge.b).size});
  }
  const Approx3& front = plane_.normal.approx;
  work_.half_spaces.push_back({{-front.x, -front.y, -front.z}, 0.0});
  // front . (y - x) >= front . (point - x), a negative number that errs by less than 2^-49 of its terms' magnitudes.
  const Approx3 s = kernel::approx_difference(plane_.point, view_.x);
  const double terms[] = {front.x * s.x, front.y * s.y, front.z * s.z};
  const double magnitude = std::abs(terms[0]) + std::abs(terms[1]) + std::abs(terms[2]);
  work_.half_spaces.push_back(
      {to_vec3(front), terms[0] + terms[1] + terms[2] - 0x1p-48 * magnitude, 0.0, 0x1p-47 * magnitude});
  work_.shaft.set(work_.half_spaces);
}

void EdgeWalk::start_run() {
  work_.outline_pieces.clear();
  work_.seen_in.resize(pieces_.size(), 0);
  work_.surfaces.resize(surfaces_.surfaces().size());
  if (++work_.run == 0) {
    std::fill(work_.seen_in.begin(), work_.seen_in.end(), 0U);
    std::fill(work_.surfaces.begin(), work_.surfaces.end(), EdgeWorkspace::Surface{});
    work_.run = 1;
  }
}

// False if one occluder hides all; the other occluders are then not needed.
bool EdgeWalk::gather_occluders() {
  start_run();
  outlines_.watch_for_shared_corners();
  bool hidden = false;
  const OutlineId shafts = culls() ? static_cast<OutlineId>(source_count_) : 1;
  for (OutlineId source = 0; source < shafts && !hidden; ++source) {
    if (culls()) make_shaft(source);
    make_side_planes(source);
    for_each_candidate(view_, work_.shaft, request_.culling, [&](std::uint32_t piece, bool inside) {
      hidden = visit(piece, source, inside);
      if (result_.record.tree_candidates % kCandidatesPerPoll == 0) kernel::poll();
      return !hidden;
    });
  }
  return !hidden;
}

// True if the piece hides all. `inside`: it lies inside every half-space of the shaft, and therefore above all side
// planes.
bool EdgeWalk::visit(std::uint32_t index, OutlineId source, bool inside) {
  if (work_.seen_in[index] == work_.run || !may_occlude(view_, plane_, request_, index)) return false;
  const Piece& piece = pieces_[index];
  const auto vertices = view_.scene.corners(piece);
  ++result_.record.tree_candidates;
  // 3. Only what enters the shaft,
  if (!inside) find_corners(vertices);
  const Sides sides = inside ? kInside : this->sides(source);
  if (!sides.some_above_each) return false;
  work_.seen_in[index] = work_.run;
  const int facing = this->facing(piece);
  if (facing == 0) return false;
  ++result_.record.candidates;
  const bool left_out = is_left_out(index, facing);
  if (left_out && sides.all_above_each) return false;
  // clipped by the source's plane.
  if (sides.some_below_first) ++result_.record.clipped;
  if (inside) find_corners(vertices);
  const OutlineId outline = add_occluder(vertices, sides.some_below_first, facing > 0);
  work_.outline_pieces.push_back(index);
  if (sides.all_above_each && culls()) {
    outlines_.set_inside_source(outline);
    return false;
  }
  outlines_.set_within_lines(outline, sides.wholly_above >> kSidePlanesBeforeEdges);
  // 5. Does it hide all?
  if (work_.edges.hides_all(outline, source_count_)) {
    result_.cutters = {piece.face};
    return true;
  }
  if (left_out) {
    outlines_.remove_last();
    work_.outline_pieces.pop_back();
  }
  return false;
}

bool EdgeWalk::is_left_out(std::uint32_t piece, int facing) {
  if (surfaces_.empty() || surfaces_.of_piece(piece) == ClosedSurfaces::kNone) return false;
  const std::uint32_t id = surfaces_.of_piece(piece);
  const ClosedSurface& surface = surfaces_.surfaces()[id];
  auto& [run, backs_left_out] = work_.surfaces[id];
  if (run != work_.run) {
    run = work_.run;
    backs_left_out = may_leave_out_backs(id);
  }
  return backs_left_out && (facing > 0) != surface.turned_inside_out;
}

// Requires the shaft: its last half-space is x's side of the source's plane.
bool EdgeWalk::may_leave_out_backs(std::uint32_t id) const {
  if (!culls() || request_.only_occluders != nullptr) return false;
  const auto& [low, high] = surfaces_.surfaces()[id].box;
  const Vec3& x = view_.x;
  const bool outside = x.x < low.x || x.y < low.y || x.z < low.z || x.x > high.x || x.y > high.y || x.z > high.z;
  if (!outside || !ShaftTree::certainly_inside({low, high}, x, work_.half_spaces.back())) return false;
  return std::ranges::none_of(view_.on, [&](FaceId own) { return has_piece_in(view_.scene.face(own), id); });
}

bool EdgeWalk::has_piece_in(const Face& face, std::uint32_t surface) const {
  for (std::uint32_t piece = face.first_piece; piece < face.first_piece + face.piece_count; ++piece) {
    if (surfaces_.of_piece(piece) == surface) return true;
  }
  return false;
}

// An occluder must have some part above each of these planes: the source's plane (above is its front), the parallel
// plane through x (above is towards the source), and the planes through x and the edges of the source. Without culling,
// only the first two are used, because outlines rely on them; pieces outside the shaft are then found edge by edge.
//
// With N and s the normal and a point of the source's plane, as seen from x, the components of N, s and t are known to
// within a relative error of 2u, u = 2^-53, |N| <= 1. The two sums N . t and N . s err by 7u of the magnitudes of their
// terms, at most 3 |t| and 3 |s|, and their difference by u of at most 3 (|t| + |s|) more: in all by
// 24u (|t| + |s|) < 2^-48 (|t| + |s|).
void EdgeWalk::make_side_planes(OutlineId source) {
  work_.side_planes.clear();
  const Approx3& front = plane_.normal.approx;
  const double scale = std::ldexp(1.0, outlines_.scale_exponent());
  const Approx3 d = kernel::approx_difference(plane_.point, view_.x);
  const Approx3 s{scale * d.x, scale * d.y, scale * d.z};  // scaled first: products of unscaled numbers may underflow
  const double size = largest(s);
  const bool usable = size >= 0x1p-300 && size <= 0x1p300;
  const double offset = front.x * s.x + front.y * s.y + front.z * s.z;
  work_.side_planes.push_back(
      {to_vec3(front), offset, 0x1p-48, usable ? 0x1p-48 * size : std::numeric_limits<double>::infinity()});
  work_.side_planes.push_back({{-front.x, -front.y, -front.z}, 0.0, 0x1p-48, 0.0});
  if (!culls()) return;
  const Outlines::Outline& outline = outlines_.outline(source);
  for (EdgeId id = outline.first; id < outline.first + outline.count; ++id) {
    const Outlines::Edge& edge = outlines_.edge(id);
    work_.side_planes.push_back({edge.normal, 0.0, edge.error, 0.0});
  }
}

Sides EdgeWalk::sides(OutlineId source) {
  const Sides sides = sides_by_filter();
  return sides.certain ? sides : sides_exactly(source);
}

Sides EdgeWalk::sides_by_filter() {
  constexpr std::size_t kFour = 4;
  if (work_.corners.size() > kFour) return {};
  FourCorners four;
  for (std::size_t c = 0; c < kFour; ++c) {
    four[c] = &outlines_.corner(work_.corners[std::min(c, work_.corners.size() - 1)]);
  }
  return sides_of(work_.side_planes, four);
}

Sides EdgeWalk::sides_exactly(OutlineId source) {
  Sides sides{true, true, true, false, 0};
  const std::size_t n = work_.corners.size();
  const auto look = [&](const auto& side) {  // the side of the c-th corner
    std::size_t above = 0;
    for (std::size_t c = 0; c < n; ++c) above += side(c) > 0 ? 1U : 0U;
    sides.some_above_each = sides.some_above_each && above > 0;
    sides.all_above_each = sides.all_above_each && above == n;
  };
  find_depths();
  sides.some_below_first = std::any_of(work_.depths.begin(), work_.depths.end(), [](int depth) { return depth < 0; });
  look([&](std::size_t c) { return work_.depths[c]; });
  look([&](std::size_t c) { return toward_sign(work_.corners[c]); });
  if (!culls()) return sides;
  const Outlines::Outline& outline = outlines_.outline(source);
  for (EdgeId id = outline.first; id < outline.first + outline.count && sides.some_above_each; ++id) {
    look([&](std::size_t c) { return outlines_.side(outlines_.edge(id), work_.corners[c]); });
  }
  return sides;
}

void EdgeWalk::find_depths() {
  work_.depths.clear();
  for (const CornerId corner : work_.corners) work_.depths.push_back(depth_sign(*outlines_.vertex(corner)));
}

// +1: on x's side of the source's plane.
int EdgeWalk::depth_sign(std::uint32_t vertex) const {
  const Vec3& v = vertices_[vertex];
  const int filtered = kernel::sign_of_dot(plane_.normal.approx, kernel::approx_difference(v, plane_.point));
  return filtered != kUncertain ? filtered : kernel::orientation(plane_.point, plane_.second, plane_.third, v);
}

// +1: ahead of the plane through x that is parallel to the source's.
int EdgeWalk::toward_sign(CornerId corner) {
  const int filtered = outlines_.side_by_filter(plane_.normal.approx, corner);
  if (filtered != kUncertain) return -filtered;
  const Vec3& v = vertices_[*outlines_.vertex(corner)];
  return -kernel::exact_sign_of_det({plane_.point, plane_.second}, {plane_.point, plane_.third}, {view_.x, v});
}

// The sign of det of three corners, 0 where the piece's plane holds x.
int EdgeWalk::facing(const Piece& piece) const {
  const auto vertex = [&](int f) -> const Vec3& { return vertices_[piece.frame[f]]; };
  const auto rounded = [&](int f) { return kernel::approx_difference(vertex(f), view_.x); };
  const int filtered = kernel::sign_of_det(rounded(0), rounded(1), rounded(2));
  return filtered != kUncertain ? filtered : kernel::orientation(view_.x, vertex(0), vertex(1), vertex(2));
}

// The part of the current piece on x's side of the source's plane.
OutlineId EdgeWalk::add_occluder(std::span<const std::uint32_t> vertices, bool is_cut, bool mirrored) {
  if (is_cut) {
    find_depths();
    return add_part_above(Outlines::Plane::kSource, vertices, mirrored);
  }
  if (mirrored) std::reverse(work_.corners.begin(), work_.corners.end());
  return outlines_.add(work_.corners, true);
}

// The part where depths are not negative.
OutlineId EdgeWalk::add_part_above(Outlines::Plane plane, std::span<const std::uint32_t> vertices, bool mirrored) {
  const std::size_t n = vertices.size();
  work_.ring.clear();
  for (std::size_t c = 0; c < n; ++c) {
    const std::size_t next = (c + 1) % n;
    if (work_.depths[c] >= 0) work_.ring.push_back(work_.corners[c]);
    if (work_.depths[c] * work_.depths[next] < 0) {
      work_.ring.push_back(outlines_.add_crossing(plane, vertices[c], vertices[next]));
    }
  }
  if (mirrored) std::reverse(work_.ring.begin(), work_.ring.end());
  return outlines_.add(work_.ring, false);
}

Rational EdgeWalk::fraction() {
  if (result_.boundary.empty()) return 0;
  if (result_.record.outcome == Outcome::kUnoccluded && !result_.record.horizon_clipped && gathered_all_) return 1;
  std::vector<Ring> source;
  for (OutlineId o = 0; o < source_count_; ++o) {
    Ring& ring = source.emplace_back();
    const Outlines::Outline& outline = outlines_.outline(o);
    for (EdgeId id = outline.first; id < outline.first + outline.count; ++id) {
      ring.push_back(kernel::make_direction(outlines_.exact(outlines_.edge(id).a)));
    }
  }
  const PlaneFrame frame(plane_.normal.exact, source);
  Rational doubled;
  result_.boundary.for_each_piece([&](const BoundaryPiece& piece) {
    kernel::poll();
    const Point2 p = frame.to_plane(piece.a * piece.begin.l + piece.b * piece.begin.m);
    const Point2 q = frame.to_plane(piece.a * piece.end.l + piece.b * piece.end.m);
    doubled += p.u * q.v - q.u * p.v;
  });
  if (!frame.keeps_orientation()) doubled = -doubled;
  return share_of_source(view_, plane_, frame, doubled);
}

}  // namespace

std::optional<PlaneVisibility> find_by_edges(const View& view, const SourcePlane& plane, const Request& request,
                                             EdgeWorkspace& workspace) {
  return EdgeWalk(view, plane, request, workspace).run();
}

}  // namespace exactff::visibility
