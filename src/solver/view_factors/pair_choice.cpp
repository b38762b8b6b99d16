#include "view_factors/pair_choice.h"

#include <optional>
#include <utility>

namespace exactff::view_factors {

std::vector<PairEnd> ends_of(const Scene& scene, const PreparedPatch& patch) {
  std::vector<PairEnd> ends;
  for (const Part& part : patch.parts) {
    const bool whole = part.is_piece && scene.pieces_of(part.face).size() == 1;
    Selection face = patch.selection;
    face.face = part.face;
    ends.push_back({part, whole ? std::make_shared<const ExactSource>(scene, face) : nullptr});
  }
  return ends;
}

std::unique_ptr<Pair> PairChoice::choose(std::span<const std::uint32_t> pieces, const PairEnd& from,
                                         const PairEnd& to) {
  std::unique_ptr<Pair> pair = make(pieces, from, to);
  if (pair == nullptr || !either_) return pair;
  const std::size_t events = pair->events();
  if (events == 0) return pair;
  std::unique_ptr<Pair> other = make(pieces, to, from);
  return other->events() < events ? std::move(other) : std::move(pair);
}

std::unique_ptr<Pair> PairChoice::make(std::span<const std::uint32_t> pieces, const PairEnd& receiver,
                                       const PairEnd& source) {
  std::optional<Sight> sight = sight_of(scene_, pieces, receiver.part, source.part, receiver.part.face);
  if (!sight) return nullptr;
  return std::make_unique<Pair>(scene_.scene, std::move(*sight), receiver.part.face, source.whole, memory_, made_++);
}

}  // namespace exactff::view_factors
