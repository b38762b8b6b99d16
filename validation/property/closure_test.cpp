// In a closed room, all form factors from an inner point add up to exactly one, whatever objects the room contains. The
// sum of the balls of all patches contains 1, and it is as narrow as the requested precision.
#include "property/closed_rooms.h"
#include "support/decimal.h"
#include "support/solve.h"
#include "support/test.h"
#include "support/transform.h"

namespace exactff::validation {
namespace {

using generate::PlainPatch;

Enclosure sum_over_patches(const Scene& scene, const PlainScene& plain, int digits) {
  ExactOptions options;
  options.engine = Engine::kBoth;
  options.digits = digits;
  Enclosure sum;
  for (const Patch& patch : scene.patches()) {
    const ExactSource source(scene, scene.select(patch.name));
    sum += exact_form_factor(scene, generate::receiver_of(plain), source, options).enclosure;
  }
  return sum;
}

mpq_class power_of_ten(int exponent) {
  mpz_class power;
  mpz_ui_pow_ui(power.get_mpz_t(), 10, static_cast<unsigned long>(exponent));
  return mpq_class(1, power);
}

// D certified digits of a summand leave a relative error below 10^(1-D), and the summands add up to 1. Without digits,
// each ball determines one double.
void expect_one(const PlainScene& plain) {
  const Scene scene = generate::build(plain);
  for (const int digits : {0, 30, 150}) {
    const Enclosure sum = sum_over_patches(scene, plain, digits);
    ASSERT_TRUE(sum.contains(1.0)) << sum.midpoint() << " +/- " << sum.radius() << '\n' << generate::to_obj(plain);
    const mpq_class bound = digits == 0 ? mpq_class(0x1p-52) : power_of_ten(digits - 1);
    ASSERT_LE(read_decimal(sum.radius()).value, bound) << digits << " digits\n" << generate::to_obj(plain);
  }
}

// --- Buildings ---

void map(PlainScene& scene, const std::function<Vec3(const Vec3&)>& change) {
  for (Vec3& vertex : scene.vertices) vertex = change(vertex);
  scene.point = change(scene.point);
}

// Exact for any coordinates: each axis is scaled by a different power of two.
void grow_axes(PlainScene& scene, Random& random) {
  const auto power = [&] { return std::ldexp(1.0, random.integer(0, 400)); };
  const double x = power();
  const double y = power();
  const double z = power();
  map(scene, [&](const Vec3& v) { return Vec3{v.x * x, v.y * y, v.z * z}; });
}

// Exact for multiples of 1/8. Afterwards most coordinates have full mantissas, and no face is parallel to an axis.
void skew(PlainScene& scene, Random& random) {
  const auto whole = [&] { return std::floor(random.between(1, 0x1p43)); };
  const std::array<double, 6> m{whole(), whole(), whole(), whole(), whole(), whole()};
  map(scene, [&](const Vec3& v) {
    return Vec3{m[0] * v.x + m[1] * v.y + m[2] * v.z, m[3] * v.y + m[4] * v.z, m[5] * v.z};
  });
  const auto symmetries = all_symmetries();
  scene = turned(scene, symmetries[random.below(symmetries.size())]);
}

PlainScene framed(ClosedRoom room, Random& random) {
  const std::size_t choice = random.below(4);
  if (choice == 0) grow_axes(room.scene, random);
  if (!room.receiver_is_eighths || choice == 0) return room.scene;
  if (choice == 1) skew(room.scene, random);
  // Rounding makes every quadrilateral non-planar, so it is cut into triangles.
  return choice >= 2 && !room.holes ? sheared(room.scene, random) : room.scene;
}

// Draws until the scene can be built: rounding or its fourth corner may make a sheet cross itself.
ClosedRoom framed_building(Random& random) {
  for (;;) {
    ClosedRoom room = random_building(random);
    room.scene = framed(room, random);
    try {
      (void)generate::build(room.scene);
      return room;
    } catch (const InputError&) {
    }
  }
}

// Cubes, L and U shapes, pillars, windows in a face with a hole; boxes, tetrahedra and two-sided sheets that touch,
// overlap and stand at the walls; receivers in planes of faces and as near to walls as doubles allow.
TEST(Closure, Buildings) {
  for (std::uint64_t i = 0; i < scaled_count(60); ++i) {
    Random random(seed_of(i));
    SCOPED_TRACE(seed_of(i));
    ASSERT_NO_FATAL_FAILURE(expect_one(framed_building(random).scene));
  }
}

TEST(Closure, ConvexRoomsOfRandomCorners) {
  for (std::uint64_t i = 0; i < scaled_count(25); ++i) {
    Random random(seed_of(i));
    SCOPED_TRACE(seed_of(i));
    ASSERT_NO_FATAL_FAILURE(expect_one(random_hull_room(random)));
  }
}

// Checks that the random buildings above include every intended kind.
TEST(Closure, TheBuildingsAreOfAllKinds) {
  int holes = 0;
  int things = 0;
  int bent = 0;
  int beside = 0;
  constexpr int kCount = 200;
  for (std::uint64_t i = 0; i < kCount; ++i) {
    Random random(seed_of(i));
    const ClosedRoom room = framed_building(random);
    const Scene scene = generate::build(room.scene);
    holes += room.holes ? 1 : 0;
    beside += room.receiver_is_eighths ? 0 : 1;
    things += std::ranges::any_of(scene.patches(), [](const Patch& p) { return p.name == "things"; }) ? 1 : 0;
    bent += std::ranges::any_of(scene.faces(), [](const Face& f) { return f.shape == FaceShape::kTriangulated; });
    ASSERT_EQ(room.holes ? 0u : scene.open_edge_count(), 0u) << seed_of(i);
  }
  for (const int kind : {holes, things, bent, beside}) EXPECT_GT(kind, kCount / 20);
}

// --- One room, by hand ---

PlainScene cube_room(Random& random) {
  PlainScene scene;
  add_room(scene, box({-1, -1, -1}, {1, 1, 1}));
  const double x = random.integer(-3, 3) / 4.0;
  const double y = random.integer(-3, 3) / 4.0;
  scene.point = {x, y, random.between(-0.99, 0.99)};
  scene.normal = {random.between(-1, 1), random.integer(-1, 1) * 1.0, random.integer(0, 1) + 0.25};
  return scene;
}

// A receiver on a wall: its own wall gives 0, and the five others add up to 1.
TEST(Closure, ReceiverOnAWall) {
  Random random(seed_of(0));
  PlainScene scene = cube_room(random);
  scene.point = {0.25, -0.375, -1};
  scene.normal = {0, 0, 3};
  expect_one(scene);
}

// In the corner of a large room, down to the smallest distance that is not 0.
TEST(Closure, ReceiverInACorner) {
  for (const double distance : {1e-15, 1e-300, 0x1p-1074}) {
    PlainScene scene;
    add_room(scene, box({0, 0, 0}, {1000, 1000, 1000}));
    scene.point = {distance, distance, distance};
    for (const Vec3& normal : {Vec3{1, 1, 1}, Vec3{-1, 0, 0}, Vec3{0, 1, -1}}) {
      scene.normal = normal;
      ASSERT_NO_FATAL_FAILURE(expect_one(scene)) << distance;
    }
  }
}

// The same room as one patch of six faces: F is a single ball, and it rounds to exactly 1.
TEST(Closure, AWholeRoomAsOneSourceIsOne) {
  for (std::uint64_t i = 0; i < scaled_count(10); ++i) {
    Random random(seed_of(i));
    PlainScene scene = cube_room(random);
    scene.source = "room";
    PlainPatch whole{"room", {}, {}};
    for (const PlainPatch& patch : scene.patches) whole.faces.push_back(patch.faces.front());
    scene.patches = {whole};
    const FormFactor result = solve(scene);
    EXPECT_EQ(result.value, 1.0) << "seed " << seed_of(i);
    EXPECT_EQ(result.upper, 1.0);
    EXPECT_EQ(result.status, Status::kCertified);
  }
}

}  // namespace
}  // namespace exactff::validation
