// What the engines are given and what they find: the visible part of one plane of the source. Two engines find it,
// visible_boundary.cpp and boolean_walk.h. No radiometry.
#pragma once

#include <algorithm>
#include <boost/container/small_vector.hpp>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "exactff/exact.h"
#include "exactff/receiver.h"
#include "receivers/own_pieces.h"
#include "scene/panels.h"
#include "scene/shaft_tree.h"
#include "visibility/edge_covers.h"
#include "visibility/outlines.h"
#include "visibility/source_plane.h"

namespace exactff::visibility {

class PlaneFrame;

// Everything that depends on the receiver alone.
struct View {
  View(const Scene& scene_in, const Receiver& receiver);

  const Scene& scene;
  Vec3 x;
  Vec3 n;          // the receiver's normal
  OwnPieces own;   // neither occlude nor illuminate
  bool is_buried;  // see scene/contacts.h: nothing is seen

  [[nodiscard]] bool is_own(std::uint32_t piece) const { return own.contains(piece); }
  // The normal as a direction in integers, which are seldom needed.
  [[nodiscard]] Direction normal() const;
};

// Whether the edge engine searches for the silhouettes of meshes (silhouettes.h) or compares outlines.
enum class Silhouetting { kWherePromising, kAlways, kNever };

struct BoundaryRequest {
  Engine engine = Engine::kEdges;
  bool fraction = false;
  bool list_cutters = false;
  const std::vector<FaceId>* only_occluders = nullptr;  // ascending
  ShaftCulling culling = ShaftCulling::kTree;
  bool remembers_covers = false;  // see CoverMemory; the counts in the record then depend on earlier calls
  Silhouetting silhouettes = Silhouetting::kWherePromising;
  bool by_pieces = false;            // looks at pieces even where panels join several, and gives the same region
  std::size_t fewest_to_cover = 64;  // candidates: with fewer, a search for a small cover saves nothing

  [[nodiscard]] bool culls() const { return culling == ShaftCulling::kTree; }
  // Whether the edge engine looks at panels instead of pieces.
  [[nodiscard]] bool joins_pieces() const { return culls() && only_occluders == nullptr && !by_pieces; }
  // Whether a proof that all is hidden may end the search before every candidate has been looked at.
  [[nodiscard]] bool may_stop_early() const { return culls() && !list_cutters; }
};

struct PlaneQuery {
  const View& view;
  const SourcePlane& plane;
  const BoundaryRequest& request;
};

// The boundary of the visible region, whichever engine found it. Refers to the workspace that it was found with: valid
// until that is used again.
class VisibleBoundary {
 public:
  VisibleBoundary() = default;  // nothing is visible
  explicit VisibleBoundary(std::vector<BoundaryPiece> pieces) : pieces_(std::move(pieces)) {}
  explicit VisibleBoundary(EdgeCovers& found) : edges_(found.parts().empty() ? nullptr : &found) {}

  [[nodiscard]] bool empty() const { return pieces_.empty() && edges_ == nullptr; }
  // Calls visit(piece) for every piece of the boundary.
  template <class Visit>
  void for_each_piece(const Visit& visit) const {
    for (const BoundaryPiece& piece : pieces_) visit(piece);
    if (edges_ == nullptr) return;
    for (const EdgeCovers::Part& part : edges_->parts()) visit(edges_->exact(part));
  }
  // What the edge engine found, else null; and what the Booleans found.
  [[nodiscard]] EdgeCovers* edges() const { return edges_; }
  [[nodiscard]] std::vector<BoundaryPiece>& pieces() { return pieces_; }

 private:
  std::vector<BoundaryPiece> pieces_;
  EdgeCovers* edges_ = nullptr;
};

// One occluder that hides all needs no allocation.
using Cutters = boost::container::small_vector<FaceId, 1>;

struct PlaneVisibility {
  PlaneRecord record;  // without its faces, which are the plane's
  VisibleBoundary boundary;
  std::optional<Rational> fraction;  // visible area / whole unclipped area of the union, in [0, 1]
  Cutters cutters;                   // ascending
};

// For both engines: calls visit(piece, inside) for every piece that may lie in the shaft, until one call returns false;
// inside: certainly within it (shaft_tree.h).
template <class Visit>
void for_each_candidate(const View& view, const HalfSpaceGroups& shaft, ShaftCulling culling, Visit&& visit) {
  if (culling == ShaftCulling::kTree) {
    shaft_tree(view.scene).query_with_inside(view.x, shaft, visit);
    return;
  }
  const auto count = static_cast<std::uint32_t>(view.scene.pieces().size());
  for (std::uint32_t piece = 0; piece < count && visit(piece, false); ++piece) {
  }
}

// For the edge engine: the same for panels.
template <class Visit>
void for_each_panel(const PlaneQuery& query, const HalfSpaceGroups& shaft, const Visit& visit) {
  const View& view = query.view;
  if (!query.request.joins_pieces()) return for_each_candidate(view, shaft, query.request.culling, visit);
  panel_tree(view.scene).query_with_inside(view.x, shaft, visit);
}

// For both engines: true if a panel of the scene may occlude the plane. The source's own pieces in this plane cannot;
// its pieces in other planes can.
[[nodiscard]] bool may_occlude(const View& view, const SourcePlane& plane, const BoundaryRequest& request,
                               PanelId panel);
// The sign of det of three corners of the piece, seen from x: 0 where its plane holds x, positive where x sees the
// back.
[[nodiscard]] inline int facing_of(const View& view, const Piece& piece) {
  const auto vertices = view.scene.vertices();
  const auto vertex = [&](int f) -> const Vec3& { return vertices[piece.frame[f]]; };
  const auto rounded = [&](int f) { return kernel::approx_difference(vertex(f), view.x); };
  const Approx3 a = rounded(0), b = rounded(1), c = rounded(2);
  if (const int filtered = kernel::sign_of_det(a, b, c); filtered != kUncertain) return filtered;
  const bool across_axis = (a.x == 0.0 && b.x == 0.0 && c.x == 0.0) || (a.y == 0.0 && b.y == 0.0 && c.y == 0.0) ||
                           (a.z == 0.0 && b.z == 0.0 && c.z == 0.0);
  return across_axis ? 0 : kernel::orientation(view.x, vertex(0), vertex(1), vertex(2));
}
// As x sees the front of the piece.
[[nodiscard]] Ring ring_of(const View& view, std::uint32_t piece);
// Twice an area in the frame's unit square, as a share of the whole unclipped source in the plane.
[[nodiscard]] Rational share_of_source(const View& view, const SourcePlane& plane, const PlaneFrame& frame,
                                       const Rational& doubled);

}  // namespace exactff::visibility
