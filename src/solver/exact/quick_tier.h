// Step 7 of the exact method (src/README.md), the first attempt at a certified value: translates the boundary that the
// edge engine found into corners, lines and pieces, and integrates these in double-double arithmetic
// (contour/quick_contour.h).
//
//   a. Give numbers to the lines of a batch of parts, and to their corners.
//   b. Make the lines that are new, four at a time.
//   c. Add the parts to the contour integral.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "contour/quick_contour.h"
#include "exact/dense_index.h"
#include "kernel/ball.h"
#include "visibility/plane_visibility.h"

namespace exactff::exact {

class QuickTier {
 public:
  static constexpr int kBits = 106;  // precision of a double-double

  // Starts a new sum in the existing memory. `normal`: the receiver's.
  void start(const Vec3& normal);

  // Adds the boundary of one plane's visible region. Declines what the Booleans found.
  void add(const visibility::VisibleBoundary& boundary);

  // The term of each of these parts in Eq. (4), to be added by the caller.
  void find_terms(visibility::EdgeCovers& found, std::span<const visibility::EdgeCovers::Part> parts,
                  std::vector<kernel::double_double::Bounded>& terms);
  // Encloses F for a sum of terms.
  [[nodiscard]] Ball ball(const kernel::double_double::Bounded& sum) const;

  // Encloses F; its radius is at least the proved error. The ball contains every number if anything was declined.
  [[nodiscard]] Ball ball() const;

 private:
  template <class Take>
  void for_each_batch(visibility::EdgeCovers& found, std::span<const visibility::EdgeCovers::Part> parts,
                      const Take& take);
  [[nodiscard]] std::uint32_t number_of_line(visibility::Outlines& outlines, visibility::EdgeId id);
  [[nodiscard]] std::uint32_t number_of_corner(visibility::Outlines& outlines, visibility::CornerId id);
  void make_lines();
  void forget_lines();

  contour::QuickContour contour_;
  bool declined_ = false;
  // Of the current plane.
  DenseIndex corner_index_, line_index_;
  std::vector<contour::QuickCorner> corners_;
  std::vector<contour::QuickEdge> edges_;
  std::vector<contour::QuickLine> lines_;  // valid for the first `made_` edges; the rest is spare memory
  std::size_t made_ = 0;
  std::vector<contour::QuickPiece> pieces_;  // of the current batch
};

}  // namespace exactff::exact
