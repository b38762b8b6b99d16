// The data of an ExactSource: its planes, and the way from directions to points of one.
#pragma once

#include <vector>

#include "exactff/exact.h"
#include "kernel/expect.h"
#include "kernel/filter.h"
#include "visibility/source_plane.h"

namespace exactff {

struct ExactSource::Planes {
  SceneId scene;
  Selection selection;
  std::vector<visibility::SourcePlane> planes;
};

struct ExactSourceInside {
  using Planes = ExactSource::Planes;
  [[nodiscard]] static const Planes& planes(const ExactSource& source) { return source.planes(); }
};

namespace exact {

// Throws InputError unless the point is finite and the normal is finite and not zero. Throws std::invalid_argument if
// the receiver's face or the source does not belong to the scene.
void check_arguments(const Scene& scene, const Receiver& receiver, const ExactSource& source,
                     const Measure& measure = {});
// The same for the receiver alone, and InputError for a precision cap below one bit or an impossible measure.
void check_view_arguments(const Scene& scene, const Receiver& receiver, const Measure& measure, int precision_cap);

// A sphere is seen as two receivers with opposite normals. Of one on a face the normal is that of the face, since what
// is buried there is on its front.
[[nodiscard]] Vec3 normal_of_sphere(const Scene& scene, const Receiver& receiver);
[[nodiscard]] Receiver looking_along(const Receiver& receiver, const Vec3& n);

}  // namespace exact

}  // namespace exactff

namespace exactff::exact {

// --- Lift ---

// From directions to points of a plane, each coordinate rounded once.

// Maps a direction from x to the point where it meets a plane.
class Lift {
 public:
  // The plane through `point`. If it holds x, no direction can be mapped.
  Lift(const kernel::ExactVec3& normal, const Vec3& point, const Vec3& x)
      : normal_(normal), x_{kernel::to_rational(x.x), kernel::to_rational(x.y), kernel::to_rational(x.z)} {
    const kernel::ScaledVec3 s = kernel::exact_difference(point, x);
    distance_ = kernel::times_power_of_two(dot(normal_, s.v), s.exponent);
  }

  [[nodiscard]] Vec3 operator()(const kernel::ExactVec3& t) const {
    EXACTFF_EXPECT(distance_ != 0);
    const kernel::Rational factor = distance_ / kernel::Rational(dot(normal_, t));
    return {kernel::nearest_double(x_[0] + factor * t.x), kernel::nearest_double(x_[1] + factor * t.y),
            kernel::nearest_double(x_[2] + factor * t.z)};
  }

 private:
  kernel::ExactVec3 normal_;
  kernel::Rational x_[3];
  kernel::Rational distance_;
};

// Scaled so that the largest component is about 1. The filters' form of a direction (Approx3) is not used because it
// has no value for small components.
inline Vec3 rounded(const kernel::ExactVec3& direction) {
  const long bits = bit_length(direction);
  const auto scaled = [bits](const kernel::Integer& component) { return kernel::nearest_double(component, -bits); };
  return {scaled(direction.x), scaled(direction.y), scaled(direction.z)};
}

}  // namespace exactff::exact
