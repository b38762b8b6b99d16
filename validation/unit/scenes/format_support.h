// Short forms for the tests of the readers.
#pragma once

#include "support/test.h"

namespace exactff::validation {

template <class Read>
std::string error_of(const Read& read) {
  const std::string said = complaint([&] { (void)read(); });
  return said.empty() ? "no error" : said;
}

inline std::string warnings_of(const Scene& scene) {
  std::string text;
  for (const Problem& warning : scene.warnings()) text += warning.message() + "\n";
  return text;
}

inline std::vector<std::string> patch_names(const Scene& scene) {
  std::vector<std::string> names;
  for (const Patch& patch : scene.patches()) names.push_back(patch.name);
  return names;
}

inline const std::vector<std::uint32_t>& ring(const Scene& scene, std::size_t face = 0) {
  return scene.faces()[face].rings.at(0);
}

}  // namespace exactff::validation

namespace exactff {

using validation::error_of;
using validation::patch_names;
using validation::ring;
using validation::warnings_of;

}  // namespace exactff
