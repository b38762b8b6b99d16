#include "radiosity/on_faces.h"

#include <string>
#include <vector>

#include "exactff/version.h"
#include "vtk/vtk.h"

namespace exactff::radiosity {

void write_vtk(const Scene& scene, const Solution& solution, const std::filesystem::path& file) {
  const auto field = [&](const char* name, std::vector<BoundedValue> Channel::*quantity, double BoundedValue::*number) {
    return vtk::field_of_faces(scene, name, solution.patches, kChannelNames.size(), [&](std::size_t i, std::size_t c) {
      return (solution.channels[c].*quantity)[i].*number;
    });
  };
  vtk::write_faces(scene,
                   {field("radiosity", &Channel::radiosity, &BoundedValue::value),
                    field("lower", &Channel::radiosity, &BoundedValue::lower),
                    field("upper", &Channel::radiosity, &BoundedValue::upper),
                    field("irradiance", &Channel::irradiance, &BoundedValue::value)},
                   {"exactff " + std::string(kVersion) + ", radiosity"}, file);
}

}  // namespace exactff::radiosity
