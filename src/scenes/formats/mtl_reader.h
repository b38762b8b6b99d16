// Wavefront MTL: the two values of a material that a form factor or a radiosity needs, and whether it lets light
// through.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "exactff/scene.h"
#include "text/text_lines.h"

namespace exactff {

// newmtl, Kd (reflectance, 1 if absent) and Ke (radiosity, 0 if absent), each with one value or three; d, Tr
// and illum for Material::see_through; everything else is ignored. Of two materials with one name the first counts.
// `file` names the text in messages.
std::vector<Material> read_mtl(std::string_view text, const std::string& file, text::ProblemList& problems,
                               text::ProblemList& warnings);

}  // namespace exactff
