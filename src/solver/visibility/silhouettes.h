// Finds silhouettes: the edges across which the number of occluders changes, without looking at all occluders.
//
// Let c(w) be the number of pieces that the ray from x in direction w meets before the source's plane. Seen from x, c
// is constant except across edges of pieces. From the left of an edge to its right it jumps by
//   J = (pieces seen on its right) - (pieces seen on its left),
// whatever the topology of the mesh; a piece seen edge-on has no area and is on neither side. An edge between two
// pieces seen on different sides of it has J = 0 and bounds nothing: so it is inside the front or the back of a mesh,
// and with every diagonal of a flat polygon.
//
// The tree of scene/edges.h leaves out edges that are certainly smooth, if all their pieces occlude. The edges of
// pieces that do not occlude in this call (the receiver's own, the source's in this plane) are therefore added. Pieces
// that the source's plane cuts are cut by it, and where it cuts them is an edge, too.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "scene/edges.h"
#include "visibility/piece_clip.h"
#include "visibility/run_marks.h"
#include "visibility/source_shaft.h"

namespace exactff::visibility {

// Whether to search for silhouettes: they must be those of all occluders and, unless the request says so, few of the
// scene's edges from a typical point.
[[nodiscard]] bool searches_silhouettes(const PlaneQuery& query);

struct SilhouetteMemory {
  ClipMemory clip;
  ShaftMemory shaft;
  std::vector<HalfSpace> order;  // the front of the source's plane, alone in a group; the rest
  HalfSpaceGroups groups;
  RunMarks known_edges, known_pieces;
  std::vector<std::int8_t> facing;  // of the known pieces
  std::vector<int> jumps;           // by edge of the outlines, after the source's
  // The ring of each piece that the source's plane cuts, as corners.
  std::unordered_map<std::uint32_t, std::vector<CornerId>> cut_rings;
  std::unordered_map<std::uint64_t, CornerId> crossings;  // by the two places
};

class Silhouettes {
 public:
  Silhouettes(const PlaneQuery& query, Outlines& outlines, SilhouetteMemory& memory);

  // Adds the silhouettes that may have a part inside the source, as edges of no outline. Requires that the first
  // `source_count` outlines are the source's, and nothing else. Counts its work in the record.
  void gather(std::size_t source_count, PlaneRecord& record);

  // 0 if the piece does not occlude; otherwise facing_of. Valid after gather.
  [[nodiscard]] int facing(std::uint32_t piece);
  // The corners of an occluding piece, or of its part on x's side of the source's plane; counter-clockwise as x sees it
  // if `facing` is negative.
  [[nodiscard]] std::span<const CornerId> corners_of(std::uint32_t piece);
  // x's side of the source's plane, and the side of the parallel plane through x that is towards it.
  [[nodiscard]] const HalfSpace& front() const { return memory_.order.front(); }
  [[nodiscard]] const HalfSpace& toward() const { return memory_.order.back(); }
  // Whether x sees a piece edge-on that may occlude, with a part before the source's plane; it may lie beside the
  // shaft.
  [[nodiscard]] bool some_edge_on() const { return some_edge_on_; }
  // J of an edge that gather added.
  [[nodiscard]] int jump(EdgeId edge) const { return memory_.jumps[edge - first_]; }

 private:
  void visit(std::uint32_t scene_edge, bool in_front);
  void visit_edges_of(const Piece& piece);
  [[nodiscard]] int facing_of_piece(std::uint32_t piece, bool in_front);
  void find_depths(const Piece& piece);
  [[nodiscard]] bool is_before_source(const Piece& piece, std::uint32_t index, int facing);
  void add_cut(const Piece& piece, std::uint32_t index, int facing);
  void add(CornerId a, CornerId b, int jump);
  [[nodiscard]] CornerId crossing(std::uint32_t p, std::uint32_t q);

  const PlaneQuery& query_;
  Outlines& outlines_;
  SilhouetteMemory& memory_;
  PieceClip clip_;
  SourceShaft shaft_;
  const SceneEdges& edges_;
  EdgeId first_ = 0;
  bool some_edge_on_ = false;
  PlaneRecord* record_ = nullptr;
};

}  // namespace exactff::visibility
