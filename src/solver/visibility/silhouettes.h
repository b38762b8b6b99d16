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
#include <optional>
#include <unordered_map>
#include <vector>

#include "scene/edges.h"
#include "visibility/edge_covers.h"
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

// --- Occluder count ---

// Counts occluders by a ray: those that x sees on both sides of a point of an edge. By filters alone.

// A direction from x: the point of an edge with a parameter.
[[nodiscard]] Approx3 between(const Outlines::Corner& a, const Outlines::Corner& b, double t);

class OccluderCount {
 public:
  struct Counts {
    int left = 0, right = 0;
  };

  // Requires what gather has found.
  OccluderCount(const PlaneQuery& query, Outlines& outlines, Silhouettes& silhouettes)
      : query_(query), outlines_(outlines), silhouettes_(silhouettes) {}

  // Just beside the point with the parameter m / (l + m) = t / ((1 - t) + t), both as doubles. Nullopt where doubles do
  // not tell.
  [[nodiscard]] std::optional<Counts> beside(EdgeId edge, double t);

 private:
  [[nodiscard]] std::optional<int> sides_of(std::uint32_t piece, int facing, EdgeId edge, double t);

  const PlaneQuery& query_;
  Outlines& outlines_;
  Silhouettes& silhouettes_;
};

// --- Silhouette walk ---

// Finds the boundary of the visible region from silhouettes alone.
//
// V is where c = 0 inside the source. Along an edge e, c on either side changes only where other silhouettes leave e to
// that side. Let g be one that meets e's line at a point q inside e, and J its jump.
//   Where e crosses g's line from g's left to its right, c grows by J behind q; from right to left, it shrinks by J.
//   That holds on e's left if g has an end strictly on e's left, and on its right if it has one strictly on its right.
// So a silhouette that ends on e, or several that meet in one point, need no case of their own; nor does one that runs
// along e, since it leaves e to no side. With c on both sides known at one point of e, it is known along e:
//   1. the parts of each silhouette that have the source on both sides;
//   2. pairs of edges whose images are near each other: the points where they meet, by exact signs;
//   3. c beside one point of a part: by the pieces that the ray through this point meets;
//   4. from there along the part, and on along the parts that begin where it ends, if nothing else meets there; along
//      an edge of the source, and on along the parts that leave it. A silhouette bounds V where c is 0 on one side
//      alone, an edge of the source where c is 0 on its left. Of edges that coincide, the one with the lowest index
//      represents all.
//
// Edges and directions are less than a half turn apart, but two planes through x meet in two opposite directions. If e
// crosses g's line from right to left, then g crosses e's line from left to right if they meet in the same direction,
// and from right to left if in opposite ones.
//
// The walk declines where doubles do not separate the points of an edge: the caller has another way.

class SilhouetteWalk : public EdgeCovers {
 public:
  // Finds parts(). False: declined. Requires that the query culls.
  [[nodiscard]] bool find(const PlaneQuery& query, PlaneRecord& record);
  // Whether something occludes a part of the source.
  [[nodiscard]] bool some_hidden() const { return some_hidden_; }

 private:
  // A change of c behind a point of an edge.
  struct Event {
    EdgeId edge = 0, by = 0;
    Parameter at;
    int left = 0, right = 0;
  };
  using Counts = OccluderCount::Counts;
  // An interval of an edge.
  struct Stretch {
    EdgeId edge = 0;
    Interval interval;
    std::optional<Counts> at_begin = {}, at_end = {};  // c behind and before the ends, where it is known
  };
  // An end of a stretch at a corner.
  struct End {
    CornerId corner = 0;
    std::uint32_t stretch = 0;
    bool is_begin = false;
  };
  // The bounds of a stretch's image, widened.
  struct Image {
    double low_u, high_u, low_v, high_v;
    std::uint32_t stretch;
  };

  void start();
  void find_stretches();
  void add_source_edge(EdgeId edge);
  void add_stretches_in_union(EdgeId edge);
  void find_meetings();
  void make_images();
  [[nodiscard]] Image image_of(const Stretch& stretch) const;
  void meet(EdgeId e, EdgeId g);
  void add_event(EdgeId e, EdgeId g, int from, int side_a, int side_b);
  void coincide(EdgeId e, EdgeId g);
  [[nodiscard]] CornerId corner_beside(const Outlines::Edge& edge);
  void note_touch(const Outlines::Edge& e, const Outlines::Edge& g, int e_a, int e_b);
  void find_ends();
  [[nodiscard]] bool trace_all();
  [[nodiscard]] bool trace(std::uint32_t index);
  [[nodiscard]] std::optional<Counts> counts_at_begin(const Stretch& stretch);
  void go_on(std::uint32_t index, bool at_begin, const Counts& counts);
  void enter(EdgeId edge, EdgeId from, const Counts& counts);
  [[nodiscard]] std::optional<double> clear_point(const Stretch& stretch) const;
  void keep(const Stretch& stretch, int kind, const Parameter& begin, const Parameter& end);
  [[nodiscard]] bool is_of_source(EdgeId edge) const { return edge < source_edges_; }

  const PlaneQuery* query_ = nullptr;
  SilhouetteMemory memory_;
  std::optional<Silhouettes> silhouettes_;
  ClippedSource source_;
  EdgeId source_edges_ = 0;
  bool some_hidden_ = false;
  std::vector<Stretch> stretches_;
  std::vector<Stretch> removed_;  // what another edge represents
  std::vector<Event> events_;
  std::vector<End> ends_;              // by corner
  std::vector<std::uint8_t> touched_;  // by corner: another edge meets it
  std::vector<std::uint32_t> waiting_;
  std::vector<std::uint8_t> done_;  // by stretch
  std::vector<Image> images_;
  Approx3 axis_u_, axis_v_, ahead_;
  std::uint64_t next_poll_ = 0;
  // Of the current stretch.
  std::vector<Event> along_;
  std::vector<Interval> off_;
  std::vector<Cover> covers_;  // of the current edge, by pieces of the source
  std::vector<Parameter> places_;
};

}  // namespace exactff::visibility
