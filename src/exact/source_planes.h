// What an ExactSource holds.
#pragma once

#include <vector>

#include "exactff/exact.h"
#include "visibility/source_plane.h"

namespace exactff {

struct ExactSource::Planes {
  Selection selection;
  std::vector<visibility::SourcePlane> planes;
};

namespace exact {

// Throws InputError unless the point is finite and the normal finite and not zero.
void check_receiver(const Receiver& receiver);

}  // namespace exact
}  // namespace exactff
