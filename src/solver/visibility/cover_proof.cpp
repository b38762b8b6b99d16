#include "visibility/cover_proof.h"

#include <algorithm>

#include "visibility/candidates.h"
#include "visibility/piece_clip.h"

namespace exactff::visibility {

namespace {

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

bool one_hides_all(const PlaneQuery& query, std::size_t source_count, EdgeSearch& search) {
  PlaneRecord uncounted;
  return Candidates(query, source_count, search, uncounted).one_that_hides_all().has_value();
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
  if (cover == 0 || !edges.all_cover(source.count) || one_hides_all(query, source.count, search)) return std::nullopt;
  record.horizon_clipped = source.is_cut;
  record.source_joined = source.count > 1;
  record.cover_remembered = true;
  record.cover = record.candidates = record.tree_candidates = cover;
  record.pairs = edges.pairs();
  record.undecided_pairs = edges.undecided_pairs();
  return record;
}

}  // namespace

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

std::optional<PlaneRecord> hidden_as_before(const PlaneQuery& query, EdgeWorkspace& workspace) {
  const std::uint32_t plane = query.plane.pieces.front();
  const auto remembered = workspace.covers.of(plane);
  if (remembered.empty() || !query.request.remembers_covers || !query.request.may_stop_early()) return std::nullopt;
  std::optional<PlaneRecord> record = hidden_by(remembered, query, workspace.attempt);
  if (!record) workspace.covers.forget(plane);
  return record;
}

}  // namespace exactff::visibility
