#include "gradient/sight_groups.h"

#include <cmath>
#include <limits>

#include "kernel/vec.h"

namespace exactff::gradient {

namespace {

// A direction in general position.
constexpr Vec3 kAnywhere{0.5398041762934, 0.2874930211667, 0.7911734960021};

}  // namespace

// The number of the plane with the normal N is |N . c| / |N| for a fixed vector c of about unit length. The components
// of N are known to within e = 2^-49 |a||b| (outlines.h). So its error is below 2 sqrt(3) e / |N| + 8u, for which
// edge.error / |N| + 2^-48 is more than enough.
void SightGroups::add(const visibility::Outlines& outlines, visibility::EdgeId id) {
  const visibility::Outlines::Edge& edge = outlines.edge(id);
  const double length = std::sqrt(kernel::dot(edge.normal, edge.normal));
  const double number = std::abs(kernel::dot(edge.normal, kAnywhere)) / length;
  const double error = edge.error / length + 0x1p-48;
  constexpr double kUnbounded = std::numeric_limits<double>::infinity();
  if (error < 0x1p-10 && number <= 2.0) {
    entries_.push_back({number - error, number + error, id});
  } else {
    entries_.push_back({-kUnbounded, kUnbounded, id});
  }
}

}  // namespace exactff::gradient
