#include "visibility/silhouettes.h"

#include <algorithm>

#include "kernel/poll.h"
#include "scene/connectedness.h"
#include "scene/places.h"

namespace exactff::visibility {

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

}  // namespace exactff::visibility
