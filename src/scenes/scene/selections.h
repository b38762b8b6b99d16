// Selections: what they emit, and the words of a flag for them.
#pragma once

#include <cstdint>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "exactff/scene.h"

namespace exactff {

// Whether a face with area has a Ke other than 0. A source without counts with a radiosity of 1 where it is named.
[[nodiscard]] bool emits(const Scene& scene, const Selection& selection);

[[nodiscard]] std::vector<std::string> names_of(const Scene& scene, std::span<const Selection> selections);

[[nodiscard]] bool has_patch(const Scene& scene, std::string_view name);
// Those of which the test holds, in their order.
template <class Test>
[[nodiscard]] std::vector<FaceId> faces_where(const Scene& scene, const Test& test) {
  std::vector<FaceId> faces;
  for (std::uint32_t f = 0; f < scene.faces().size(); ++f) {
    if (test(scene.faces()[f])) faces.push_back(FaceId{f});
  }
  return faces;
}
// Those with area.
[[nodiscard]] std::vector<Selection> all_patches(const Scene& scene);

[[nodiscard]] inline Selection selection_of(const Scene& scene, FaceId face) {
  return {scene.face(face).patch, face, scene.id()};
}
// The faces as selections: a patch if all its faces with area are among them, else its faces. In the order of the
// scene, each once. `faces` without area are left out.
[[nodiscard]] std::vector<Selection> selections_of(const Scene& scene, std::vector<FaceId> faces);

// Of its faces: an estimate.
[[nodiscard]] double area_of(const Scene& scene, const Selection& selection);
[[nodiscard]] std::set<FaceId> faces_of(const Scene& scene, std::span<const Selection> selections);

// Its name in quotation marks, for messages; not more than is easily read.
[[nodiscard]] std::string quoted(const Scene& scene, const Selection& selection);

// "--flip a,b", for a shell. A name with a comma gets a flag of its own. Empty if there is no selection, or if there
// are more than anybody wants to type.
[[nodiscard]] std::string flag_words(const Scene& scene, std::string_view flag, std::span<const Selection> selections);

// "'a', 'b' and 12 more".
[[nodiscard]] std::string listed(const Scene& scene, std::span<const Selection> selections);

}  // namespace exactff
