#include "kernel/gauss.h"

#include <arb_hypgeom.h>

#include <array>
#include <cmath>

#include "kernel/expect.h"

namespace exactff::kernel {
namespace {

constexpr long kBits = 128;

std::vector<GaussNode> make_rule(std::size_t count) {
  std::vector<GaussNode> rule;
  for (std::size_t k = 0; k < count; ++k) {
    Ball node(kBits), weight(kBits);  // of the rule on [-1, 1]
    arb_hypgeom_legendre_p_ui_root(node.get(), weight.get(), count, k, kBits);
    arb_add_ui(node.get(), node.get(), 1, kBits);
    arb_mul_2exp_si(node.get(), node.get(), -1);
    arb_mul_2exp_si(weight.get(), weight.get(), -1);
    rule.push_back({to_disc(node), to_disc(weight)});
  }
  return rule;
}

}  // namespace

Disc to_disc(const Ball& ball) {
  const double centre = nearest_to_midpoint(ball);
  if (!std::isfinite(centre)) return disc::kFailed;
  const Ball rest = ball_around(-centre, 0.0, 0.0);
  Ball distance(kBits);
  arb_add(distance.get(), ball.get(), rest.get(), kBits);
  mag_t radius;
  mag_init(radius);
  arb_get_mag(radius, distance.get());  // an upper bound, of 30 bits
  const double bound = mag_get_d(radius);
  mag_clear(radius);
  return {centre, bound * disc::kUp + disc::kTiny};
}

const std::vector<GaussNode>& enclosed_gauss_rule(std::size_t count) {
  EXACTFF_EXPECT(count >= 1 && count <= kMostNodes);
  static const std::array<std::vector<GaussNode>, kMostNodes> rules = [] {
    std::array<std::vector<GaussNode>, kMostNodes> made;
    for (std::size_t n = 1; n <= kMostNodes; ++n) made[n - 1] = make_rule(n);
    return made;
  }();
  return rules[count - 1];
}

}  // namespace exactff::kernel
