#include "support/random_scenes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>

#include "generate/families.h"
#include "generate/vectors.h"
#include "support/transform.h"

namespace exactff::validation {

using generate::PlainPatch;
using generate::PlainScene;
using generate::Random;
using generate::operator+;
using generate::operator-;
using generate::operator*;

namespace {

using Corners = std::vector<Vec3>;

// Draws the parts of one scene. All coordinates are small multiples of 1/16, so that sums and halves are exact.
class Degenerate {
 public:
  explicit Degenerate(Random& random) : random_(random) {}

  PlainScene make() {
    if (random_.one_in(5)) scene_.point = point();
    if (random_.one_in(3)) scene_.normal = direction();
    add_source();
    const int occluders = random_.integer(1, 7);
    for (int i = 0; i < occluders; ++i) add_occluder(i);
    if (random_.one_in(10)) scene_.point = any_corner();
    return std::move(scene_);
  }

 private:
  double half(int low, int high) { return random_.integer(low, high) / 2.0; }

  Vec3 point() {
    const double x = half(-3, 3);
    const double y = half(-3, 3);
    return {x, y, half(-1, 4)};
  }

  Vec3 direction() {
    const double x = random_.integer(-2, 2);
    const double y = random_.integer(-2, 2);
    const double z = random_.integer(-1, 2);
    return x == 0 && y == 0 && z == 0 ? Vec3{0, 0, 1} : Vec3{x, y, z};
  }

  Vec3 any_corner() { return scene_.vertices[random_.below(scene_.vertices.size())]; }
  Vec3 corner() { return random_.one_in(3) ? any_corner() : point(); }

  Corners triangle() {
    const Vec3 a = corner();
    const Vec3 b = corner();
    return {a, b, corner()};
  }

  Corners parallelogram() {
    const Vec3 a = corner();
    const Vec3 b = corner();
    const Vec3 c = corner();
    return {a, b, b + (c - a), c};
  }

  // A square facing -z; corners clockwise seen from above.
  static Corners square(double x, double y, double z, double side) {
    return {{x, y + side, z}, {x + side, y + side, z}, {x + side, y, z}, {x, y, z}};
  }

  Corners random_square(double z) {
    const double x = half(-3, 1);
    const double y = half(-3, 1);
    return square(x, y, z, half(1, 4));
  }

  static Corners l_shape(double z) { return {{-1, 1, z}, {0, 1, z}, {0, 0, z}, {1, 0, z}, {1, -1, z}, {-1, -1, z}}; }

  void add_source() {
    PlainPatch& source = scene_.patch("source");
    switch (random_.below(10)) {
      case 0:
        return scene_.add_ring(source, l_shape(2));
      case 1:
        return scene_.add_rings(source, {square(-1, -1, 2, 2), square(-0.5, -0.5, 2, 0.5 * random_.integer(1, 2))});
      case 2:  // two faces in one plane that may overlap
        scene_.add_ring(source, random_square(2));
        return scene_.add_ring(source, random_square(2));
      case 3:  // a roof: two planes, each face may hide the other
        scene_.add_ring(source, {{-1, 1, 2}, {0, 1, 1.5}, {0, -1, 1.5}, {-1, -1, 2}});
        return scene_.add_ring(source, {{0, 1, 1.5}, {1, 1, 2}, {1, -1, 2}, {0, -1, 1.5}});
      case 4:
        for (const double x : {-1.0, 0.0}) {
          for (const double y : {-1.0, 0.0}) scene_.add_ring(source, square(x, y, 2, 1));
        }
        return;
      case 5:
        return scene_.add_ring(source, {{-1, 1, 2}, {1, 1, 2.5}, {1, -1, 2}, {-1, -1, 2}});  // not planar
      case 6:
        seed_corners();
        return add_until_some_area(source);
      default:
        return scene_.add_ring(source, square(-1, -1, 2, 2));
    }
  }

  // Gives corner() corners to repeat.
  void seed_corners() { scene_.vertices.push_back(point()); }

  void add_until_some_area(PlainPatch& source) {
    scene_.add_ring(source, random_.one_in(2) ? triangle() : parallelogram());
  }

  // Halfway between the receiver and the source: the shadow of its corner is a corner of the source.
  Corners covering() {
    const PlainPatch& source = scene_.patch("source");
    Corners out;
    for (const std::uint32_t index : source.faces[random_.below(source.faces.size())].rings.front()) {
      out.push_back(0.5 * (scene_.point + scene_.vertices[index]));
    }
    return out;
  }

  // Two existing corners and a new one: the face shares an edge, or lies in an existing plane.
  Corners neighbour() {
    const std::size_t i = random_.below(scene_.vertices.size());
    const std::size_t j = i + 1 < scene_.vertices.size() ? i + 1 : 0;
    const Vec3 a = scene_.vertices[i];
    const Vec3 b = scene_.vertices[j];
    return {a, b, random_.one_in(2) ? 0.5 * (a + corner()) : corner()};
  }

  // A parallelogram through the receiver, or one whose plane contains it.
  Corners edge_on() {
    const Vec3 a = random_.one_in(2) ? scene_.point : scene_.point + direction();
    const Vec3 b = scene_.point + direction();
    const Vec3 c = 2 * scene_.point - a;
    return {a, b, random_.one_in(2) ? c : b + direction()};
  }

  Corners repeated() {
    const PlainPatch& patch = scene_.patches[random_.below(scene_.patches.size())];
    Corners out;
    for (const std::uint32_t index : patch.faces.front().rings.front()) out.push_back(scene_.vertices[index]);
    if (random_.one_in(2)) std::ranges::reverse(out);
    return out;
  }

  Corners one_face() {
    switch (random_.below(11)) {
      case 0:
      case 1:
        return triangle();
      case 2:
        return parallelogram();
      case 3:
        return covering();
      case 4:
        return neighbour();
      case 5:
        return edge_on();
      case 6:
        return repeated();
      case 7:
        return random_square(2);  // in the plane of most sources
      case 8:
        return l_shape(half(1, 5));
      default:
        return random_square(half(1, 5));
    }
  }

  void add_tiles(PlainPatch& patch) {
    const double z = 1;
    for (const double x : {-0.5, 0.0}) {
      for (const double y : {-0.5, 0.0}) {
        if (!random_.one_in(6)) scene_.add_ring(patch, square(scene_.point.x + x, scene_.point.y + y, z, 0.5));
      }
    }
  }

  // A closed tetrahedron.
  void add_solid(PlainPatch& patch) {
    const Vec3 a = corner();
    const Vec3 b = corner();
    const Vec3 c = corner();
    const Vec3 d = corner();
    for (const Corners& face : {Corners{a, b, c}, Corners{a, c, d}, Corners{a, d, b}, Corners{b, d, c}}) {
      scene_.add_ring(patch, face);
    }
  }

  void add_occluder(int number) {
    PlainPatch patch{std::string("o").append(std::to_string(number)), {}, {}};
    switch (random_.below(10)) {
      case 0:
        add_tiles(patch);
        break;
      case 1:
        add_solid(patch);
        break;
      case 2: {
        const double z = half(1, 4);
        scene_.add_rings(patch, {square(-0.75, -0.75, z, 1.5), square(-0.5, -0.5, z, half(1, 2))});
        break;
      }
      default:
        scene_.add_ring(patch, one_face());
    }
    if (!patch.faces.empty()) scene_.patches.push_back(std::move(patch));
  }

  Random& random_;
  PlainScene scene_;
};

}  // namespace

PlainScene degenerate_scene(Random& random) { return Degenerate(random).make(); }

PlainScene generic_scene(Random& random) {
  const auto anywhere = [&](double z) {
    const double x = random.between(-1.2, 1.2);
    return Vec3{x, random.between(-1.2, 1.2), z + random.between(-0.4, 0.4)};
  };
  PlainScene scene;
  const double bottom = random.between(-0.2, 0.2);
  scene.point = anywhere(bottom);
  scene.normal = anywhere(1.0);
  Corners source{anywhere(2), anywhere(2), anywhere(2)};
  const Vec3 u = source[1] - source[0];
  const Vec3 v = source[2] - source[0];
  if (u.x * v.y - u.y * v.x > 0) std::swap(source[1], source[2]);  // most receivers see it from below
  scene.add_ring(scene.patch("source"), source);
  const int occluders = random.integer(0, 8);
  for (int i = 0; i < occluders; ++i) {
    Corners face{anywhere(1), anywhere(1), anywhere(1)};
    if (random.one_in(3)) {  // an edge beside an existing one, at a distance of 1 ulp or 0
      const std::size_t k = 3 * random.below(scene.vertices.size() / 3);
      face[0] = scene.vertices[k];
      face[1] = scene.vertices[k + 1];
      if (random.one_in(2)) face[0].x = std::nextafter(face[0].x, std::numeric_limits<double>::infinity());
    }
    scene.add_ring(scene.patch(std::string("o").append(std::to_string(i))), face);
  }
  return scene;
}

PlainScene random_scene(Random& random) { return random.one_in(3) ? generic_scene(random) : degenerate_scene(random); }

namespace {

// Draws until the scene can be built: the change may have made a face cross itself.
PlainScene changed_scene(Random& random, PlainScene (*change)(const PlainScene&, Random&)) {
  for (;;) {
    PlainScene scene = change(degenerate_scene(random), random);
    try {
      (void)generate::build(scene);
      return scene;
    } catch (const InputError&) {
    }
  }
}

}  // namespace

PlainScene nudged_scene(Random& random) { return changed_scene(random, &nudged); }

PlainScene sheared_scene(Random& random) {
  return changed_scene(random, [](const PlainScene& scene, Random& r) { return sheared(retriangulated(scene, r), r); });
}

PlainScene crowded_scene(Random& random) {
  PlainScene scene = generate::lattice({.n = random.integer(20, 60), .seed = random.bits(), .cover = 2.0});
  scene.point = {random.integer(-2, 2) / 4.0, 0, random.integer(-1, 0) / 8.0};
  return scene;
}

PlainScene triangles_scene(Random& random) {
  const auto at = [&](double z) { return Vec3{random.integer(-4, 4) / 4.0, random.integer(-4, 4) / 4.0, z}; };
  PlainScene scene;
  scene.normal = {random.integer(-1, 1) / 2.0, random.integer(-1, 1) / 2.0, 1};
  scene.add_ring(scene.patch("source"), {{-1, 1, 1}, {1, 1, 1}, at(1)});
  scene.vertices.back().y = random.one_in(2) ? -1 : 0.5;
  const int occluders = random.integer(1, 8);
  for (int i = 0; i < occluders; ++i) {
    Corners corners;
    for (int k = 0; k < 3; ++k) corners.push_back(at(random.integer(-1, 6) / 8.0));
    scene.add_ring(scene.patch(std::string("o").append(std::to_string(i))), corners);
  }
  return scene;
}

PlainScene scene_of_all_magnitudes(Random& random) {
  const PlainScene scene = triangles_scene(random);
  return slid_along_rays(scene, random.one_in(2) ? 1000 : 60, random);
}

std::span<const RandomFamily> random_families() {
  static const std::vector<RandomFamily> kAll = [] {
    std::vector<RandomFamily> all = {{"Degenerate", 250, &degenerate_scene},
                                     {"Generic", 60, &generic_scene},
                                     {"Nudged", 150, &nudged_scene},
                                     {"Sheared", 100, &sheared_scene},
                                     {"Crowded", 20, &crowded_scene},
                                     {"Triangles", 100, &triangles_scene},
                                     {"Magnitudes", 60, &scene_of_all_magnitudes}};
    const std::span<const RandomFamily> on_rays = families_on_rays();
    all.insert(all.end(), on_rays.begin(), on_rays.end());
    all.push_back({"Sheets", 60, &sheets_scene});
    return all;
  }();
  return kAll;
}

std::uint64_t scaled_count(std::uint64_t count) {
  const char* text = std::getenv("EXACTFF_TEST_SCALE");
  const double factor = text == nullptr ? 1.0 : std::strtod(text, nullptr);
  return std::max<std::uint64_t>(1, static_cast<std::uint64_t>(static_cast<double>(count) * factor));
}

std::uint64_t seed_of(std::uint64_t index) {
  const char* text = std::getenv("EXACTFF_TEST_SEED");
  const std::uint64_t base = text == nullptr ? 1 : std::strtoull(text, nullptr, 10);
  return Random(base * 0x10001u + index).bits();
}

}  // namespace exactff::validation
