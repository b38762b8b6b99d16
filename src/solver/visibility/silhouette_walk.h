// Finds the boundary of the visible region from silhouettes alone (silhouettes.h).
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
#pragma once

#include <optional>
#include <vector>

#include "visibility/edge_covers.h"
#include "visibility/occluder_count.h"
#include "visibility/silhouettes.h"

namespace exactff::visibility {

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
  kernel::Approx3 axis_u_, axis_v_, ahead_;
  std::uint64_t next_poll_ = 0;
  // Of the current stretch.
  std::vector<Event> along_;
  std::vector<Interval> off_;
  std::vector<Cover> covers_;  // of the current edge, by pieces of the source
  std::vector<Parameter> places_;
};

}  // namespace exactff::visibility
