// What a receiver sees (view.h), as closed regions with exact corners: their areas, a mesh of them in space, and
// pictures of the whole view.
//
// A region is the part of one face, front or back, that is seen. It lies in a plane: a face that is not exactly planar
// has one for each of its triangles.
//
// A view is a set of directions above the horizon. view_svg draws it on a disk whose rim is the horizon and whose
// middle is the receiver's normal:
//
//   kNusselt   A direction is projected to the base of the unit hemisphere, along the normal (W. Nusselt, "Graphische
//              Bestimmung des Winkelverhaeltnisses bei der Waermestrahlung", 1928). Areas are form factors times pi, in
//              squares of the disk's radius. Straight edges become arcs of ellipses around the middle.
//   kFisheye   Stereographic: the direction at the angle th to the normal is tan(th / 2) from the middle. Of all
//              fisheyes this one keeps angles, so small things keep their shapes up to the rim, as in a photograph, and
//              it maps straight edges to arcs of circles, which a file can hold without approximation.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "exactff/receiver.h"
#include "exactff/scene.h"

namespace exactff {

enum class ViewProjection { kNusselt, kFisheye };

struct ViewPictureOptions {
  ViewProjection projection = ViewProjection::kNusselt;
  Vec3 up{0.0, 1.0, 0.0};  // points upwards in the picture; another axis if it is parallel to the normal
};

// A self-contained SVG document: every patch in the colours of its materials (Kd, shaded by the slope of its faces; Ke
// for lamps), backs of faces darker, what is open in the colour of the sky, the outlines of the patches, and their
// names where they fit; browsers show all names under the pointer. Arcs are SVG's elliptic arcs; corners are rounded to
// 1e-5 pixels, 320 of which are the radius. Requires what `view` requires, and an `up` that is finite and not zero
// (else InputError).
[[nodiscard]] std::string view_svg(const Scene& scene, const Receiver& receiver,
                                   const ViewPictureOptions& options = {});

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

// The mesh as a scene, for files (scene_files.h, vtk.h): every triangle is a face in the patch and material of its
// face. Backs are in patches of their own, named "NAME (back)". Throws InputError if there are no triangles.
[[nodiscard]] Scene to_scene(const Scene& scene, const VisibilityMesh& mesh);

}  // namespace exactff
