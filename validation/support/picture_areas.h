// The areas of a picture of a whole view (exactff/view.h), from the text of the SVG document alone. Arcs are
// read as the SVG 1.1 standard says (appendix F.6) and integrated numerically.
#pragma once

#include <map>
#include <string>
#include <utility>

namespace exactff::validation {

struct PictureArea {
  double share = 0.0;  // of the hemisphere, weighted by the cosine: a form factor
  std::size_t sides = 0;
  std::size_t arcs = 0;  // of these
};

// By class (front, back, open) and name.
using PictureAreas = std::map<std::pair<std::string, std::string>, PictureArea>;
[[nodiscard]] PictureAreas picture_areas(const std::string& svg, bool fisheye);

}  // namespace exactff::validation
