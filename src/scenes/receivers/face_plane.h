// A face as seen along its Newell vector: exact tests for inside, and points of the face rounded once.
#pragma once

#include <array>
#include <vector>

#include "exactff/scene.h"
#include "scene/face_points.h"

namespace exactff {

// Requires a face with area.
class FacePlane {
 public:
  FacePlane(const Scene& scene, FaceId id);
  // Of the face with these rings, the first of which is the outer one.
  FacePlane(FacePoints points, const Vec3& first_corner);

  [[nodiscard]] const FacePoints& points() const { return points_; }
  [[nodiscard]] const kernel::ExactVec3& normal() const { return normal_; }  // the Newell vector's direction

  // No holes and a left turn at each corner.
  [[nodiscard]] bool is_convex() const;
  [[nodiscard]] bool is_convex_quadrilateral() const { return points_.size() == 4 && is_convex(); }

  // The first corner plus offset * 2^exponent, each coordinate rounded once.
  [[nodiscard]] Vec3 rounded(const std::array<kernel::Rational, 3>& offset) const;

 private:
  FacePoints points_;
  Vec3 first_corner_;
  kernel::ExactVec3 normal_;
};

// The frame of the plane is e, the first edge cleared of its component along the normal n, and f = n x e. Neither is
// normalised, since their lengths are irrational. A point p, relative to the first corner, has the coordinates a = e.p
// and b = f.p; it equals a/(e.e) e + b/(f.f) f.
class FaceFrame {
 public:
  // In units of 2^exponent; the denominator is positive.
  struct Coordinate {
    kernel::Integer numerator;
    kernel::Integer denominator;
  };

  // Keeps a reference to the plane.
  explicit FaceFrame(const FacePlane& plane);

  [[nodiscard]] const kernel::ExactVec3& e() const { return e_; }
  [[nodiscard]] const kernel::ExactVec3& f() const { return f_; }
  // Coordinates of every corner: integers.
  [[nodiscard]] const std::vector<kernel::Integer>& a() const { return a_; }
  [[nodiscard]] const std::vector<kernel::Integer>& b() const { return b_; }

  // Not on an edge, and an odd number of edges on one side.
  [[nodiscard]] bool strictly_inside(const Coordinate& a, const Coordinate& b) const;

 private:
  [[nodiscard]] int crosses(std::size_t i, const Coordinate& a, const Coordinate& b) const;

  const FacePlane& plane_;
  kernel::ExactVec3 e_;
  kernel::ExactVec3 f_;
  std::vector<kernel::Integer> a_;
  std::vector<kernel::Integer> b_;
};

// In lowest terms.
[[nodiscard]] kernel::Rational quotient(const kernel::Integer& numerator, const kernel::Integer& denominator);

}  // namespace exactff
