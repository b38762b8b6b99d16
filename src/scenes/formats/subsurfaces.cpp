#include "formats/subsurfaces.h"

#include "kernel/exact_vec.h"

namespace exactff::formats {

namespace {

// Sums of twice the area vector of polygons (Newell's vector).
class AreaSum {
 public:
  explicit AreaSum(const Scene& scene) : scene_(scene) {}

  void add(std::span<const std::uint32_t> polygon) {
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vec3& a = scene_.vertices()[polygon[i]];
      const Vec3& b = scene_.vertices()[polygon[(i + 1) % polygon.size()]];
      x_ += product(a.y, b.z) - product(a.z, b.y);
      y_ += product(a.z, b.x) - product(a.x, b.z);
      z_ += product(a.x, b.y) - product(a.y, b.x);
    }
  }
  friend bool operator==(const AreaSum& a, const AreaSum& b) { return a.x_ == b.x_ && a.y_ == b.y_ && a.z_ == b.z_; }

 private:
  static kernel::Rational product(double a, double b) { return kernel::to_rational(a) * kernel::to_rational(b); }

  const Scene& scene_;
  kernel::Rational x_, y_, z_;
};

}  // namespace

bool in_one_plane(std::span<const Vec3> vertices) {
  for (std::size_t b = 1; b < vertices.size(); ++b) {
    for (std::size_t c = b + 1; c < vertices.size(); ++c) {
      for (std::size_t d = c + 1; d < vertices.size(); ++d) {
        if (kernel::orientation(vertices[0], vertices[b], vertices[c], vertices[d]) != 0) return false;
      }
    }
  }
  return true;
}

// Let m be the number of subsurfaces over a point. The remainder has the points of the base with even m. So the areas
// of the remainder and of the subsurfaces exceed the area of the base by the integral of m, less 1 where m is odd, and
// of m outside the base. This is 0 only if m is at most 1, and 0 outside.
bool are_parts(const Scene& scene, FaceId base, std::span<const FaceId> subsurfaces) {
  AreaSum whole(scene), parts(scene);
  whole.add(scene.face(base).rings.front());
  for (const Piece& piece : scene.pieces_of(base)) parts.add(scene.corners(piece));
  for (const FaceId subsurface : subsurfaces) parts.add(scene.face(subsurface).rings.front());
  return parts == whole;
}

bool same_front(const Scene& scene, FaceId base, FaceId subsurface) {
  const Vec3& a = scene.face(base).newell;
  const Vec3& b = scene.face(subsurface).newell;
  if (scene.face(subsurface).shape != FaceShape::kPlanar) return true;
  return (a.x < 0.0) == (b.x < 0.0) && (a.y < 0.0) == (b.y < 0.0) && (a.z < 0.0) == (b.z < 0.0);  // they are parallel
}

}  // namespace exactff::formats
