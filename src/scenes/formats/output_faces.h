// The faces of a scene as polygons that a format can hold.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "exactff/scene.h"
#include "formats/writers.h"

namespace exactff::formats {

enum class Polygons {
  kAny,          // any number of corners, not always convex or planar, but without holes
  kFourCorners,  // convex and planar
  kTriangles,
};

struct OutputFace {
  FaceId face{};
  std::vector<std::uint32_t> corners;
};

// In the order of the faces. A face that does not fit is cut at its own vertices, exactly. Faces that cannot be used
// are left out. Faces without area are kept as they are, if the format can hold them. `format` is its name in messages.
[[nodiscard]] std::vector<OutputFace> output_faces(const Scene& scene, Polygons polygons, const std::string& format,
                                                   Losses& losses);

}  // namespace exactff::formats
