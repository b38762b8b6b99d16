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

#include "exactff/receiver.h"
#include "scene/planes.h"

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

}  // namespace exactff
