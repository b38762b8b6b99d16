// The visible boundary: by the edge engine below, or by the Booleans (boolean_walk.h).
//
// The edge engine works by predicates alone. A corner is constructed only where an edge crosses the
// horizon or the source's plane (source_plane.h).
//
// Steps 1 to 7 of the exact method (src/README.md), stopping as soon as nothing is left:
//   1. cull: x behind or in the plane, or nothing above the horizon;
//   2. clip the pieces that the receiver's horizon cuts (source_shaft.h);
//   3. try those that hid the plane from the receiver before, if the caller allows it;
//   4. find candidates in the shaft;
//   5. stop if one of them hides all;
//   6. try a few that may hide all together;
//   7. cut the edges: find the visible parts of each (visible_edges.h).
#include "visibility/visible_boundary.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>

#include "kernel/expect.h"
#include "kernel/poll.h"
#include "scene/closed_surfaces.h"
#include "scene/panels.h"
#include "visibility/boolean_walk.h"
#include "visibility/polygon_sets.h"
#include "visibility/source_shaft.h"

namespace exactff::visibility {
namespace {

// --- Backs of closed surfaces ---

// Which pieces of closed surfaces are left out because they show x their backs.
//
// Let x lie outside the box of a closed surface (closed_surfaces.h) all of whose pieces may occlude or are seen
// edge-on, and let the box lie on x's side of the source's plane, off it. Along almost every segment from x to a point
// y of that plane the winding number goes up by one at each piece that is crossed from the front, down by one at each
// that is crossed from the back, and is 0 at both ends, which lie outside the box. So as many pieces are crossed from
// the front as from the back. The pieces that show x their backs cover the same region as the pieces that show x their
// fronts, up to a set of area zero, and either set may be left out. All pieces remain candidates, and each may still
// hide all.

class SurfaceBacks {
 public:
  SurfaceBacks(const PlaneQuery& query, const SourceShaft& shaft, BacksMemory& memory)
      : query_(query),
        shaft_(shaft),
        surfaces_(closed_surfaces(query.view.scene)),
        panels_(*query.plane.scene_panels),
        memory_(memory) {}

  void start();
  // `facing`: facing_of the panel. Requires the shaft of an outline.
  [[nodiscard]] bool is_left_out(PanelId panel, int facing) {
    if (surfaces_.empty()) return false;
    const std::uint32_t surface = surface_of(panel);
    if (surface == ClosedSurfaces::kNone) return false;
    return backs_left_out(surface) && (facing > 0) != surfaces_.surfaces()[surface].turned_inside_out;
  }

 private:
  [[nodiscard]] std::uint32_t surface_of(PanelId panel) const {
    return panels_.is_joined(panel) ? panels_.sheet_of(panel).surface : surfaces_.of_piece(panel);
  }
  [[nodiscard]] bool backs_left_out(std::uint32_t surface);
  [[nodiscard]] bool may_leave_out_backs(std::uint32_t surface) const;

  const PlaneQuery& query_;
  const SourceShaft& shaft_;
  const ClosedSurfaces& surfaces_;
  const Panels& panels_;
  BacksMemory& memory_;
};

void SurfaceBacks::start() {
  const std::size_t count = surfaces_.surfaces().size();
  memory_.decided.clear(count);
  memory_.left_out.resize(count);
  if (count == 0) return;
  memory_.has_own_piece.clear(count);
  const View& view = query_.view;
  for (const PlaneId plane : view.own.planes()) {
    const auto own = view.own.pieces_in(plane);
    if (facing_of(view, view.scene.pieces()[own.front()]) == 0) continue;  // x sees them edge-on
    for (const std::uint32_t piece : own) {
      const std::uint32_t surface = surfaces_.of_piece(piece);
      if (surface != ClosedSurfaces::kNone) memory_.has_own_piece.set(surface);
    }
  }
}

bool SurfaceBacks::backs_left_out(std::uint32_t surface) {
  if (!memory_.decided.is_set(surface)) {
    memory_.decided.set(surface);
    memory_.left_out[surface] = may_leave_out_backs(surface) ? 1 : 0;
  }
  return memory_.left_out[surface] != 0;
}

bool SurfaceBacks::may_leave_out_backs(std::uint32_t surface) const {
  const View& view = query_.view;
  if (!query_.request.culls() || query_.request.only_occluders != nullptr) return false;
  const auto& [low, high] = surfaces_.surfaces()[surface].box;
  const Vec3& x = view.x;
  const bool outside = x.x < low.x || x.y < low.y || x.z < low.z || x.x > high.x || x.y > high.y || x.z > high.z;
  if (!outside || !ShaftTree::certainly_inside({low, high}, x, shaft_.front())) return false;
  return !memory_.has_own_piece.is_set(surface);
}

// --- Steps 4 and 5: candidates ---

// Steps 4 and 5 of the exact method, for the edge engine: finds the panels that enter the shaft and adds their
// outlines, unless one of them hides all.
//
// Candidates come from the bounding-volume tree; then signs decide (source_shaft.h). A face that the source's plane
// cuts is clipped, no face is clipped to the shaft, and pieces of closed surfaces that face away from x are left out.

class Candidates {
 public:
  static constexpr std::uint64_t kAny = std::numeric_limits<std::uint64_t>::max();

  // Requires that the first `source_count` outlines of the search are the source's. Counts its work in the record.
  Candidates(const PlaneQuery& query, std::size_t source_count, EdgeSearch& search, PlaneRecord& record)
      : query_(query),
        panels_(*query.plane.scene_panels),
        source_count_(source_count),
        search_(search),
        outlines_(search.edges.outlines()),
        record_(record),
        clip_(query, outlines_, search.clip),
        shaft_(query, clip_, outlines_, search.shaft),
        backs_(query, shaft_, search.backs) {}

  // Adds the outlines of all candidates. If one hides all, returns it; the others are then not needed. Stops
  // after more than `most` candidates: see too_many().
  [[nodiscard]] std::optional<PanelId> gather(std::uint64_t most = kAny);
  [[nodiscard]] bool too_many() const { return too_many_; }
  // Adds the outlines of what buries parts of the source. They lie in its plane, and are no candidates.
  void add_covers();
  // A panel that hides all, if there is one. Looks only at those that may. Adds outlines. Requires culling.
  [[nodiscard]] std::optional<PanelId> one_that_hides_all();

 private:
  void start();
  [[nodiscard]] bool visit(PanelId panel, bool inside);

  const PlaneQuery& query_;
  const Panels& panels_;
  const std::size_t source_count_;
  EdgeSearch& search_;
  Outlines& outlines_;
  PlaneRecord& record_;
  PieceClip clip_;
  SourceShaft shaft_;
  SurfaceBacks backs_;
  bool too_many_ = false;
};

constexpr std::uint64_t kCandidatesPerPoll = 1'024;

void Candidates::start() {
  search_.outline_panels.clear();
  search_.seen.clear(panels_.end());
  backs_.start();
  too_many_ = false;
}

std::optional<PanelId> Candidates::gather(std::uint64_t most) {
  const BoundaryRequest& request = query_.request;
  start();
  outlines_.watch_for_shared_corners();
  std::optional<PanelId> alone;
  const OutlineId shafts = request.culls() ? static_cast<OutlineId>(source_count_) : 1;
  for (OutlineId source = 0; source < shafts && !alone && !too_many_; ++source) {
    shaft_.set(source);
    for_each_panel(query_, shaft_.half_spaces(), [&](PanelId panel, bool inside) {
      if (visit(panel, inside)) alone = panel;
      if (record_.tree_candidates % kCandidatesPerPoll == 0) kernel::poll();
      too_many_ = record_.candidates > most;
      return !alone && !too_many_;
    });
  }
  return alone;
}

void Candidates::add_covers() {
  for (const std::uint32_t cover : query_.plane.covers) {
    clip_.take(query_.view.scene.corners(query_.view.scene.pieces()[cover]));
    (void)clip_.add_occluder(false, facing_of(query_.view, query_.view.scene.pieces()[cover]));
    search_.outline_panels.push_back(cover);
  }
}

std::optional<PanelId> Candidates::one_that_hides_all() {
  start();
  shaft_.set(0);
  shaft_.narrow();
  std::optional<PanelId> alone;
  for_each_panel(query_, shaft_.half_spaces(), [&](PanelId panel, bool /*inside*/) {
    if (visit(panel, false)) alone = panel;
    return !alone;
  });
  return alone;
}

// True if the panel hides all. `inside`: it lies inside every half-space of the shaft, and therefore above all side
// planes.
bool Candidates::visit(PanelId panel, bool inside) {
  if (search_.seen.is_set(panel) || !may_occlude(query_.view, query_.plane, query_.request, panel)) return false;
  const auto vertices = panels_.corners(panel);
  ++record_.tree_candidates;
  // 4. Only what enters the shaft,
  if (!inside) clip_.take(vertices);
  const Sides sides = inside ? kInsideShaft : shaft_.sides();
  if (!sides.some_above_each) return false;
  search_.seen.set(panel);
  const int facing = facing_of(query_.view, panels_.piece(panel));
  if (facing == 0) return false;
  ++record_.candidates;
  const bool left_out = backs_.is_left_out(panel, facing);
  if (left_out && sides.all_above_each) return false;
  // clipped by the source's plane.
  if (sides.some_below_first) ++record_.clipped;
  if (inside) clip_.take(vertices);
  const OutlineId outline = clip_.add_occluder(sides.some_below_first, facing);
  search_.outline_panels.push_back(panel);
  if (sides.all_above_each && query_.request.culls()) {
    outlines_.set_inside_source(outline);
    return false;
  }
  outlines_.set_within_lines(outline, sides.wholly_above >> SourceShaft::kSidePlanesBeforeEdges);
  // 5. Does it hide all?
  if (outlines_.cover(outline, source_count_, 0)) return true;
  if (left_out) {
    outlines_.remove_last();
    search_.outline_panels.pop_back();
  }
  return false;
}

// --- Steps 3 and 6: a few that hide all ---

// A few occluders that hide all of the source together. That they do is proved by step 7 for their own edges and the
// source's alone (visible_edges.h).

// Adds the part of the panel between x and the source's plane, if there is any.
void add_if_between(const PlaneQuery& query, PanelId panel, PieceClip& clip, PlaneRecord& record) {
  const Panels& panels = *query.plane.scene_panels;
  clip.take(panels.corners(panel));
  const std::span<const int> depths = clip.find_depths();
  if (std::ranges::none_of(depths, [](int depth) { return depth > 0; })) return;
  if (std::ranges::none_of(clip.corners(), [&](CornerId corner) { return clip.toward_sign(corner) > 0; })) return;
  const int facing = facing_of(query.view, panels.piece(panel));
  if (facing == 0) return;
  const bool is_cut = std::ranges::any_of(depths, [](int depth) { return depth < 0; });
  if (is_cut) ++record.clipped;
  clip.add_occluder(is_cut, facing);
}

std::optional<PlaneRecord> hidden_by(std::span<const PanelId> remembered, const PlaneQuery& query, EdgeSearch& search) {
  PlaneRecord record;
  PieceClip clip(query, search.edges.outlines(), search.clip);
  const ClippedSource source = clip.add_source();
  const std::size_t end = query.plane.scene_panels->end();
  for (const PanelId panel : remembered) {
    if (panel >= end || !may_occlude(query.view, query.plane, query.request, panel)) continue;
    add_if_between(query, panel, clip, record);
  }
  VisibleEdges& edges = search.edges;
  const std::size_t cover = edges.outlines().outlines().size() - source.count;
  PlaneRecord uncounted;
  if (cover == 0 || !edges.all_cover(source.count) ||
      Candidates(query, source.count, search, uncounted).one_that_hides_all()) {
    return std::nullopt;
  }
  record.horizon_clipped = source.is_cut;
  record.source_joined = source.count > 1;
  record.cover_remembered = true;
  record.cover = record.candidates = record.tree_candidates = cover;
  record.pairs = edges.pairs();
  record.undecided_pairs = edges.undecided_pairs();
  return record;
}

// Whether some of the candidates hide all. Requires the outlines of all candidates in the search, the source's first.
// If the request allows it, remembers them.
bool hidden_by_few(const PlaneQuery& query, std::size_t source_count, EdgeWorkspace& workspace) {
  const BoundaryRequest& request = query.request;
  VisibleEdges& edges = workspace.search.edges;
  const std::vector<PanelId>& panels = workspace.search.outline_panels;
  if (!request.may_stop_early() || panels.size() < request.fewest_to_cover) return false;
  if (!edges.find_cover(source_count)) return false;
  if (request.remembers_covers) {
    const auto panel_of = [&](OutlineId o) { return panels[o - source_count]; };
    workspace.covers.set(query.plane.pieces.front(), edges.cover(), panel_of);
  }
  return true;
}

// The record, if the pieces that hid the plane from the receiver before hide it again, and no piece does so alone. Else
// forgets them. A narrow query of the tree decides whether one piece hides all, so no candidates are gathered.
// The attempt has memory of its own: the search does not change.
std::optional<PlaneRecord> hidden_as_before(const PlaneQuery& query, EdgeWorkspace& workspace) {
  const std::uint32_t plane = query.plane.pieces.front();
  const auto remembered = workspace.covers.of(plane);
  if (remembered.empty() || !query.request.remembers_covers || !query.request.may_stop_early()) return std::nullopt;
  std::optional<PlaneRecord> record = hidden_by(remembered, query, workspace.attempt);
  if (!record) workspace.covers.forget(plane);
  return record;
}

// --- All steps ---

class EdgeWalk {
 public:
  EdgeWalk(const PlaneQuery& query, EdgeWorkspace& workspace)
      : query_(query), work_(workspace), edges_(workspace.search.edges) {}

  // Nullopt where the Booleans are the better method (visible_edges.h). Lists a cutter only where one occluder hides
  // all.
  std::optional<PlaneVisibility> run() {
    const std::optional<Outcome> outcome = find_outcome();
    if (!outcome) return std::nullopt;
    result_.record.outcome = *outcome;
    if (query_.request.fraction) result_.fraction = fraction();
    return std::move(result_);
  }

 private:
  [[nodiscard]] std::optional<Outcome> find_outcome();
  [[nodiscard]] std::uint64_t most_candidates() const;
  [[nodiscard]] std::optional<Outcome> find_by_silhouettes();
  [[nodiscard]] Outcome hidden_by_panel(PanelId panel);
  void note_edges(const EdgeCovers& found);
  [[nodiscard]] Rational fraction();

  const PlaneQuery query_;
  EdgeWorkspace& work_;
  VisibleEdges& edges_;
  Outlines* outlines_ = &edges_.outlines();  // that hold the source
  PlaneVisibility result_;
  ClippedSource source_;
};

// Nullopt where the Booleans are the better method.
std::optional<Outcome> EdgeWalk::find_outcome() {
  PlaneRecord& record = result_.record;
  // 1. Cull.
  if (query_.view.is_buried) return Outcome::kBuried;
  if (query_.view.is_own(query_.plane.pieces.front())) return Outcome::kReceiverFace;
  if (side_of(query_.plane, query_.view.x) <= 0) return Outcome::kBehind;
  // 2. Clip by the receiver's horizon.
  source_ = PieceClip(query_, edges_.outlines(), work_.search.clip).add_source();
  record.horizon_clipped = source_.is_cut;
  if (source_.count == 0) return Outcome::kBelowHorizon;
  // 3. Try what hid the plane before.
  if (std::optional<PlaneRecord> hidden = hidden_as_before(query_, work_)) {
    record = std::move(*hidden);
    return Outcome::kHiddenByUnion;
  }
  // 4. Find candidates. 5. Stop if one hides all.
  Candidates candidates(query_, source_.count, work_.search, record);
  auto alone = candidates.gather(most_candidates());
  if (candidates.too_many()) {
    record.tree_candidates = record.candidates = record.clipped = 0;
    if (const std::optional<Outcome> outcome = find_by_silhouettes()) return outcome;
    source_ = PieceClip(query_, edges_.outlines(), work_.search.clip).add_source();
    alone = candidates.gather();
  }
  if (alone) return hidden_by_panel(*alone);
  candidates.add_covers();
  // 6. Try a few occluders.
  const bool hidden = hidden_by_few(query_, source_.count, work_);
  // 7. Cut the edges.
  if (!hidden && !edges_.find(source_.count)) return std::nullopt;
  result_.boundary = VisibleBoundary(edges_);
  note_edges(edges_);
  if (!result_.boundary.empty()) return record.candidates == 0 ? Outcome::kUnoccluded : Outcome::kPartlyHidden;
  if (record.candidates == 0) return Outcome::kBuried;
  record.cover = hidden ? edges_.cover().size() : record.candidates;
  return Outcome::kHiddenByUnion;
}

// With more, silhouettes are searched for.
std::uint64_t EdgeWalk::most_candidates() const {
  constexpr std::uint64_t kFew = 32;
  if (!searches_silhouettes(query_)) return Candidates::kAny;
  return query_.request.silhouettes == Silhouetting::kAlways ? 0 : kFew;
}

// A joined panel is several faces together.
Outcome EdgeWalk::hidden_by_panel(PanelId panel) {
  result_.record.cover = 1;
  if (query_.plane.scene_panels->is_joined(panel)) return Outcome::kHiddenByUnion;
  result_.cutters = {query_.view.scene.pieces()[panel].face};
  return Outcome::kHiddenByOne;
}

// Nullopt: declined.
std::optional<Outcome> EdgeWalk::find_by_silhouettes() {
  PlaneRecord record = result_.record, uncounted;
  if (const auto alone = Candidates(query_, source_.count, work_.search, uncounted).one_that_hides_all()) {
    return hidden_by_panel(*alone);
  }
  SilhouetteWalk& walk = work_.silhouettes;
  if (!walk.find(query_, record)) return std::nullopt;
  outlines_ = &walk.outlines();
  result_.record = std::move(record);
  result_.boundary = VisibleBoundary(walk);
  note_edges(walk);
  if (!result_.boundary.empty()) return walk.some_hidden() ? Outcome::kPartlyHidden : Outcome::kUnoccluded;
  result_.record.cover = result_.record.candidates;
  return Outcome::kHiddenByUnion;
}

void EdgeWalk::note_edges(const EdgeCovers& found) {
  PlaneRecord& record = result_.record;
  record.pairs = found.pairs();
  record.undecided_pairs = found.undecided_pairs();
  record.edges = found.parts().size();
  record.source_joined = source_.count > 1;
}

Rational EdgeWalk::fraction() {
  if (result_.boundary.empty()) return 0;
  const bool is_whole = !source_.is_cut && query_.plane.covers.empty();
  if (result_.record.outcome == Outcome::kUnoccluded && is_whole) return 1;
  Outlines& outlines = *outlines_;
  std::vector<Ring> source;
  for (OutlineId o = 0; o < source_.count; ++o) {
    Ring& ring = source.emplace_back();
    const Outlines::Outline& outline = outlines.outline(o);
    for (EdgeId id = outline.first; id < outline.first + outline.count; ++id) {
      ring.push_back(kernel::make_direction(outlines.exact(outlines.edge(id).a)));
    }
  }
  const PlaneFrame frame(query_.plane.normal.exact, source);
  Rational doubled;
  result_.boundary.for_each_piece([&](const BoundaryPiece& piece) {
    kernel::poll();
    const Point2 p = frame.to_plane(piece.from());
    const Point2 q = frame.to_plane(piece.to());
    doubled += p.u * q.v - q.u * p.v;
  });
  if (!frame.keeps_orientation()) doubled = -doubled;
  return share_of_source(query_.view, query_.plane, frame, doubled);
}

}  // namespace

PlaneVisibility find_visible_boundary(const View& view, const SourcePlane& plane, const BoundaryRequest& request,
                                      EdgeWorkspace& workspace) {
  EXACTFF_EXPECT(!(view.n == Vec3{}));
  if (request.engine == Engine::kBoolean) return find_by_booleans(view, plane, request);
  std::optional<PlaneVisibility> found = EdgeWalk({view, plane, request}, workspace).run();
  if (!found) return find_by_booleans(view, plane, request);
  if (request.list_cutters) found->cutters = find_cutters(view, plane, request);
  return std::move(*found);
}

}  // namespace exactff::visibility
