// A row of a matrix on the scene, for ParaView.
#pragma once

#include <filesystem>

#include "exactff/matrix.h"
#include "exactff/scene.h"

namespace exactff::matrix {

// Writes the factors of the first row and their bounds at the faces of the columns, NaN elsewhere. Requires a row.
// Throws as vtk::write_faces does.
void write_vtk(const Scene& scene, const Matrix& matrix, const std::filesystem::path& file);

}  // namespace exactff::matrix
