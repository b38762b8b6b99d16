#include "view_factors/pair_choice.h"

#include <optional>
#include <utility>

namespace exactff::view_factors {

namespace {

// The faces of the part's panel as a source, if they are nothing else.
std::shared_ptr<const ExactSource> source_of(const Scene& scene, const Selection& patch, const Part& part) {
  if (!part.is_piece) return nullptr;
  const Panels& all = panels(scene);
  Selection source = patch;
  if (all.is_joined(part.panel)) {
    const Sheet& sheet = all.sheet_of(part.panel);
    if (sheet.panel_count > 1 || faces_of(scene, part) != scene.faces_of(patch)) return nullptr;
  } else {
    if (scene.pieces_of(part.face).size() > 1) return nullptr;
    source.face = part.face;
  }
  return std::make_shared<const ExactSource>(scene, source);
}

}  // namespace

std::vector<PairEnd> ends_of(const Scene& scene, const PreparedPatch& patch) {
  std::vector<PairEnd> ends;
  for (const Part& part : patch.parts) ends.push_back({part, source_of(scene, patch.selection, part)});
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

std::unique_ptr<Pair> PairChoice::of_open(std::span<const std::uint32_t> pieces, const Part& receiver,
                                          std::shared_ptr<const ExactSource> whole) {
  return std::make_unique<Pair>(scene_.scene, sight_of_open(scene_, pieces, receiver), receiver.face, std::move(whole),
                                memory_, made_++);
}

std::unique_ptr<Pair> PairChoice::make(std::span<const std::uint32_t> pieces, const PairEnd& receiver,
                                       const PairEnd& source) {
  std::optional<Sight> sight = sight_of(scene_, pieces, receiver.part, source.part);
  if (!sight) return nullptr;
  return std::make_unique<Pair>(scene_.scene, std::move(*sight), receiver.part.face, source.whole, memory_, made_++);
}

}  // namespace exactff::view_factors
