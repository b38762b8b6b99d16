// The pieces of a scene that neither occlude nor illuminate a receiver, because it counts as lying in their plane.
//
// These are all pieces, of any face, that lie exactly in the plane of one of the receiver's own faces (Receiver::on),
// whichever way they face. An own face that is not planar is its triangles, and the receiver lies on one of them: that
// whose area holds the point's perpendicular projection onto its plane; of several, the one with the nearest plane,
// then the one with the lowest index. If none holds it, the nearest plane decides. The other triangles occlude and
// illuminate. All of this is exact.
#pragma once

#include <algorithm>
#include <boost/container/small_vector.hpp>
#include <cstdint>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "exactff/receiver.h"
#include "scene/panels.h"

namespace exactff {

class OwnPieces {
 public:
  OwnPieces() = default;  // of a receiver on no face
  // Requires faces of the scene.
  OwnPieces(const Scene& scene, const Receiver& receiver);

  [[nodiscard]] bool contains(std::uint32_t piece) const {
    return !planes_.empty() && std::ranges::find(planes_, all_->of_piece(piece)) != planes_.end();
  }
  // The planes of the own faces. A piece lies in one of them if and only if it is contained.
  [[nodiscard]] std::span<const PlaneId> planes() const { return {planes_.data(), planes_.size()}; }
  [[nodiscard]] std::span<const std::uint32_t> pieces_in(PlaneId plane) const { return all_->pieces_in(plane); }

 private:
  const Planes* all_ = nullptr;  // of the scene, if there are own faces
  boost::container::small_vector<PlaneId, 4> planes_;
};

// The piece of a face on which a receiver on that face lies. Requires a face with area.
[[nodiscard]] std::uint32_t own_piece(const Scene& scene, FaceId face, const Vec3& x);
// Towards its front: Face::newell of the file with this piece as a face, if its face is not planar; else that of its
// face.
[[nodiscard]] Vec3 front_of_piece(const Scene& scene, std::uint32_t piece);

// --- Placing ---

// What the makers of receivers share.

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
