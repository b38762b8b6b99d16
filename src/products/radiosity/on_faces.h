// A solution on the scene, for ParaView.
#pragma once

#include <filesystem>

#include "exactff/radiosity.h"
#include "exactff/scene.h"

namespace exactff::radiosity {

// Writes the radiosities, their bounds and the irradiances at the faces of the patches, three channels each, NaN
// elsewhere. Throws as vtk::write_faces does.
void write_vtk(const Scene& scene, const Solution& solution, const std::filesystem::path& file);

}  // namespace exactff::radiosity
