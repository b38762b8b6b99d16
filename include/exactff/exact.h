// The exact form factor from a point to a polygonal source with occluders in between.
//
//   F(x -> s) = integral over the visible part of s of max(0, cos th_r) max(0, cos th_s) / (pi r^2) dA
//
// A pure number in [0, 1]. The boundary of the visible region is found exactly. Tampieri's Eq. (4) over it is evaluated
// in double-double arithmetic with a proved error bound, and where that does not determine the nearest double, in ball
// arithmetic of rising precision.
// Source: F. Tampieri, "Accurate Form-Factor Computation", Graphics Gems III (1992).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "exactff/enclosure.h"
#include "exactff/receiver.h"
#include "exactff/scene.h"

namespace exactff {

enum class Status {
  kCertified,     // value is the correctly rounded F > 0
  kZero,          // F is proved to be exactly 0
  kUnderflow,     // F is positive and rounds to 0
  kNotCertified,  // the precision cap was met; the enclosure is valid, value is its midpoint rounded
};
[[nodiscard]] std::string_view to_string(Status status);

// How the visible region is found. Both ways give the same bits.
enum class Engine {
  kEdges,    // what is left of every edge, by signs of determinants alone
  kBoolean,  // polygon Booleans: the reference
  kBoth,     // both, one checked against the other: std::logic_error where they differ by more than the cap explains
};
[[nodiscard]] std::string_view to_string(Engine engine);

// Who is looked at as a possible occluder. Both ways give the same bits of values and fractions; the records tell of
// the work that was done.
enum class ShaftCulling {
  kTree,  // what the bounding-volume tree and the half-spaces of the shaft do not rule out
  kNone,  // every face of the scene, as if there were no shaft: to measure what it saves
};

// How far one plane of the source had to be followed; every later stage had no work.
enum class Outcome {
  kReceiverFace,   // the receiver lies on this face by construction
  kBehind,         // x is behind or in the plane of the faces
  kBelowHorizon,   // no part lies above the receiver's horizon
  kUnoccluded,     // nothing in the shaft
  kHiddenByOne,    // one occluder hides all
  kPartlyHidden,   // the occluders leave a part visible
  kHiddenByUnion,  // the occluders hide all of it together, none of them alone
};
[[nodiscard]] std::string_view to_string(Outcome outcome);

// What was done for the faces of the source that lie in one oriented plane.
struct PlaneRecord {
  std::vector<FaceId> faces;
  Engine engine = Engine::kEdges;  // that did the work
  Outcome outcome = Outcome::kBehind;
  bool horizon_clipped = false;               // the horizon cut the faces
  bool source_joined = false;                 // more than one convex piece had to be joined
  std::uint64_t tree_candidates = 0;          // pieces the bounding-volume tree could not rule out, in each shaft
  std::uint64_t candidates = 0;               // pieces left by the exact predicates
  std::uint64_t clipped = 0;                  // candidates that the source's plane, or the Booleans' shaft, cuts
  std::uint64_t pairs = 0;                    // of an edge and another face, looked at by the edge engine
  std::uint64_t undecided_pairs = 0;          // those that the floating-point filter left to exact predicates
  std::uint64_t loops = 0;                    // boundary loops integrated; the edge engine does not count them
  std::uint64_t edges = 0;                    // boundary pieces integrated; the Booleans merge collinear ones
  std::optional<double> visible_fraction;     // on request, correctly rounded
  std::optional<std::string> exact_fraction;  // on request: "p/q"
};

// One line of the account that a result gives of itself.
struct StageNote {
  std::string stage;
  bool ran = false;
  std::string note;  // what it did, or why it was left out
};
[[nodiscard]] std::vector<StageNote> stages(const PlaneRecord& plane);

// How much of the source is visible, decided exactly: the fraction itself may round to 0 or 1.
enum class VisiblePart { kNothing, kSome, kAll };
[[nodiscard]] std::string_view to_string(VisiblePart part);

struct FormFactor {
  double value = 0.0;
  double lower = 0.0;  // when certified: the neighbouring doubles of value, clamped to [0, 1]
  double upper = 0.0;
  Status status = Status::kZero;
  Enclosure enclosure;                      // holds F
  std::optional<double> visible_fraction;   // on request: visible over whole unclipped area, correctly rounded
  std::optional<VisiblePart> visible_part;  // with it
  // On request: faces whose shadow overlaps the clipped source, ascending. Where one face hides a whole plane, it alone
  // is listed for that plane: the search ends there.
  std::vector<FaceId> cutters;
  std::vector<PlaneRecord> planes;
  int precision_bits = 0;  // of the last contour evaluation; 0 if none was needed
};

struct ExactOptions {
  Engine engine = Engine::kEdges;
  bool visible_fraction = false;
  bool exact_fraction = false;  // implies visible_fraction
  bool list_cutters = false;
  int digits = 0;             // raise the precision until so many decimals are certified, if they can be
  int precision_cap = 65536;  // bits, at least 1 (else InputError)
  const std::vector<FaceId>* only_occluders = nullptr;  // ascending; every other face is ignored
  ShaftCulling culling = ShaftCulling::kTree;
};

// What depends on the source alone, computed once. Refers to the scene it was made from.
class ExactSource {
 public:
  ExactSource(const Scene& scene, const Selection& selection);
  ExactSource(ExactSource&&) noexcept;
  ExactSource& operator=(ExactSource&&) noexcept;
  ~ExactSource();

  [[nodiscard]] const Selection& selection() const;
  struct Planes;
  [[nodiscard]] const Planes& planes() const;

 private:
  std::unique_ptr<Planes> planes_;
};

// Exact (value), encloses (enclosure). `source` must have been made from `scene` (else std::invalid_argument). Requires
// finite coordinates and a normal other than zero (else InputError). Safe to call from several threads at once; the
// result depends on nothing but the arguments, also where the thread rounds otherwise than to nearest or flushes small
// numbers to zero.
[[nodiscard]] FormFactor exact_form_factor(const Scene& scene, const Receiver& receiver, const ExactSource& source,
                                           const ExactOptions& options = {});
// The same into a result that the caller keeps: every field is set anew in the memory that there is. From the second
// time on nothing is allocated, unless the value takes more than double-double, the Booleans take over (`engine` of a
// plane's record), or options ask for more. These must not point into `result`, of which an exception leaves nothing to
// rely on.
void exact_form_factor(const Scene& scene, const Receiver& receiver, const ExactSource& source,
                       const ExactOptions& options, FormFactor& result);

// True where x is behind or in the plane of every face of the source: F is 0 for a reason that is
// often a flipped normal.
[[nodiscard]] bool behind_every_face(const FormFactor& result);

// The exact geometry rounded to doubles, for pictures and for counting silent errors. No value depends on it. Loops run
// counter-clockwise as x sees them, holes clockwise.
struct Loop {
  std::vector<Vec3> corners;
  bool hole = false;
};
struct PlaneDrawing {
  Vec3 normal;                       // front, not normalised
  std::vector<Loop> source;          // whole faces, unclipped
  std::vector<Loop> clipped_source;  // above the horizon
  struct Shadow {
    FaceId face{};
    Loop outline;  // convex
  };
  std::vector<Shadow> shadows;  // of each candidate, clipped to the source's hull
  std::vector<Loop> visible;
};
[[nodiscard]] std::vector<PlaneDrawing> draw_visibility(const Scene& scene, const Receiver& receiver,
                                                        const ExactSource& source);

}  // namespace exactff
