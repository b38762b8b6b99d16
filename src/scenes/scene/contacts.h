// Where solids touch: parts of faces that are buried.
//
// A part of a face is *buried* where a piece of a solid (solids.h) lies on it in its plane with the opposite front: the
// floor under a box, the bottom of the box, both sides of the contact of two boxes. What is buried neither sends nor
// receives. A solid of positive volume buries what it covers of any face. One of negative volume, a room, buries only
// what it covers of faces of solids of positive volume. None buries
//   - a face of its own, or a twin of one: a face with the same corners and the opposite front that belongs to no
//     solid;
//   - faces of a solid whose faces are all twins of its own, such as the other side of a room of two-sided walls.
// A piece buries nothing if another piece of its solid overlaps it with the opposite front. A piece that belongs to no
// solid, but has the corners and the front of one that does, counts as that one.
//
// So burying is a relation between pieces, and all questions are answered by the pieces that cover one.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "exactff/scene.h"

namespace exactff {

class Contacts {
 public:
  Contacts() = default;
  explicit Contacts(const Scene& scene);

  [[nodiscard]] bool empty() const { return covers_.empty(); }
  // The pieces that bury a part of this one, ascending. All have the same front.
  [[nodiscard]] std::span<const std::uint32_t> covers(std::uint32_t piece) const;
  // All pieces of which something is buried, with their covers.
  [[nodiscard]] const std::map<std::uint32_t, std::vector<std::uint32_t>>& all() const { return covers_; }

  // Of two pieces that overlap in one plane and show x these sides: whether the first is seen there. A front is seen
  // before a back, unless the back buries it; of fronts, or of backs, the one of the lower piece, but fronts of which
  // nothing is buried come first, and backs that bury something.
  struct Side {
    std::uint32_t piece = 0;
    bool front = true;
  };
  [[nodiscard]] bool comes_first(const Side& a, const Side& b) const;

 private:
  // Fronts and backs by themselves.
  [[nodiscard]] int rank(const Side& side) const;

  std::map<std::uint32_t, std::vector<std::uint32_t>> covers_;
  std::vector<std::uint8_t> is_cover_, is_of_solid_;  // by piece; empty if nothing is buried
};

// Found at the first call; safe to call from several threads.
const Contacts& contacts(const Scene& scene);

// Of a point of these pieces, which lie in one plane and have one front, as looked at from that front.
struct Burial {
  std::optional<FaceId> under;  // its projection along the front lies in the open interior of what this face buries
  bool is_exposed = false;      // else, but a piece holds its projection
};
// Neither, if the normal does not look from the front. Exact.
[[nodiscard]] Burial burial_of(const Scene& scene, std::span<const std::uint32_t> pieces, const Vec3& point,
                               const Vec3& normal);

// --- Coplanar ---

// Convex pieces in one plane, compared exactly.

// Whether the pieces have more than an edge or a point in common. Requires that they lie in one plane.
[[nodiscard]] bool overlap(const Scene& scene, const Piece& a, const Piece& b);

// Whether their fronts look the same way. The same requirement.
[[nodiscard]] bool have_same_front(const Scene& scene, const Piece& a, const Piece& b);

// Whether they have the same corners: then they cover the same points.
[[nodiscard]] bool have_same_corners(const Scene& scene, const Piece& a, const Piece& b);

}  // namespace exactff
