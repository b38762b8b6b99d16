#include "gradient/sight_directions.h"

#include <algorithm>

namespace exactff::gradient {

using kernel::ExactVec3;
using visibility::EdgeId;
using visibility::OutlineId;
using visibility::Outlines;

SightDirections::SightDirections(Outlines& outlines, const Outlines::Edge& edge)
    : edge_(edge), normal_(cross(outlines.exact(edge.b), outlines.exact(edge.a))) {
  make_primitive(normal_);
}

int SightDirections::turn(const ExactVec3& p, const ExactVec3& q) const {
  return kernel::sign(dot(normal_, cross(p, q)));
}

bool SightDirections::is_between(const ExactVec3& from, const ExactVec3& to, const ExactVec3& t) const {
  return turn(from, t) >= 0 && turn(t, to) >= 0;
}

std::vector<int> SightDirections::sides_of(Outlines& outlines, OutlineId id) const {
  const Outlines::Outline outline = outlines.outline(id);
  std::vector<int> sides;
  for (EdgeId e = outline.first; e < outline.first + outline.count; ++e) {
    sides.push_back(outlines.side(edge_, outlines.edge(e).a));
  }
  return sides;
}

int SightDirections::side_of(std::span<const int> sides) {
  const bool some_above = std::ranges::any_of(sides, [](int side) { return side > 0; });
  const bool some_below = std::ranges::any_of(sides, [](int side) { return side < 0; });
  return some_above && some_below ? 0 : some_above ? 1 : -1;
}

std::optional<std::pair<ExactVec3, ExactVec3>> SightDirections::arc_of(Outlines& outlines, OutlineId id,
                                                                       std::span<const int> sides) const {
  const EdgeId first = outlines.outline(id).first;
  std::vector<ExactVec3> ends;
  for (std::size_t c = 0; c < sides.size(); ++c) {
    const Outlines::Edge edge = outlines.edge(first + static_cast<EdgeId>(c));
    if (sides[c] == 0) ends.push_back(outlines.exact(edge.a));
    if (sides[c] * sides[(c + 1) % sides.size()] >= 0) continue;
    const ExactVec3 p = outlines.exact(edge.a), q = outlines.exact(edge.b);
    ends.push_back(p * abs(dot(normal_, q)) + q * abs(dot(normal_, p)));
  }
  if (ends.size() < 2) return std::nullopt;
  const auto is_before = [&](const ExactVec3& p, const ExactVec3& q) { return turn(p, q) > 0; };
  const std::pair arc{*std::ranges::min_element(ends, is_before), *std::ranges::max_element(ends, is_before)};
  return turn(arc.first, arc.second) > 0 ? std::optional(arc) : std::nullopt;
}

}  // namespace exactff::gradient
