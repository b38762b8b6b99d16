// The ray-sampled adaptive algorithm: F. Tampieri, "Accurate Form-Factor Computation", Graphics Gems III
// (1992), with shaft culling after E. Haines and J. Wallace (1991). Estimates; plain double, shadow rays by
// Embree in single precision.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "exactff/receiver.h"
#include "exactff/scene.h"

namespace exactff {

namespace sampled {
class PatchVisibility;
}

enum class SamplePattern { kCentre, kRegular, kJittered, kLowDiscrepancy };

enum class Variant {
  kMended,   // horizon clip, sound cull, double precision
  kLiteral,  // as printed: drops perpendicular pairs, no horizon clip, Eq. (4) by acos in float
};

struct AdaptiveOptions {
  double eps_b = 1e-3;  // radiosity; eps_F = eps_B / max(rho_r B_s)
  double eps_a = 0.0;   // area, square of the scene's unit of length
  int rays = 16;        // shadow rays per undecided sub-patch; kCentre traces one
  SamplePattern pattern = SamplePattern::kJittered;
  std::uint64_t seed = 1;
  Variant variant = Variant::kMended;
  int depth_cap = 48;
  std::uint64_t most_leaves = 0;  // once there are so many, nothing is split any more; 0: no bound
  bool record_leaves = false;
};

// Why the recursion stopped at a leaf.
enum class LeafReason {
  kShaftEmpty,      // no candidate: V = 1, certain
  kShaftCut,        // one candidate cuts the shaft: V = 0, certain
  kSampledVisible,  // every ray got through: V = 1
  kSampledHidden,   // no ray got through: V = 0
  kEpsF,            // F <= eps_F
  kEpsA,            // A <= eps_A
  kDepthCap,        // or there are most_leaves
};
inline constexpr std::size_t kLeafReasonCount = 7;
[[nodiscard]] std::string_view to_string(LeafReason reason);

struct Leaf {
  std::array<Vec3, 4> corners{};  // counter-clockwise seen from the source's front
  int corner_count = 0;           // 3 or 4
  double visibility = 0.0;        // V
  double form_factor = 0.0;       // unoccluded
  int depth = 0;
  LeafReason reason{};
};

struct AdaptiveResult {
  // Finite. In [0, 1] for a source of one face; never negative, and above 1 only where faces of the source that
  // overlap, or errors of V, add up to more. The literal variant can leave [0, 1] on both sides.
  double form_factor = 0.0;
  std::uint64_t leaves = 0;
  std::uint64_t rays = 0;
  std::uint64_t shaft_tests = 0;  // piece against sub-shaft
  std::array<std::uint64_t, kLeafReasonCount> leaves_by_reason{};
  std::vector<std::uint64_t> leaves_by_depth;
  std::vector<Leaf> leaf_list;  // if record_leaves
};

// What depends on the source alone: its faces as triangles and quadrilaterals, and which faces lie in their planes.
// Made by AdaptiveSolver::prepare, for that solver. Immutable, shared between threads.
class AdaptiveSource {
 public:
  AdaptiveSource(AdaptiveSource&&) noexcept;
  AdaptiveSource& operator=(AdaptiveSource&&) noexcept;
  ~AdaptiveSource();

  struct Data;
  [[nodiscard]] const Data& data() const;  // for the library's own modules

 private:
  friend class AdaptiveSolver;
  explicit AdaptiveSource(std::unique_ptr<Data> data);
  std::unique_ptr<Data> data_;
};

// What depends on the scene alone: packed pieces, ray structure. Immutable, shared between threads. Refers to the
// scene it was made from.
class AdaptiveSolver {
 public:
  // Throws InputError where single precision would merge distinct vertices or collapse or flip a face, and where a
  // scene of more than 16 pieces is too thin for the ray structure: not flat, but thinner than about 2^-75 (2.6e-23) of
  // its size along some axis.
  explicit AdaptiveSolver(const Scene& scene);
  AdaptiveSolver(AdaptiveSolver&&) noexcept;
  AdaptiveSolver& operator=(AdaptiveSolver&&) noexcept;
  ~AdaptiveSolver();

  // Faces of the selection that coincide (the same corners, whichever comes first) are taken once; coplanar faces of
  // one source that overlap otherwise count each fully here, and as their union in the exact method.
  [[nodiscard]] AdaptiveSource prepare(const Selection& source) const;

  // Estimates F. `source` must have been prepared by a solver of the same scene (else std::invalid_argument).
  // `largest_rho_b` is the largest rho_r B_s over the channels; where it is 0 the result is 0
  // at once. Depends on nothing but the arguments and, in long candidate lists, on the instruction set that Embree
  // finds (rays are seeded from options.seed, the receiver and the source). Throws InputError where the receiver is
  // not finite or has no normal, or an option is out of range. With eps_b = eps_a = 0 the recursion goes on to the
  // depth cap wherever a shadow's edge is seen: 2^depth leaves or more.
  [[nodiscard]] AdaptiveResult form_factor(const Receiver& receiver, const AdaptiveSource& source, double largest_rho_b,
                                           const AdaptiveOptions& options) const;
  // For the library's own modules: where shaft culling leaves V in doubt, `visibility` is asked instead of rays.
  [[nodiscard]] AdaptiveResult form_factor(const Receiver& receiver, const AdaptiveSource& source, double largest_rho_b,
                                           const AdaptiveOptions& options, sampled::PatchVisibility& visibility) const;
  // The same with prepare(source) each time, which looks at every face of the scene.
  [[nodiscard]] AdaptiveResult form_factor(const Receiver& receiver, const Selection& source, double largest_rho_b,
                                           const AdaptiveOptions& options) const;

  // Seconds spent building the ray structure, apart from everything else. It is built when a candidate list is first
  // too long to be tested directly; 0 until then.
  [[nodiscard]] double build_seconds() const;

 private:
  struct Impl;
  [[nodiscard]] const Impl& impl() const;
  std::unique_ptr<Impl> impl_;
};

}  // namespace exactff
