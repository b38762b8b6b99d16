// A source of the visible fraction V of a sub-patch, used by the recursion in place of shadow rays.
#pragma once

#include <cstdint>

#include "adaptive/sub_patch.h"

namespace exactff::adaptive {

class PatchVisibility {
 public:
  virtual ~PatchVisibility() = default;
  // The sub-patches in the following calls are parts of this piece of the scene.
  virtual void start(std::uint32_t piece) = 0;
  // V in [0, 1]; the recursion ends at 0 and at 1. Corners are relative to x, in scaled coordinates.
  virtual double fraction(const SubPatch& s) = 0;
};

}  // namespace exactff::adaptive
