// What may bound the view of one plane of the source, now or after a small movement of x: the source, and every piece
// that touches the closed shaft, as outlines, and the pieces that x sees edge-on. The search of the edge engine is not
// enough here, since it leaves out pieces that hide nothing now.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "visibility/piece_clip.h"
#include "visibility/run_marks.h"
#include "visibility/source_shaft.h"

namespace exactff::gradient {

// A workspace.
class Profile {
 public:
  enum class Extent {
    kBefore,   // of the source's plane
    kMeeting,  // also pieces in or behind it that have two corners in it
  };
  // Finds everything below. Keeps references to what the query refers to.
  void gather(const visibility::PlaneQuery& query, Extent extent = Extent::kBefore);
  // For a plane that holds x: the pieces that meet the plane, whole, as outlines. No source.
  void gather_around_plane(const visibility::PlaneQuery& query);

  [[nodiscard]] visibility::Outlines& outlines() { return outlines_; }
  [[nodiscard]] const visibility::Outlines& outlines() const { return outlines_; }
  // Outlines: first those of the source above the horizon, then those of the occluders before the source's plane.
  [[nodiscard]] std::size_t source_count() const { return source_count_; }
  // A piece of the scene for each outline.
  [[nodiscard]] std::span<const std::uint32_t> pieces() const { return pieces_; }
  // Pieces that x sees edge-on, with a part before the source's plane.
  [[nodiscard]] std::span<const std::uint32_t> sheets() const { return sheets_; }
  // Pieces in the source's plane or behind it, with at least two corners in it.
  [[nodiscard]] std::span<const std::uint32_t> meeting() const { return meeting_; }
  // One of the sheets that holds x.
  [[nodiscard]] const std::optional<std::uint32_t>& touching() const { return touching_; }
  // An edge in the plane through x with this normal. Requires that there is one.
  [[nodiscard]] visibility::Outlines::Edge edge_in_plane(const kernel::ExactVec3& normal);
  // One piece hides all of the source and more: the view does not change when x moves.
  [[nodiscard]] bool stays_hidden() const { return stays_hidden_; }

 private:
  void start();
  struct Shaft;
  void visit(Shaft& shaft, std::uint32_t index, bool inside);
  [[nodiscard]] bool is_beside(visibility::OutlineId source, std::span<const visibility::CornerId> corners) const;
  [[nodiscard]] bool hides_more(visibility::OutlineId occluder);

  visibility::Outlines outlines_;
  visibility::ClipMemory clip_;
  visibility::ShaftMemory shaft_;
  visibility::RunMarks seen_;
  std::vector<std::uint32_t> pieces_, sheets_, meeting_;
  std::optional<std::uint32_t> touching_;
  std::size_t source_count_ = 0;
  bool with_meeting_ = false;
  bool stays_hidden_ = false;
};

// Whether the piece, in whose plane x lies, holds x.
[[nodiscard]] bool holds_x(const visibility::View& view, const Piece& piece);

}  // namespace exactff::gradient
