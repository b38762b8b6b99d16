// The data of an ExactSource.
#pragma once

#include <vector>

#include "exactff/exact.h"
#include "visibility/source_plane.h"

namespace exactff {

struct ExactSource::Planes {
  SceneId scene;
  Selection selection;
  std::vector<visibility::SourcePlane> planes;
};

struct ExactSourceInside {
  using Planes = ExactSource::Planes;
  [[nodiscard]] static const Planes& planes(const ExactSource& source) { return source.planes(); }
};

namespace exact {

// Throws InputError unless the point is finite and the normal is finite and not zero. Throws std::invalid_argument if
// the receiver's face or the source does not belong to the scene.
void check_arguments(const Scene& scene, const Receiver& receiver, const ExactSource& source);
// The same for the receiver alone, and InputError for a precision cap below one bit.
void check_view_arguments(const Scene& scene, const Receiver& receiver, int precision_cap);

}  // namespace exact
}  // namespace exactff
