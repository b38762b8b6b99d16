// The pieces that each part of a patch may see (visibility/seen_pieces.h), and the closed surfaces around it, found
// when they are first asked for.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "view_factors/enclosures.h"
#include "view_factors/exact_scene.h"
#include "view_factors/sight.h"
#include "visibility/walls.h"

namespace exactff::view_factors {

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

 private:
  [[nodiscard]] exactff::Box region_of(const Part& part) const;

  const ExactScene& scene_;
  std::vector<visibility::Wall> walls_;
  mutable std::once_flag enclosures_once_;
  mutable std::optional<Enclosures> enclosures_;
};

}  // namespace exactff::view_factors
