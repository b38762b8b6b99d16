// Triangles in clusters, like the leaves of trees: ellipsoids of leaves above trunks, between the ground and the sky.
// Metres; z up.
//
// 1. The ground is divided into a square grid. Each tree stands in a cell, off its middle, and its crown is about as
//    wide as the cell.
// 2. Leaves are distributed to the trees in turn. A leaf is an equilateral triangle of any orientation about a point
//    chosen uniformly in the crown. The area of the leaves follows from their number and the requested leaf area.
#include <algorithm>
#include <array>
#include <cmath>

#include "kernel/vec.h"
#include "models/model_files.h"
#include "models/random.h"
#include "models/square_grid.h"

namespace exactff::models {

namespace {

constexpr double kSide = 40.0;  // side of ground and sky
constexpr double kSkyHeight = 16.0;
constexpr double kLongestLeaf = 1.0;  // from the centre of a leaf to a corner
constexpr int kMostLeaves = 10'000'000;

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

double length(const Vec3& v) { return std::sqrt(kernel::dot(v, v)); }
Vec3 times(const Vec3& v, double factor) { return {v.x * factor, v.y * factor, v.z * factor}; }
Vec3 plus(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }

// Two random perpendicular unit vectors.
std::array<Vec3, 2> frame(Random& random) {
  for (;;) {
    const Vec3 a = in_ball(random);
    const Vec3 c = kernel::cross(a, in_ball(random));
    if (length(a) < 0.1 || length(c) < 0.1) continue;  // too short to have a direction
    return {times(a, 1.0 / length(a)), times(c, 1.0 / length(c))};
  }
}

std::vector<Vec3> leaf(Random& random, const Tree& tree, double radius) {
  const Vec3 place = in_ball(random);
  const Vec3 middle = plus(tree.middle, {tree.across * place.x, tree.across * place.y, tree.upward * place.z});
  const auto [u, v] = frame(random);
  const Vec3 side = times(v, radius * std::sqrt(0.75));
  const Vec3 low = plus(middle, times(u, -0.5 * radius));
  return {plus(middle, times(u, radius)), plus(low, side), plus(low, times(side, -1.0))};
}

// The sides of a prism that extends from the ground up into the crown.
void add_trunk(PlainScene& scene, const Tree& tree) {
  const auto& [x, y, top] = tree.middle;
  const double t = tree.trunk;
  const std::array<std::array<double, 2>, 4> plan{{{x - t, y - t}, {x + t, y - t}, {x + t, y + t}, {x - t, y + t}}};
  for (std::size_t i = 0; i < 4; ++i) {
    const auto& a = plan[i];
    const auto& b = plan[(i + 1) % 4];
    scene.add_ring(scene.patch("trunks"), {{a[0], a[1], 0}, {b[0], b[1], 0}, {b[0], b[1], top}, {a[0], a[1], top}});
  }
}

// The distance from the centre of a leaf to its corners for which n leaves have `cover` times the area of the ground.
double leaf_radius(int n, double cover) {
  const double area = cover * kSide * kSide / n;
  return std::min(kLongestLeaf, std::sqrt(area / (3 * std::sqrt(0.1875))));
}

PlainScene make_forest(const Settings& settings) {
  constexpr double h = kSide / 2;
  const int n = static_cast<int>(settings.whole("n"));
  Random random(static_cast<std::uint64_t>(settings.whole("seed")));
  const std::vector<Tree> trees = plant(random, static_cast<int>(settings.whole("trees")));
  const double radius = leaf_radius(n, settings.number("cover"));
  PlainScene scene;
  scene.materials = {{"soil", {0.3, 0.25, 0.2}, {}},
                     {"bark", {0.25, 0.2, 0.15}, {}},
                     {"leaf", {0.2, 0.45, 0.1}, {}},
                     {"sky", {0, 0, 0}, {1, 1, 1}}};
  scene.patches = {{"ground", "soil", {}}, {"trunks", "bark", {}}, {"leaves", "leaf", {}}, {"sky", "sky", {}}};
  scene.add_ring(scene.patch("ground"), {{-h, -h, 0}, {h, -h, 0}, {h, h, 0}, {-h, h, 0}});
  for (const Tree& tree : trees) add_trunk(scene, tree);
  PlainPatch& leaves = scene.patch("leaves");
  for (int i = 0; i < n; ++i) {
    scene.add_ring(leaves, leaf(random, trees[static_cast<std::size_t>(i) % trees.size()], radius));
  }
  scene.add_ring(scene.patch("sky"),
                 {{-h, -h, kSkyHeight}, {-h, h, kSkyHeight}, {h, h, kSkyHeight}, {h, -h, kSkyHeight}});
  scene.source = "sky";
  return scene;
}

}  // namespace

Model forest_model() {
  return {.name = "forest",
          .summary =
              "trees with n triangular leaves between the ground and the sky, 40 x 40 m (ground, trunks, leaves, sky)",
          .settings =
              {whole_setting("n", 10'000, 1, kMostLeaves, "leaves"), whole_setting("trees", 25, 1, 10'000, "trees"),
               number_setting(
                   "cover", 2.0, 1e-3, 100.0,
                   "total area of the leaves / area of the ground; less if leaves would be longer than about a metre"),
               seed_setting()},
          .make = &make_forest};
}

}  // namespace exactff::models
