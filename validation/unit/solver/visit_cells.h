// The smooth cells of a pair of patches, and their formulas in balls.
#pragma once

#include "kernel/ball.h"
#include "support/test.h"
#include "view_factors/cell_view.h"
#include "view_factors/formula.h"
#include "view_factors/prepared_patch.h"
#include "view_factors/seen_parts.h"
#include "view_factors/sight.h"

namespace exactff::validation {

// The smooth cells of a pair, each with its formula; cut as long as `depth` allows.
template <class Visit>
void visit_cells(const view_factors::Sight& sight, view_factors::CellView& view, const view_factors::Cell& cell,
                 std::size_t depth, view_factors::Candidates candidates, const Visit& visit) {
  using view_factors::CellView;
  constexpr std::size_t kDeepest = 12;
  const CellView::Outcome outcome = view.look(cell, depth, candidates);
  if (outcome == CellView::Outcome::kKnown) {
    if (!view.parts().empty()) visit(view_factors::Formula(sight, view.parts()), cell);
  } else if (outcome == CellView::Outcome::kCut && depth < kDeepest) {
    const view_factors::Halves halves = cut(cell, sight.receiver, view.best_cut(), sight.points.units());
    visit_cells(sight, view, halves.negative, depth + 1, candidates, visit);
    visit_cells(sight, view, halves.positive, depth + 1, candidates, visit);
  }
}

template <class Visit>
void visit_cells(const Scene& scene, const char* from, const char* to, const Visit& visit) {
  using namespace view_factors;
  const ExactScene exact(scene);
  const Part receiver = parts_of(exact, scene.select(from)).front(), source = parts_of(exact, scene.select(to)).front();
  const std::optional<Sight> sight = sight_of(exact, SeenParts(exact).seen_from(receiver).occluders, receiver, source);
  ASSERT_TRUE(sight);
  PairMemory memory;
  CellView view(*sight, memory, 0);
  view.start();
  visit_cells(*sight, view, sight->root, 0, view.all_candidates(), visit);
}

// At p + s ((q - p) + t (v - q)), exactly.
inline Ball value_in_balls(const view_factors::Formula& formula, const view_factors::Cell& cell, double s, double t) {
  constexpr long kBits = 256;
  const auto corner = [&](std::size_t i) { return view_factors::ball_point(cell.corners[i], kBits); };
  const Ball at_s = kernel::to_ball(s, kBits), at_t = kernel::to_ball(t, kBits);
  const view_factors::BallPoint p = corner(0), q = corner(1), v = corner(2);
  const auto coordinate = [&](Ball view_factors::BallPoint::*axis) {
    return p.*axis + at_s * ((q.*axis - p.*axis) + at_t * (v.*axis - q.*axis));
  };
  return formula.at(view_factors::BallPoint{coordinate(&view_factors::BallPoint::x),
                                            coordinate(&view_factors::BallPoint::y),
                                            coordinate(&view_factors::BallPoint::z)});
}

}  // namespace exactff::validation

namespace exactff {

using validation::value_in_balls;
using validation::visit_cells;

}  // namespace exactff
