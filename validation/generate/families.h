// The library's own, under the name by which tests know it, and a list of them.
#pragma once

#include <array>
#include <span>
#include <string_view>

#include "generate/plain_scene.h"
#include "models/families.h"

namespace exactff::models {

struct Family {
  std::string_view name;
  std::string_view summary;
  PlainScene (*make)(const FamilyOptions&);
};

[[nodiscard]] inline std::span<const Family> families() {
  static constexpr std::array<Family, 7> kFamilies{{
      {"karkanis", "n random triangles of one normal between receiver and source", &karkanis},
      {"soup", "n random triangles of any orientation", &soup},
      {"blinds", "n tilted slats", &blinds},
      {"tiles", "n x n abutting squares that hide all (dyadic if n is a power of two, else decimal)", &tiles},
      {"mesh", "a closed sphere of about n triangles", &mesh},
      {"lattice", "n degenerate faces on a lattice of 1/64", &lattice},
      {"room", "a room with a window, a blind of n slats and a table", &room},
  }};
  return kFamilies;
}

}  // namespace exactff::models
