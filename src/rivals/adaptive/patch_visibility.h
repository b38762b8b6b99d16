// A source of the visible fraction V of a sub-patch, used by the recursion in place of shadow rays.
#pragma once

#include <cstdint>

#include "adaptive/sub_patch.h"
#include "exactff/adaptive.h"

namespace exactff {
namespace adaptive {

class PatchVisibility {
 public:
  virtual ~PatchVisibility() = default;
  // The sub-patches in the following calls are parts of this piece of the scene.
  virtual void start(std::uint32_t piece) = 0;
  // V in [0, 1]; the recursion ends at 0 and at 1. Corners are relative to x, in scaled coordinates.
  virtual double fraction(const SubPatch& s) = 0;
};

}  // namespace adaptive

struct AdaptiveInside {
  using SourceData = AdaptiveSource::Data;
  // As AdaptiveSolver::form_factor, but where shaft culling leaves V undecided, `visibility` computes V instead of
  // rays.
  [[nodiscard]] static AdaptiveResult form_factor(const AdaptiveSolver& solver, const Receiver& receiver,
                                                  const AdaptiveSource& source, double largest_rho_b,
                                                  const AdaptiveOptions& options,
                                                  adaptive::PatchVisibility& visibility);
};

}  // namespace exactff
