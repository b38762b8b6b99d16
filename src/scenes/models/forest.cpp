// Triangles in clusters, like the leaves of trees: ellipsoids of leaves above trunks, between the ground and the sky.
// Metres; z up. The sky is as large as the ground; or, with a sun, both reach to the horizon.
//
// 1. The ground is divided into a square grid. Each tree stands in a cell, off its middle, and its crown is about as
//    wide as the cell.
// 2. Leaves are distributed to the trees in turn. A leaf is an equilateral triangle of any orientation about a point
//    chosen uniformly in the crown. The area of the leaves follows from their number and the requested leaf area.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <tuple>
#include <utility>

#include "kernel/vec.h"
#include "models/random.h"
#include "models/registry.h"
#include "models/rooms.h"

namespace exactff::models {

namespace {

using kernel::difference;
using kernel::length;
using kernel::scaled;
using kernel::sum;

constexpr double kSide = 40.0;  // side of ground and sky
constexpr double kSkyHeight = 16.0;
constexpr double kLongestLeaf = 1.0;  // from the centre of a leaf to a corner
constexpr int kMostLeaves = 10'000'000;

// With a sun. From the middle of the ground, its middle is seen in the direction (-2, -1, 2) / 3.
constexpr double kPlainSide = 8192.0;
constexpr double kHighSky = 1024.0;
constexpr Vec3 kSun{-896.0, -448.0, 896.0};
constexpr double kSunDistance = 1344.0;
constexpr double kSunSize = 0.0093;        // its diameter / its distance: half a degree
constexpr Rgb kSunlight{3.0, 2.75, 2.25};  // the irradiance of the ground from the whole sun

struct Tree {
  Vec3 middle;  // centre of the crown
  double across = 0.0;
  double upward = 0.0;  // half axes of the crown
  double trunk = 0.0;   // half its width
};

std::vector<Tree> plant(Random& random, int count) {
  std::vector<Tree> trees;
  for_each_cell(random, count, kSide, 0.3, [&](double x, double y, double cell) {
    Tree tree;
    tree.middle = {x - kSide / 2, y - kSide / 2, random.between(6.0, 8.0)};
    tree.across = std::min(6.0, cell * random.between(0.3, 0.45));
    tree.upward = random.between(2.5, 4.5);
    tree.trunk = std::min(0.3, 0.05 * cell) * random.between(0.5, 1.0);
    trees.push_back(tree);
  });
  return trees;
}

// A uniformly distributed point in the unit ball.
Vec3 in_ball(Random& random) {
  for (;;) {
    const double x = random.between(-1, 1);
    const double y = random.between(-1, 1);
    const double z = random.between(-1, 1);
    if (x * x + y * y + z * z <= 1.0) return {x, y, z};
  }
}

// Two random perpendicular unit vectors.
std::array<Vec3, 2> frame(Random& random) {
  for (;;) {
    const Vec3 a = in_ball(random);
    const Vec3 c = kernel::cross(a, in_ball(random));
    if (length(a) < 0.1 || length(c) < 0.1) continue;  // too short to have a direction
    return {scaled(a, 1.0 / length(a)), scaled(c, 1.0 / length(c))};
  }
}

std::vector<Vec3> leaf(Random& random, const Tree& tree, double radius) {
  const Vec3 place = in_ball(random);
  const Vec3 middle = sum(tree.middle, {tree.across * place.x, tree.across * place.y, tree.upward * place.z});
  const auto [u, v] = frame(random);
  const Vec3 side = scaled(v, radius * std::sqrt(0.75));
  const Vec3 low = kernel::along(middle, u, -0.5 * radius);
  return {kernel::along(middle, u, radius), sum(low, side), difference(low, side)};
}

// A level square. Its front faces up.
Quad level_square(double x, double y, double half, double z) {
  return {{{x - half, y - half, z}, {x + half, y - half, z}, {x + half, y + half, z}, {x - half, y + half, z}}};
}

// The sides of a prism; fronts outward if the base is seen counter-clockwise from above.
void add_sides(PlainScene& scene, std::string_view name, const Quad& base, double top) {
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 &a = base[i], &b = base[(i + 1) % 4];
    scene.add_ring(scene.patch(name), {a, b, {b.x, b.y, top}, {a.x, a.y, top}});
  }
}

// The sides of a prism that extends from the ground up into the crown.
void add_trunk(PlainScene& scene, const Tree& tree) {
  const auto& [x, y, top] = tree.middle;
  add_sides(scene, "trunks", level_square(x, y, tree.trunk, 0.0), top);
}

// The distance from the centre of a leaf to its corners for which n leaves have `cover` times the area of the ground.
double leaf_radius(int n, double cover) {
  const double area = cover * kSide * kSide / n;
  return std::min(kLongestLeaf, std::sqrt(area / (3 * std::sqrt(0.1875))));
}

Quad turned(const Quad& q) { return {{q[0], q[3], q[2], q[1]}}; }

void add_flat_sky(PlainScene& scene) {
  scene.materials.push_back({"sky", {0, 0, 0}, {1, 1, 1}});
  add_quad(scene, "sky", turned(level_square(0.0, 0.0, kSide / 2, kSkyHeight)));
}

// Twelve corners, at equal angles as seen from the middle of the ground, in a level plane, so that they are exactly
// planar: along (2, 1) the polygon is 3/2 as long as across.
std::vector<Vec3> sun(double radius) {
  const double h = std::sqrt(0.75);
  const double step = radius / std::sqrt(5.0);
  std::vector<Vec3> corners;
  std::array<std::array<double, 2>, 3> quarter{{{1.0, 0.0}, {h, -0.5}, {0.5, -h}}};
  for (int turn = 0; turn < 4; ++turn) {
    for (auto& [along, across] : quarter) {
      corners.push_back({kSun.x + step * (3.0 * along - across), kSun.y + step * (1.5 * along + 2.0 * across), kSun.z});
      std::tie(along, across) = std::pair(across, -along);  // clockwise, so that the front faces down
    }
  }
  return corners;
}

// A box of sky on a plain around the ground, and the sun in it.
void add_sun_and_sky(PlainScene& scene) {
  constexpr double kPi = std::numbers::pi;
  constexpr double kFactor = kSunSize * kSunSize / (2 * kPi);  // of the ground to the sun
  const Quad plain = level_square(0.0, 0.0, kPlainSide / 2, 0.0);
  scene.materials.push_back({"sky", {0, 0, 0}, {0.5, 0.65, 0.9}});
  scene.materials.push_back({"sun", {0, 0, 0}, {kSunlight.r / kFactor, kSunlight.g / kFactor, kSunlight.b / kFactor}});
  add_quad(scene, "sky", turned(level_square(0.0, 0.0, kPlainSide / 2, kHighSky)));
  add_sides(scene, "sky", turned(plain), kHighSky);
  add_patch(scene, "plain", "soil");
  add_frame(scene, "plain", plain, level_square(0.0, 0.0, kSide / 2, 0.0));
  add_patch(scene, "sun", "sun");
  scene.add_ring(scene.patch("sun"), sun(kSunDistance * kSunSize / 2));
}

PlainScene make_forest(const Settings& settings) {
  const int n = static_cast<int>(settings.whole("n"));
  Random random(static_cast<std::uint64_t>(settings.whole("seed")));
  const std::vector<Tree> trees = plant(random, static_cast<int>(settings.whole("trees")));
  const double radius = leaf_radius(n, settings.number("cover"));
  PlainScene scene;
  scene.materials = {{"soil", {0.3, 0.25, 0.2}, {}}, {"bark", {0.25, 0.2, 0.15}, {}}, {"leaf", {0.2, 0.45, 0.1}, {}}};
  scene.patches = {{"ground", "soil", {}}, {"trunks", "bark", {}}, {"leaves", "leaf", {}}, {"sky", "sky", {}}};
  add_quad(scene, "ground", level_square(0.0, 0.0, kSide / 2, 0.0));
  for (const Tree& tree : trees) add_trunk(scene, tree);
  PlainPatch& leaves = scene.patch("leaves");
  for (int i = 0; i < n; ++i) {
    scene.add_ring(leaves, leaf(random, trees[static_cast<std::size_t>(i) % trees.size()], radius));
  }
  const bool has_sun = settings.word("light") == "sun";
  has_sun ? add_sun_and_sky(scene) : add_flat_sky(scene);
  scene.source = has_sun ? "sun" : "sky";
  return scene;
}

}  // namespace

Recipe forest_model() {
  return {{.name = "forest",
           .summary = "trees with n triangular leaves between the ground and the sky, 40 x 40 m (ground, trunks, "
                      "leaves, sky; with "
                      "a sun also plain, sun)",
           .settings =
               {whole_setting("n", 10'000, 1, kMostLeaves, "leaves"), whole_setting("trees", 25, 1, 10'000, "trees"),
                number_setting(
                    "cover", 2.0, 1e-3, 100.0,
                    "total area of the leaves / area of the ground; less if leaves would be longer than about a metre"),
                word_setting("light", {"sky", "sun"},
                             "sky: as large as the ground; sun: half a degree wide, far away, and a sky all around"),
                seed_setting()}},
          &make_forest};
}

}  // namespace exactff::models
