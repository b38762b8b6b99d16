// Cells: convex polygons in the receiver's plane, cut exactly.
//
// A corner is the point that the receiver's plane shares with the planes of two sides. Sides are planes of the scene,
// or planes of two or three of its points, so that however often a cell is cut, its numbers do not grow.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <tuple>
#include <utility>
#include <vector>

#include "exactff/geometry.h"
#include "kernel/vec.h"
#include "view_factors/exact_scene.h"

namespace exactff::view_factors {

struct Cell {
  std::vector<Point> corners;                       // counter-clockwise as seen from the receiver's front
  std::vector<std::shared_ptr<const Plane>> sides;  // side i leads from corner i to the next
};

// The sides' planes are positive outside.
[[nodiscard]] Cell cell_of(const Points& points, const Ring& ring, const Plane& receiver);

// The sign that an affine function, zero on the plane, has everywhere inside the cell; 0 if it vanishes there.
// kMixed: it has both signs inside.
inline constexpr int kMixed = 2;
[[nodiscard]] int sign_inside(const Plane& plane, const Cell& cell);

// The same from the function's sign at a corner.
template <class SignAt>
int common_sign(const Cell& cell, const SignAt& sign_at) {
  int found = 0;
  for (const Point& corner : cell.corners) {
    const int sign = sign_at(corner);
    if (sign == 0 || sign == found) continue;
    if (found != 0) return kMixed;
    found = sign;
  }
  return found;
}

// The two parts of a cell. Requires that the plane has both signs inside.
struct Halves {
  Cell negative, positive;
};
[[nodiscard]] Halves cut(const Cell& cell, const Plane& receiver, const std::shared_ptr<const Plane>& by,
                         const Units& units);

// --- Estimates ---

using kernel::length;
[[nodiscard]] double distance_to_segment(const Vec3& x, const Vec3& a, const Vec3& b);
[[nodiscard]] double distance_from_sides(const Cell& cell, const Vec3& x);
[[nodiscard]] std::vector<Vec3> positions_of(const std::vector<Point>& points);
// Of a planar polygon; in squares of the unit of Point::at.
[[nodiscard]] double area(const std::vector<Vec3>& ring);
// Of the area, or of the sum of the weights of a rule. A corner's coordinates err by 2^-53 at most, and an area by its
// perimeter times that, before roundings of the arithmetic, which are smaller.
[[nodiscard]] double error_of_area(const std::vector<Vec3>& ring);
[[nodiscard]] inline double area(const Cell& cell) { return area(positions_of(cell.corners)); }
// The smaller of the two parts' areas, over the whole.
[[nodiscard]] double balance(const Cell& cell, const Plane& plane);
// More than that, from an estimate of the plane; 1 if it says nothing.
[[nodiscard]] double balance_at_most(const Cell& cell, const RoundedPlane& plane);
// A plane across the cell, perpendicular to the axis along which it is widest, at a short number near its middle.
[[nodiscard]] std::shared_ptr<const Plane> bisector(const Cell& cell, const Units& units);

// --- Crossing order ---

// The sign, on a cell, of the quadratic function that orders two crossings on an edge (cell_view.h).

// The sign of f(x) = det(N_e, N_g, N_h) everywhere inside the cell, N = (a - x) x (b - x) for a line through a and b; 0
// if f vanishes there; kMixed if the polar form does not decide.
//
// Filter. Let u = 2^-53 and e = 8u. Coordinates are at most 1 and rounded once; middles of two corners, twice. So a
// component of a - x, or of b - a, errs by at most e. Let A and L bound the magnitudes of their components, rounded or
// not. A component of N = (a - x) x (b - a) errs by at most 2 (A + L) e, and 5u A L for its own roundings: less than
// r = 4 (A + L) e, and is at most S = 2 A L + r. The determinant is a sum of six products of three such components,
// each wrong by at most r S S + S r S + S S r, and its roundings add at most 8u S S S to each. The roundings of the
// polar form add less than as much again. So each f errs by at most
//   6 (r S S + S r S + S S r + 2 e S S S),
// and the polar form by the sum of these with its coefficients. Underflow adds less than 2^-1000.
[[nodiscard]] int crossing_order(const Points& points, const Cell& cell, LineId e, LineId g, LineId h);

// --- Event bound ---

// How wrong the formula of a cell's centre can be elsewhere in the cell, if only orders of crossings are undecided.
//
// Let three edges lie on the lines e, g, h, and let only the order of their crossings be undecided on the cell. Let F0
// be the contour integral over the parts that bound the visible region from the centre, continued to x: their ends move
// with the lines, and a part whose ends have changed places counts with the opposite sign. Let F be the true value.
//
// The two contours at x differ only along the three lines, and only between the crossings, since all other signs are
// the same: their difference is a closed chain of the three sides of one spherical triangle, hence a multiple of its
// boundary. A coefficient is 1, 0 or -1 in either contour, so the multiple is at most 2. The difference of the
// integrals is the multiple times the integral of cos / pi over the triangle, at most 2 / pi times its area A. By the
// isoperimetric inequality on the sphere, L^2 >= A (4 pi - A) for its perimeter L. Here A <= 2 pi, so
//
//   A <= L^2 / (2 pi),   |F - F0| <= L^2 / pi^2.
//
// Several such triples of which no two share a line change the contour in separate places, and their bounds add up. If
// two share a line, the difference is a closed chain on all these lines, and no shape is known: each side contributes
// at most 2 / (2 pi) of its length, since |cos| <= 1 in Eq. (4). There a coefficient of F0 may exceed 1. On one edge,
// let the ends of its parts be f_1, t_1, f_2, t_2, ... in the order at the centre, and S those of them before a place y
// of the edge at x. The coefficient of F0 at y is c, the number of f in S less the number of t in S; that of F is 0 or
// 1. A pair of an end in S and one that is earlier at the centre, but not in S, has changed its order, and its side
// holds y. Of the f in S, the k-th one is preceded by k - 1 or more t; if c >= 2, this makes c (c - 1) / 2 such pairs
// or more. Likewise |c| (|c| + 1) / 2 if c < 0. So twice the number of pairs is at least the difference of the
// coefficients. If c is 0 or 1 and the coefficients differ, some pair has changed its order, too.
//
// That the crossings of a pair are close to each other, not nearly opposite, is no matter: if f has no zero on the
// cell, its order is that at the centre. If it has one, the crossings coincide there, both being on one edge, and the
// angle between them cannot grow from 0 beyond 31 degrees while its sine stays below 0.51.
//
// A side on e, from the crossing with g to that with h, has the sine |N_e| |f| / (|N_e x N_g| |N_e x N_h|), where
// f = det(N_e, N_g, N_h). On the cell, |f| is at most the largest |b| of its polar form; |N| is convex, so its largest
// value is at a corner; and |N_e x N_g| is at least the smallest coefficient of the polar form of its component along
// the direction that it has at the centre.
//
// Roundings. Let u = 2^-53. Coordinates are at most 1 and rounded once, those of the middle of two corners twice. So a
// component of p = a - x or q = b - x is at most 2 and errs by at most 5u, |p|, |q| <= sqrt(12), and p and q err by at
// most 5 sqrt(3) u. A component of N = p x q is twice the area of a triangle in a square of side 2, hence at most 4,
// and |N| <= 4 sqrt(3) < 7.
// - N errs by 2 sqrt(12) 5 sqrt(3) u = 60u for p and q, and by sqrt(3) 16u for its own roundings: less than 90u.
// - f is a sum of six products of at most 4^3 with five roundings each: it errs by 3 (90u) 7^2 + 6 (4^3) 5u < 2^14 u.
//   So does the component of N_g x N_h along d, |d| <= 2: by less than 2 (90u) 7 |d| + 6 (4^2) 5u |d|.
// - Both are at most 7^3. A coefficient of the polar form, of three values, errs by 3 (2^14 u) + 4 (7^3 u) < 2^-37.
//   kRoundings = 2^-34 is added to the largest |b| and subtracted from the smallest component, so these are bounds.
//   (The length of d errs by less than 2^-20, but where |N_g x N_h| at the centre is below 2^-500. Then the smallest
//   component is below 2^-34, and nothing is claimed.)
// - A computed |N| may be too small. But where the bounds of |N_e x N_g| are positive, the component is more than
//   2^-34 - 2^-37 at every corner, which is less than 7.1 |N_e|. So |N_e| > 2^-38, and it errs by less than
//   90u / 2^-38 < 0.28 % of it.
// So a true sine is less than 1.003 times the one computed, which is below 1/2. Up to 0.51 the arc sine grows by less
// than 1.17 times its argument, and is not smaller than this: the angles are below 1.0036 times those computed, and
// their squares below 1.0073 times. Other roundings are relative and below 2^-30, with fewer than 2^20 triples. All
// this is less than kEventMargin.

using CrossingTriple = std::array<LineId, 3>;  // ascending

// What the sides of one triple's triangle are computed from, on the cell. Requires a cell and lines whose coordinates
// are at most 1.
struct TriangleBounds {
  double order = 0.0;              // at least |f|
  std::array<double, 3> normal{};  // |N_i|, the largest
  std::array<double, 3> cross{};   // at most |N_i x N_(i + 1)|
};
[[nodiscard]] TriangleBounds triangle_bounds(const Points& points, const Cell& cell, const Vec3& centre,
                                             const CrossingTriple& triple);

// In double: times kEventMargin, it is not below the bound. Infinite where a crossing may be near an end of its edges'
// planes.
[[nodiscard]] double event_bound(const Points& points, const Cell& cell, const Vec3& centre,
                                 std::vector<CrossingTriple> triples);
inline constexpr double kEventMargin = 1.01;

// --- Polar form ---

// The polar form of a quadratic function at pairs of corners (cell_view.h), in double.

// Calls visit(b) for the coefficients b(c_i, c_j), i <= j, until one call returns false.
template <class Function, class Visit>
void for_each_coefficient(const Function& f, const std::vector<Vec3>& corners, const Visit& visit) {
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3& y = corners[i];
    const double at_y = f(y);
    if (!visit(at_y)) return;
    for (std::size_t j = i + 1; j < corners.size(); ++j) {
      const Vec3& z = corners[j];
      const Vec3 middle{0.5 * (y.x + z.x), 0.5 * (y.y + z.y), 0.5 * (y.z + z.z)};
      if (!visit(2.0 * f(middle) - 0.5 * (at_y + f(z)))) return;
    }
  }
}

// --- Pair memory ---

// What has been found out about cells and would cost time to find again: signs, and exact planes. Its size is limited;
// what no longer fits is found again, so the results do not depend on it.
//
// It serves pair after pair, so that its memory is allocated once.
//
// Cells form a tree, and a sign that is known for a cell is known for its parts. So a sign is kept with the cell that
// it was found for, and holds as long as this cell is on the way from the root to the present one.

// More than the signs of cell.h.
inline constexpr int kMixedAndSeen = 3;  // mixed on the cell, and considered as a cut
inline constexpr int kUnasked = 4;

class PairMemory {
 public:
  // The pairs so far are done with: their numbers may be given to others.
  void forget_pairs() { planes_.clear(); }
  // To be called first: what is asked from here on is about the cells of another pair, or of this one from a new root.
  void start(std::size_t pair, std::size_t line_count, std::size_t point_count);
  // The cells from the root to one, by depth.
  using Way = std::vector<std::uint64_t>;
  // The same, but what follows are parts of a cell that was the present one before.
  void resume(std::size_t pair, std::size_t line_count, std::size_t point_count, Way way);
  [[nodiscard]] const Way& way() const { return way_; }
  // The present cell becomes one at this depth, a part of the last one at the depth before.
  void enter(std::size_t depth);

  // The sign of a line and a point, or kUnasked. Mixed signs are known for the cell itself alone.
  [[nodiscard]] int sign(LineId line, PointId point) const;
  void keep_sign(LineId line, PointId point, int sign);

  // The plane through a line and a point of the points.
  const std::shared_ptr<const Plane>& plane(const Points& points, LineId line, PointId point);

 private:
  static constexpr int kDepthBits = 24;

  struct Entry {
    std::uint64_t key = ~std::uint64_t{0};
    std::uint64_t cell = 0;  // its number, then its depth
    std::int8_t sign = 0;
  };
  [[nodiscard]] static std::uint64_t key(LineId line, PointId point) { return std::uint64_t{line} << 32 | point; }
  void take(std::size_t pair, std::size_t line_count, std::size_t point_count);
  [[nodiscard]] std::size_t slot(LineId line, PointId point) const {
    return (line * point_count_ + point) & (entries_.size() - 1);
  }

  std::size_t pair_ = 0, point_count_ = 0, depth_ = 0;
  std::uint64_t cells_ = 0;
  std::vector<Entry> entries_;  // a power of two of them; each place is taken by the last sign that falls on it
  Way way_;                     // to the present cell
  std::map<std::tuple<std::size_t, LineId, PointId>, std::shared_ptr<const Plane>> planes_;
};

// Memories for as many jobs as run at the same time.
class PairMemories {
 public:
  [[nodiscard]] std::unique_ptr<PairMemory> take() {
    const std::lock_guard lock(mutex_);
    if (idle_.empty()) return std::make_unique<PairMemory>();
    std::unique_ptr<PairMemory> memory = std::move(idle_.back());
    idle_.pop_back();
    return memory;
  }
  void give_back(std::unique_ptr<PairMemory> memory) {
    memory->forget_pairs();
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(memory));
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<PairMemory>> idle_;
};

}  // namespace exactff::view_factors
