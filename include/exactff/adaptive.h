// Tampieri's adaptive algorithm, which estimates a form factor with ray-sampled visibility. It splits the source until
// a limit in AdaptiveOptions is met. The parts that it does not split further are the leaves. Shaft culling or shadow
// rays give each leaf a visibility V in [0, 1].
// Estimates only. Arithmetic is in plain double; Embree traces the shadow rays in single precision.
// Source: F. Tampieri, "Accurate Form-Factor Computation", Graphics Gems III (1992); shaft culling after E. Haines and
// J. Wallace (1991).
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "exactff/receiver.h"
#include "exactff/scene.h"

namespace exactff {

enum class SamplePattern { kCentre, kRegular, kJittered, kLowDiscrepancy };

enum class Variant {
  kMended,   // with a horizon clip, a sound shaft cull and double precision
  kLiteral,  // as printed: drops perpendicular pairs, no horizon clip, Eq. (4) by acos in float
};

[[nodiscard]] std::string_view to_string(SamplePattern pattern);
[[nodiscard]] std::string_view to_string(Variant variant);
[[nodiscard]] std::optional<SamplePattern> pattern_named(std::string_view name);
[[nodiscard]] std::optional<Variant> variant_named(std::string_view name);

struct AdaptiveOptions {
  double eps_b = 1e-3;  // a radiosity: leaves with F <= eps_F are not split, eps_F = eps_B / max(rho_r B_s)
  double eps_a = 0.0;   // an area, in the square of the scene's unit of length: leaves with A <= eps_A are not split
  int rays = 16;        // shadow rays per undecided sub-patch; kCentre traces one
  SamplePattern pattern = SamplePattern::kJittered;
  std::uint64_t seed = 1;
  Variant variant = Variant::kMended;
  int depth_cap = 48;
  std::uint64_t most_leaves = 0;  // splitting stops at this number of leaves; 0: no bound
  bool record_leaves = false;
  std::uint64_t most_recorded_leaves = 0;  // records all leaves down to a depth, at most so many; 0: no bound
  friend bool operator==(const AdaptiveOptions&, const AdaptiveOptions&) = default;
};

// Why the recursion stopped at a leaf.
enum class LeafReason {
  kShaftEmpty,      // no candidate: V = 1, certain
  kShaftCut,        // one candidate cuts the shaft: V = 0, certain
  kSampledVisible,  // every ray got through: V = 1
  kSampledHidden,   // no ray got through: V = 0
  kEpsF,            // F <= eps_F
  kEpsA,            // A <= eps_A
  kDepthCap,        // depth_cap or most_leaves was reached
};
inline constexpr std::size_t kLeafReasonCount = 7;
[[nodiscard]] std::string_view to_string(LeafReason reason);

struct Leaf {
  std::array<Vec3, 4> corners{};  // counter-clockwise as seen from the source's front
  int corner_count = 0;           // 3 or 4
  double visibility = 0.0;        // V
  double form_factor = 0.0;       // unoccluded
  int depth = 0;
  LeafReason reason{};
};

struct AdaptiveResult {
  // Always finite. In [0, 1] for a source of one face. For several faces it is never negative, and it exceeds 1 only
  // where overlapping faces of the source, or errors of V, add up to more. The literal variant can leave [0, 1] on both
  // sides.
  double form_factor = 0.0;
  std::uint64_t leaves = 0;
  std::uint64_t rays = 0;
  std::uint64_t shaft_tests = 0;  // tests of one piece of the scene against one sub-shaft
  std::array<std::uint64_t, kLeafReasonCount> leaves_by_reason{};
  std::vector<std::uint64_t> leaves_by_depth;
  std::vector<Leaf> leaf_list;  // if record_leaves
};

// The data that depend on the source alone: its faces as triangles and quadrilaterals, and the faces that lie in their
// planes. Made by AdaptiveSolver::prepare, and valid for solvers of the same scene. Immutable; threads may share it.
class AdaptiveSource {
 public:
  AdaptiveSource(AdaptiveSource&&) noexcept;
  AdaptiveSource& operator=(AdaptiveSource&&) noexcept;
  ~AdaptiveSource();

 private:
  friend struct AdaptiveInside;  // see scene.h
  friend class AdaptiveSolver;
  struct Data;
  [[nodiscard]] const Data& data() const;
  explicit AdaptiveSource(std::unique_ptr<Data> data);
  std::unique_ptr<Data> data_;
};

// The data that depend on the scene alone: packed pieces and the ray-tracing structure. Immutable; threads may share
// it. Keeps a reference to the scene it was made from.
class AdaptiveSolver {
 public:
  // Throws InputError if single precision would merge distinct vertices or collapse or flip a face. Also throws it if a
  // scene of more than 16 pieces is too thin for the ray-tracing structure: not flat, but thinner along some axis than
  // about 2^-75 (2.6e-23) of its size.
  explicit AdaptiveSolver(const Scene& scene);
  AdaptiveSolver(AdaptiveSolver&&) noexcept;
  AdaptiveSolver& operator=(AdaptiveSolver&&) noexcept;
  ~AdaptiveSolver();

  // Faces of the selection with the same corners in the same order (starting at any of them) count once. Coplanar faces
  // of one source that overlap in any other way each count in full here; the exact method counts their union.
  [[nodiscard]] AdaptiveSource prepare(const Selection& source) const;

  // Estimates F. `source` must have been prepared by a solver of the same scene (else std::invalid_argument).
  // `largest_rho_b` is the largest rho_r B_s over the channels; if it is 0, the result is 0 and no work is done, except
  // for the literal variant with eps_b > 0. Throws InputError if the receiver is not finite or has no normal, or if an
  // option is out of range.
  // The result depends on the arguments alone and, for long candidate lists, on the instruction set that Embree
  // detects. (Rays are seeded from options.seed, the receiver and the source.) With eps_b = eps_a = 0 the recursion
  // goes down to the depth cap wherever it sees the edge of a shadow: 2^depth leaves or more.
  [[nodiscard]] AdaptiveResult form_factor(const Receiver& receiver, const AdaptiveSource& source, double largest_rho_b,
                                           const AdaptiveOptions& options) const;
  // As above, but calls prepare(source) each time, which visits every face of the scene.
  [[nodiscard]] AdaptiveResult form_factor(const Receiver& receiver, const Selection& source, double largest_rho_b,
                                           const AdaptiveOptions& options) const;

  // Seconds spent building the ray-tracing structure, measured on its own. It is built when a candidate list is first
  // too long to test directly; 0 before that.
  [[nodiscard]] double build_seconds() const;

 private:
  friend struct AdaptiveInside;  // see scene.h
  struct Impl;
  [[nodiscard]] const Impl& impl() const;
  std::unique_ptr<Impl> impl_;
};

}  // namespace exactff
