#include "bench/scenes.h"

#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <utility>

#include "generate/families.h"
#include "generate/random.h"
#include "scene/edges.h"
#include "scene/shaft_tree.h"

namespace exactff::bench {

namespace {

using generate::FamilyOptions;
using generate::PlainScene;

FamilyOptions options(int n, double cover = 1.0) { return {.n = n, .seed = 1, .cover = cover}; }

// -1, 0 or +1 unit in the last place; zero stays.
double nudged(double value, generate::Random& random) {
  const int step = random.integer(-1, 1);
  return step == 0 || value == 0.0 ? value : std::nextafter(value, step * 1e300);
}

// The lattice is rotated by 1 radian about the axis, and each occluder's corner is then moved by a unit in the last
// place. What coincided in the lattice now almost coincides, and doubles can hardly decide any sign. Heights stay
// unchanged, so that the squares stay planar.
PlainScene near_degenerate(int n) {
  constexpr double kCosine = 0.54030230586813977, kSine = 0.8414709848078965;
  PlainScene scene = generate::lattice(options(n));
  for (Vec3& v : scene.vertices) v = {kCosine * v.x - kSine * v.y, kSine * v.x + kCosine * v.y, v.z};
  generate::Random random(1);
  for (const generate::PlainFace& face : scene.patch("occ").faces) {
    for (const std::uint32_t corner : face.rings.front()) {
      Vec3& v = scene.vertices[corner];
      v.x = nudged(v.x, random);
      v.y = nudged(v.y, random);
    }
  }
  return scene;
}

// About n of the abutting squares that cover the source. Every third square is left out, and no two of those are
// adjacent. Corners and edges coincide everywhere.
PlainScene tiles(int n) {
  int side = static_cast<int>(std::lround(std::sqrt(1.5 * n)));
  if (side % 3 == 0) ++side;
  return generate::tiles({.n = side, .seed = 1, .cover = 1.0, .drop = 3});
}

struct Kind {
  const char* name;
  PlainScene (*make)(int n);
};

// Depth: the average number of occluders on a ray to the source.
constexpr std::array<Kind, 8> kKinds{{
    {"sparse", [](int n) { return generate::soup(options(n, 0.75)); }},  // depth 0.8
    {"blinds", [](int n) { return generate::blinds(options(n)); }},
    {"mesh", [](int n) { return generate::mesh(options(n)); }},
    {"dense", [](int n) { return generate::soup(options(n, 4.0)); }},
    {"deep", [](int n) { return generate::soup(options(n, 50.0)); }},
    {"tiles", tiles},
    {"lattice", [](int n) { return generate::lattice(options(n)); }},
    {"near", near_degenerate},
}};
constexpr std::array<int, 5> kSizes{100, 1000, 10'000, 100'000, 1'000'000};

const BenchScene& scene_of(const Kind& kind, int n) {
  static std::map<std::pair<const char*, int>, std::unique_ptr<BenchScene>> made;
  std::unique_ptr<BenchScene>& scene = made[{kind.name, n}];
  if (!scene) scene = std::make_unique<BenchScene>(kind.make(n));
  return *scene;
}

template <class Register>
void for_every_scene(const std::string& subject, const Register& add) {
  for (const Kind& kind : kKinds) {
    for (const int n : kSizes) add(subject + '/' + kind.name + '/' + std::to_string(n), kind, n);
  }
}

}  // namespace

BenchScene::BenchScene(const PlainScene& plain)
    : scene(build(plain)), source(scene, scene.select(plain.source)), receiver(receiver_of(plain)) {
  (void)shaft_tree(scene);
  (void)edges_per_silhouette(scene);  // and the edges, where they will be used
}

double BenchScene::visible_fraction() const {
  if (!visible_fraction_) {
    visible_fraction_ = exact_form_factor(scene, receiver, source, {.visible_fraction = true}).visible_fraction;
  }
  return *visible_fraction_;
}

void add_for_every_scene(const std::string& subject, const Body& body) {
  for_every_scene(subject, [&](const std::string& name, const Kind& kind, int n) {
    benchmark::RegisterBenchmark(name.c_str(), [body, &kind, n](benchmark::State& state) {
      body(state, scene_of(kind, n));
    })->Unit(benchmark::kMicrosecond);
  });
}

void add_maker_for_every_scene(const std::string& subject, const MakerBody& body) {
  for_every_scene(subject, [&](const std::string& name, const Kind& kind, int n) {
    benchmark::RegisterBenchmark(
        name.c_str(), [body, &kind, n](benchmark::State& state) { body(state, [&kind, n] { return kind.make(n); }); })
        ->Unit(benchmark::kMicrosecond)
        ->Iterations(1);
  });
}

}  // namespace exactff::bench
