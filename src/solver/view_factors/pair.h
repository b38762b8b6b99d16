// One convex part seen from another: its cells and their integrals.
#pragma once

#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "exactff/exact.h"
#include "exactff/geometry.h"
#include "kernel/vec.h"
#include "view_factors/cell_view.h"
#include "view_factors/factor_bounds.h"
#include "view_factors/formula.h"
#include "view_factors/left_out.h"
#include "view_factors/sight.h"

namespace exactff::view_factors {

// --- Quadrature ---

// Gauss-Legendre rules on convex polygons.

struct Node {
  double x, weight;
};

// The n-point rule on [0, 1].
template <unsigned kCount>
const std::array<Node, kCount>& gauss_rule() {
  static const std::array<Node, kCount> rule = [] {
    using Rule = boost::math::quadrature::gauss<double, kCount>;
    std::array<Node, kCount> nodes{};
    std::size_t at = 0;
    for (std::size_t i = 0; i < Rule::abscissa().size(); ++i) {
      const double x = Rule::abscissa()[i], weight = 0.5 * Rule::weights()[i];
      nodes[at++] = {0.5 + 0.5 * x, weight};
      if (x != 0.0) nodes[at++] = {0.5 - 0.5 * x, weight};
    }
    return nodes;
  }();
  return rule;
}

// A point of the quadrilateral of the corners 0, i, i + 1 and i + 2, or 0 again where there is no corner i + 2:
//   between(between(corner 0, corner i, s), between(the last corner, corner i + 1, s), t).
struct CellPlace {
  std::size_t i;
  double s, t;
};

struct WeightedPlace {
  Vec3 at;
  double weight;  // the rule's times the area of the map
  CellPlace place;
};

// The rule for integrals over the convex polygon, which is cut into quadrilaterals, and perhaps a triangle, at its
// first corner. Each is the image of a square, whose first side collapses for a triangle.
template <unsigned kCount>
std::vector<WeightedPlace> gauss_places(const std::vector<Vec3>& ring) {
  std::vector<WeightedPlace> places;
  places.reserve(kCount * kCount * (ring.size() / 2));
  for (std::size_t i = 1; i + 1 < ring.size(); i += 2) {
    const Vec3& a = ring[0];
    const Vec3& last = i + 2 < ring.size() ? ring[i + 2] : a;
    const Vec3 b = kernel::difference(ring[i], a), d = kernel::difference(last, a);
    const Vec3 twist = kernel::difference(kernel::difference(ring[i + 1], last), b);
    for (const Node& s : gauss_rule<kCount>()) {
      const Vec3 along_t{d.x + s.x * twist.x, d.y + s.x * twist.y, d.z + s.x * twist.z};
      for (const Node& t : gauss_rule<kCount>()) {
        const Vec3 along_s{b.x + t.x * twist.x, b.y + t.x * twist.y, b.z + t.x * twist.z};
        const Vec3 normal = kernel::cross(along_s, along_t);
        const Vec3 x{a.x + s.x * b.x + t.x * along_t.x, a.y + s.x * b.y + t.x * along_t.y,
                     a.z + s.x * b.z + t.x * along_t.z};
        places.push_back({x, s.weight * t.weight * kernel::length(normal), {i, s.x, t.x}});
      }
    }
  }
  return places;
}

// --- Pair ---

// A cell with the integral of the point factor over it, in squares of the unit of Point::at.
struct Share {
  Cell cell;
  Candidates candidates;                        // of a cell without a formula, or of which some are left out
  std::shared_ptr<const Formula> formula;       // null: the boundary is not constant on the cell
  std::shared_ptr<const Formula> to_horizon{};  // of the source as far as the horizon, if that is near (sight.h)
  PairMemory::Way way;                          // to the cell, the same; empty if it has not been looked at
  std::shared_ptr<const Plane> cut;             // decides more; null: see Pair::improve
  double integral = 0.0;
  // Of the integral: an estimate, and for an event cell a bound besides; with its roundings. Or, certified, a bound.
  double error = 0.0;
  // What may improve it.
  enum class Next {
    kCut,
    kMorePoints,  // a rule of more points
    kNextStage,   // only rounding is left, which a later stage's limits make smaller
    kNothing,     // too narrow in double, or only rounding is left
  };
  Next next = Next::kCut;
  std::size_t stage = 0;  // whose limits it is within
  bool is_event = false;  // without a formula, or with a bound of its event
  bool is_dark = false;   // all that is known are bounds of the point factor
  LeftOut left_out{};     // its middle is in the integral, and half of its width in the error
  // If positive: at every point of the cell, the point factor lies within this of `near` or, if that is null, of the
  // mean. Its integral is in the error.
  double bound = 0.0;
  std::shared_ptr<const Formula> near;

  // For a share that will not be improved.
  void keep_for_points() {
    candidates = {};
    left_out = {};
    way = {};
    formula = to_horizon = nullptr;
    cut = nullptr;
    if (bound == 0.0) cell = {};
  }
  void keep_numbers_only() {
    bound = 0.0;
    near = nullptr;
    keep_for_points();
  }
};

class Pair {
 public:
  static constexpr std::uint64_t kEffortOfCell = 2048;
  struct Limits {
    std::size_t stage = 0;         // their number
    double rounding = 0.0;         // larger bounds of the rounding error of F ask for balls; at most 2^-6
    double negligible_area = 0.0;  // on smaller cells F is only known to lie in [0, 1]
    double quadrature = 0.0;       // larger errors of the mean of F on a cell ask for more points
    // Integrals are enclosed, within (cell's area / area)^(3/4) of this, so that cells about a singular point may
    // together have it. 0: they are estimated.
    double certified = 0.0;
    double area = 0.0;  // of the receiver's patch
  };
  // Where the source part is whole faces, `whole` is these, or lies all around the scene: a point factor to it checks
  // each cell. `id` tells the pairs apart that share the memory.
  Pair(const Scene& scene, Sight sight, FaceId receiver_face, std::shared_ptr<const ExactSource> whole,
       PairMemory& memory, std::size_t id);

  [[nodiscard]] std::size_t point_count() const { return sight_.points.point_count(); }
  [[nodiscard]] const Sight& sight() const { return sight_; }
  [[nodiscard]] FaceId receiver_face() const { return receiver_face_; }
  [[nodiscard]] const ExactSource* whole() const { return whole_.get(); }
  // An estimate of how many lines cut the receiver (CellView::count_events).
  [[nodiscard]] std::size_t events();

  // For what is called from now on.
  void set_limits(const Limits& limits) { limits_ = limits; }
  // Of a call. When the cost is used up, the cells that are left are estimated as well as can be; when the effort is,
  // they wait as they are.
  struct Budget {
    std::size_t cost = 0;
    std::uint64_t effort = 0;
  };
  // Cuts the receiver until every cell is smooth, an event cell, has an error of at most `enough`, or sees nothing; the
  // last are left out.
  [[nodiscard]] std::vector<Share> cells(double enough, const Budget& budget);
  // The receiver as one cell of which only bounds are known.
  [[nodiscard]] std::vector<Share> without_cells() const;
  // The cell by a better rule or, cut in two, its halves, without parts that see nothing. A cell that has not been
  // looked at is cut as cells() does.
  [[nodiscard]] std::vector<Share> improve(Share share, const Budget& budget);
  // Of the share's integral. It lies within the error, but a point of the cell may tell more than the middle does.
  [[nodiscard]] double estimate(const Share& share) const;
  [[nodiscard]] std::size_t cells_made() const { return cells_made_; }
  // In cells; one that asks for very many signs counts for several.
  [[nodiscard]] std::size_t cost() const { return cells_made_ + extra_cost_; }
  // About as many times a few nanoseconds, from what has been done.
  [[nodiscard]] std::uint64_t effort() const { return view_.work() + kEffortOfCell * cells_made_; }

 private:
  CellView::Outcome view(const Cell& cell, std::size_t depth, Candidates& candidates);
  // `trifle`: what may be hidden by candidates that are left out.
  void look(Cell cell, std::size_t depth, Candidates candidates, double enough, double trifle,
            std::vector<Share>& shares);
  // Null where the last view is not known, or nothing is seen.
  [[nodiscard]] std::shared_ptr<const Formula> formula_of_view(CellView::Outcome outcome) const;
  [[nodiscard]] bool is_hard(const Formula& formula, const Cell& cell);
  // As bounds of what is left out ask for it.
  [[nodiscard]] Extent extent_of(const Cell& cell) const;
  // Of a view with these parts, if the source as far as the horizon has a formula, too.
  [[nodiscard]] std::shared_ptr<const Formula> formula_to_horizon(const std::vector<BoundaryPart>& seen) const;
  // In the integral and the error.
  static void count_left_out(Share& share);
  // The share has its cell and what is seen from it. `most`: the largest error that is useful.
  void add_smooth(Share share, double most, std::vector<Share>& shares);
  // `triples`: all that is undecided; if empty, more may be.
  void add_event(Cell cell, std::size_t depth, Candidates candidates, const std::vector<CrossingTriple>& triples,
                 std::vector<Share>& shares);
  // All that is known is the largest factor.
  void add_dark(Cell cell, Candidates candidates, PairMemory::Way way, std::shared_ptr<const Plane> cut,
                std::vector<Share>& shares) const;
  // By a better rule on the same cell, if there is one.
  [[nodiscard]] bool improve_whole(Share& share);
  struct Integral {
    double integral = 0.0, error = 0.0;
    double rounding = 0.0;     // in the error
    bool more_points = false;  // would lessen it
    double bound = 0.0;        // Share::bound,
    bool is_near = false;      // of the formula
  };
  [[nodiscard]] Share::Next next_of(const Integral& found) const;
  // Of a share with a formula: by this, or by that of the source as far as the horizon with a bound of the difference.
  template <class Integrate>
  [[nodiscard]] Integral better_integral(const Share& share, const Integrate& integrate) const;
  [[nodiscard]] Integral integrate(const Formula& formula, const Cell& cell) const;
  // `radii`: the distance of the nearest edge (resolution).
  template <unsigned kCount>
  [[nodiscard]] Integral integrate_by(const Formula& formula, const Cell& cell, double radii) const;
  [[nodiscard]] Integral integrate_event(const Formula& formula, const Cell& cell, const Point& centre,
                                         const Candidates& candidates,
                                         const std::vector<CrossingTriple>& triples) const;
  [[nodiscard]] Integral enclose(const Formula& formula, const Cell& cell, double most) const;
  [[nodiscard]] Integral enclose_event(const Formula& formula, const Cell& cell, const Point& centre,
                                       const Candidates& candidates, const std::vector<CrossingTriple>& triples) const;
  [[nodiscard]] bool certifies() const { return limits_.certified > 0.0; }
  [[nodiscard]] double size_of(const Cell& cell) const;
  struct Range {
    double low = 0.0, high = 1.0;
    [[nodiscard]] double middle() const { return 0.5 * (low + high); }
    [[nodiscard]] double half() const { return 0.5 * (high - low); }
  };
  // Of F on the cell, whatever is hidden.
  [[nodiscard]] Range range_on(const Cell& cell, const Candidates& candidates) const;
  struct Rule {
    double integral = 0.0;
    double rounding = 0.0;  // of the values and of the cell's area
  };
  // `most`: where rounding matters, any value up to this is good enough, as all of them are within the error.
  template <unsigned kCount>
  [[nodiscard]] Rule gauss_integral(const Formula& formula, const Cell& cell, const std::vector<Vec3>& ring,
                                    std::optional<double> most = {}) const;
  [[nodiscard]] Evaluated value_at(const Formula& formula, const Point& x) const;
  [[nodiscard]] double factor_near(const Vec3& at) const;
  void check(const Cell& cell, const Formula& formula) const;
  [[nodiscard]] double slope_bound(const Candidates& candidates, const Vec3& centre, double radius) const;

  const Scene& scene_;
  Sight sight_;
  FaceId receiver_face_;
  std::shared_ptr<const ExactSource> whole_;
  Limits limits_;
  FactorBound bound_;
  std::vector<FactorBound> of_occluders_;  // from their positive sides, then from the others; of what is open
  std::optional<StripBound> strip_;        // of Sight::near_horizon
  CellView view_;
  Omissions omissions_;
  std::size_t cells_made_ = 0, extra_cost_ = 0;
  Budget budget_;  // of all calls so far and this one
};

}  // namespace exactff::view_factors
