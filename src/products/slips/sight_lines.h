// Rays and lines of sight in doubles, for diagnoses only.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "exactff/scene.h"
#include "scene/shaft_tree.h"

namespace exactff::slips {

// How a patch is looked at.
inline constexpr std::size_t kOrigins = 6;  // pieces of a patch from which rays start
inline constexpr int kRaysOfAnOrigin = 16;
inline constexpr std::size_t kLinesFrom = 4;       // pieces of a patch from which lines start
inline constexpr std::size_t kLinesTo = 256;       // other pieces at which they end
inline constexpr std::uint64_t kMostLines = 3000;  // of a patch

// What a ray meets first.
struct Hit {
  std::uint32_t piece = 0;
  double distance = 0.0;  // in lengths of the direction
  bool front = false;     // the ray arrives at the front
};

class SightLines {
 public:
  explicit SightLines(const Scene& scene);

  // False if coordinates are so large or small that doubles do not suffice.
  [[nodiscard]] bool usable() const { return usable_; }
  [[nodiscard]] double diameter() const { return diameter_; }
  // Of the piece's front, of length 1.
  [[nodiscard]] const Vec3& normal(std::uint32_t piece) const { return normals_[piece]; }
  // Whether a point lies on the piece, within a rounding.
  [[nodiscard]] bool holds(std::uint32_t piece, const Vec3& point) const;
  // Points inside the piece: its centre, and points near its corners.
  [[nodiscard]] std::vector<Vec3> points_of(std::uint32_t piece) const;

  // The first face that a ray from a point meets, closer than `limit` in lengths of the direction. Of coincident faces,
  // which doubles cannot tell apart, a front is met. Transparent faces are met only on their fronts. Faces at the
  // origin of the ray are not met.
  [[nodiscard]] std::optional<Hit> first_hit(const Vec3& from, const Vec3& direction, double limit) const;
  // All faces that it meets up to the first one that is not transparent, with those at the same distance as that one,
  // in the order of distances.
  [[nodiscard]] std::vector<Hit> hits_in_sight(const Vec3& from, const Vec3& direction, double limit) const;

  // Whether the segment meets the piece, between its ends.
  [[nodiscard]] bool meets(std::uint32_t piece, const Vec3& from, const Vec3& along) const {
    return crossing(piece, from, along).value_or(1.0) < 1.0;
  }

 private:
  template <class Visit>
  void visit_crossings(const Vec3& from, const Vec3& direction, const Visit& visit) const;
  [[nodiscard]] std::optional<double> crossing(std::uint32_t piece, const Vec3& from, const Vec3& direction) const;
  [[nodiscard]] bool is_within_edges(std::uint32_t piece, const Vec3& point) const;

  const Scene& scene_;
  std::vector<Vec3> normals_;
  double diameter_ = 0.0;
  bool usable_ = false;
};

// At most `count` members, evenly spread.
[[nodiscard]] std::vector<std::uint32_t> spread(const std::vector<std::uint32_t>& all, std::size_t count);

// One of kRaysOfAnOrigin directions that are distributed about the normal by the cosine: a spiral with the golden
// angle.
[[nodiscard]] Vec3 ray_before(const Vec3& normal, int index);

// --- Patches and places of pieces ---

[[nodiscard]] inline PatchId patch_of(const Scene& scene, std::uint32_t piece) {
  return scene.face(scene.pieces()[piece].face).patch;
}
[[nodiscard]] std::vector<std::vector<std::uint32_t>> pieces_by_patch(const Scene& scene);
[[nodiscard]] Box box_of(const Scene& scene, std::uint32_t piece);
// Of all corners of the face, sorted.
[[nodiscard]] std::vector<std::uint32_t> sorted_places(const Scene& scene, const Face& face);
[[nodiscard]] bool holds(const Box& outer, const Box& inner);

// Whether the point lies within a closed surface of these pieces, by the sum of their signed solid angles: 4 pi times
// the winding number, negative inside one whose fronts look outward. Counts its triangles.
[[nodiscard]] bool is_within(const Scene& scene, std::span<const std::uint32_t> pieces, const Vec3& point,
                             std::uint64_t& triangles);

// --- Pieces that lie in nearly one plane and cover each other ---

struct PieceOverlap {
  double area = 0.0;
  double apart = 0.0;  // largest distance of the smaller piece from the larger one's plane; 0: exactly one plane
};

// Nothing if less than a millionth of the smaller piece is covered: then they only touch, but for roundings of their
// corners. If they lie in two planes, less than a ten-thousandth, or more than a millionth of the larger piece's
// diameter, and more than `reach`, from each other. The fronts may be the same or opposite.
[[nodiscard]] std::optional<PieceOverlap> overlap_of(const Scene& scene, const SightLines& sight, std::uint32_t a,
                                                     std::uint32_t b, double reach = 0.0);

[[nodiscard]] double piece_area(const Scene& scene, const SightLines& sight, std::uint32_t piece);

}  // namespace exactff::slips
