#include "studies/honest_families.h"

#include <algorithm>
#include <cmath>
#include <numbers>
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

// --- Almost closed ---

using Quad = std::vector<Vec3>;

double* coordinate(Vec3& v, int axis) { return axis == 0 ? &v.x : axis == 1 ? &v.y : &v.z; }

// By 1e-15 to 1e-3, up or down.
double slip(Random& random) { return (random.one_in(2) ? 1.0 : -1.0) * power(random, -15.0, -3.0); }

// Six quads with their fronts inside: the floor, the ceiling, and walls at the ends of x and y.
std::vector<Quad> room_of(double a, double b, double c) {
  return {{{0, 0, 0}, {a, 0, 0}, {a, b, 0}, {0, b, 0}}, {{0, 0, c}, {0, b, c}, {a, b, c}, {a, 0, c}},
          {{0, 0, 0}, {0, b, 0}, {0, b, c}, {0, 0, c}}, {{a, 0, 0}, {a, 0, c}, {a, b, c}, {a, b, 0}},
          {{0, 0, 0}, {0, 0, c}, {a, 0, c}, {a, 0, 0}}, {{0, b, 0}, {a, b, 0}, {a, b, c}, {0, b, c}}};
}

int axis_of(std::size_t wall) { return wall < 2 ? 2 : wall < 4 ? 0 : 1; }

void add_almost_closed_room(PlainScene& scene, std::size_t kind, Random& random) {
  const double a = random.between(1.0, 5.0), b = random.between(1.0, 5.0), c = random.between(1.0, 3.0);
  std::vector<Quad> walls = room_of(a, b, c);
  const double most = power(random, -15.0, -3.0);
  const std::size_t source = 1 + random.below(5);
  for (std::size_t w = 0; w < walls.size(); ++w) {
    const int axis = axis_of(w);
    const double off = slip(random);
    const std::size_t first = random.below(4);
    for (std::size_t k = 0; k < 4; ++k) {
      Vec3& v = walls[w][k];
      if (kind == 0) {
        for (int i = 0; i < 3; ++i) *coordinate(v, i) += random.between(-most, most);
      } else if (kind == 1 || (kind == 2 && (k == first || k == (first + 1) % 4))) {
        *coordinate(v, axis) += off;
      } else if (kind == 3) {
        for (int i = 0; i < 3; ++i) {
          if (i != axis) *coordinate(v, i) += *coordinate(v, i) == 0.0 ? -off : off;
        }
      }
    }
    scene.add_ring(scene.patch(w == 0 ? "floor" : w == source ? "source" : "occ"), walls[w]);
  }
  if (kind == 4) {
    for (int count = random.integer(1, 4); count > 0; --count) {
      const Quad& wall = walls[random.below(walls.size())];
      const std::size_t k = random.below(4);
      const Vec3 &p = wall[k], &q = wall[(k + 1) % 4];
      const Vec3 tip{0.5 * (p.x + q.x) + slip(random), 0.5 * (p.y + q.y) + slip(random),
                     0.5 * (p.z + q.z) + slip(random)};
      scene.add_ring(scene.patch("occ"), {p, q, tip});
    }
  }
  if (kind == 0 && random.one_in(2)) {
    const double x = a * random.between(0.2, 0.8);
    scene.add_ring(scene.patch("occ"), {{x, 0, 0}, {x, b * 0.6, 0}, {x, b * 0.6, c}, {x + most, 0, c}});
  }
}

// Rings of facets that rise outwards, with their fronts upwards.
void add_dish(PlainScene& scene, Random& random) {
  const int around = random.integer(5, 15), rings = random.integer(1, 2);
  const double deep = random.between(0.1, 1.0), most = power(random, -15.0, -3.0);
  const auto at = [&](int ring, int k) {
    const double r = static_cast<double>(ring) / rings, angle = 2.0 * std::numbers::pi * k / around;
    const auto off = [&] { return random.between(-most, most); };
    return Vec3{r * std::cos(angle) + off(), r * std::sin(angle) + off(), deep * r * r + off()};
  };
  for (int k = 0; k < around; ++k) {
    scene.add_ring(scene.patch("floor"), {at(0, 0), at(1, k), at(1, k + 1)});
    if (rings < 2) continue;
    scene.add_ring(scene.patch("floor"), {at(1, k), at(2, k), at(2, k + 1)});
    scene.add_ring(scene.patch("floor"), {at(1, k), at(2, k + 1), at(1, k + 1)});
  }
  const double high = deep * random.between(0.5, 2.0);
  add_square(scene, "source", -0.5, -0.5, 1.0, high, false);
}

void add_streets(PlainScene& scene, Random& random) {
  const double most = power(random, -15.0, -3.0);
  const auto add = [&](const char* name, Quad ring) {
    for (Vec3& v : ring) {
      for (int i = 0; i < 3; ++i) *coordinate(v, i) += random.between(-most, most);
    }
    scene.add_ring(scene.patch(name), ring);
  };
  const int street = random.integer(0, 2);
  for (int x = 0; x < 3; ++x) {
    const double low = 3.0 * x - 1.0;
    add(x == street ? "floor" : "occ", {{low, -1, 0}, {low + 1, -1, 0}, {low + 1, 6, 0}, {low, 6, 0}});
  }
  for (int house = 0; house < 4; ++house) {
    const double x = 3.0 * (house % 2), y = 3.0 * (house / 2), high = random.between(0.5, 4.0);
    for (Quad wall : room_of(2.0, 2.0, high)) {
      std::ranges::reverse(wall);
      for (Vec3& v : wall) v = {v.x + x, v.y + y, v.z};
      add(random.one_in(3) ? "source" : "occ", wall);
    }
  }
  add("source", {{-1, -1, 6}, {-1, 6, 6}, {8, 6, 6}, {8, -1, 6}});
}

void add_almost_closed(PlainScene& scene, std::size_t family, Random& random) {
  if (family < 5) return add_almost_closed_room(scene, family, random);
  return family == 5 ? add_dish(scene, random) : add_streets(scene, random);
}

}  // namespace

Scene hard_scene(std::size_t family, std::uint64_t seed) {
  Random random(seed);
  PlainScene scene;
  if (family < kHardFamilies.size()) {
    add_family(scene, family, random);
  } else {
    add_almost_closed(scene, family - kHardFamilies.size(), random);
  }
  return generate::build(scene);
}

}  // namespace exactff::experiments
