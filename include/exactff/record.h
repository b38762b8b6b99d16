// How the visible region of a source was found: the engine, the outcome, and a record of the work.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "exactff/scene.h"

namespace exactff {

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
  kReceiverFace,   // the receiver was made on this face (Receiver::on)
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
  bool horizon_clipped = false;       // the horizon cut the faces
  bool source_joined = false;         // the faces consist of several convex pieces that had to be joined
  std::uint64_t tree_candidates = 0;  // pieces that the bounding-volume tree did not rule out, for all shafts
  std::uint64_t candidates = 0;       // pieces that remain after the exact predicates
  std::uint64_t clipped = 0;          // candidates cut by the source's plane, or by the Booleans' shaft
  std::uint64_t pairs = 0;            // pairs of an edge and another face that the edge engine examined
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

}  // namespace exactff
