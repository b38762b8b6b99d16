// Wavefront MTL: the two values of a material that a form factor or a radiosity needs, and whether it lets light
// through.
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "exactff/error.h"
#include "exactff/scene.h"
#include "text/text_lines.h"

namespace exactff {

// newmtl, Kd (reflectance, 1 if absent) and Ke (radiosity, 0 if absent), each with one value or three; d, Tr
// and illum for Material::see_through; everything else is ignored. Of two materials with one name the first counts.
// `file` names the text in messages.
std::vector<Material> read_mtl(std::string_view text, const std::string& file, text::ProblemList& problems,
                               text::ProblemList& warnings);

// --- Converted names ---

// The names of a file that are not UTF-8. They are converted, and the user is told once for each file.

class ConvertedNames {
 public:
  void add(std::size_t line, std::string_view name);
  [[nodiscard]] const std::set<std::string>& names() const { return names_; }  // as they are in the file
  [[nodiscard]] Problem warning(const std::string& file) const;                // requires at least one name

 private:
  std::set<std::string> names_;
  std::string first_;
  std::size_t first_line_ = 0;
};

}  // namespace exactff
