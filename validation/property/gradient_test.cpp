// The gradient of the form factor against references that share nothing with it: differences of values that are
// certified to many digits (slopes.h), and identities. The receivers are at the origin, so that steps of 2^-200 of the
// smallest coordinate are exact.
#include "generate/families.h"
#include "kernel/ball.h"
#include "property/slopes.h"
#include "support/solve.h"
#include "support/test.h"
#include "support/transform.h"

namespace exactff::validation {
namespace {

constexpr std::array kAxes = {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};

// A scene, its receiver at the origin and its source.
struct Trial {
  explicit Trial(const PlainScene& plain)
      : scene(generate::build(plain)),
        receiver(generate::receiver_of(plain)),
        source(scene, scene.select(plain.source)) {}

  [[nodiscard]] FormFactor solve(const ExactOptions& options) const {
    return exact_form_factor(scene, receiver, source, options);
  }
  [[nodiscard]] FormFactor with_gradient(Engine engine = Engine::kEdges) const {
    return solve({.engine = engine, .gradient = true});
  }
  [[nodiscard]] Derivative along(const Vec3& d) const { return *solve({.along = d}).gradient->along; }
  [[nodiscard]] Ball value_at(const Vec3& point) const {
    Receiver moved = receiver;
    moved.point = point;
    return ball_of(exact_form_factor(scene, moved, source, {.digits = 120}).enclosure);
  }
  // The slope of F on the side of d.
  [[nodiscard]] double slope(const Vec3& d, double step) const {
    return slope_of([&](double h) { return value_at(times(d, h)); }, step);
  }

  Scene scene;
  Receiver receiver;
  ExactSource source;
};

// The same scene with the receiver at the origin; rounded.
PlainScene around_the_receiver(PlainScene plain) {
  for (Vec3& v : plain.vertices) v = {v.x - plain.point.x, v.y - plain.point.y, v.z - plain.point.z};
  plain.point = {};
  return plain;
}

void expect_near(double found, double reference, const std::string& what) {
  EXPECT_LE(std::abs(found - reference), 1e-15 * std::abs(reference) + 1e-30)
      << what << ": " << found << ", not " << reference;
}

struct Met {
  std::size_t smooth = 0, kinks = 0, slopes = 0;
};

// Both slopes along each axis, at kinks those along directions that are named.
void expect_true_slopes(const Trial& trial, double step, Met& met) {
  const Gradient gradient = *trial.with_gradient().gradient;
  ++(gradient.kink ? met.kinks : met.smooth);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const double way : {1.0, -1.0}) {
      const Vec3 d = times(kAxes[axis], way);
      const std::string what = "axis " + std::to_string(axis) + (way > 0 ? ", ahead" : ", back");
      if (!gradient.kink) {
        expect_near(way * gradient.position[axis].value, trial.slope(d, step), what);
        continue;
      }
      const Derivative along = trial.along(d);
      EXPECT_EQ(along.status == DerivativeStatus::kNone, gradient.kink->reason == KinkReason::kOnFace) << what;
      if (along.status == DerivativeStatus::kNone) continue;
      expect_near(along.value, trial.slope(d, step), what);
      ++met.slopes;
    }
  }
}

TEST(Gradient, IsTheSlopeOfTheValuesInEveryFamily) {
  Met met;
  for (const RandomFamily& family : random_families()) {
    for (std::uint64_t i = 0; i < scaled_count(10); ++i) {
      Random random(seed_of(i));
      const PlainScene plain = around_the_receiver(family.make(random));
      const std::optional<double> step = step_for(plain);
      if (!step) continue;
      std::optional<Trial> trial;
      try {
        trial.emplace(plain);
      } catch (const InputError&) {
        continue;  // the move to the origin made a face cross itself
      }
      SCOPED_TRACE(std::string(family.name) + " " + std::to_string(i) + '\n' + generate::to_obj(plain));
      expect_true_slopes(*trial, *step, met);
      if (HasFailure()) return;
    }
  }
  EXPECT_GT(met.smooth, 30U);
  EXPECT_GT(met.kinks, 30U);
  EXPECT_GT(met.slopes, 100U);
}

TEST(Gradient, BothEnginesAgreeInEveryFamily) {
  for (const RandomFamily& family : random_families()) {
    for (std::uint64_t i = 0; i < scaled_count(15); ++i) {
      Random random(seed_of(1000 + i));
      const PlainScene plain = family.make(random);
      SCOPED_TRACE(std::string(family.name) + '\n' + generate::to_obj(plain));
      EXPECT_NO_THROW(static_cast<void>(Trial(plain).with_gradient(Engine::kBoth)));
    }
  }
}

// dF/dx = n . dV/dx would be another way; here V is compared with the value alone.
TEST(Gradient, NormalTimesVIsTheValue) {
  for (std::uint64_t i = 0; i < scaled_count(100); ++i) {
    Random random(seed_of(2000 + i));
    const PlainScene plain = random_scene(random);
    const FormFactor f = Trial(plain).with_gradient();
    const Vec3 n = plain.normal;
    Ball sum(kBits), squared(kBits);
    for (int axis = 0; axis < 3; ++axis) {
      const double c = axis == 0 ? n.x : axis == 1 ? n.y : n.z;
      sum = sum + number(c) * ball_of(f.gradient->normal[static_cast<std::size_t>(axis)].enclosure);
      squared = squared + number(c) * number(c);
    }
    EXPECT_TRUE(EnclosureInside::of(sum / sqrt(squared)).overlaps(f.enclosure)) << generate::to_obj(plain);
  }
}

TEST(Gradient, AxisPermutationsAndSignFlipsChangeNoBit) {
  const std::vector<Symmetry> symmetries = all_symmetries();
  for (std::uint64_t i = 0; i < scaled_count(100); ++i) {
    Random random(seed_of(3000 + i));
    const PlainScene plain = random_scene(random);
    const Symmetry& symmetry = symmetries[1 + random.below(47)];
    const Gradient a = *Trial(plain).with_gradient().gradient,
                   b = *Trial(turned(plain, symmetry)).with_gradient().gradient;
    ASSERT_EQ(a.kink.has_value(), b.kink.has_value()) << generate::to_obj(plain);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto old = static_cast<std::size_t>(symmetry.axis[k]);
      EXPECT_TRUE(same(b.position[k], a.position[old], symmetry.sign[k])) << k << '\n' << generate::to_obj(plain);
      EXPECT_TRUE(same(b.normal[k], a.normal[old], symmetry.sign[k])) << k << '\n' << generate::to_obj(plain);
    }
  }
}

TEST(Gradient, ScalesByPowersOfTwoAsOneOverLength) {
  for (std::uint64_t i = 0; i < scaled_count(60); ++i) {
    Random random(seed_of(4000 + i));
    const PlainScene plain = random_scene(random);
    PlainScene large = plain;
    const int exponent = random.integer(-60, 60);
    generate::scale(large, std::ldexp(1.0, exponent));
    const Gradient a = *Trial(plain).with_gradient().gradient, b = *Trial(large).with_gradient().gradient;
    ASSERT_EQ(a.kink.has_value(), b.kink.has_value());
    for (std::size_t k = 0; k < 3; ++k) EXPECT_TRUE(same(a.position[k], b.position[k], std::ldexp(1.0, exponent)));
  }
}

TEST(Gradient, OrderAndTriangulationOfOccludersChangeNoBit) {
  for (std::uint64_t i = 0; i < scaled_count(60); ++i) {
    Random random(seed_of(5000 + i));
    const PlainScene plain = random_scene(random);
    const PlainScene other = retriangulated(shuffled(plain, random), random);
    const Gradient a = *Trial(plain).with_gradient().gradient, b = *Trial(other).with_gradient().gradient;
    ASSERT_EQ(a.kink.has_value(), b.kink.has_value()) << generate::to_obj(plain) << generate::to_obj(other);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_TRUE(same(a.position[k], b.position[k], 1.0)) << generate::to_obj(plain) << generate::to_obj(other);
    }
  }
}

// --- Cases ---

struct Quad {
  const char* name;
  std::vector<Vec3> corners;
};

Scene scene_of(const std::vector<Quad>& quads) {
  SceneBuilder builder;
  const MaterialId material = builder.add_material({});
  for (const Quad& quad : quads) {
    std::vector<std::uint32_t> ring;
    for (const Vec3& corner : quad.corners) ring.push_back(builder.add_vertex(corner));
    builder.add_face(builder.patch(quad.name), material, {ring});
  }
  return builder.build();
}

FormFactor factor(const Scene& scene, const Vec3& x, ExactOptions options = {.engine = Engine::kBoth, .gradient = true},
                  const char* on = nullptr) {
  const ExactSource source(scene, scene.select("light"));
  Receiver receiver{x, {0, 0, 1}, {}, ""};
  if (on != nullptr) receiver.on = own_faces_named(scene, on);
  return exact_form_factor(scene, receiver, source, options);
}

double slope_along(const Scene& scene, const Vec3& x, const Vec3& d) {
  return factor(scene, x, {.engine = Engine::kBoth, .along = d}).gradient->along->value;
}

const Quad kLight{"light", {{-1, 1, 2}, {1, 1, 2}, {1, -1, 2}, {-1, -1, 2}}};

// In 20 digits, by mpmath with 50 digits and by central differences with steps of 1e-15.
TEST(Gradient, OfATriangleBeforeAQuadrilateral) {
  const Scene scene = scene_of({{"light", {{-1, 1, 3}, {1.2, 1, 3}, {1, -1, 3}, {-1, -1, 3}}},
                                {"triangle", {{-.2, -.1, 1.5}, {.3, 0, 1.2}, {0, .4, 1.7}}}});
  const Gradient gradient = *factor(scene, {.1, .2, 0}).gradient;
  ASSERT_FALSE(gradient.kink);
  const std::array expected = {0.0077151812691301294592, -0.012064163961779630695, 0.05004974966825400213};
  for (std::size_t axis = 0; axis < 3; ++axis) {  // the decimals of the reference are meant exactly, these are doubles
    EXPECT_NEAR(gradient.position[axis].value, expected[axis], 1e-17);
    EXPECT_EQ(gradient.position[axis].status, DerivativeStatus::kCertified);
  }
}

TEST(Gradient, IsProvedZeroWhereEqualTermsCancel) {
  const Gradient gradient = *factor(scene_of({kLight}), {0, 0, 0}).gradient;
  ASSERT_FALSE(gradient.kink);
  EXPECT_EQ(gradient.position[0].status, DerivativeStatus::kZero);
  EXPECT_EQ(gradient.position[1].status, DerivativeStatus::kZero);
  EXPECT_EQ(gradient.position[2].status, DerivativeStatus::kCertified);
  EXPECT_EQ(gradient.normal[0].status, DerivativeStatus::kZero);
}

// A sheet that x sees edge-on bounds nothing, yet F falls on both sides.
TEST(Gradient, ASheetInsideTheViewSeenEdgeOnIsAKink) {
  const Scene scene = scene_of({kLight, {"sheet", {{0, -.5, .5}, {0, .5, .5}, {0, .5, 1.5}, {0, -.5, 1.5}}}});
  const FormFactor f = factor(scene, {0, 0, 0});
  ASSERT_TRUE(f.gradient->kink);
  EXPECT_EQ(f.gradient->kink->reason, KinkReason::kEdgeOn);
  EXPECT_EQ(f.gradient->kink->faces, scene.patches()[1].faces);
  for (const Derivative& d : f.gradient->position) EXPECT_TRUE(std::isnan(d.value));
  EXPECT_EQ(f.gradient->normal[2].status, DerivativeStatus::kCertified);
  EXPECT_EQ(slope_along(scene, {}, {1, 0, 0}), slope_along(scene, {}, {-1, 0, 0}));
  EXPECT_LT(slope_along(scene, {}, {1, 0, 0}), 0.0);
  EXPECT_EQ(slope_along(scene, {}, {0, 1, 0}), 0.0);
}

// Two shadows that abut at different depths: a proved zero with a slope on one side.
TEST(Gradient, AbuttingShadowsAreAKinkAlthoughFIsZero) {
  const Scene scene = scene_of({kLight,
                                {"left", {{-2, -2, .5}, {0, -2, .5}, {0, 2, .5}, {-2, 2, .5}}},
                                {"right", {{0, -2, 1}, {2, -2, 1}, {2, 2, 1}, {0, 2, 1}}}});
  const FormFactor f = factor(scene, {0, 0, 0});
  EXPECT_EQ(f.status, Status::kZero);
  ASSERT_TRUE(f.gradient->kink);
  EXPECT_EQ(f.gradient->kink->reason, KinkReason::kCoincident);
  const double left = slope_along(scene, {}, {-1, 0, 0}), right = slope_along(scene, {}, {1, 0, 0});
  EXPECT_EQ(std::min(left, right), 0.0);
  EXPECT_GT(std::max(left, right), 0.01);
}

// A step: two faces and the riser between them, seen edge-on. Together they cover whatever x does.
TEST(Gradient, AStepSeenEdgeOnIsNoKink) {
  const std::vector<Quad> step = {kLight,
                                  {"left", {{-2, -2, .5}, {0, -2, .5}, {0, 2, .5}, {-2, 2, .5}}},
                                  {"riser", {{0, -2, .5}, {0, 2, .5}, {0, 2, 1}, {0, -2, 1}}},
                                  {"right", {{0, -2, 1}, {1, -2, 1}, {1, 2, 1}, {0, 2, 1}}}};
  EXPECT_FALSE(factor(scene_of(step), {0, 0, 0}).gradient->kink);
}

// A shadow that ends where the source begins bounds nothing and is a kink.
TEST(Gradient, AShadowBesideTheSourceIsAKink) {
  const Scene scene = scene_of({kLight, {"beside", {{.5, -1, 1}, {2, -1, 1}, {2, 1, 1}, {.5, 1, 1}}}});
  ASSERT_TRUE(factor(scene, {0, 0, 0}).gradient->kink);
  EXPECT_EQ(factor(scene, {0, 0, 0}).value, factor(scene_of({kLight}), {0, 0, 0}).value);
}

// A floor of several faces: the neighbours of the receiver's own face lie along the horizon, where w . n = 0.
TEST(Gradient, NeighboursInTheReceiversPlaneAreNoKinks) {
  std::vector<Quad> quads = {{"light", {{-1, 3, -2}, {1, 3, -2}, {1, 3, 2}, {-1, 3, 2}}}};
  quads.push_back({"own", {{-2, -2, 0}, {2, -2, 0}, {2, 1, 0}, {-2, 1, 0}}});
  quads.push_back({"next", {{-2, 1, 0}, {2, 1, 0}, {2, 2, 0}, {-2, 2, 0}}});
  const Scene scene = scene_of(quads);
  const FormFactor f = factor(scene, {.5, 0, 0}, {.engine = Engine::kBoth, .gradient = true}, "own");
  EXPECT_GT(f.value, 0.0);
  EXPECT_FALSE(f.gradient->kink);
}

TEST(Gradient, OnAFaceThatIsNotItsOwnThereIsNone) {
  const Scene scene = scene_of({kLight, {"floor", {{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}}}});
  const FormFactor f = factor(scene, {0, 0, 0});
  ASSERT_TRUE(f.gradient->kink);
  EXPECT_EQ(f.gradient->kink->reason, KinkReason::kOnFace);
  EXPECT_EQ(factor(scene, {0, 0, 0}, {.along = Vec3{0, 0, 1}}).gradient->along->status, DerivativeStatus::kNone);
  EXPECT_FALSE(factor(scene, {0, 0, 0}, {.gradient = true}, "floor").gradient->kink);
}

TEST(Gradient, ASourceSeenEdgeOnIsAKinkUnlessItLiesOnTheHorizon) {
  const Quad wall{"light", {{0, 1, 1}, {0, 1, 2}, {0, 2, 2}, {0, 2, 1}}};  // in the plane x = 0
  const FormFactor f = factor(scene_of({wall}), {0, 0, 0});
  EXPECT_EQ(f.status, Status::kZero);
  ASSERT_TRUE(f.gradient->kink);
  EXPECT_EQ(f.gradient->kink->reason, KinkReason::kSourceEdgeOn);
  const double ahead = slope_along(scene_of({wall}), {}, {1, 0, 0}),
               back = slope_along(scene_of({wall}), {}, {-1, 0, 0});
  EXPECT_EQ(std::min(ahead, back), 0.0);
  EXPECT_GT(std::max(ahead, back), 0.01);
  const Quad floor{"light", {{1, 1, 0}, {2, 1, 0}, {2, 2, 0}, {1, 2, 0}}};
  EXPECT_FALSE(factor(scene_of({floor}), {0, 0, 0}).gradient->kink);
}

TEST(Gradient, AddsOverSources) {
  const Quad left{"left", {{-1, 1, 2}, {0, 1, 2}, {0, -1, 2}, {-1, -1, 2}}};
  const Quad right{"right", {{0, 1, 2}, {1, 1, 2}, {1, -1, 2}, {0, -1, 2}}};
  const Quad post{"post", {{-.3, -.3, 1}, {.4, -.2, 1}, {.1, .5, 1.2}}};
  const Receiver receiver{{.1, .2, 0}, {0, .1, 1}, {}, ""};
  const auto gradient_of = [&](const Scene& scene, const char* name) {
    const ExactSource source(scene, scene.select(name));
    return *exact_form_factor(scene, receiver, source, {.gradient = true}).gradient;
  };
  const Scene parts = scene_of({left, right, post});
  const Gradient a = gradient_of(parts, "left"), b = gradient_of(parts, "right");
  const Gradient whole = gradient_of(scene_of({kLight, post}), "light");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Enclosure sum = a.position[axis].enclosure;
    sum += b.position[axis].enclosure;
    EXPECT_TRUE(sum.overlaps(whole.position[axis].enclosure));
  }
}

TEST(Gradient, TheDirectionOfAMovementMustNotBeZero) {
  EXPECT_THROW(static_cast<void>(factor(scene_of({kLight}), {}, {.along = Vec3{}})), InputError);
}

TEST(Gradient, ArcsAddUpToTheGradient) {
  const Scene scene = scene_of({kLight, {"post", {{-.3, -.3, 1}, {.4, -.2, 1}, {.1, .5, 1.2}}}});
  const Gradient gradient = *factor(scene, {.1, .2, 0}, {.list_arcs = true}).gradient;
  EXPECT_EQ(gradient.arcs.size(), 7U);
  Vec3 sum;
  for (const GradientArc& arc : gradient.arcs) sum = {sum.x + arc.part.x, sum.y + arc.part.y, sum.z + arc.part.z};
  EXPECT_NEAR(sum.x, gradient.position[0].value, 1e-15);
  EXPECT_NEAR(sum.y, gradient.position[1].value, 1e-15);
  EXPECT_NEAR(sum.z, gradient.position[2].value, 1e-15);
}

}  // namespace
}  // namespace exactff::validation
