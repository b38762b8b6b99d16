// Which pieces of a scene lie in one plane, exactly, whichever way they face.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "exactff/scene.h"

namespace exactff {

// Counted from 0, in the order of their first pieces.
enum class PlaneId : std::uint32_t {};

class Planes {
 public:
  Planes() = default;
  explicit Planes(const Scene& scene);

  [[nodiscard]] std::size_t count() const { return first_.empty() ? 0 : first_.size() - 1; }
  // Two pieces have the same plane if and only if some plane holds both.
  [[nodiscard]] PlaneId of_piece(std::uint32_t piece) const { return of_piece_[piece]; }
  // All pieces in the plane, transparent ones included, ascending.
  [[nodiscard]] std::span<const std::uint32_t> pieces_in(PlaneId plane) const {
    const std::size_t i = index_of(plane);
    return std::span(pieces_).subspan(first_[i], first_[i + 1] - first_[i]);
  }

 private:
  void sort_pieces(std::size_t found);

  std::vector<PlaneId> of_piece_;
  std::vector<std::uint32_t> pieces_;  // by plane
  std::vector<std::uint32_t> first_;   // of each plane in pieces_; one entry more
};

// The planes of the scene's pieces, found at the first call; safe to call from several threads.
const Planes& planes(const Scene& scene);

}  // namespace exactff
