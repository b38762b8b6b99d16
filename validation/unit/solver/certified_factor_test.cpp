// Certified view factors: the quadrature's remainder and the formula in discs. view_factor_test.cpp has known values.
#include "kernel/gauss.h"
#include "support/test.h"
#include "unit/solver/known_factors.h"
#include "unit/solver/visit_cells.h"
#include "view_factors/certified_integral.h"

namespace exactff {
namespace {

ViewFactor certified(const Scene& scene, const char* from, const char* to, double accuracy,
                     std::size_t budget = 100000) {
  return view_factor(scene, scene.select(from), scene.select(to),
                     {.accuracy = accuracy, .budget = budget, .certify = true});
}

// Three edges may meet in one direction, and the budget may not suffice: the claim stays, and the width is honest.
TEST(CertifiedFactor, KeepsItsClaimInACrowd) {
  PlainScene plain = plates(1.0, 1.0);
  add(plain, "a", {{0.1, 0.1, 0.3}, {0.9, 0.2, 0.4}, {0.4, 0.8, 0.35}});
  add(plain, "b", {{0.2, 0.05, 0.5}, {0.95, 0.6, 0.55}, {0.3, 0.9, 0.6}});
  add(plain, "c", {{0.5, 0.1, 0.7}, {0.8, 0.9, 0.65}, {0.1, 0.5, 0.75}});
  const Scene scene = generate::build(plain);
  const ViewFactor fine = certified(scene, "below", "above", 1e-3);
  EXPECT_TRUE(fine.accurate);
  EXPECT_GT(fine.event_cells, 0U);
  for (const std::size_t budget : {std::size_t{1}, std::size_t{50}, std::size_t{500}}) {
    const ViewFactor coarse = certified(scene, "below", "above", 1e-5, budget);
    EXPECT_EQ(coarse.claim, Claim::kCertified);
    EXPECT_FALSE(coarse.accurate);
    EXPECT_GT(coarse.upper - coarse.lower, 1e-5);
    EXPECT_LE(coarse.lower, fine.upper);
    EXPECT_GE(coarse.upper, fine.lower);
  }
}

using view_factors::cover_of_half_ellipse;
using view_factors::quadrature_remainder;

TEST(CertifiedQuadrature, CoversTheFilledEllipse) {
  for (const double rho : {1.125, 1.5, 2.0, 3.0, 5.0}) {
    const double a = 0.5 * (rho + 1.0 / rho), b = 0.5 * (rho - 1.0 / rho);
    const kernel::Disc disc = cover_of_half_ellipse(rho);
    EXPECT_LE(disc.radius, std::hypot(b, 0.5));
    for (int i = 0; i <= 64; ++i) {
      for (const double filled : {0.0, 0.5, 1.0}) {
        const double w = 0.5 * std::numbers::pi * i / 64.0;
        const double x = filled * a * std::cos(w), y = filled * b * std::sin(w);
        EXPECT_LE(std::hypot(x - disc.centre, y), disc.radius * (1.0 + 1e-14)) << rho << ' ' << i;
      }
    }
  }
}

// 1 / (c - x) on [0, 1], whose largest magnitude in an ellipse is that at the end of its long axis.
TEST(CertifiedQuadrature, BoundsTheErrorOfAPoleAndNotByMuch) {
  for (const double c : {1.1, 1.25, 1.5, 2.0, 4.0}) {
    for (const std::size_t nodes : {std::size_t{2}, std::size_t{3}, std::size_t{4}, std::size_t{6}}) {
      double sum = 0.0, least = HUGE_VAL;
      for (const kernel::GaussNode& node : kernel::enclosed_gauss_rule(nodes)) {
        sum += node.weight.centre / (c - node.at.centre);
      }
      const double error = std::abs(sum - std::log(c / (c - 1.0)));
      for (double rho = 1.01; 0.5 + 0.25 * (rho + 1.0 / rho) < c; rho *= 1.01) {
        const double bound = quadrature_remainder(1.0 / (c - 0.5 - 0.25 * (rho + 1.0 / rho)), rho, nodes);
        EXPECT_GE(bound, error - 1e-15) << c << ' ' << nodes;
        least = std::min(least, bound);
      }
      EXPECT_LE(least, 150.0 * error + 1e-12) << c << ' ' << nodes;
    }
  }
}

// --- The formula in discs, judged by Arb's balls at the same points ---

using view_factors::Cell;
using view_factors::DiscFormula;
using view_factors::Formula;

TEST(DiscFormula, HoldsTheFormulaInBalls) {
  PlainScene turned = plates_with_plate(1.0, 0.5, 0.75);
  add(turned, "turned", {{0.3, 0.2, 0.4}, {0.7, 0.3, 0.45}, {0.5, 0.8, 0.35}});
  for (const auto& [scene, from, to] :
       {std::tuple{generate::build(turned), "below", "above"}, std::tuple{generate::build(turned), "turned", "above"},
        std::tuple{generate::build(floor_and_wall()), "floor", "wall"}}) {
    Random random(7);
    std::size_t cells = 0;
    visit_cells(scene, from, to, [&](const Formula& formula, const Cell& cell) {
      ++cells;
      DiscFormula discs(formula, cell);
      discs.take({0, 1, 2, 2});
      for (int i = 0; i < 20; ++i) {
        const double s = random.unit(), t = random.unit();
        const kernel::Disc found = discs.value({s, 0.0}, {t, 0.0});
        const kernel::Disc truth = kernel::to_disc(value_in_balls(formula, cell, s, t));
        EXPECT_LE(std::abs(found.centre - truth.centre), found.radius + 0x1p-60);
        EXPECT_LE(found.radius, 1e-12);
        // What holds on a disc holds at its points.
        const kernel::Disc wide = discs.value({0.5, 0.5}, {t, 0.0});
        EXPECT_TRUE(!is_finite(wide) || std::abs(wide.centre - truth.centre) <= wide.radius);
      }
    });
    EXPECT_GT(cells, 0U);
  }
}

// On the real axis inside the ellipse, beyond the cell, where the map's Jacobian is larger.
TEST(DiscFormula, IsBoundedOnTheEllipse) {
  using view_factors::Axis;
  using view_factors::bound_on_ellipse;
  for (const double gap : {2.0, 100.0}) {
    std::size_t judged = 0;
    visit_cells(generate::build(plates(1.0, gap)), "below", "above", [&](const Formula& formula, const Cell& cell) {
      DiscFormula discs(formula, cell);
      discs.take({0, 1, 2, 2});
      for (const double rho : {1.5, 2.0, 3.0, 5.0}) {
        const double bound = bound_on_ellipse(discs, Axis::kS, rho);
        if (!(bound < HUGE_VAL)) continue;
        const double end = 0.5 + 0.25 * (rho + 1.0 / rho);
        for (const double t : {0.0, 0.5, 1.0}) {
          const double value = kernel::nearest_to_midpoint(value_in_balls(formula, cell, end, t));
          const double jacobian = discs.jacobian({end, 0.0}, {t, 0.0}).centre;
          EXPECT_LE(std::abs(value * jacobian), bound) << gap << ' ' << rho << ' ' << t;
          ++judged;
        }
      }
    });
    EXPECT_GT(judged, 3U);
  }
}

}  // namespace
}  // namespace exactff
