// The faces of a region as one surface: its outline, and the face under a point of it.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "exactff/receiver.h"
#include "exactff/scene.h"
#include "scene/face_points.h"

namespace exactff {

// --- Face plane ---

// A face as seen along its Newell vector: exact tests for inside, and points of the face rounded once.

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

// --- Region shape ---

// The outline runs as receiver.h says for grid_receivers.
//
// A point is located by the signs of determinants in the frame of the outline's plane. Coordinates there are first
// brought to doubles in [-1, 1], with errors of at most 2^-51: two quotients of integers that are truncated to 53 bits.
// Differences are then off by 2^-49, products of two of them (at most 4) by 2^-46, and a determinant by less than
// kUncertain. Signs closer to zero are decided in integers.
class RegionShape {
 public:
  RegionShape(const Scene& scene, const Region& region);
  RegionShape(const RegionShape&) = delete;
  RegionShape& operator=(const RegionShape&) = delete;

  [[nodiscard]] const FacePlane& outline() const { return outline_; }
  [[nodiscard]] const FaceFrame& frame() const { return frame_; }

  // A receiver on the first piece that the point lies on as seen along the outline's normal, at the point of that
  // piece, rounded once (receiver_on). Nothing if the point does not lie strictly inside the outline. `offset` is
  // relative to the outline's first corner, in units of 2^exponent; a and b are its coordinates in the frame.
  [[nodiscard]] std::optional<Receiver> receiver_under(const std::array<kernel::Rational, 3>& offset,
                                                       const FaceFrame::Coordinate& a,
                                                       const FaceFrame::Coordinate& b) const;

 private:
  static constexpr double kUncertain = 0x1p-43;

  // A convex piece of a face that is seen from its front along the outline's normal.
  struct Tile {
    std::uint32_t piece = 0;
    kernel::ExactVec3 corner;
    kernel::ExactVec3 normal;
    std::vector<kernel::Integer> a, b;  // of the corners, in the frame
    std::vector<double> x, y;           // the same as doubles
  };
  struct PlanePlace {
    const FaceFrame::Coordinate& a;
    const FaceFrame::Coordinate& b;
    double x, y;
  };

  RegionShape(const Scene& scene, const Region& region, const std::vector<std::vector<std::uint32_t>>& outline);
  void add_tile(std::uint32_t piece, std::size_t ring);
  void fill_bins();
  [[nodiscard]] std::size_t bin_of(double t) const;
  [[nodiscard]] static int side(const Tile& tile, std::size_t corner, const PlanePlace& place);
  [[nodiscard]] std::array<kernel::Rational, 3> on_plane(const Tile& tile,
                                                         const std::array<kernel::Rational, 3>& offset) const;

  FacePoints points_;  // of the outline, then of each tile as a ring
  FacePlane outline_;
  FaceFrame frame_;
  const Scene& scene_;
  bool is_lone_;  // face
  bool planar_ = true;
  long a_bits_ = 0, b_bits_ = 0;
  std::vector<Tile> tiles_;  // by face
  std::size_t bins_ = 1;     // along each axis
  std::vector<std::vector<std::uint32_t>> tiles_in_bin_;
};

}  // namespace exactff
