// What both sides of all surfaces look at, by rays in doubles. From this table follows, for any choice of fronts, how
// much of what the fronts look at is lost.
#pragma once

#include <cstdint>
#include <vector>

#include "exactff/scene.h"
#include "slips/sight_lines.h"

namespace exactff::slips {

// One side of a piece: twice the index of the piece, and 1 more for its back.
using Side = std::uint32_t;
inline std::uint32_t piece_of(Side side) { return side / 2; }

using Flipped = std::vector<bool>;  // by face

class Outlook {
 public:
  struct Ray {
    Side from = 0;
    double area = 0.0;            // for which it stands
    std::vector<Side> seen = {};  // up to the first face that is not transparent, with all faces in the same place
    bool clear = true;            // no two of them are in the same place
    bool ends = false;            // on a face that is not transparent: of others, no backs are seen
  };

  // The same number of rays from both sides of each of the oriented surfaces. None starts where another face lies on
  // the surface. There are no rays if there are too many surfaces, or if doubles do not suffice.
  Outlook(const Scene& scene, const SightLines& sight);

  [[nodiscard]] const std::vector<Ray>& rays() const { return rays_; }
  [[nodiscard]] const std::vector<std::uint32_t>& surface_of_piece() const { return surface_; }

  [[nodiscard]] bool is_front(Side side, const Flipped& flipped) const {
    return (side % 2 == 1) == flipped[index_of(scene_.pieces()[piece_of(side)].face)];
  }
  // The ray starts from a front and meets one.
  [[nodiscard]] bool is_good(const Ray& ray, const Flipped& flipped) const;

  // Summed over fronts, the area times the share of the view that shows backs, or nothing.
  struct Lost {
    double to_backs = 0.0, to_nothing = 0.0;
    [[nodiscard]] double total() const { return to_backs + to_nothing; }
  };
  [[nodiscard]] Lost lost(const Flipped& flipped) const;

 private:
  void cast(const SightLines& sight, const std::vector<std::uint32_t>& pieces, std::size_t count);
  void cast(const SightLines& sight, std::uint32_t piece, const Vec3& point, const double* place, double area);
  [[nodiscard]] bool is_covered(const SightLines& sight, std::uint32_t piece, const Vec3& point) const;

  const Scene& scene_;
  std::vector<std::uint32_t> surface_;  // by piece
  std::vector<Ray> rays_;
};

// --- Connected surfaces whose faces agree on which side is the front ---

// By piece: the number of its surface, from 0. Two pieces that are alone at an edge, and run along it in opposite
// directions, belong to one surface; likewise the pieces of a face. Edges count in parts where ends of others lie on
// them (T-junctions). Where more than two pieces meet, an edge joins none of them.
[[nodiscard]] std::vector<std::uint32_t> oriented_surfaces(const Scene& scene);

}  // namespace exactff::slips
