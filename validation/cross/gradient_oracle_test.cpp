// Compares derivatives with slopes of the oracle, which shares nothing with the solver and steps by 2^-400 in rational
// numbers: one-sided ones by the receiver's point, also at kinks, and those by vertices.
#include "kernel/ball.h"
#include "support/oracle.h"
#include "support/oracle_check.h"
#include "support/solve.h"
#include "support/test.h"
#include "support/transform.h"

namespace exactff::validation {
namespace {

Vec3 direction(Random& random) {
  for (;;) {
    const auto component = [&] { return static_cast<double>(random.integer(-3, 3)); };
    const Vec3 d{component(), component(), component()};
    if (!(d == Vec3{})) return d;
  }
}

Vec3 negative(const Vec3& d) { return {-d.x, -d.y, -d.z}; }

void expect_near(double found, double reference, const std::string& what) {
  EXPECT_LE(std::abs(found - reference), 1e-13 * std::abs(reference) + 1e-28)
      << what << ": " << found << ", not " << reference;
}

// The oracle's step is to be smaller than any distance, and its numbers short.
bool is_moderate(const PlainScene& plain) {
  double least = 1.0, largest = 0.0;
  const auto take = [&](const Vec3& v) {
    for (const double c : {v.x, v.y, v.z}) {
      largest = std::max(largest, std::abs(c));
      if (c != 0.0) least = std::min(least, std::abs(c));
    }
  };
  std::ranges::for_each(plain.vertices, take);
  take(plain.point);
  return least > 0x1p-100 && largest > 0x1p-40 && largest < 0x1p40 && plain.patches.size() < 40;
}

TEST(GradientOracle, SlopesByTheReceiversPointAgreeAlsoAtKinks) {
  std::size_t smooth = 0, kinks = 0;
  for (const RandomFamily& family : random_families()) {
    for (std::uint64_t i = 0; i < scaled_count(6); ++i) {
      Random random(seed_of(i));
      const PlainScene plain = family.make(random);
      if (!is_moderate(plain)) continue;
      const Scene scene = generate::build(plain);
      const Receiver receiver = receiver_in(scene, plain);
      const Selection selection = scene.select(plain.source);
      const ExactSource source(scene, selection);
      const Vec3 d = direction(random);
      const double length = std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
      for (const Vec3& along : {d, negative(d)}) {
        const Gradient gradient = *exact_form_factor(scene, receiver, source, {.along = along}).gradient;
        if (gradient.along->status == DerivativeStatus::kNone) continue;
        ++(gradient.kink ? kinks : smooth);
        expect_near(gradient.along->value * length, oracle_slope(scene, receiver, selection, {{}, along}),
                    std::string(family.name) + ' ' + std::to_string(i) + '\n' + generate::to_obj(plain));
        if (HasFailure()) return;
      }
    }
  }
  EXPECT_GT(smooth, 50U);
  EXPECT_GT(kinks, 15U);
}

// Each movement of a vertex at random, and back.
TEST(GradientOracle, SlopesByVerticesAgree) {
  std::size_t moving = 0, resting = 0, kinks = 0, sharp = 0;
  for (const RandomFamily& family : random_families()) {
    for (std::uint64_t i = 0; i < scaled_count(8); ++i) {
      Random random(seed_of(500 + i));
      const PlainScene plain = in_triangles(family.make(random));
      if (!is_moderate(plain) || !has_only_area(plain)) continue;
      const Scene scene = generate::build(plain);
      const Receiver receiver = receiver_in(scene, plain);
      const Selection selection = scene.select(plain.source);
      const ExactSource source(scene, selection);
      const Gradient gradient = *exact_form_factor(scene, receiver, source, {.vertices = true}).gradient;
      if (gradient.kink) continue;
      const auto& faces = plain.patches[random.below(plain.patches.size())].faces;
      const std::uint32_t corner = faces[random.below(faces.size())].rings[0][random.below(3)];
      const Vec3 place = plain.vertices[corner], d = direction(random);
      const auto found = std::ranges::find_if(
          gradient.vertices, [&](const VertexDerivative& v) { return plain.vertices[v.vertex] == place; });
      const bool rests = found == gradient.vertices.end();
      const double ahead = oracle_slope(scene, receiver, selection, {place, d});
      const double back = oracle_slope(scene, receiver, selection, {place, negative(d)});
      ++(rests ? resting : found->is_kink ? kinks : moving);
      if (!rests && found->is_kink) {
        sharp += std::abs(ahead + back) > 1e-13 * std::abs(ahead) ? 1 : 0;
        continue;
      }
      constexpr long kBits = 300;
      Ball sum(kBits);
      const double components[] = {d.x, d.y, d.z};
      for (std::size_t axis = 0; axis < 3 && !rests; ++axis) {
        sum = sum + EnclosureInside::ball(found->position[axis].enclosure) * kernel::to_ball(components[axis], kBits);
      }
      const double expected = kernel::nearest_to_midpoint(sum);
      const std::string what = std::string(family.name) + ' ' + std::to_string(i) + ", vertex " +
                               std::to_string(corner) + '\n' + generate::to_obj(plain);
      expect_near(expected, ahead, what);
      expect_near(-expected, back, what);
      if (HasFailure()) return;
    }
  }
  EXPECT_GT(moving, 20U);
  EXPECT_GT(resting, 20U);
  EXPECT_GT(kinks, 5U);
  EXPECT_GT(3 * sharp, kinks);
}

}  // namespace
}  // namespace exactff::validation
