// The whole view from a point: what is seen in every direction, exactly, with the form factors of all patches.
//
// What is seen in a direction above the horizon is the nearest face whose plane does not hold x and that is not one of
// the receiver's own faces. Transparent faces are left out. Of coplanar faces the one with the lowest index is seen. A
// front counts for its patch, a back for `back`, and a direction that meets nothing for `open`. The shares of all
// fronts, `back` and `open` add up to 1.
//
// The form factor of a patch (exact.h) is its share, except where coplanar faces of different patches overlap, or of
// one patch that look opposite ways: each then counts fully in its form factor.
//
// All edges of the view are found in one sweep: every edge lies between two things seen, and counts for both. Source of
// the question: T. Karkanis, "Accurate Point-To-Patch Form Factors", University of Toronto, about 1999.
#pragma once

#include <optional>
#include <vector>

#include "exactff/exact.h"

namespace exactff {

// A share of the light leaving x, as in FormFactor. If certified, `value` is the true share, correctly rounded;
// `enclosure` always contains it.
struct ViewShare {
  double value = 0.0;
  double lower = 0.0;
  double upper = 0.0;
  Status status = Status::kZero;
  Enclosure enclosure;
  int precision_bits = 0;
};

// The share as a form factor, without records. The second form keeps the memory of `result`.
[[nodiscard]] FormFactor as_form_factor(const ViewShare& share);
void as_form_factor(const ViewShare& share, FormFactor& result);

struct SeenPatch {
  PatchId patch{};
  std::optional<FaceId> face;  // with ViewOptions::faces: values are those of this face
  ViewShare form_factor;       // as exact_form_factor gives it, in every bit
  ViewShare share;             // of the view; differs only where `stacked`
  bool stacked = false;        // coplanar faces overlap: the two values may differ
};

// A part of the boundary between two things seen. It lies in a plane through x. Seen from x, `left` is on its left and
// `right` on its right as one goes from `from` to `to`.
struct ViewArc {
  std::optional<FaceId> left;   // always a face
  std::optional<FaceId> right;  // empty: nothing
  bool left_front = true;       // x sees its front
  bool right_front = true;
  bool on_horizon = false;  // there is nothing on its right because that is below the horizon
  Vec3 from, to;  // directions from x, each component rounded from the exact one; largest component in [1/2, 1)
};

// How much work it was.
struct ViewRecord {
  std::uint64_t outlines = 0;   // convex pieces above the horizon
  std::uint64_t windows = 0;    // parts of the directions, each with few edges
  std::uint64_t pairs = 0;      // pairs of an outline's edges and another outline
  std::uint64_t undecided = 0;  // pairs left to exact predicates
  std::uint64_t pierced = 0;    // pairs of outlines that may pierce each other
  std::uint64_t arcs = 0;
};

struct WholeView {
  std::vector<SeenPatch> patches;  // every patch, or face, with a share or a form factor above 0, by index
  ViewShare back;                  // backs of faces
  ViewShare open;                  // nothing
  std::vector<ViewArc> arcs;       // on request
  ViewRecord record;
};

struct ViewOptions {
  bool faces = false;         // one value for each face instead of each patch
  bool arcs = false;          // also list the arcs, between any two faces
  int digits = 0;             // as in ExactOptions
  int precision_cap = 65536;  // the same
};

// The view of the receiver. Requires its faces to be of this scene (else std::invalid_argument), and finite
// coordinates, a normal other than zero and a precision cap of at least one bit (else InputError). Threads may call it
// concurrently, each with a workspace of its own. The result depends on the arguments alone.
[[nodiscard]] WholeView view(const Scene& scene, const Receiver& receiver, const ViewOptions& options = {});
// As above, into a result and with a workspace that the caller keeps. Once the memory is large enough, nothing is
// allocated, except for stacked patches, values that need more than double-double precision, and listed arcs. After an
// exception the content of `result` is unspecified.
void view(const Scene& scene, const Receiver& receiver, const ViewOptions& options, WholeView& result,
          Workspace& workspace);

}  // namespace exactff
