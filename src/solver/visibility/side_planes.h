// Decides on which sides of a few planes a piece of up to four corners lies, by the filter alone and for all corners at
// once.
#pragma once

#include <array>
#include <span>

#include "visibility/outlines.h"

namespace exactff::visibility {

// A corner t, a direction from x, lies above the plane if normal . t > offset. This is certain if the two sides differ
// by more than error_per_size |t| + error, where |t| is the largest component.
struct SidePlane {
  Vec3 normal;
  double offset = 0.0;
  double error_per_size = 0.0;
  double error = 0.0;
};

using FourCorners = std::array<const Outlines::Corner*, 4>;  // a triangle's last corner repeated

struct Sides {
  bool certain = false;                 // if false, the other members mean nothing
  bool some_above_each = false;         // every plane has a corner above it
  bool all_above_each = false;          // every corner lies above every plane
  bool some_below_first = false;        // a corner lies below the first plane
  Outlines::LineBits wholly_above = 0;  // a bit for each of the first planes: all corners lie above it
  bool beside = false;                  // every corner lies below one plane; false if that took no filter
};

inline constexpr Sides kInsideShaft{.certain = true, .some_above_each = true, .all_above_each = true};

Sides sides_of(std::span<const SidePlane> planes, const FourCorners& corners);

}  // namespace exactff::visibility
