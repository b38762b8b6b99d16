// The derivatives of the form factor by vertices, against references that share nothing with them: differences of
// values that are certified to many digits, and identities.
//
// The scene is first moved, with roundings, so that one vertex lies at the origin. Steps of 2^-200 of the smallest
// coordinate are then exact (slopes.h).
#include "generate/families.h"
#include "kernel/ball.h"
#include "property/slopes.h"
#include "support/solve.h"
#include "support/test.h"
#include "support/transform.h"

namespace exactff::validation::by_vertices {
namespace {

bool holds_zero(const Ball& ball) { return EnclosureInside::of(ball).contains(0.0); }
double component(const Vec3& v, std::size_t axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

FormFactor solve_vertices(const PlainScene& plain, Engine engine = Engine::kEdges) {
  const Scene scene = generate::build(plain);
  const ExactSource source(scene, scene.select(plain.source));
  return exact_form_factor(scene, generate::receiver_of(plain), source, {.engine = engine, .vertices = true});
}

Ball value_of(const PlainScene& plain) {
  const Scene scene = generate::build(plain);
  const ExactSource source(scene, scene.select(plain.source));
  return ball_of(exact_form_factor(scene, generate::receiver_of(plain), source, {.digits = 120}).enclosure);
}

// --- Differences ---

PlainScene around(PlainScene plain, const Vec3& centre) {
  const auto moved = [&](const Vec3& v) { return Vec3{v.x - centre.x, v.y - centre.y, v.z - centre.z}; };
  for (Vec3& v : plain.vertices) v = moved(v);
  plain.point = moved(plain.point);
  return plain;
}

// The slope if what lies at the origin moves by d.
double slope(const PlainScene& plain, const Vec3& d, double step) {
  const auto value_at = [&](double h) {
    PlainScene moved = plain;
    for (Vec3& v : moved.vertices) {
      if (v == Vec3{}) v = times(d, h);
    }
    return value_of(moved);
  };
  return slope_of(value_at, step);
}

struct Met {
  std::size_t moving = 0, resting = 0, kinks = 0, sharp = 0;
};

constexpr std::array kDirections = {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}, Vec3{1, -2, 3}};

void expect_true_slopes(const PlainScene& plain, double step, Met& met) {
  const Gradient gradient = *solve_vertices(plain).gradient;
  if (gradient.kink) return;
  const auto found =
      std::ranges::find_if(gradient.vertices, [&](const auto& v) { return plain.vertices[v.vertex] == Vec3{}; });
  const bool rests = found == gradient.vertices.end();
  ++(rests ? met.resting : found->is_kink ? met.kinks : met.moving);
  bool sharp = false;
  for (const Vec3& d : kDirections) {
    const double ahead = slope(plain, d, step), back = slope(plain, times(d, -1.0), step);
    if (!rests && found->is_kink) {
      sharp = sharp || std::abs(ahead + back) > 1e-15 * std::abs(ahead) + 1e-30;
      continue;
    }
    Ball sum(kBits);
    for (std::size_t axis = 0; axis < 3 && !rests; ++axis) {
      sum = sum + ball_of(found->position[axis].enclosure) * number(component(d, axis));
    }
    const double expected = middle(sum);
    const std::string what = std::to_string(d.x) + ' ' + std::to_string(d.y) + ' ' + std::to_string(d.z);
    const double limit = 1e-14 * std::abs(expected) + 1e-29;
    EXPECT_LE(std::abs(ahead - expected), limit) << what << ", ahead: " << ahead << ", not " << expected;
    EXPECT_LE(std::abs(back + expected), limit) << what << ", back: " << -back << ", not " << expected;
  }
  met.sharp += sharp ? 1 : 0;
}

// A vertex of a face, if possible one at a kink.
Vec3 a_vertex(const PlainScene& plain, Random& random) {
  const Gradient gradient = *solve_vertices(plain).gradient;
  const auto kink = std::ranges::find_if(gradient.vertices, &VertexDerivative::is_kink);
  if (kink != gradient.vertices.end() && random.one_in(2)) return plain.vertices[kink->vertex];
  const auto& faces = plain.patches[random.below(plain.patches.size())].faces;
  return plain.vertices[faces[random.below(faces.size())].rings[0][random.below(3)]];
}

TEST(VertexGradient, IsTheSlopeOfTheValuesInEveryFamily) {
  Met met;
  for (const RandomFamily& family : random_families()) {
    for (std::uint64_t i = 0; i < scaled_count(8); ++i) {
      Random random(seed_of(i));
      const PlainScene made = family.make(random);
      PlainScene plain;
      std::optional<double> step;
      try {
        const PlainScene triangles = in_triangles(made);
        if (!has_only_area(triangles)) continue;  // what has none may get some as soon as it moves
        plain = around(triangles, a_vertex(triangles, random));
        step = step_for(plain);
        if (!has_only_area(plain)) continue;
      } catch (const InputError&) {
        continue;  // the move made a face cross itself
      }
      if (!step) continue;
      SCOPED_TRACE(std::string(family.name) + " " + std::to_string(i) + '\n' + generate::to_obj(plain));
      expect_true_slopes(plain, *step, met);
      if (HasFailure()) return;
    }
  }
  RecordProperty("moving", static_cast<int>(met.moving));
  RecordProperty("kinks", static_cast<int>(met.kinks));
  RecordProperty("sharp", static_cast<int>(met.sharp));
  EXPECT_GT(met.moving, 20U);
  EXPECT_GT(met.resting, 10U);
  EXPECT_GT(met.kinks, 3U);
  EXPECT_GT(2 * met.sharp, met.kinks);  // most of them are true ones along one of the directions
}

// A square light of two triangles before the receiver, and a triangle through its plane, or with a corner in it.
PlainScene pierced_light(Random& random) {
  const auto eighths = [&](int low, int high) { return random.integer(8 * low, 8 * high) / 8.0; };
  PlainScene plain;
  plain.vertices = {{-1, -1, 2}, {-1, 1, 2}, {1, 1, 2}, {1, -1, 2}};
  plain.patch(plain.source).faces = {{{{0, 1, 2}}}, {{{0, 2, 3}}}};
  const double middle = random.one_in(3) ? 2.0 : eighths(1, 3);
  for (const double z : {eighths(0, 2) + 1.0 / 64, middle, eighths(2, 4) + 1.0 / 64}) {
    plain.vertices.push_back({eighths(-1, 1) + 1.0 / 256, eighths(-1, 1), z});
  }
  plain.patch("occluder").faces = {{{{4, 5, 6}}}};
  plain.point = {eighths(-1, 1) / 8 + 1.0 / 512, eighths(-1, 1) / 8, 0.0};
  plain.normal = {eighths(-1, 1), 0.0, 2.0};
  return plain;
}

// Each triangle of the light moves by itself, although both lie in one plane.
TEST(VertexGradient, IsTheSlopeWhereALightOfTwoTrianglesIsPierced) {
  Met met;
  for (std::uint64_t i = 0; i < scaled_count(40); ++i) {
    Random random(seed_of(7000 + i));
    const PlainScene made = pierced_light(random);
    if (!has_only_area(made)) continue;
    const PlainScene plain = around(made, made.vertices[random.below(made.vertices.size())]);
    const std::optional<double> step = step_for(plain);
    if (!step || !has_only_area(plain)) continue;
    SCOPED_TRACE(std::to_string(i) + '\n' + generate::to_obj(plain));
    expect_true_slopes(plain, *step, met);
    if (HasFailure()) return;
  }
  EXPECT_GT(met.moving, 10U);
}

TEST(VertexGradient, BothEnginesAgreeInEveryFamily) {
  for (const RandomFamily& family : random_families()) {
    for (std::uint64_t i = 0; i < scaled_count(5); ++i) {
      Random random(seed_of(1000 + i));
      const PlainScene plain = family.make(random);
      SCOPED_TRACE(std::string(family.name) + ' ' + std::to_string(i) + '\n' + generate::to_obj(plain));
      EXPECT_NO_THROW(static_cast<void>(solve_vertices(plain, Engine::kBoth)));
      if (HasFailure()) return;
    }
  }
}

// --- Identities ---

using Three = std::array<Ball, 3>;

Three balls(const std::array<Derivative, 3>& d) {
  return {ball_of(d[0].enclosure), ball_of(d[1].enclosure), ball_of(d[2].enclosure)};
}
Three balls(const Vec3& v) { return {number(v.x), number(v.y), number(v.z)}; }
void add(Three& sum, const Three& part) {
  for (std::size_t i = 0; i < 3; ++i) sum[i] = sum[i] + part[i];
}
Three cross(const Three& a, const Three& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Ball dot(const Three& a, const Three& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// Calls visit(plain, gradient) for scenes of all families without kinks of any kind.
template <class Visit>
void for_each_smooth(std::uint64_t count, std::uint64_t first_seed, const Visit& visit) {
  std::size_t smooth = 0, moving = 0;
  for (const RandomFamily& family : random_families()) {
    for (std::uint64_t i = 0; i < scaled_count(count); ++i) {
      Random random(seed_of(first_seed + i));
      const PlainScene plain = family.make(random);
      const Gradient gradient = *solve_vertices(plain).gradient;
      const bool kinks = gradient.kink || std::ranges::any_of(gradient.vertices, &VertexDerivative::is_kink);
      if (kinks) continue;
      ++smooth;
      moving += gradient.vertices.empty() ? 0 : 1;
      SCOPED_TRACE(std::string(family.name) + ' ' + std::to_string(i) + '\n' + generate::to_obj(plain));
      visit(plain, gradient);
      if (testing::Test::HasFailure()) return;
    }
  }
  EXPECT_GT(smooth, 40U);
  EXPECT_GT(moving, 20U);
}

TEST(VertexGradient, AMovementOfAllChangesNothing) {
  for_each_smooth(8, 3000, [](const PlainScene&, const Gradient& gradient) {
    Three sum = balls(gradient.position);
    for (const VertexDerivative& v : gradient.vertices) add(sum, balls(v.position));
    for (const Ball& b : sum) EXPECT_TRUE(holds_zero(b)) << middle(b);
  });
}

TEST(VertexGradient, AScalingOfAllChangesNothing) {
  for_each_smooth(8, 4000, [](const PlainScene& plain, const Gradient& gradient) {
    Ball sum = dot(balls(plain.point), balls(gradient.position));
    for (const VertexDerivative& v : gradient.vertices) {
      sum = sum + dot(balls(plain.vertices[v.vertex]), balls(v.position));
    }
    EXPECT_TRUE(holds_zero(sum)) << middle(sum);
  });
}

TEST(VertexGradient, ARotationOfAllChangesNothing) {
  for_each_smooth(8, 5000, [](const PlainScene& plain, const Gradient& gradient) {
    Three sum = cross(balls(plain.point), balls(gradient.position));
    const Three n = balls(plain.normal);
    Three turned = cross(n, balls(gradient.normal));
    for (Ball& b : turned) b = b / sqrt(dot(n, n));
    add(sum, turned);
    for (const VertexDerivative& v : gradient.vertices) {
      add(sum, cross(balls(plain.vertices[v.vertex]), balls(v.position)));
    }
    for (const Ball& b : sum) EXPECT_TRUE(holds_zero(b)) << middle(b);
  });
}

// A kink may be reported where there is none, and how a concave face is cut, which depends on the axes, may decide
// that.
TEST(VertexGradient, AxisPermutationsAndSignFlipsChangeNoBit) {
  const std::vector<Symmetry> symmetries = all_symmetries();
  std::size_t compared = 0, kinks_of_one = 0;
  for (std::uint64_t i = 0; i < scaled_count(60); ++i) {
    Random random(seed_of(6000 + i));
    const PlainScene plain = random_scene(random);
    const Symmetry& symmetry = symmetries[1 + random.below(47)];
    const Gradient a = *solve_vertices(plain).gradient, b = *solve_vertices(turned(plain, symmetry)).gradient;
    ASSERT_EQ(a.vertices.size(), b.vertices.size()) << generate::to_obj(plain);
    for (std::size_t v = 0; v < a.vertices.size(); ++v) {
      EXPECT_EQ(a.vertices[v].vertex, b.vertices[v].vertex);
      ++compared;
      if (a.vertices[v].is_kink != b.vertices[v].is_kink) {
        ++kinks_of_one;
        continue;
      }
      for (std::size_t k = 0; k < 3; ++k) {
        const auto old = static_cast<std::size_t>(symmetry.axis[k]);
        EXPECT_TRUE(same(b.vertices[v].position[k], a.vertices[v].position[old], symmetry.sign[k]))
            << v << ' ' << k << '\n'
            << generate::to_obj(plain);
      }
    }
  }
  EXPECT_LE(1000 * kinks_of_one, compared);
}

// --- Cases ---

constexpr const char* kSource = "source";

// A square light at height 2 that looks down, seen from below.
PlainScene under_a_light() {
  PlainScene plain;
  plain.add_ring(plain.patch(kSource), {{-1, 1, 2}, {1, 1, 2}, {1, -1, 2}, {-1, -1, 2}});
  plain.point = {.125, .0625, 0};
  return plain;
}

const VertexDerivative* vertex_at(const PlainScene& plain, const Gradient& gradient, const Vec3& place) {
  const auto found = std::ranges::find_if(gradient.vertices,
                                          [&](const VertexDerivative& v) { return plain.vertices[v.vertex] == place; });
  return found == gradient.vertices.end() ? nullptr : &*found;
}

// Faces that are joined to panels lose the corners in the middle of straight sides; these move the border all the same.
TEST(VertexGradient, ACornerBetweenTwoFacesOfAWallMovesItsSides) {
  PlainScene plain = under_a_light();
  generate::PlainPatch& wall = plain.patch("wall");
  plain.add_ring(wall, {{-.5, -.25, 1}, {0, -.25, 1}, {0, .25, 1}, {-.5, .25, 1}});
  plain.add_ring(wall, {{0, -.25, 1}, {.25, -.25, 1}, {.25, .25, 1}, {0, .25, 1}});
  const Gradient gradient = *solve_vertices(plain, Engine::kBoth).gradient;
  EXPECT_EQ(gradient.vertices.size(), 10U);
  const VertexDerivative* middle = vertex_at(plain, gradient, {0, .25, 1});
  ASSERT_NE(middle, nullptr);
  EXPECT_LT(middle->position[1].value, -0.01);
}

// Three faces that abut without sharing all corners: the gap that opens is a kink, the outer corners move as ever.
TEST(VertexGradient, ATJunctionIsAKinkForItsCorners) {
  PlainScene plain = under_a_light();
  plain.add_ring(plain.patch("left"), {{-.25, -.25, 1}, {0, -.25, 1}, {0, .25, 1}, {-.25, .25, 1}});
  plain.add_ring(plain.patch("below"), {{0, -.25, 1}, {.25, -.25, 1}, {.25, .0625, 1}, {0, .0625, 1}});
  plain.add_ring(plain.patch("above"), {{0, .0625, 1}, {.25, .0625, 1}, {.25, .25, 1}, {0, .25, 1}});
  const Gradient gradient = *solve_vertices(plain, Engine::kBoth).gradient;
  ASSERT_FALSE(gradient.kink);
  for (const Vec3& place : {Vec3{0, -.25, 1}, Vec3{0, .0625, 1}, Vec3{0, .25, 1}}) {
    ASSERT_NE(vertex_at(plain, gradient, place), nullptr);
    EXPECT_TRUE(vertex_at(plain, gradient, place)->is_kink);
    EXPECT_TRUE(std::isnan(vertex_at(plain, gradient, place)->position[0].value));
  }
  EXPECT_FALSE(vertex_at(plain, gradient, {-.25, -.25, 1})->is_kink);
  EXPECT_FALSE(vertex_at(plain, gradient, {.25, .0625, 1})->is_kink);
}

// What stands on the source hides what is beside its foot only while it stands.
TEST(VertexGradient, WhatTouchesTheSourceIsAKinkThere) {
  PlainScene plain = under_a_light();
  plain.add_ring(plain.patch("wall"), {{-.5, .25, 2}, {.5, .25, 2}, {.5, .5, 1}, {-.5, .5, 1}});
  const Gradient gradient = *solve_vertices(plain, Engine::kBoth).gradient;
  ASSERT_FALSE(gradient.kink);
  EXPECT_TRUE(vertex_at(plain, gradient, {-.5, .25, 2})->is_kink);
  EXPECT_TRUE(vertex_at(plain, gradient, {.5, .25, 2})->is_kink);
  EXPECT_FALSE(vertex_at(plain, gradient, {.5, .5, 1})->is_kink);
}

TEST(VertexGradient, AFaceOverTheSourceIsAKinkAlthoughItHidesNothing) {
  PlainScene plain = under_a_light();
  plain.add_ring(plain.patch("over"), {{-2, -2, 2}, {2, -2, 2}, {2, 2, 2}, {-2, 2, 2}});
  const Gradient gradient = *solve_vertices(plain, Engine::kBoth).gradient;
  ASSERT_NE(vertex_at(plain, gradient, {2, 2, 2}), nullptr);
  EXPECT_TRUE(vertex_at(plain, gradient, {2, 2, 2})->is_kink);
}

}  // namespace
}  // namespace exactff::validation::by_vertices
