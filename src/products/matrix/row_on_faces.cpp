#include "matrix/row_on_faces.h"

#include <string>

#include "exactff/version.h"
#include "kernel/expect.h"
#include "vtk/vtk.h"

namespace exactff::matrix {

void write_vtk(const Scene& scene, const Matrix& matrix, const std::filesystem::path& file) {
  const Factors& all = matrix.factors;
  EXACTFF_EXPECT(!all.from.empty());
  const auto field = [&](const char* name, double ViewFactor::*number) {
    return vtk::field_of_faces(scene, name, all.to, 1,
                               [&](std::size_t j, std::size_t) { return all.at(0, j).*number; });
  };
  vtk::write_faces(
      scene,
      {field("factor", &ViewFactor::value), field("lower", &ViewFactor::lower), field("upper", &ViewFactor::upper)},
      {"exactff " + std::string(kVersion) + ", view factors from " + scene.name_of(all.from.front())}, file);
}

}  // namespace exactff::matrix
