#include "models/families.h"

#include <array>
#include <cmath>
#include <map>

#include "models/random.h"
#include "models/registry.h"

namespace exactff::models {
namespace {

PlainScene with_square_source() {
  PlainScene scene;
  scene.add_ring(scene.patch("source"), {{-1, 1, 1}, {1, 1, 1}, {1, -1, 1}, {-1, -1, 1}});
  scene.patches.push_back({"occ", {}, {}});
  return scene;
}

// Half the side of the square about each triangle, as seen at distance 1, for which n triangles have the requested
// cover: a random triangle in a square has 11/144 of its area on average, and the source's shadow area is 4.
double reach(const FamilyOptions& options) { return std::sqrt(options.cover * (144.0 / 11.0) / options.n); }

Vec3 near_by(Random& random, const Vec3& centre, double half_side) {
  const auto off = [&] { return random.between(-half_side, half_side); };
  const double dx = off();
  const double dy = off();
  return {centre.x + dx, centre.y + dy, centre.z + off()};
}

}  // namespace

PlainScene karkanis(const FamilyOptions& options) {
  Random random(options.seed);
  PlainScene scene = with_square_source();
  for (int i = 0; i < options.n; ++i) {
    const double z = random.between(0.2, 0.8);
    const double x = z * random.between(-1, 1);
    const Vec3 centre{x, z * random.between(-1, 1), z};
    std::vector<Vec3> corners;
    for (int k = 0; k < 3; ++k) corners.push_back(near_by(random, centre, z * reach(options)));
    for (Vec3& corner : corners) corner.z = z;
    scene.add_ring(scene.patch("occ"), corners);
  }
  return scene;
}

PlainScene soup(const FamilyOptions& options) {
  Random random(options.seed);
  PlainScene scene = with_square_source();
  scene.normal = {random.between(-0.3, 0.3), random.between(-0.3, 0.3), 1.0};
  for (int i = 0; i < options.n; ++i) {
    const double z = random.between(0.05, 1.1);
    const double x = z * random.between(-1, 1);
    const Vec3 centre{x, z * random.between(-1, 1), z};
    std::vector<Vec3> corners;
    for (int k = 0; k < 3; ++k) corners.push_back(near_by(random, centre, z * reach(options)));
    scene.add_ring(scene.patch("occ"), corners);
  }
  return scene;
}

PlainScene blinds(const FamilyOptions& options) {
  PlainScene scene = with_square_source();
  const double pitch = 1.0 / options.n;  // the pyramid is 1 wide at z = 1/2
  for (int i = 0; i < options.n; ++i) {
    const double low = -0.5 + pitch * i;
    const double high = low + pitch / 2;
    const double back = 0.5 + pitch / 4;  // the slat is as deep as half its height
    scene.add_ring(scene.patch("occ"), {{-0.75, low, 0.5}, {0.75, low, 0.5}, {0.75, high, back}, {-0.75, high, back}});
  }
  return scene;
}

PlainScene tiles(const FamilyOptions& options) {
  PlainScene scene = with_square_source();
  const int n = options.n;
  const std::uint32_t first = static_cast<std::uint32_t>(scene.vertices.size());
  const auto at = [n](int k) { return static_cast<double>(2 * k - n) / (2 * n); };
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) scene.vertices.push_back({at(i), at(j), 0.5});
  }
  const auto index = [&](int i, int j) { return first + static_cast<std::uint32_t>(j * (n + 1) + i); };
  for (int k = 0; k < n * n; ++k) {
    if (options.drop > 0 && k % options.drop == 0) continue;
    const int i = k % n;
    const int j = k / n;
    scene.patch("occ").faces.push_back({{{index(i, j), index(i + 1, j), index(i + 1, j + 1), index(i, j + 1)}}});
  }
  return scene;
}

namespace {

Vec3 on_sphere(const std::array<int, 3>& direction) {
  const double x = direction[0];
  const double y = direction[1];
  const double z = direction[2];
  const double length = std::sqrt(x * x + y * y + z * z);
  return {0.125 + 0.375 * x / length, 0.0625 + 0.375 * y / length, 0.5 + 0.375 * z / length};
}

// The lattice points of the octahedron's surface |x| + |y| + |z| = steps, projected onto the sphere. Faces share them.
class Sphere {
 public:
  Sphere(PlainScene& scene, int steps) : scene_(scene), steps_(steps) {}

  // The face of the octahedron in the octant with the three signs, divided into steps^2 triangles.
  void add_octant(int sx, int sy, int sz) {
    for (int i = 0; i < steps_; ++i) {
      for (int j = 0; i + j < steps_; ++j) {
        add_triangle(sx, sy, sz, {{{i, j}, {i + 1, j}, {i, j + 1}}});
        if (i + j + 1 < steps_) add_triangle(sx, sy, sz, {{{i + 1, j}, {i + 1, j + 1}, {i, j + 1}}});
      }
    }
  }

 private:
  std::uint32_t vertex(const std::array<int, 3>& key) {
    const auto [entry, is_new] = indices_.try_emplace(key, static_cast<std::uint32_t>(scene_.vertices.size()));
    if (is_new) scene_.vertices.push_back(on_sphere(key));
    return entry->second;
  }

  void add_triangle(int sx, int sy, int sz, const std::array<std::array<int, 2>, 3>& corners) {
    Ring ring;
    for (const auto& [i, j] : corners) ring.push_back(vertex({sx * i, sy * j, sz * (steps_ - i - j)}));
    if (sx * sy * sz < 0) std::swap(ring[1], ring[2]);
    scene_.patch("occ").faces.push_back({{ring}});
  }

  PlainScene& scene_;
  int steps_;
  std::map<std::array<int, 3>, std::uint32_t> indices_;
};

}  // namespace

PlainScene mesh(const FamilyOptions& options) {
  PlainScene scene = with_square_source();
  int steps = 1;
  while (8 * steps * steps < options.n) ++steps;
  Sphere sphere(scene, steps);
  for (int octant = 0; octant < 8; ++octant) {
    sphere.add_octant(octant & 1 ? -1 : 1, octant & 2 ? -1 : 1, octant & 4 ? -1 : 1);
  }
  return scene;
}

namespace {

// Generates faces whose corners are multiples of 1/64, about as large as `cover` requires.
class LatticeFaces {
 public:
  LatticeFaces(PlainScene& scene, const FamilyOptions& options)
      : scene_(scene), reach_(reach(options)), random_(options.seed) {}

  std::vector<Vec3> next() {
    const std::size_t kind = random_.below(10);
    if (kind < 3) return square();
    if (kind < 6 || scene_.vertices.size() < 7) return triangle();
    return kind < 9 ? neighbour() : repetition();
  }

 private:
  static double rounded(double value) { return std::floor(value * 64.0 + 0.5) / 64.0; }

  // Sometimes in the plane of the source or beyond it, or level with the receiver or behind it.
  Vec3 centre() {
    const double z = random_.integer(-2, 18) / 16.0;
    const double x = rounded(std::abs(z) * random_.between(-1, 1));
    return {x, rounded(std::abs(z) * random_.between(-1, 1)), z};
  }

  double half_side(const Vec3& c) const { return std::max(2.0 / 64.0, c.z * reach_); }

  Vec3 beside(const Vec3& c) {
    const double x = rounded(c.x + random_.between(-1, 1) * half_side(c));
    const double y = rounded(c.y + random_.between(-1, 1) * half_side(c));
    return {x, y, random_.one_in(2) ? c.z : rounded(c.z + random_.between(-1, 1) * half_side(c))};
  }

  std::vector<Vec3> triangle() {
    const Vec3 c = centre();
    return {c, beside(c), beside(c)};
  }

  std::vector<Vec3> square() {
    const Vec3 c = centre();
    const double side = std::max(1.0 / 64.0, rounded(half_side(c)));
    return {c, {c.x + side, c.y, c.z}, {c.x + side, c.y + side, c.z}, {c.x, c.y + side, c.z}};
  }

  // Shares the first edge of an existing face.
  std::vector<Vec3> neighbour() {
    const Vec3 a = first_corner_of_some_face();
    return {a, scene_.vertices[chosen_ + 1], beside(a)};
  }

  std::vector<Vec3> repetition() {
    const Vec3 a = first_corner_of_some_face();
    return {a, scene_.vertices[chosen_ + 1], scene_.vertices[chosen_ + 2]};
  }

  Vec3 first_corner_of_some_face() {
    const auto& faces = scene_.patch("occ").faces;
    chosen_ = faces[random_.below(faces.size())].rings.front().front();
    return scene_.vertices[chosen_];
  }

  PlainScene& scene_;
  double reach_;
  Random random_;
  std::size_t chosen_ = 0;
};

}  // namespace

PlainScene lattice(const FamilyOptions& options) {
  PlainScene scene = with_square_source();
  LatticeFaces faces(scene, options);
  for (int i = 0; i < options.n; ++i) scene.add_ring(scene.patch("occ"), faces.next());
  return scene;
}

// --- Family models ---

// The families (families.h) as models. Each gets materials, so that the source emits, and a square `floor` around the
// receiver, facing the source, for receivers other than the origin.

namespace {

constexpr int kMostFaces = 10'000'000;
constexpr int kMostTilesASide = 3000;

FamilyOptions options_of(const Settings& settings) {
  FamilyOptions options;
  options.n = static_cast<int>(settings.whole("n"));
  if (settings.has("seed")) options.seed = static_cast<std::uint64_t>(settings.whole("seed"));
  if (settings.has("cover")) options.cover = settings.number("cover");
  if (settings.has("drop")) options.drop = static_cast<int>(settings.whole("drop"));
  return options;
}

void complete(PlainScene& scene, double side) {
  const double h = side / 2;
  if (side > 0.0) scene.add_ring(scene.patch("floor"), {{-h, -h, 0}, {h, -h, 0}, {h, h, 0}, {-h, h, 0}});
  scene.materials = {{"light", {0, 0, 0}, {1, 1, 1}}, {"grey", {0.5, 0.5, 0.5}, {}}};
  for (PlainPatch& patch : scene.patches) patch.material = patch.name == scene.source ? "light" : "grey";
}

template <PlainScene (*kFamily)(const FamilyOptions&)>
PlainScene make_family(const Settings& settings) {
  PlainScene scene = kFamily(options_of(settings));
  complete(scene, settings.number("floor"));
  return scene;
}

// Turns all of Karkanis' triangles towards the receiver, so that they can be sources: the family leaves their front to
// chance.
void turn_down(PlainScene& scene, PlainPatch& patch) {
  for (PlainFace& face : patch.faces) {
    Ring& ring = face.rings.front();
    const Vec3 &a = scene.vertices[ring[0]], &b = scene.vertices[ring[1]], &c = scene.vertices[ring[2]];
    if ((b.x - a.x) * (c.y - a.y) > (b.y - a.y) * (c.x - a.x)) std::swap(ring[1], ring[2]);
  }
}

PlainScene make_karkanis(const Settings& settings) {
  PlainScene scene = karkanis(options_of(settings));
  turn_down(scene, scene.patch("occ"));
  complete(scene, settings.number("floor"));
  return scene;
}

PlainScene make_room(const Settings& settings) { return room(options_of(settings)); }

SettingSpec cover_setting() {
  return number_setting("cover", 1.0, 1e-6, 1e6, "total area of all shadows / area of the source");
}

SettingSpec floor_setting() {
  return number_setting("floor", 1.0, 0.0, 100.0, "side of the patch `floor` around the receiver; 0: no floor");
}

SettingSpec count_setting(int fallback, int most, std::string meaning) {
  return whole_setting("n", fallback, 1, most, std::move(meaning));
}

}  // namespace

Recipe karkanis_model() {
  return {
      {.name = "karkanis",
       .summary = "n random triangles with the same normal, facing the receiver at the origin, in front of the square "
                  "source (occ, source, floor)",
       .settings = {count_setting(50, kMostFaces, "triangles"), cover_setting(), floor_setting(), seed_setting()}},
      &make_karkanis};
}

Recipe soup_model() {
  return {{.name = "soup",
           .summary = "n random triangles of any orientation between the origin and the square source (occ, source, "
                      "floor)",
           .settings = {count_setting(50, kMostFaces, "triangles"), cover_setting(), floor_setting(), seed_setting()}},
          &make_family<&soup>};
}

Recipe blinds_model() {
  return {{.name = "blinds",
           .summary = "n tilted slats between the origin and the square source (occ, source, floor)",
           .settings = {count_setting(50, kMostFaces, "slats"), floor_setting()}},
          &make_family<&blinds>};
}

Recipe tiles_model() {
  return {
      {.name = "tiles",
       .summary = "n x n abutting squares that hide the square source from the origin (occ, source, floor)",
       .settings = {count_setting(16, kMostTilesASide,
                                  "tiles along a side; with a power of two, the corners are exact"),
                    whole_setting("drop", 0, 0, kMostFaces, "leave out every k-th square; 0: none"), floor_setting()}},
      &make_family<&tiles>};
}

Recipe mesh_model() {
  return {{.name = "mesh",
           .summary = "a closed sphere of about n triangles between the origin and the square source (occ, source, "
                      "floor)",
           .settings = {count_setting(1000, kMostFaces, "triangles"), floor_setting()}},
          &make_family<&mesh>};
}

Recipe lattice_model() {
  return {
      {.name = "lattice",
       .summary = "n faces that touch, overlap and coincide, with corners on multiples of 1/64 (occ, source, floor)",
       .settings = {count_setting(50, kMostFaces, "faces"), cover_setting(), floor_setting(), seed_setting()}},
      &make_family<&lattice>};
}

Recipe room_model() {
  return {{.name = "room",
           .summary = "a room with a window behind a venetian blind of n slats, and a table (floor, ceiling, wall_*, "
                      "window, blind, table_*)",
           .settings = {count_setting(32, kMostFaces, "slats")}},
          &make_room};
}

}  // namespace exactff::models
