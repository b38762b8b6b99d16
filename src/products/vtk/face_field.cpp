#include "vtk/face_field.h"

#include <limits>
#include <utility>
#include <vector>

namespace exactff::vtk {

Field field_of_faces(const Scene& scene, std::string name, std::span<const Selection> selections,
                     std::size_t components, const std::function<double(std::size_t, std::size_t)>& value) {
  std::vector<double> values(components * scene.faces().size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < selections.size(); ++i) {
    for (const FaceId face : scene.faces_of(selections[i])) {
      for (std::size_t c = 0; c < components; ++c) values[components * index_of(face) + c] = value(i, c);
    }
  }
  return {std::move(name), components, std::move(values)};
}

}  // namespace exactff::vtk
