#include "studies/honest_families.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "generate/plain_scene.h"
#include "models/random.h"

namespace exactff::experiments {

namespace {

using generate::PlainScene;
using models::Random;

// 10 to a power, uniform between two.
double power(Random& random, double low, double high) { return std::pow(10.0, low + (high - low) * random.unit()); }

// Looking up from below, down from above.
void add_square(PlainScene& scene, const char* name, double x, double y, double size, double z, bool up) {
  std::vector<Vec3> ring{{x, y, z}, {x + size, y, z}, {x + size, y + size, z}, {x, y + size, z}};
  if (!up) std::swap(ring[1], ring[3]);
  scene.add_ring(scene.patch(name), ring);
}

void add_plates(PlainScene& scene, double gap) {
  add_square(scene, "floor", 0.0, 0.0, 1.0, 0.0, true);
  add_square(scene, "source", 0.0, 0.0, 1.0, gap, false);
}

// All of the plates but for a corner.
void add_cut_cover(PlainScene& scene, Random& random, double z) {
  const double cut = power(random, -3.0, 0.0);
  scene.add_ring(scene.patch("occ"), {{-1, -1, z}, {1, -1, z}, {1, 1.0 - cut, z}, {1.0 - cut, 1, z}, {-1, 1, z}});
}

void add_frame(PlainScene& scene, double low_x, double high_x, double low_y, double high_y, double z) {
  generate::PlainPatch& occ = scene.patch("occ");
  scene.add_ring(occ, {{-1, -1, z}, {low_x, -1, z}, {low_x, 2, z}, {-1, 2, z}});
  scene.add_ring(occ, {{high_x, -1, z}, {2, -1, z}, {2, 2, z}, {high_x, 2, z}});
  scene.add_ring(occ, {{low_x, -1, z}, {high_x, -1, z}, {high_x, low_y, z}, {low_x, low_y, z}});
  scene.add_ring(occ, {{low_x, high_y, z}, {high_x, high_y, z}, {high_x, 2, z}, {low_x, 2, z}});
}

void add_family(PlainScene& scene, std::size_t family, Random& random) {
  switch (family) {
    case 0: {
      const double gap = power(random, -9.0, 0.0);
      add_plates(scene, gap);
      add_cut_cover(scene, random, gap * random.between(0.05, 0.95));
      break;
    }
    case 1: {
      const double gap = power(random, -4.0, 0.0), tilt = std::min(gap, power(random, -9.0, -1.0));
      add_square(scene, "floor", 0.0, 0.0, 1.0, 0.0, true);
      scene.add_ring(scene.patch("source"), {{0, 0, gap}, {0, 1, gap}, {1, 1, gap + tilt}, {1, 0, gap + tilt}});
      if (random.one_in(2)) add_square(scene, "occ", 0.3, 0.2, 0.5, 0.4 * gap, false);
      break;
    }
    case 2:
      add_plates(scene, 1.0);
      add_cut_cover(scene, random, random.between(0.05, 0.95));
      break;
    case 3: {
      const double at = random.between(0.1, 0.9), width = power(random, -6.0, -1.0), gap = power(random, -2.0, 0.0);
      add_plates(scene, gap);
      add_frame(scene, at, at + width, -1.0, 2.0, gap * random.between(0.2, 0.8));
      break;
    }
    case 4: {
      add_family(scene, random.one_in(2) ? 2 : 3, random);
      const Vec3 shift{5e6 + random.unit(), -4e6, random.one_in(2) ? 300.0 : 0.0};
      for (Vec3& v : scene.vertices) v = {v.x + shift.x, v.y + shift.y, v.z + shift.z};
      break;
    }
    case 5: {
      const double small = power(random, -9.0, 0.0), large = power(random, 0.0, 9.0);
      add_square(scene, "floor", 0.0, 0.0, small, 0.0, true);
      add_square(scene, "source", -0.5 * large, -0.5 * large, large, large * power(random, -2.0, 0.0), false);
      if (random.one_in(2)) add_square(scene, "occ", 0.2 * small, -small, 2.0 * small, small, true);
      break;
    }
    case 6:
      add_plates(scene, power(random, -2.0, 0.0));
      add_square(scene, "occ", 0.25, 0.25, 0.5, 0.5 * scene.vertices.back().z, true);
      add_square(scene, "occ", 0.25, 0.25, 0.5, scene.vertices.back().z, false);
      add_square(scene, "source", 0.25, 0.0, 0.5, scene.vertices[4].z, true);
      break;
    default: {
      const double hole = power(random, -4.0, -1.0), x = random.between(0.1, 0.8), y = random.between(0.1, 0.8);
      const double gap = power(random, -2.0, 0.0);
      add_plates(scene, gap);
      add_frame(scene, x, x + hole, y, y + hole, gap * random.between(0.2, 0.8));
    }
  }
}

}  // namespace

Scene hard_scene(std::size_t family, std::uint64_t seed) {
  Random random(seed);
  PlainScene scene;
  add_family(scene, family, random);
  return generate::build(scene);
}

}  // namespace exactff::experiments
