// Numbers of patches and faces as a field of the scene's faces.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>

#include "exactff/scene.h"
#include "vtk/vtk.h"

namespace exactff::vtk {

// For write_faces: number c of a face is value(i, c) of the last selection i that has the face, and NaN if none has it.
[[nodiscard]] Field field_of_faces(const Scene& scene, std::string name, std::span<const Selection> selections,
                                   std::size_t components,
                                   const std::function<double(std::size_t i, std::size_t c)>& value);

}  // namespace exactff::vtk
