// Panels: the pieces of a scene, with neighbours in one plane joined, so that a wall of triangles costs what the wall
// costs.
//
// A *sheet* is a set of pieces of one patch in one oriented plane, of several planar faces, that are connected by edges
// and do not overlap. Edges are matched by the positions of their ends, or, if a patch does not have very many, also in
// part. Its union is cut into convex panels, fewer than its pieces. A piece of no sheet is a panel by itself.
//
// The panels of a sheet cover exactly what its pieces cover, but a panel need not consist of whole pieces. Whoever
// leaves out some of the pieces uses the pieces instead.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "exactff/scene.h"
#include "scene/shaft_tree.h"
#include "scene/triangulation.h"

namespace exactff {

// Below the number of pieces: the piece of that index, by itself.
using PanelId = std::uint32_t;

struct Sheet {
  std::vector<std::uint32_t> pieces;  // ascending
  PanelId first_panel = 0;
  std::uint32_t panel_count = 0;
  std::uint32_t surface = 0;  // the closed surface that all of its pieces belong to, or ClosedSurfaces::kNone
};

// Refers to its scene.
class Panels {
 public:
  static constexpr std::uint32_t kNoSheet = std::numeric_limits<std::uint32_t>::max();

  Panels() = default;
  explicit Panels(const Scene& scene);

  // Without sheets, every panel is a piece.
  [[nodiscard]] bool empty() const { return sheets_.empty(); }
  [[nodiscard]] std::size_t end() const { return pieces_.size() + joined_.size(); }  // ids are below
  [[nodiscard]] std::span<const Sheet> sheets() const { return sheets_; }
  [[nodiscard]] std::uint32_t sheet_of_piece(std::uint32_t piece) const {
    return empty() ? kNoSheet : sheet_of_piece_[piece];
  }

  // Whether the panel is of a sheet. Then its face is one of several, and its corners are not among Scene::corners().
  [[nodiscard]] bool is_joined(PanelId id) const { return id >= pieces_.size(); }
  [[nodiscard]] std::uint32_t sheet_of_joined(PanelId id) const { return sheet_of_joined_[id - pieces_.size()]; }
  [[nodiscard]] const Sheet& sheet_of(PanelId joined) const { return sheets_[sheet_of_joined(joined)]; }
  [[nodiscard]] const Piece& piece(PanelId id) const {
    return is_joined(id) ? joined_[id - pieces_.size()] : pieces_[id];
  }
  [[nodiscard]] std::span<const std::uint32_t> corners(PanelId id) const {
    const Piece& piece = this->piece(id);
    const std::span<const std::uint32_t> all = is_joined(id) ? std::span(joined_corners_) : corners_;
    return all.subspan(piece.first_corner, piece.corner_count);
  }

 private:
  void add(const Scene& scene, std::vector<std::uint32_t> pieces, const std::vector<ConvexPart>& parts);

  std::span<const Piece> pieces_;           // of the scene
  std::span<const std::uint32_t> corners_;  // of all pieces
  std::vector<Sheet> sheets_;
  std::vector<std::uint32_t> sheet_of_piece_;
  std::vector<Piece> joined_;
  std::vector<std::uint32_t> joined_corners_;  // vertex indices
  std::vector<std::uint32_t> sheet_of_joined_;
};

// The panels of the scene, found at the first call; safe to call from several threads.
const Panels& panels(const Scene& scene);
// The tree over the panels, likewise. Without sheets, it is that of the pieces.
const ShaftTree& panel_tree(const Scene& scene);

// --- Planes ---

// Which pieces of a scene lie in one plane, exactly, whichever way they face.

// Counted from 0, in the order of their first pieces.
enum class PlaneId : std::uint32_t {};

class Planes {
 public:
  Planes() = default;
  explicit Planes(const Scene& scene);

  [[nodiscard]] std::size_t count() const { return first_.empty() ? 0 : first_.size() - 1; }
  // Two pieces have the same plane if and only if some plane holds both.
  [[nodiscard]] PlaneId of_piece(std::uint32_t piece) const { return of_piece_[piece]; }
  // All pieces in the plane, transparent ones included, ascending.
  [[nodiscard]] std::span<const std::uint32_t> pieces_in(PlaneId plane) const {
    const std::size_t i = index_of(plane);
    return std::span(pieces_).subspan(first_[i], first_[i + 1] - first_[i]);
  }

 private:
  void sort_pieces(std::size_t found);

  std::vector<PlaneId> of_piece_;
  std::vector<std::uint32_t> pieces_;  // by plane
  std::vector<std::uint32_t> first_;   // of each plane in pieces_; one entry more
};

// The planes of the scene's pieces, found at the first call; safe to call from several threads.
const Planes& planes(const Scene& scene);

}  // namespace exactff
