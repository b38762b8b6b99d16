// Wavefront MTL: the two numbers of a material that a form factor or a radiosity needs.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "exactff/scene.h"
#include "scene/text_lines.h"

namespace exactff {

// newmtl, Kd (reflectance, 1 if absent) and Ke (radiosity, 0 if absent), each with one value or three; everything
// else is passed over. Of two materials of one name the first counts. `file` stands for the text in messages.
std::vector<Material> read_mtl(std::string_view text, const std::string& file, ProblemList& problems,
                               ProblemList& warnings);

}  // namespace exactff
