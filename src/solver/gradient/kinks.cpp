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
