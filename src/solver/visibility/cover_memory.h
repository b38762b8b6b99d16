// Remembers which pieces hid a source plane from the receiver before, since they mostly hide it from a neighbour as
// well. What it returns is only tried first: the pieces may be those of another scene.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

namespace exactff::visibility {

class CoverMemory {
 public:
  static constexpr std::size_t kMost = 128;  // pieces of a cover; more are not remembered

  // Those that hid the plane with this first piece last; empty if that is not known.
  [[nodiscard]] std::span<const std::uint32_t> of(std::uint32_t first_piece) const {
    const Cover& cover = covers_[first_piece % kPlanes];
    return {cover.pieces.data(), cover.first_piece == first_piece ? cover.count : 0};
  }
  void forget(std::uint32_t first_piece) { covers_[first_piece % kPlanes].count = 0; }
  // Remembers the piece of each of these, or of the first kMost of them.
  template <class Item, class PieceOf>
  void set(std::uint32_t first_piece, std::span<const Item> items, const PieceOf& piece_of) {
    Cover& cover = covers_[first_piece % kPlanes];
    cover.first_piece = first_piece;
    cover.count = 0;
    for (const Item& item : items.first(std::min(items.size(), kMost))) cover.pieces[cover.count++] = piece_of(item);
  }

 private:
  static constexpr std::size_t kPlanes = 16;
  struct Cover {
    std::uint32_t first_piece = 0;
    std::size_t count = 0;
    std::array<std::uint32_t, kMost> pieces{};
  };
  std::array<Cover, kPlanes> covers_{};
};

}  // namespace exactff::visibility
