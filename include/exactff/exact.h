// The exact form factor from a point x (the receiver) to a polygonal source s, with occluders in between. An occluder
// is a face between x and s that hides part of s.
//
//   F(x -> s) = integral over the visible part of s of max(0, cos th_r) max(0, cos th_s) / (pi r^2) dA
//
// F is a pure number in [0, 1]; r is the distance, th_r and th_s are the angles to the normals at x and on s. The
// boundary of the visible region is found exactly. Tampieri's Eq. (4) over this boundary is evaluated in double-double
// arithmetic with a proved error bound. If that does not determine the nearest double, it is evaluated in ball
// arithmetic of increasing precision.
// Source: F. Tampieri, "Accurate Form-Factor Computation", Graphics Gems III (1992).
#pragma once

#include <array>
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

// ------------------------------------------------------------------------------------ how the visible part was found

// How the visible region is found. All engines give the same bits.
enum class Engine {
  kEdges,    // finds the visible parts of every edge, using only signs of determinants
  kBoolean,  // polygon Booleans: the reference engine
  kBoth,     // runs both and compares: std::logic_error if they differ by more than the cap explains
};
[[nodiscard]] std::string_view to_string(Engine engine);

// Which faces are considered as occluders. Both settings give the same bits of values and fractions; the records
// describe the work that was actually done. The shaft is the pyramid from x to the convex hull of the part of the
// source above the horizon; nothing outside it can hide any of the source.
enum class ShaftCulling {
  kTree,  // those that the bounding-volume tree and the half-spaces of the shaft do not rule out
  kNone,  // every face of the scene, to measure what culling saves
};

// The result for one plane of the source. Processing stops as soon as this is known; the later stages are skipped.
enum class Outcome {
  kBuried,         // the receiver, or all that it could see of the faces, is buried (scene.h)
  kReceiverFace,   // the receiver lies in this plane, that of an own face (Receiver::on)
  kBehind,         // x is behind the faces or in their plane
  kBelowHorizon,   // no part lies above the receiver's horizon, the plane through x perpendicular to its normal
  kUnoccluded,     // no occluder in the shaft
  kHiddenByOne,    // a single occluder hides everything
  kPartlyHidden,   // occluders are in the shaft and leave part of the faces visible; see decided_outcome
  kHiddenByUnion,  // the occluders together hide everything, but none of them alone
};
[[nodiscard]] std::string_view to_string(Outcome outcome);

// The work done for those faces of the source that lie in one oriented plane.
struct PlaneRecord {
  std::vector<FaceId> faces;
  Engine engine = Engine::kEdges;  // the engine that did the work
  Outcome outcome = Outcome::kBehind;
  bool horizon_clipped = false;  // the horizon cut the faces
  bool source_joined = false;    // the faces consist of several convex pieces that had to be joined
  // Pieces, or panels that join several in one plane.
  std::uint64_t tree_candidates = 0;  // those that the bounding-volume tree did not rule out, for all shafts
  std::uint64_t candidates = 0;       // those that remain after the exact predicates
  // If silhouettes were searched for: edges that the tree of edges did not rule out, and of these the silhouettes,
  // across which the number of occluders changes, with a part before the source. The pieces beside the former are
  // candidates.
  std::uint64_t tree_edges = 0;
  std::uint64_t silhouettes = 0;
  std::uint64_t clipped = 0;          // candidates cut by the source's plane, or by the Booleans' shaft
  std::uint64_t pairs = 0;            // pairs of an edge and another face, or edge, that the edge engine examined
  std::uint64_t undecided_pairs = 0;  // pairs that the floating-point filter left to exact predicates
  std::uint64_t loops = 0;            // boundary loops integrated; the edge engine does not count them
  std::uint64_t edges = 0;            // boundary pieces integrated; the Booleans merge collinear ones
  // If occluders hide everything: how many were needed for the proof. 1 if one hides all; otherwise often far fewer
  // than the candidates, but not always the fewest possible.
  std::uint64_t cover = 0;
  // Those that hid everything from an earlier receiver (ExactOptions::from_scratch) hide it again, and no others were
  // looked for: they are the candidates.
  bool cover_remembered = false;
  std::optional<double> visible_fraction;     // on request, correctly rounded
  std::optional<std::string> exact_fraction;  // on request: "p/q"
  // How many faces hide a part of it, if that was decided exactly: on request (list_cutters), and 0 if the fraction
  // is 1.
  std::optional<std::uint64_t> cutters;
};

// The outcome, but kUnoccluded instead of kPartlyHidden if `cutters` is 0. The search keeps every face as a candidate
// that no single side of the shaft rules out, so a candidate may hide nothing.
[[nodiscard]] Outcome decided_outcome(const PlaneRecord& plane);

// ----------------------------------------------------------------------------------------------------------- measure

// What is integrated over the directions w, unit vectors, in which the source is visible. n is the receiver's unit
// normal; only directions above its horizon count.
enum class MeasureKind {
  kFormFactor,  // (w . n) / pi: F, in [0, 1]
  kSolidAngle,  // 1: the solid angle, in sr, at most 2 pi
  kOvercast,    // (w . n) (1 + 2 w . up) 3 / (7 pi) where w . up > 0: what x receives of a sky behind the source, over
              // what open ground receives of the whole sky. In [0, 1]. The sky is the overcast one of the CIE (standard
              // sky 16; P. Moon and D. E. Spencer, 1942), whose zenith is `up`: the sky component of a daylight factor
};
[[nodiscard]] std::string_view to_string(MeasureKind kind);  // "form-factor", "solid-angle", "overcast"
[[nodiscard]] std::optional<MeasureKind> measure_named(std::string_view name);

struct Measure {
  MeasureKind kind = MeasureKind::kFormFactor;
  Vec3 up{0.0, 0.0, 1.0};  // of kOvercast: of any length other than zero (else InputError)
  // The receiver is a small sphere, without a normal: directions on both sides of it count. The form factor from the
  // sphere is the solid angle over 4 pi. Not with kOvercast (else InputError).
  bool sphere = false;

  [[nodiscard]] bool is_form_factor() const { return kind == MeasureKind::kFormFactor && !sphere; }
  friend bool operator==(const Measure&, const Measure&) = default;
};

// ------------------------------------------------------------------------------------------------------- form factor

enum class Status {
  kCertified,     // value is the correctly rounded F > 0; as the other three, also of another measure in place of F
  kZero,          // F is proved to be exactly 0
  kUnderflow,     // F is positive and rounds to 0
  kNotCertified,  // the precision cap was reached; the enclosure is valid, value is its rounded midpoint
};
[[nodiscard]] std::string_view to_string(Status status);

// One line of the explanation of a result: one stage.
struct StageNote {
  std::string stage;
  bool ran = false;
  std::string note;  // what it did, or why it was skipped
};
[[nodiscard]] std::vector<StageNote> stages(const PlaneRecord& plane);

// Which part of the source is visible, decided exactly. (The fraction may round to 0 or 1 although a part is visible or
// hidden.)
enum class VisiblePart { kNothing, kSome, kAll };
[[nodiscard]] std::string_view to_string(VisiblePart part);

// ---------------------------------------------------------------------------------------------------------- gradient

enum class DerivativeStatus {
  kCertified,  // value is the correctly rounded derivative, which is not 0
  kZero,       // the derivative is proved to be exactly 0
  kUnderflow,  // the derivative is not 0 and rounds to 0
  kEnclosed,   // the enclosure is valid, but does not determine the double: it still contains 0 at 256 bits, or the
               // derivative is beyond the range of doubles, or the precision cap was reached. value is 0 if the
               // enclosure contains 0, else its rounded midpoint
  kNone,       // the derivative does not exist: value is NaN, and there is no enclosure
};
[[nodiscard]] std::string_view to_string(DerivativeStatus status);

// One number, with its proof.
struct Derivative {
  double value = 0.0;
  DerivativeStatus status = DerivativeStatus::kZero;
  Enclosure enclosure;
};

// Why F has no derivative by the receiver's point.
enum class KinkReason {
  kEdgeOn,        // x sees a face edge-on, where a movement shows or hides something
  kCoincident,    // x sees lines at different depths as one line, where a movement shows or hides something
  kSourceEdgeOn,  // x sees the source edge-on, and sees it from one side of its plane
  kOnFace,        // x lies on a face that is not its own
};
[[nodiscard]] std::string_view to_string(KinkReason reason);

struct Kink {
  KinkReason reason = KinkReason::kEdgeOn;
  std::vector<FaceId> faces;  // that meet there, ascending; of the source those in its plane
};

// An arc of the visible boundary whose line in space moves it: what it adds to dF/dx. Estimates, for people.
struct GradientArc {
  Vec3 begin, end;  // on the line, at the ends of the arc
  Vec3 part;
};

// The derivatives of F by the three coordinates of a vertex, per unit of length. Vertices at equal coordinates move
// together.
struct VertexDerivative {
  std::uint32_t vertex = 0;  // the lowest index of those at its coordinates
  bool is_kink = false;      // F has no derivative by this vertex
  std::array<Derivative, 3> position;
};

// The derivatives of F at a receiver. F = n . V / |n|, where V does not depend on the normal n.
//
// Each arc of the visible boundary lies on a line in space: an edge, or the cut of a face with the source's plane. If x
// moves by d, the arc moves, and F changes by
//
//   dF = 1/pi sum over arcs of (d . m) integral of (w . n) / r along the arc
//
// m is the unit normal of the arc's plane, into the visible region; w a unit direction along the arc; r the distance of
// the line in this direction; n the unit normal at x. Arcs on the horizon add nothing, since there w . n = 0.
//
// Kinks. Where x sees a face edge-on, or lines at different depths as one line, a movement may show or hide something
// on one side only. F then has no derivative. This is decided by exact signs, whether or not anything there bounds the
// view now: a sheet seen edge-on inside the view bounds nothing, and where two shadows abut at different depths, F is 0
// there and on one side. There is no kink where another face covers both sides; along the horizon, so neighbours of the
// receiver's own face in its plane make none; for edges on one line in space; and where faces join to one surface that
// hides on both sides. Each plane of a source is judged by itself: where its faces hide each other along an edge-on
// face, a kink may be reported although the sum over the planes has a derivative.
//
// Vertices. Only lines that bound the view move it, so a diagonal of a face that was cut into pieces does not; nor does
// the horizon. A plane follows three vertices of its face: the lowest that are not on a line; of a face that is not
// planar, those of its triangle. Other corners move outlines alone. So the derivative is the true one also for faces of
// more corners, unless such a plane is tilted. Faces without area are left out, although they may get one. Exactly, as
// sums of balls:
//
//   dF/dx + sum dF/dv = 0,   x . dF/dx + sum v . dF/dv = 0,   x X dF/dx + n X dF/dn + sum v X dF/dv = 0
//
// F has no derivative by vertices of lines that coincide and would move apart, such as those of two walls that abut
// without sharing their corners; and of edges in the source's plane, such as the foot of a block on it: if such an
// edge, or the source's frame, moves one way, a part of the source becomes visible. A face that lies on a visible part
// of the source has none either: F would jump. Where several planes move in different ways, and where such a face may
// be hidden by others, a kink may be reported although there is none; this may depend on how a concave face is cut. But
// no derivative is given where there is none.
struct Gradient {
  std::optional<Kink> kink;            // set if dF/dx does not exist: the first one found
  std::array<Derivative, 3> position;  // dF/dx by each coordinate of the point, per unit of length
  std::array<Derivative, 3> normal;    // V, a pure number: dF/dn at a unit normal. It exists at kinks, too
  // On request: the one-sided derivative by a movement along a direction, per unit of length. Exists at kinks except
  // kOnFace, where F may jump.
  std::optional<Derivative> along;
  std::vector<GradientArc> arcs;  // on request, the largest part first; not at kinks
  // On request: the vertices by which the derivative is not proved to be zero, and those at kinks, ascending; not at
  // kinks of dF/dx. The receiver stays. Where a face meets the source's plane, the border moves with both planes. The
  // three vertices that the source's plane follows are `frames`, one for each face, or for faces that overlap in one.
  std::vector<VertexDerivative> vertices;
  std::vector<std::array<std::uint32_t, 3>> frames;
};

struct FormFactor {
  double value = 0.0;  // of ExactOptions::measure, as the bounds and the enclosure
  double lower = 0.0;  // if certified: the neighbouring doubles of value, clamped to the range of the measure
  double upper = 0.0;
  Status status = Status::kZero;
  Enclosure enclosure;                      // contains F
  std::optional<double> visible_fraction;   // on request: visible area over whole unclipped area, correctly rounded
  std::optional<VisiblePart> visible_part;  // set if visible_fraction is set
  // On request: the faces whose shadow overlaps the clipped source, in ascending order. If one face hides a whole
  // plane, it is the only one listed for that plane, because the search stops there.
  std::vector<FaceId> cutters;
  std::vector<PlaneRecord> planes;
  int precision_bits = 0;            // precision of the last contour evaluation; 0 if none was needed
  std::optional<Gradient> gradient;  // on request
};

struct ExactOptions {
  Engine engine = Engine::kEdges;
  Measure measure = {};  // with a gradient, only the form factor (else InputError)
  bool visible_fraction = false;
  bool exact_fraction = false;  // implies visible_fraction
  bool list_cutters = false;
  bool gradient = false;
  bool list_arcs = false;          // of the gradient, which is then computed
  bool vertices = false;           // of the gradient, which is then computed
  std::optional<Vec3> along = {};  // implies gradient; a direction of any length other than zero (else InputError)
  int digits = 0;                  // raises the precision until this many significant digits are certified, if possible
  int precision_cap = 65536;       // bits, at least 1 (else InputError)
  const std::vector<FaceId>* only_occluders = nullptr;  // ascending; all other faces are ignored
  ShaftCulling culling = ShaftCulling::kTree;
  // Does not try first what hid the source from an earlier receiver (with the same workspace). Otherwise the counts in
  // the records, but nothing else, depend on earlier calls.
  bool from_scratch = false;
};

// The data that depend on the source alone, computed once for many receivers. Keeps a reference to the scene.
class ExactSource {
 public:
  ExactSource(const Scene& scene, const Selection& selection);
  ExactSource(ExactSource&&) noexcept;
  ExactSource& operator=(ExactSource&&) noexcept;
  ~ExactSource();

  [[nodiscard]] const Selection& selection() const;

 private:
  friend struct ExactSourceInside;  // see scene.h
  struct Planes;
  [[nodiscard]] const Planes& planes() const;
  std::unique_ptr<Planes> planes_;
};

// Memory that is reused from one call to the next. It affects no result but counts of work in the records, and these
// only where faces that hid a source from one receiver hide it from the next one, too (ExactOptions::from_scratch).
// Concurrent calls need one each.
class Workspace {
 public:
  Workspace();
  Workspace(Workspace&&) noexcept;
  Workspace& operator=(Workspace&&) noexcept;
  ~Workspace();

 private:
  friend struct WorkspaceInside;  // see scene.h
  struct Memory;
  [[nodiscard]] Memory& memory();
  std::unique_ptr<Memory> memory_;
};

// The form factor from `receiver` to `source`. If certified, `value` is the true F, correctly rounded; `enclosure`
// always contains F. Requires a source and a receiver face of this scene (else std::invalid_argument), and finite
// coordinates, a normal other than zero and a precision cap of at least one bit (else InputError). Threads may call it
// concurrently. The result depends on the arguments alone, even if the thread uses another rounding mode or flushes
// small numbers to zero.
[[nodiscard]] FormFactor exact_form_factor(const Scene& scene, const Receiver& receiver, const ExactSource& source,
                                           const ExactOptions& options = {});
// As above, into a result and with a workspace that the caller keeps. Every field is set again, in the existing memory.
// Once the memory is large enough, nothing is allocated, unless the value needs more than double-double precision, the
// Booleans take over (`engine` in a plane's record), or the options request additional output. The options must not
// point into `result`. After an exception the content of `result` is unspecified.
void exact_form_factor(const Scene& scene, const Receiver& receiver, const ExactSource& source,
                       const ExactOptions& options, FormFactor& result, Workspace& workspace);
// As above, with a workspace that belongs to the calling thread, and from scratch. The first form uses it, too.
void exact_form_factor(const Scene& scene, const Receiver& receiver, const ExactSource& source,
                       const ExactOptions& options, FormFactor& result);

// True if x is behind every face of the source or in its plane. Then F is 0, often because of a flipped normal.
[[nodiscard]] bool behind_every_face(const FormFactor& result);

// ----------------------------------------------------------------------------------------------------------- drawing

// The exact geometry rounded to doubles, for pictures and for counting silent errors. No value depends on it. Loops are
// counter-clockwise as seen from x, holes clockwise.
struct Loop {
  std::vector<Vec3> corners;
  bool hole = false;
};
struct PlaneDrawing {
  Vec3 normal;                       // front, not normalised
  std::vector<Loop> source;          // whole faces, unclipped
  std::vector<Loop> clipped_source;  // the part above the horizon
  struct Shadow {
    FaceId face{};
    Loop outline;  // convex
  };
  std::vector<Shadow> shadows;  // the shadow of each candidate, clipped to the convex hull of the source
  std::vector<Loop> visible;
};
[[nodiscard]] std::vector<PlaneDrawing> draw_visibility(const Scene& scene, const Receiver& receiver,
                                                        const ExactSource& source);

}  // namespace exactff
