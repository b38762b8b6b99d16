// Certified view factors: the quadrature's remainder, the formula in discs, and known values.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "exactff/matrix.h"
#include "exactff/scene_files.h"
#include "exactff/view_factors.h"
#include "generate/plain_scene.h"
#include "generate/random.h"
#include "kernel/gauss.h"
#include "support/program.h"
#include "unit/solver/visit_cells.h"
#include "view_factors/certified_integral.h"

namespace exactff {
namespace {

using generate::PlainScene;

void add(PlainScene& scene, const std::string& name, const std::vector<Vec3>& corners) {
  scene.add_ring(scene.patch(name), corners);
}

// Squares that face each other, `gap` apart.
PlainScene squares(double side, double gap) {
  PlainScene scene;
  add(scene, "below", {{0, 0, 0}, {side, 0, 0}, {side, side, 0}, {0, side, 0}});
  add(scene, "above", {{0, side, gap}, {side, side, gap}, {side, 0, gap}, {0, 0, gap}});
  return scene;
}

PlainScene with_plate(PlainScene scene, double side, double plate, double height) {
  const double low = 0.5 * (side - plate), high = 0.5 * (side + plate);
  add(scene, "plate", {{low, low, height}, {high, low, height}, {high, high, height}, {low, high, height}});
  return scene;
}

PlainScene floor_and_wall() {
  PlainScene scene;
  add(scene, "floor", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  add(scene, "wall", {{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}});
  return scene;
}

// The six faces of a box, as patches; seen from outside, or from inside.
void add_box(PlainScene& scene, const std::string& name, const Vec3& l, const Vec3& h, bool inside) {
  const std::vector<std::vector<Vec3>> faces = {{{l.x, l.y, l.z}, {l.x, h.y, l.z}, {h.x, h.y, l.z}, {h.x, l.y, l.z}},
                                                {{l.x, l.y, h.z}, {h.x, l.y, h.z}, {h.x, h.y, h.z}, {l.x, h.y, h.z}},
                                                {{l.x, l.y, l.z}, {h.x, l.y, l.z}, {h.x, l.y, h.z}, {l.x, l.y, h.z}},
                                                {{l.x, h.y, l.z}, {l.x, h.y, h.z}, {h.x, h.y, h.z}, {h.x, h.y, l.z}},
                                                {{l.x, l.y, l.z}, {l.x, l.y, h.z}, {l.x, h.y, h.z}, {l.x, h.y, l.z}},
                                                {{h.x, l.y, l.z}, {h.x, h.y, l.z}, {h.x, h.y, h.z}, {h.x, l.y, h.z}}};
  for (std::size_t i = 0; i < faces.size(); ++i) {
    std::vector<Vec3> corners = faces[i];
    if (inside) std::ranges::reverse(corners);
    add(scene, name + std::to_string(i), corners);
  }
}

std::vector<Selection> all_patches(const Scene& scene) {
  std::vector<Selection> patches;
  for (std::size_t i = 0; i < scene.patches().size(); ++i) patches.push_back({PatchId(i), {}, scene.id()});
  return patches;
}

ViewFactor certified(const Scene& scene, const char* from, const char* to, double accuracy,
                     std::size_t budget = 100000) {
  return view_factor(scene, scene.select(from), scene.select(to),
                     {.accuracy = accuracy, .budget = budget, .certify = true});
}

void expect_certified(const PlainScene& plain, const char* from, const char* to, double truth) {
  const Scene scene = generate::build(plain);
  for (const double accuracy : {1e-2, 1e-4, 1e-6, 1e-8, 1e-10}) {
    for (const bool forth : {true, false}) {
      const ViewFactor f = forth ? certified(scene, from, to, accuracy) : certified(scene, to, from, accuracy);
      EXPECT_EQ(f.claim, Claim::kCertified);
      EXPECT_TRUE(f.accurate);
      EXPECT_LE(f.lower, truth) << accuracy << ' ' << from;
      EXPECT_GE(f.upper, truth) << accuracy << ' ' << from;
      EXPECT_LE(f.upper - f.lower, accuracy);
    }
  }
}

TEST(CertifiedFactor, OfSquaresHoldsTheKnownValue) {
  expect_certified(squares(1.0, 1.0), "below", "above", 0.199824895698387383041599251193);
  expect_certified(squares(2.0, 1.0), "below", "above", 0.415253283577146735374144917);
  expect_certified(squares(1.0, 10.0), "below", "above", 0.00316205683875760162512871788517);
  expect_certified(squares(1.0, 100.0), "below", "above", 3.18288667328291964442604e-5);
  expect_certified(squares(1.0, 1000.0), "below", "above", 3.18309673977380257770e-7);
}

TEST(CertifiedFactor, UpToACommonEdgeHoldsTheKnownValue) {
  expect_certified(floor_and_wall(), "floor", "wall", 0.200043776075403154239600187202);
}

TEST(CertifiedFactor, BehindAPlateHoldsTheKnownValue) {
  expect_certified(with_plate(squares(1.0, 1.0), 1.0, 0.5, 0.75), "below", "above", 0.115620602132415020312711990740);
  expect_certified(with_plate(squares(2.0, 1.0), 2.0, 0.9, 0.75), "below", "above", 0.2828875141866424869);
}

// Every row adds up to 1, and an estimate that is much better than the accuracy lies in every interval.
void expect_closed_room(const Scene& scene, double accuracy) {
  const std::vector<Selection> all = all_patches(scene);
  const matrix::Factors proved =
      matrix::compute(scene, all, all, {.factors = {.accuracy = accuracy, .certify = true}}).factors;
  const matrix::Factors estimated =
      matrix::compute(scene, all, all, {.factors = {.accuracy = 1e-3 * accuracy}}).factors;
  for (std::size_t i = 0; i < all.size(); ++i) {
    double lower = 0.0, upper = 0.0;
    for (std::size_t j = 0; j < all.size(); ++j) {
      const ViewFactor &f = proved.at(i, j), &close = estimated.at(i, j);
      EXPECT_TRUE(f.claim == Claim::kCertified || (f.claim == Claim::kZero && f.upper == 0.0));
      EXPECT_LE(f.upper - f.lower, accuracy * (1.0 + 1e-12));
      EXPECT_LE(f.lower, close.upper) << i << ' ' << j;
      EXPECT_GE(f.upper, close.lower) << i << ' ' << j;
      lower += f.lower;
      upper += f.upper;
    }
    EXPECT_LE(lower, 1.0) << i;
    EXPECT_GE(upper, 1.0) << i;
  }
}

TEST(CertifiedFactor, OfClosedRoomsHoldOne) {
  PlainScene room;
  add_box(room, "wall", {0, 0, 0}, {4, 4, 4}, true);
  add_box(room, "cube", {1.5, 1.5, 1.5}, {2.5, 2.5, 2.5}, false);
  expect_closed_room(generate::build(room), 1e-6);
}

TEST(CertifiedFactor, OfTheLShapedRoomHoldsTheKnownValue) {
  const Scene scene = read_scene(EXACTFF_DATA_DIR "/scenes/formats/test4.vs3");
  const std::vector<Selection> all = all_patches(scene);
  const ViewFactor f = view_factor(scene, all[0], all[5], {.accuracy = 1e-10, .certify = true});
  EXPECT_LE(f.lower, 0.1823559036685958);
  EXPECT_GE(f.upper, 0.1823559036685958);
  EXPECT_LE(f.upper - f.lower, 1e-10);
}

// Three edges may meet in one direction, and the budget may not suffice: the claim stays, and the width is honest.
TEST(CertifiedFactor, KeepsItsClaimInACrowd) {
  PlainScene plain = squares(1.0, 1.0);
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

TEST(CertifiedFactor, IsTheSameForAnyUnitOfLengthAndAnyNumberOfThreads) {
  const auto scaled = [](double unit) {
    PlainScene plain = with_plate(squares(1.0, 1.0), 1.0, 0.5, 0.75);
    for (Vec3& v : plain.vertices) v = {unit * v.x, unit * v.y, unit * v.z};
    return generate::build(plain);
  };
  const ViewFactor one = certified(scaled(1.0), "below", "above", 1e-8);
  for (const double unit : {0x1p-300, 0x1p200}) {
    const ViewFactor f = certified(scaled(unit), "below", "above", 1e-8);
    EXPECT_EQ(f.lower, one.lower);
    EXPECT_EQ(f.upper, one.upper);
  }
  const Scene scene = scaled(1.0);
  const std::vector<Selection> all = all_patches(scene);
  const ViewFactorOptions options{.certify = true};
  const matrix::Factors a = matrix::compute(scene, all, all, {.factors = options, .threads = 1}).factors;
  const matrix::Factors b = matrix::compute(scene, all, all, {.factors = options, .threads = 3}).factors;
  for (std::size_t e = 0; e < a.entries.size(); ++e) EXPECT_EQ(a.entries[e].lower, b.entries[e].lower);
}

TEST(CertifiedFactor, IsBetweenTheOthersInStrength) {
  EXPECT_EQ(to_string(Claim::kCertified), "certified");
  EXPECT_EQ(matrix::weaker(Claim::kCertified, Claim::kEstimated), Claim::kEstimated);
  EXPECT_EQ(matrix::weaker(Claim::kZero, Claim::kCertified), Claim::kCertified);
}

// --- The remainder ---

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

using validation::value_in_balls;
using validation::visit_cells;
using view_factors::Cell;
using view_factors::DiscFormula;
using view_factors::Formula;

TEST(DiscFormula, HoldsTheFormulaInBalls) {
  PlainScene turned = with_plate(squares(1.0, 1.0), 1.0, 0.5, 0.75);
  add(turned, "turned", {{0.3, 0.2, 0.4}, {0.7, 0.3, 0.45}, {0.5, 0.8, 0.35}});
  for (const auto& [scene, from, to] :
       {std::tuple{generate::build(turned), "below", "above"}, std::tuple{generate::build(turned), "turned", "above"},
        std::tuple{generate::build(floor_and_wall()), "floor", "wall"}}) {
    generate::Random random(7);
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

// Each point has branches of its own: a wide angle, an edge that is seen from its other end, a disc that fails.
TEST(DiscFormula, HasTheSameBitsFourAtATime) {
  using view_factors::FourDiscs;
  generate::Random random(8);
  int judged = 0, failed = 0;
  const auto judge = [&](const Formula& formula, const Cell& cell) {
    DiscFormula discs(formula, cell);
    discs.take({0, 1, 2, 2});
    for (int i = 0; i < 200; ++i) {
      FourDiscs s, t;
      for (kernel::Disc& d : s) d = {random.unit(), std::ldexp(random.unit(), 1 - i % 10)};
      for (kernel::Disc& d : t) d = {random.unit(), 0.0};
      const FourDiscs found = discs.integrands(s, t);
      FourDiscs one;
      for (std::size_t k = 0; k < 4; ++k) one[k] = discs.value(s[k], t[k]) * discs.jacobian(s[k], t[k]);
      const bool succeeds = std::all_of(one.begin(), one.end(), [](const kernel::Disc& d) { return is_finite(d); });
      ++(succeeds ? judged : failed);
      for (std::size_t k = 0; k < 4; ++k) {
        EXPECT_EQ(is_finite(found[k]), succeeds);
        EXPECT_TRUE(!succeeds || (found[k].centre == one[k].centre && found[k].radius == one[k].radius));
      }
    }
  };
  visit_cells(generate::build(with_plate(squares(1.0, 1.0), 1.0, 0.5, 0.75)), "below", "above", judge);
  visit_cells(generate::build(floor_and_wall()), "floor", "wall", judge);
  EXPECT_GT(judged, 100);
  EXPECT_GT(failed, 20);
}

// On the real axis inside the ellipse, beyond the cell, where the map's Jacobian is larger.
TEST(DiscFormula, IsBoundedOnTheEllipse) {
  using view_factors::Axis;
  using view_factors::bound_on_ellipse;
  for (const double gap : {2.0, 100.0}) {
    std::size_t judged = 0;
    visit_cells(generate::build(squares(1.0, gap)), "below", "above", [&](const Formula& formula, const Cell& cell) {
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

// --- The command ---

TEST(CertifiedMatrix, IsWrittenOnRequest) {
  const std::string scene = EXACTFF_DATA_DIR "/scenes/formats/test4.vs3";
  const auto run = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"matrix", scene, "--plain"});
    return validation::run_program(EXACTFF_PROGRAM, arguments);
  };
  const validation::ProgramRun proved = run({"--certify"}), estimated = run({});
  EXPECT_EQ(proved.exit_code, 0);
  EXPECT_NE(proved.output.find("\tcertified\tcells\n"), std::string::npos);
  EXPECT_EQ(proved.output.find("estimated"), std::string::npos);
  EXPECT_EQ(estimated.output.find("certified"), std::string::npos);
}

}  // namespace
}  // namespace exactff
