// The pieces that each part of a patch may see (visibility/walls.h), and the closed surfaces around it, found
// when they are first asked for.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "view_factors/almost_closed.h"
#include "view_factors/exact_scene.h"
#include "view_factors/sight.h"
#include "visibility/walls.h"

namespace exactff::view_factors {

// --- Enclosures ---

// Closed surfaces between two parts of patches, or around all that a part sees.
//
// Let S be a closed surface with winding number w (scene/closed_surfaces.h). If w just above a point x of one part
// differs from w just above a point y of another one, then almost every segment from such an x to such a y crosses
// pieces of S whose signs add up to the difference, and so at least one piece. It lies in the plane of neither part:
// the segment is blocked. Far away from S, w is 0: if it is other than
// 0 just above x, so is almost every ray from there.
//
// If S has holes in a plane, all this holds on its side of the plane, for parts that lie there and, if in the plane,
// look away from it: the segment does not meet the plane. But a ray may leave through a hole.
//
// w is found above one point of a part by a ray from it, exactly. It is the same above all of the part if above its
// interior, near enough, no piece of S is met. That holds for a piece with no corner in front of the part's plane.
// Otherwise the piece must not meet the part's interior, and does not in three cases:
// - Their boxes are apart.
// - The part lies on one side of the piece's plane, not all of it in that plane.
// - The plane through an edge of the part, along the part's normal, has all of the piece's corners on its outer side
//   or in it. If no corner lies behind the part's plane, only those in it count: their convex hull is what the piece
//   has in common with that plane.

// Of every closed surface, just above all of a part; nothing where it is not proved to be the same.
using Windings = std::vector<std::optional<int>>;

class Enclosures {
 public:
  // Keeps a reference.
  explicit Enclosures(const ExactScene& scene);

  // Transparent pieces belong to no closed surface.
  [[nodiscard]] Windings above(const Part& part) const;
  // Whether nothing outside of closed surfaces is proved to be seen. False does not mean that anything is.
  [[nodiscard]] bool are_around(const Windings& windings) const;

 private:
  const ExactScene& scene_;
  std::vector<ExactSurface> surfaces_;  // with edges cut at T-junctions
};

// At most this is open: the integral over the parts, in squares of the unit of Point::at (almost_closed.h).
[[nodiscard]] double open_at_most(const ExactScene& scene, const std::vector<AlmostClosedSurface>& surfaces,
                                  std::span<const Part> parts);

// Whether the parts are proved to see nothing of each other. False does not mean that they see something.
[[nodiscard]] bool are_separated(const Windings& one, const Windings& other);

// --- Seen parts ---

// What a part may see. Its pairs are computed among these pieces, from either end. Proof: of all pieces that a segment
// from a point of the part meets, the nearest is seen from there. If it belongs to no closed surface, it is among the
// occluders. Otherwise all pieces of its surface are, and where sight.h leaves some of them out, others block the
// segment.
struct SeenPieces {
  std::vector<std::uint32_t> seen;       // ascending
  std::vector<std::uint32_t> occluders;  // these and the others of their closed surfaces, ascending
};

class SeenParts {
 public:
  using Lists = std::vector<SeenPieces>;  // by part

  // Keeps a reference.
  explicit SeenParts(const ExactScene& scene);

  // Of these parts, by their index in the list. From any thread.
  class OfPatch {
   public:
    [[nodiscard]] const Lists& lists(const SeenParts& scene, std::span<const Part> parts) const;
    // Whether parts[i] may see some of the other part's face, or sheet: whether its list holds some. The first few
    // questions are answered without the lists.
    [[nodiscard]] bool sees(const SeenParts& scene, std::span<const Part> parts, std::size_t i,
                            const Part& other) const;
    [[nodiscard]] const std::vector<Windings>& windings(const SeenParts& scene, std::span<const Part> parts) const;

   private:
    struct State {
      std::once_flag once, windings_once;
      std::atomic<std::size_t> questions{0};
      Lists lists;
      std::vector<Windings> windings;
    };
    std::unique_ptr<State> state_ = std::make_unique<State>();
  };

  [[nodiscard]] SeenPieces seen_from(const Part& part) const;
  [[nodiscard]] const Enclosures& enclosures() const;
  [[nodiscard]] const std::vector<AlmostClosedSurface>& almost_closed() const;

 private:
  [[nodiscard]] exactff::Box region_of(const Part& part) const;

  const ExactScene& scene_;
  std::vector<visibility::Wall> walls_;
  mutable std::once_flag enclosures_once_, almost_closed_once_;
  mutable std::optional<Enclosures> enclosures_;
  mutable std::vector<AlmostClosedSurface> almost_closed_;
};

}  // namespace exactff::view_factors
