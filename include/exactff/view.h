// The whole view from a point: what is seen in every direction, exactly, with the form factors of all patches; its
// pictures, and the closed regions that it consists of.
//
// What is seen in a direction above the horizon is the nearest face whose plane does not hold x and that is not one of
// the receiver's own faces. Transparent faces are left out. Of faces in one plane a front is seen before a back, and of
// several fronts the one with the lowest index. A front counts for its patch, a back for `back`, and a direction that
// meets nothing for `open`. The shares of all fronts, `back`, `open` and `buried` add up to 1. Except for the choice
// among several fronts, nothing depends on the order of the faces. The part of a front that is buried (scene.h) is not
// seen: there, the back that buries it is.
//
// Of another measure (exact.h) than the form factor, the shares are solid angles, which add up to 2 pi, or 4 pi around
// a sphere; or parts of what open ground receives of an overcast sky, which add up to what x receives of an open sky: 1
// if x looks straight up.
//
// The form factor of a patch (exact.h) is its share, except where a front of another patch with a lower index lies in
// one plane with it and overlaps it: such a patch is stacked, and keeps its full form factor.
//
// All edges of the view are found in one sweep: every edge lies between two things seen, and counts for both. Source of
// the question: T. Karkanis, "Accurate Point-To-Patch Form Factors", University of Toronto, about 1999.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "exactff/exact.h"
#include "exactff/receiver.h"
#include "exactff/scene.h"

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
  bool stacked = false;        // a lower front overlaps one of its own in their plane: the share may be less
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
  std::vector<SeenPatch> patches;      // every patch, or face, with a share or a form factor above 0, by index
  ViewShare back;                      // backs of faces
  ViewShare open;                      // nothing
  ViewShare buried;                    // all, 1 of F, if the receiver is buried (scene.h) and sees nothing; else 0
  std::optional<FaceId> buried_under;  // the face that lies on it
  std::vector<ViewArc> arcs;           // on request
  ViewRecord record;
};

struct ViewOptions {
  bool faces = false;         // one value for each face instead of each patch
  bool arcs = false;          // also list the arcs, between any two faces
  Measure measure = {};       // as in ExactOptions, of shares and form factors
  int digits = 0;             // as in ExactOptions
  int precision_cap = 65536;  // the same
};

// The memory of view(), which serves for single sources as well.
class ViewWorkspace : public Workspace {
 public:
  ViewWorkspace();
  ViewWorkspace(ViewWorkspace&&) noexcept;
  ViewWorkspace& operator=(ViewWorkspace&&) noexcept;
  ~ViewWorkspace();

 private:
  friend struct ViewWorkspaceInside;  // see scene.h
  struct Memory;
  [[nodiscard]] Memory& memory();
  std::unique_ptr<Memory> memory_;
};

// The view of the receiver. Requires its faces to be of this scene (else std::invalid_argument), and finite
// coordinates, a normal other than zero and a precision cap of at least one bit (else InputError). Threads may call it
// concurrently, each with a workspace of its own. The result depends on the arguments alone.
[[nodiscard]] WholeView view(const Scene& scene, const Receiver& receiver, const ViewOptions& options = {});
// As above, into a result and with a workspace that the caller keeps. Once the memory is large enough, nothing is
// allocated, except for stacked patches, values that need more than double-double precision, and listed arcs. After an
// exception the content of `result` is unspecified.
void view(const Scene& scene, const Receiver& receiver, const ViewOptions& options, WholeView& result,
          ViewWorkspace& workspace);

// ---------------------------------------------------------------------------------------------------------- pictures

// A view is a set of directions above the horizon. view_svg draws it on a disk whose rim is the horizon and whose
// middle is the receiver's normal:
//
//   kNusselt   A direction is projected to the base of the unit hemisphere, along the normal (W. Nusselt, "Graphische
//              Bestimmung des Winkelverhaeltnisses bei der Waermestrahlung", 1928). Areas are form factors times pi, in
//              squares of the disk's radius. Straight edges become arcs of ellipses around the middle.
//   kFisheye   Stereographic: the direction at the angle th to the normal is tan(th / 2) from the middle. Of all
//              fisheyes this one keeps angles, so small things keep their shapes up to the rim, as in a photograph, and
//              it maps straight edges to arcs of circles, which a file can hold without approximation.
enum class ViewProjection { kNusselt, kFisheye };

struct ViewPictureOptions {
  ViewProjection projection = ViewProjection::kNusselt;
  Vec3 up{0.0, 1.0, 0.0};  // points upwards in the picture; another axis if it is parallel to the normal
};

// A self-contained SVG document: every patch in the colours of its materials (Kd, shaded by the slope of its faces; Ke
// for lamps), or in other ones where neighbours would look alike, backs of faces darker, what is open in the colour of
// the sky, the outlines of the patches, and their names where they fit; browsers show all names under the pointer. Arcs
// are SVG's elliptic arcs; corners are rounded to 1e-5 pixels, 320 of which are the radius. Requires what `view`
// requires, and an `up` that is finite and not zero (else InputError).
[[nodiscard]] std::string view_svg(const Scene& scene, const Receiver& receiver,
                                   const ViewPictureOptions& options = {});

// ----------------------------------------------------------------------------------------------------------- regions

// A region is the part of one face, front or back, that is seen. It lies in a plane: a face that is not exactly planar
// has one for each of its triangles.
struct SeenRegion {
  FaceId face{};
  std::uint32_t triangle = 0;  // of a face that is not exactly planar, the number of its triangle, from 1; else 0
  bool front = true;           // x sees its front
  std::string fraction;        // area over the area of the whole face, or triangle, exact: "p/q"
};

struct VisibilityMesh {
  struct Triangle {
    std::uint32_t region = 0;
    std::array<std::uint32_t, 3> corners{};  // counter-clockwise as seen from the front of the face
  };
  std::vector<SeenRegion> regions;  // by face
  std::vector<Vec3> points;         // exact corners, each coordinate rounded once: corners of the scene keep their bits
  std::vector<Triangle> triangles;  // by region
  std::size_t flat = 0;             // triangles left out because rounding their corners flattens or turns them
};

// All regions that the receiver sees, cut into triangles (constrained Delaunay). The triangles of a region have corners
// at its corners only: where a region ends at the middle of another one's side, the mesh has no corner in that side.
// Requires what `view` requires.
[[nodiscard]] VisibilityMesh visibility_mesh(const Scene& scene, const Receiver& receiver);

// The mesh as a scene, for files (scene_files.h): every triangle is a face in the patch and material of its
// face. Backs are in patches of their own, named "NAME (back)".
[[nodiscard]] Scene to_scene(const Scene& scene, const VisibilityMesh& mesh);

// ------------------------------------------------------------------------------------------------ quantities of light

// B = Ke + rho * sum over sources of B_s F_s is what leaves the point, in each colour channel: rho is Kd of its face,
// Ke the emission of its face, B_s the radiosity of a source, F_s the exact form factor.
enum class Quantity {
  kRadiance,    // B / pi
  kRadiosity,   // B
  kIrradiance,  // sum of B_s F_s: what arrives, whatever the face reflects or emits
  kFormFactor,  // sum of F_s, in every channel
};
[[nodiscard]] std::string_view to_string(Quantity quantity);  // "radiance", "form-factor"
[[nodiscard]] std::optional<Quantity> quantity_named(std::string_view name);

enum class KeMeans { kRadiosity, kRadiance };  // kRadiance: B_s is pi Ke, and a face emits pi Ke

[[nodiscard]] std::string unit_of(Quantity quantity, KeMeans ke);  // "the unit of Ke / pi"

}  // namespace exactff
