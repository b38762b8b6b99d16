// The visible share, seen from x, of a small convex window in a plane of a source. The control of the sampled algorithm
// uses it for every sub-patch instead of tracing rays.
//
// The visible region of the whole plane is found exactly, once per receiver, with the code of the exact method. A
// window is given by directions from x: its corners are the points where they meet the plane, so rounding cannot move
// them out of the plane. Let c be a point of the window and p_i q_i the oriented pieces of the region's boundary, in
// any order. Then
//
//   visible area = sum_i +- area( triangle(c, p_i, q_i) n window ).
//
// Whether the answer is 0, 1 or in between is decided exactly. It is in between if and only if a piece that is not part
// of the source's own outline runs through the interior of the window. A filter in double with a proved bound decides
// this, or rational numbers if the filter is uncertain. The share itself is then a sum in double.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "exact/window_area.h"
#include "exactff/exact.h"
#include "kernel/numbers.h"
#include "visibility/plane_visibility.h"

namespace exactff::exact {

class VisibleShare {
 public:
  // Requires x in front of the plane, as it is in front of all that source_planes finds, and a receiver as for
  // exact_form_factor.
  VisibleShare(const Scene& scene, const Receiver& receiver, const visibility::SourcePlane& plane,
               Workspace& workspace);

  // Selects the piece of the plane in which the next windows lie, up to rounding errors.
  void start(std::uint32_t piece);

  static constexpr double kAccuracy = 0x1p-30;
  // Visible area over whole area of the window: exactly 0, exactly 1, or strictly in between. The errors of the
  // window's corners then change it by less than kAccuracy, and so does rounding for each piece of the region's
  // boundary (see window_blur); usually it is much closer.
  //
  // Requires three or four corners, convex, counter-clockwise as seen from x. Returns 0 if rounding of the corners has
  // left no window: all on one line, clockwise, or some directions that do not meet the plane.
  [[nodiscard]] double of(std::span<const Vec3> directions);
  // The same, computed in rational numbers and rounded once.
  [[nodiscard]] double of_exactly(std::span<const Vec3> directions);

  // Number of pieces and windows that the filter left to rational numbers.
  [[nodiscard]] std::uint64_t undecided() const { return undecided_; }

 private:
  using Rational = kernel::Rational;
  struct Piece {
    Point<Rational> exact_p, exact_q;  // the region lies to the left of pq
    Point<double> p, q;
    bool outline = false;  // part of the outline of the source
    bool horizon = false;
  };
  // A window, counter-clockwise in (u, v).
  struct Window {
    SmallPolygon<double> corners;
    double error = 0.0;  // bound on the error of each coordinate
  };
  enum class Meeting { kNo, kYes, kUnsure };

  [[nodiscard]] Point<double> flat(const Vec3& direction, double& error) const;
  void make_frame();
  void add(const visibility::BoundaryPiece& piece);
  [[nodiscard]] bool on_edge(const Piece& piece, const Point<Rational>& a, const Point<Rational>& b) const;
  void set_window(std::span<const Vec3> directions);
  [[nodiscard]] SmallPolygon<Rational> exact_window(std::span<const Vec3> directions) const;
  [[nodiscard]] bool partly(std::span<const Vec3> directions);
  [[nodiscard]] Meeting meets(const Piece& piece) const;
  [[nodiscard]] bool all_meet_plane(std::span<const Vec3> directions) const;
  [[nodiscard]] double window_blur(double doubled_area_of_window) const;

  const visibility::View view_;
  const visibility::SourcePlane& plane_;
  bool all_ = false;  // the whole source is visible
  std::vector<Piece> pieces_;
  kernel::ExactVec3 away_;                       // the plane's normal turned away from x
  std::optional<visibility::PlaneFrame> frame_;  // its unit square is the source's box
  std::array<double, 3> away_approx_{};          // the frame in doubles
  Point<double> low_approx_{}, size_approx_{};
  Window window_;
  std::uint64_t undecided_ = 0;
};

}  // namespace exactff::exact
