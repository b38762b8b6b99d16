// Changes of a scene that must not change a bit of the value, the zero flag or the visible fraction.
#include <thread>

#include "generate/families.h"
#include "support/solve.h"
#include "support/test.h"
#include "support/transform.h"

namespace exactff::validation {
namespace {

// Compares each of `count` random scenes with the result of `change`.
void expect_unchanged_bits(std::uint64_t count, const std::function<PlainScene(const PlainScene&, Random&)>& change) {
  for (std::uint64_t i = 0; i < scaled_count(count); ++i) {
    Random random(seed_of(i));
    const PlainScene scene = random_scene(random);
    const PlainScene changed = change(scene, random);
    ASSERT_EQ(answer(scene), answer(changed)) << "scene " << i << ", seed " << seed_of(i) << '\n'
                                              << generate::to_obj(scene) << "changed:\n"
                                              << generate::to_obj(changed);
  }
}

TEST(Invariance, OrderOfOccludersFacesVerticesAndCorners) {
  expect_unchanged_bits(150, [](const PlainScene& scene, Random& random) { return shuffled(scene, random); });
}

TEST(Invariance, RetriangulatedOccluders) {
  expect_unchanged_bits(150, [](const PlainScene& scene, Random& random) { return retriangulated(scene, random); });
}

TEST(Invariance, AxisPermutationsAndSignFlips) {
  expect_unchanged_bits(150, [](const PlainScene& scene, Random& random) {
    const std::vector<Symmetry> symmetries = all_symmetries();
    return turned(scene, symmetries[1 + random.below(47)]);
  });
}

TEST(Invariance, EverySymmetryOfTheCube) {
  const PlainScene scene = generate::soup({.n = 20, .seed = 3});
  const Answer expected = answer(scene);
  for (const Symmetry& symmetry : all_symmetries()) EXPECT_EQ(answer(turned(scene, symmetry)), expected);
}

TEST(Invariance, PowerOfTwoScaling) {
  expect_unchanged_bits(100, [](const PlainScene& scene, Random& random) {
    PlainScene out = scene;
    generate::scale(out, std::ldexp(1.0, random.integer(-300, 300)));
    return out;
  });
}

bool scales_exactly(const PlainScene& scene, int exponent) {
  PlainScene there = scene;
  generate::scale(there, std::ldexp(1.0, exponent));
  generate::scale(there, std::ldexp(1.0, -exponent / 2));  // in two steps, because 2^1074 is not a double
  generate::scale(there, std::ldexp(1.0, -exponent - (-exponent / 2)));
  return there.point == scene.point && there.vertices == scene.vertices;
}

TEST(Invariance, ScalingToTheEdgesOfTheDoubles) {
  for (const int exponent : {-1064, -1022, -1020, 1000, 1018, 1020}) {
    std::uint64_t compared = 0;
    for (std::uint64_t i = 0; i < scaled_count(15); ++i) {
      Random random(seed_of(i));
      const PlainScene scene = degenerate_scene(random);
      if (!scales_exactly(scene, exponent)) continue;
      PlainScene scaled = scene;
      generate::scale(scaled, std::ldexp(1.0, exponent));
      ASSERT_EQ(answer(scene), answer(scaled)) << "2^" << exponent << ", seed " << seed_of(i) << '\n'
                                               << generate::to_obj(scene);
      ++compared;
    }
    EXPECT_GT(compared, 0u);
  }
}

TEST(Invariance, LengthOfTheNormal) {
  expect_unchanged_bits(40, [](const PlainScene& scene, Random& random) {
    PlainScene out = scene;
    const double factor = std::ldexp(1.0, random.integer(-900, 900));
    out.normal = {factor * scene.normal.x, factor * scene.normal.y, factor * scene.normal.z};
    return out;
  });
}

// A repeated occluder and one beyond the source add nothing.
TEST(Invariance, IdleOccluders) {
  expect_unchanged_bits(40, [](const PlainScene& scene, Random&) {
    constexpr double kFar = 0x1p40;
    PlainScene out = scene;
    if (out.patches.size() > 1) {
      out.patches.push_back(out.patches[1]);
      out.patches.back().name = "twin";
    }
    out.add_ring(out.patch("far"),
                 {{-kFar, -kFar, kFar}, {kFar, -kFar, kFar}, {kFar, kFar, kFar}, {-kFar, kFar, kFar}});
    return out;
  });
}

TEST(Invariance, RepeatedCornersAndCornersOnStraightSides) {
  expect_unchanged_bits(100, [](const PlainScene& scene, Random& random) { return with_idle_corners(scene, random); });
}

TEST(Invariance, SpikesInRings) {
  expect_unchanged_bits(200, [](const PlainScene& scene, Random& random) { return with_spikes(scene, random); });
}

// On the way, holes become keyholes and numbers become text.
TEST(Invariance, TheWayThroughObj) {
  ExactOptions options;
  options.visible_fraction = true;
  for (std::uint64_t i = 0; i < scaled_count(100); ++i) {
    Random random(seed_of(i));
    const PlainScene plain = random_scene(random);
    std::istringstream text(generate::to_obj(plain));
    const Scene scene = read_obj(text, "scene.obj");
    ASSERT_EQ(answer(plain), answer_of(solve(scene, plain, options))) << "seed " << seed_of(i) << '\n' << text.str();
  }
}

// With magnitudes from 1e-300 to 1e300 in one scene, even in one triangle, F is the same to the last bit.
TEST(Invariance, CornersSlideAlongRaysThroughTheReceiver) {
  for (const int range : {1, 40, 1000}) {
    for (std::uint64_t i = 0; i < scaled_count(40); ++i) {
      Random random(seed_of(i));
      const PlainScene scene = triangles_scene(random);
      const PlainScene slid = slid_along_rays(scene, range, random);
      const FormFactor before = solve(scene);
      const FormFactor after = solve(slid);
      ASSERT_EQ(before.value, after.value) << "seed " << seed_of(i) << '\n' << generate::to_obj(slid);
      ASSERT_EQ(before.status, after.status) << "seed " << seed_of(i) << '\n' << generate::to_obj(slid);
    }
  }
}

std::vector<Answer> answers(const Scene& scene, const std::vector<Receiver>& receivers, const ExactSource& source) {
  ExactOptions options;
  options.engine = Engine::kBoth;
  options.visible_fraction = true;
  std::vector<Answer> out;
  for (const Receiver& receiver : receivers) {
    out.push_back(answer_of(exact_form_factor(scene, receiver, source, options)));
  }
  return out;
}

// Two threads that use the same scene and source at the same time, compared with one thread.
TEST(Invariance, OneOrTwoThreads) {
  const PlainScene plain = generate::lattice({.n = 40, .seed = 5});
  const Scene scene = generate::build(plain);
  const ExactSource source(scene, scene.select("source"));
  std::vector<Receiver> receivers;
  for (int i = 0; i < 24; ++i) receivers.push_back({{i / 16.0 - 0.75, i / 32.0, 0}, {0, 0.25, 1}, {}, {}});
  std::vector<Answer> first;
  std::vector<Answer> second;
  std::thread one([&] { first = answers(scene, receivers, source); });
  std::thread two([&] { second = answers(scene, receivers, source); });
  one.join();
  two.join();
  EXPECT_EQ(first, second);
  EXPECT_EQ(first, answers(scene, receivers, source));
}

}  // namespace
}  // namespace exactff::validation
