// What an ExactSource holds.
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

namespace exact {

// Throws InputError unless the point is finite and the normal finite and not zero; std::invalid_argument where the
// receiver's face or the source is not the scene's.
void check_arguments(const Scene& scene, const Receiver& receiver, const ExactSource& source);

}  // namespace exact
}  // namespace exactff
