// Pairs of parts: which of the two is cut into cells.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "view_factors/pair.h"
#include "view_factors/prepared_patch.h"

namespace exactff::view_factors {

// A part, and the source that checks the cells which see it if it is a whole face or several.
struct PairEnd {
  const Part& part;
  std::shared_ptr<const ExactSource> whole;
};
// One for each part of the patch, to which they refer.
[[nodiscard]] std::vector<PairEnd> ends_of(const Scene& scene, const PreparedPatch& patch);

class PairChoice {
 public:
  // Keeps references. `either`: A_i F_ij = A_j F_ji holds, so either of two parts may be cut.
  PairChoice(const ExactScene& scene, PairMemory& memory, bool either)
      : scene_(scene), memory_(memory), either_(either) {}

  // Cuts `from`, or the one that fewer lines seem to cut. `pieces`: all that may occlude, by ascending index. Null if
  // the two do not see each other.
  [[nodiscard]] std::unique_ptr<Pair> choose(std::span<const std::uint32_t> pieces, const PairEnd& from,
                                             const PairEnd& to);
  // What the pieces leave open of all directions; `whole`: a source all around the scene.
  [[nodiscard]] std::unique_ptr<Pair> of_open(std::span<const std::uint32_t> pieces, const Part& receiver,
                                              std::shared_ptr<const ExactSource> whole);

 private:
  [[nodiscard]] std::unique_ptr<Pair> make(std::span<const std::uint32_t> pieces, const PairEnd& receiver,
                                           const PairEnd& source);

  const ExactScene& scene_;
  PairMemory& memory_;
  bool either_;
  std::size_t made_ = 0;  // numbers the pairs in the memory
};

}  // namespace exactff::view_factors
