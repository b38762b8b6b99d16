// The exact solver's receiver and factor at a point of a part, which is given in the unit of Point::at.
#pragma once

#include <cmath>

#include "exactff/exact.h"
#include "view_factors/exact_scene.h"

namespace exactff::view_factors {

inline Receiver receiver_at(const ExactScene& exact, const Vec3& at, const Plane& plane, FaceId face) {
  const int exponent = static_cast<int>(exact.units.exponent + exact.units.shift);
  const auto in_scene = [&](double x) { return std::ldexp(x, exponent); };
  const auto& n = plane.rounded;
  return {
      .point = {in_scene(at.x), in_scene(at.y), in_scene(at.z)}, .normal = {n[0], n[1], n[2]}, .on = {face}, .id = {}};
}

inline double factor_at(const ExactScene& exact, const Vec3& at, const Plane& plane, FaceId face,
                        const ExactSource& source) {
  return exact_form_factor(exact.scene, receiver_at(exact, at, plane, face), source).value;
}

}  // namespace exactff::view_factors
