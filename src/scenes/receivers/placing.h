// What the makers of receivers share.
#pragma once

#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "exactff/receiver.h"

namespace exactff {

// "NAME:k" even for a patch of one face.
[[nodiscard]] std::string numbered_name_of(const Scene& scene, FaceId face);

// Each face with area as a region.
[[nodiscard]] std::vector<Region> lone_regions(const Scene& scene, std::span<const FaceId> faces);

// The tolerance of find_faces for a point that was computed: 1e-6 of the scene's diameter, or two units in the last
// place of its largest coordinate in single precision.
[[nodiscard]] double tolerance_of_computed_points(const Scene& scene);

// The own faces of a receiver that lies on a face: that face first, then the others of its patch within the tolerance
// whose fronts agree with its front, as find_faces adds them.
[[nodiscard]] std::vector<FaceId> own_faces(const Scene& scene, FaceId face, const Vec3& point, double tolerance);

// Whether receivers on faces lie behind other faces, which hide everything from them: a diagnosis. Looks closely only
// where another piece comes near an own face and lies nearly in its plane.
class HidingFaces {
 public:
  explicit HidingFaces(const Scene& scene) : scene_(scene) {}

  // The faces that hide everything, of which some piece lies within tolerance_of_computed_points before the receiver.
  // Their normals are parallel to the receiver's within a degree, and they do not lie exactly in the plane of an own
  // face.
  [[nodiscard]] std::vector<FaceId> of(const Receiver& receiver);

 private:
  [[nodiscard]] bool are_possible_on(FaceId face);

  const Scene& scene_;
  std::unordered_map<FaceId, bool> possible_;
};

// Whether the region is a lone planar face.
[[nodiscard]] bool is_one_planar_face(const Scene& scene, const Region& region);

enum class Looks { kToFront, kToBack };
// A receiver at a rounded point of a face, with these own faces, and the normal of the piece on which it lies. On a
// face that is not planar, rounding may put a point beside a fold behind the other triangle, which would then hide half
// of what the exact point sees. Such a point is moved by a few roundings, to where the receiver looks.
[[nodiscard]] Receiver receiver_on(const Scene& scene, FaceId face, std::vector<FaceId> on, const Vec3& rounded,
                                   Looks looks = Looks::kToFront);

}  // namespace exactff
