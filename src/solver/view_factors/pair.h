// One convex part seen from another: its cells and their integrals.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "exactff/exact.h"
#include "view_factors/cell_view.h"
#include "view_factors/factor_bound.h"
#include "view_factors/formula.h"
#include "view_factors/quadrature.h"
#include "view_factors/sight.h"

namespace exactff::view_factors {

// A cell with the integral of the point factor over it, in squares of the unit of Point::at.
struct Share {
  Cell cell;
  Candidates candidates;                   // of an event cell
  std::shared_ptr<const Formula> formula;  // null for an event cell: the boundary is not constant on it
  double integral = 0.0;
  // Of the integral: an estimate, and for an event cell a bound besides; with its roundings. Or, certified, a bound.
  double error = 0.0;
  bool narrow = false;  // not worth a cut: too narrow in double, or only rounding is left
  bool is_event = formula == nullptr;

  // For a share that will not be cut.
  void keep_numbers_only() {
    cell = {};
    candidates = {};
    formula = nullptr;
  }
};

class Pair {
 public:
  struct Limits {
    double rounding = 0.0;         // larger bounds of the rounding error of F ask for balls; at most 2^-6
    double negligible_area = 0.0;  // on smaller cells F is only known to lie in [0, 1]
    double quadrature = 0.0;       // larger errors of the mean of F on a cell ask for more points
    double enough = 0.0;           // a cell to be cut stays undecided if its error is at most this
    // Integrals are enclosed, within (cell's area / area)^(3/4) of this, so that cells about a singular point may
    // together have it. 0: they are estimated.
    double certified = 0.0;
    double area = 0.0;  // of the receiver's patch
  };
  // Where the source part is whole faces, `whole` is these: a point factor to it checks each cell. `id` tells the
  // pairs apart that share the memory.
  Pair(const Scene& scene, Sight sight, std::vector<FaceId> receiver_faces, std::shared_ptr<const ExactSource> whole,
       const Limits& limits, PairMemory& memory, std::size_t id);

  [[nodiscard]] std::size_t point_count() const { return sight_.points.point_count(); }
  // True if Limits::enough will do for all of the receiver.
  [[nodiscard]] bool is_dim() const { return bound_.on(sight_.root) * size_of(sight_.root) <= limits_.enough; }
  // An estimate of how many lines cut the receiver (CellView::count_events).
  [[nodiscard]] std::size_t events();

  // Cuts the receiver until every cell is smooth, an event cell, or sees nothing; the last are left out. Gives up when
  // cost() reaches the budget: what is left then counts as event cells.
  [[nodiscard]] std::vector<Share> cells(std::size_t budget);
  // The two halves of a cell, without parts that see nothing.
  [[nodiscard]] std::vector<Share> halves(Share share);
  [[nodiscard]] std::size_t cells_made() const { return cells_made_; }
  // In cells; one that asks for very many signs counts for several.
  [[nodiscard]] std::size_t cost() const { return cells_made_ + extra_cost_; }

 private:
  CellView::Outcome view(const Cell& cell, std::size_t depth, Candidates& candidates);
  // `enough`: see Limits.
  void look(Cell cell, std::size_t depth, Candidates candidates, double enough, std::vector<Share>& shares);
  // `most`: the largest error that is useful.
  void add_smooth(Cell cell, std::shared_ptr<const Formula> formula, double most, std::vector<Share>& shares);
  // `triples`: all that is undecided; if empty, more may be.
  void add_event(Cell cell, std::size_t depth, Candidates candidates, const std::vector<CrossingTriple>& triples,
                 std::vector<Share>& shares);
  struct Integral {
    double integral, error;
    double rounding = 0.0;  // in the error
    [[nodiscard]] bool is_most_of(double all) const { return rounding > 0.5 * all; }
  };
  [[nodiscard]] Integral integrate(const Formula& formula, const Cell& cell) const;
  [[nodiscard]] Integral enclose(const Formula& formula, const Cell& cell, double most) const;
  [[nodiscard]] Integral enclose_event(const Formula& formula, const Cell& cell, const Point& centre,
                                       const Candidates& candidates, const std::vector<CrossingTriple>& triples) const;
  [[nodiscard]] bool certifies() const { return limits_.certified > 0.0; }
  [[nodiscard]] double size_of(const Cell& cell) const;
  bool add_if_negligible(Cell& cell, Candidates& candidates, std::vector<Share>& shares) const;
  bool add_if_dim(Cell& cell, Candidates& candidates, double enough, std::vector<Share>& shares) const;
  struct Rule {
    double integral = 0.0;
    double rounding = 0.0;  // of the values and of the cell's area
  };
  template <unsigned kCount>
  [[nodiscard]] Rule gauss_integral(const Formula& formula, const Cell& cell, const std::vector<Vec3>& ring) const;
  [[nodiscard]] Evaluated value_at(const Formula& formula, const Point& x) const;
  [[nodiscard]] double factor_near(const Vec3& at) const;
  void check(const Cell& cell, const Formula& formula) const;
  [[nodiscard]] double slope_bound(const Candidates& candidates, const Vec3& centre, double radius) const;

  const Scene& scene_;
  Sight sight_;
  std::vector<FaceId> receiver_faces_;
  std::shared_ptr<const ExactSource> whole_;
  Limits limits_;
  FactorBound bound_;
  CellView view_;
  std::size_t cells_made_ = 0, extra_cost_ = 0, budget_ = 0;
};

}  // namespace exactff::view_factors
