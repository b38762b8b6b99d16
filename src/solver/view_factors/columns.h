// What the columns of a matrix are. Only between patches of the scene is the factor of the other direction wanted, too.
#pragma once

namespace exactff::view_factors {

enum class Columns {
  kPatches,
  // Each is a patch of copies of faces, turned or not. Where closed surfaces hide these, that is proved first
  // (enclosures.h).
  kBacks,
  // Each is a patch through which something is seen that lies beyond.
  kWindows,
  // Each is a patch whose fronts lie all around the scene and look inward, at infinity as it were, and that hides
  // nothing. The factor to it is what the occluders leave of all directions.
  kSurroundings,
};

}  // namespace exactff::view_factors
