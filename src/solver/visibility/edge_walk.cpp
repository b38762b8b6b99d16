#include "visibility/edge_walk.h"

#include <algorithm>

#include "kernel/poll.h"
#include "visibility/candidates.h"
#include "visibility/cover_proof.h"
#include "visibility/piece_clip.h"
#include "visibility/plane_frame.h"

namespace exactff::visibility {

using kernel::Rational;
using kernel::Ring;

namespace {

class EdgeWalk {
 public:
  EdgeWalk(const PlaneQuery& query, EdgeWorkspace& workspace)
      : query_(query), work_(workspace), edges_(workspace.search.edges) {}

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
  // 5. Try what hid the plane before.
  if (std::optional<PlaneRecord> hidden = hidden_as_before(query_, work_)) {
    record = std::move(*hidden);
    return Outcome::kHiddenByUnion;
  }
  // 3. Find candidates. 4. Stop if one hides all.
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
  // 5. Try a few occluders.
  const bool hidden = hidden_by_few(query_, source_.count, work_);
  // 6. Cut the edges.
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
    const Point2 p = frame.to_plane(piece.a * piece.begin.l + piece.b * piece.begin.m);
    const Point2 q = frame.to_plane(piece.a * piece.end.l + piece.b * piece.end.m);
    doubled += p.u * q.v - q.u * p.v;
  });
  if (!frame.keeps_orientation()) doubled = -doubled;
  return share_of_source(query_.view, query_.plane, frame, doubled);
}

}  // namespace

std::optional<PlaneVisibility> find_by_edges(const View& view, const SourcePlane& plane, const BoundaryRequest& request,
                                             EdgeWorkspace& workspace) {
  return EdgeWalk({view, plane, request}, workspace).run();
}

}  // namespace exactff::visibility
