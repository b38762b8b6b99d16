// Scenes whose coincidences survive every exact frame.
//
// The receiver is the origin, and corners are k (a, b, 5) with small integers a, b, k. So they lie on few rays from the
// receiver: shadows share corners and edges for any distances k, and planes meet the receiver, the source and each
// other. The source lies at k = 12, so the corners of shadows are thirds, fifths and sevenths of the occluders'
// corners. A frame (random_frames.h) then either moves the scene by an affine map that is exact in doubles, so that all
// coincidences remain and only rationals can decide, or rounds every coordinate, so that every coincidence is missed by
// an ulp.
#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "generate/vectors.h"
#include "kernel/vec.h"
#include "support/random_frames.h"
#include "support/random_scenes.h"

namespace exactff::validation {

using generate::PlainPatch;
using generate::PlainScene;
using generate::Random;
using generate::operator+;
using generate::operator-;
using kernel::cross;

namespace {

using Corners = std::vector<Vec3>;
using Ray = std::array<int, 2>;
using Outline = std::vector<Ray>;
using Shape = std::vector<Outline>;  // the outer ring counter-clockwise, then holes

constexpr int kSource = 12;

Vec3 at(const Ray& ray, int k) { return {1.0 * k * ray[0], 1.0 * k * ray[1], 5.0 * k}; }

// All within [0, 4]^2.
const std::vector<Shape>& plain_shapes() {
  static const std::vector<Shape> shapes{
      {{{0, 0}, {4, 0}, {4, 4}, {0, 4}}},
      {{{0, 1}, {4, 1}, {4, 3}, {0, 3}}},
      {{{0, 0}, {4, 0}, {0, 4}}},
      {{{0, 0}, {4, 1}, {1, 4}}},
      {{{0, 0}, {4, 0}, {4, 2}, {2, 2}, {2, 4}, {0, 4}}},                                                  // an L
      {{{0, 0}, {2, 1}, {4, 0}, {2, 4}}},                                                                  // an arrow
      {{{0, 0}, {4, 0}, {4, 4}, {3, 4}, {3, 1}, {2, 1}, {2, 4}, {1, 4}, {1, 1}, {0, 1}}},                  // a comb
      {{{1, 0}, {3, 0}, {3, 1}, {4, 1}, {4, 3}, {3, 3}, {3, 4}, {1, 4}, {1, 3}, {0, 3}, {0, 1}, {1, 1}}},  // a cross
  };
  return shapes;
}

const std::vector<Shape>& odd_shapes() {
  const Outline square{{0, 0}, {4, 0}, {4, 4}, {0, 4}};
  static const std::vector<Shape> shapes{
      {square, {{1, 1}, {3, 1}, {3, 3}, {1, 3}}},
      {square, {{0, 0}, {2, 1}, {1, 2}}},                                            // the hole touches a corner
      {square, {{2, 0}, {3, 2}, {1, 2}}},                                            // the hole touches a side
      {square, {{1, 1}, {2, 1}, {2, 2}, {1, 2}}, {{2, 2}, {3, 2}, {3, 3}, {2, 3}}},  // two holes that touch
      {square, {{1, 1}, {3, 1}, {3, 3}, {1, 3}}, {{2, 1}, {3, 2}, {2, 3}, {1, 2}}},  // an island that fills its hole
      {{{0, 0}, {4, 0}, {4, 4}, {3, 3}, {3, 1}, {1, 1}, {1, 3}, {3, 3}, {4, 4}, {0, 4}}},  // a keyhole
      {{{2, 2}, {4, 1}, {4, 3}, {2, 2}, {0, 3}, {0, 1}}},                                  // two lobes at one corner
      {{{0, 0}, {4, 0}, {4, 4}, {3, 4}, {2, 0}, {1, 4}, {0, 4}}},                          // a corner on another side
      {{{0, 0}, {4, 0}, {4, 4}, {2, 2}, {4, 4}, {0, 4}}},                                  // a spike
      {{{0, 0}, {2, 0}, {4, 0}, {4, 2}, {4, 2}, {4, 4}, {0, 4}, {0, 3}}},                  // idle and repeated corners
  };
  return shapes;
}

// Draws the parts of one scene.
class Rays {
 public:
  explicit Rays(Random& random) : random_(random) {}

  Random& random() { return random_; }
  PlainScene& scene() { return scene_; }
  PlainPatch& source() { return scene_.patch("source"); }

  int k() { return random_.integer(1, kSource - 1); }
  Ray ray() {
    const int a = random_.integer(-4, 4);
    return {a, random_.integer(-4, 4)};
  }
  // Mostly between the receiver and the source, sometimes behind either, in the source's plane or at the receiver.
  Vec3 corner() {
    if (random_.one_in(12)) return at(ray(), random_.integer(-2, 15));
    return random_.one_in(8) ? any_corner() : at(ray(), k());
  }
  Vec3 any_corner() { return scene_.vertices[random_.below(scene_.vertices.size())]; }

  Shape shape() { return placed(pick(random_.one_in(3) ? odd_shapes() : plain_shapes())); }
  Shape plain_shape() { return placed(pick(plain_shapes())); }

  // Facing the receiver.
  static std::vector<Corners> flat(const Shape& shape, int k) {
    std::vector<Corners> rings;
    for (const Outline& outline : shape) {
      Corners& ring = rings.emplace_back();
      for (const Ray& ray : outline) ring.insert(ring.begin(), at(ray, k));
    }
    return rings;
  }

  void add_source(const Shape& shape) { scene_.add_rings(source(), flat(shape, kSource)); }
  void add_occluder(const std::vector<Corners>& rings) { scene_.add_rings(new_patch(), rings); }
  void add_face(const Corners& ring) { add_occluder({ring}); }
  void add_flat() { add_occluder(flat(shape(), random_.one_in(12) ? random_.integer(kSource, 14) : k())); }
  // The shadows of its corners are on the rays; its plane is not parallel to the source.
  void add_tilted() {
    const Ray a = ray();
    const Ray b = ray();
    add_face({at(a, k()), at(b, k()), at(ray(), k())});
  }
  void add_parallelogram() {
    const Vec3 a = corner();
    const Vec3 b = corner();
    const Vec3 c = corner();
    add_face({a, b, b + (c - a), c});
  }
  void add_any() {
    switch (random_.below(4)) {
      case 0:
        return add_tilted();
      case 1:
        return add_parallelogram();
      default:
        return add_flat();
    }
  }
  void add_some(int most) {
    for (int count = random_.integer(0, most); count > 0; --count) add_any();
  }

  PlainPatch& new_patch() { return scene_.patch("o" + std::to_string(scene_.patches.size())); }

  Vec3 some_direction() {
    const double x = random_.integer(-2, 2);
    const double y = random_.integer(-2, 2);
    return {x, y, 1.0 * random_.integer(1, 2)};
  }

  PlainScene done() {
    if (random_.one_in(4)) scene_.normal = some_direction();
    return std::move(scene_);
  }

 private:
  const Shape& pick(const std::vector<Shape>& shapes) { return shapes[random_.below(shapes.size())]; }

  // Rotated, mirrored and moved; counter-clockwise rings stay counter-clockwise.
  Shape placed(Shape shape) {
    const bool swap = random_.one_in(2);
    const bool mirror = random_.one_in(2);
    const Ray move{random_.integer(-1, 1), random_.integer(-1, 1)};
    for (Outline& outline : shape) {
      for (auto& [a, b] : outline) {
        if (swap) std::swap(a, b);
        a = (mirror ? 2 - a : a - 2) + move[0];
        b += move[1] - 2;
      }
      if (swap != mirror) std::ranges::reverse(outline);
    }
    return shape;
  }

  Random& random_;
  PlainScene scene_;
};

// --- Families ---

PlainScene mixed(Random& random) {
  Rays rays(random);
  rays.add_source(rays.shape());
  rays.add_any();
  rays.add_some(6);
  return rays.done();
}

// Blades with one corner on a common ray: all their shadows meet in a point, and many edges end there.
PlainScene fan(Random& random) {
  Rays rays(random);
  rays.add_source(rays.plain_shape());
  const Ray apex = rays.ray();
  for (int blades = random.integer(3, 8); blades > 0; --blades) {
    const Ray side = rays.ray();
    rays.add_face({at(apex, rays.k()), at(side, rays.k()), at(rays.ray(), rays.k())});
  }
  return rays.done();
}

// Edges that all cross in one point: the ray through the apex halves each of them.
PlainScene concurrent(Random& random) {
  Rays rays(random);
  rays.add_source(rays.shape());
  for (int count = random.integer(3, 7); count > 0; --count) {
    const Ray side = rays.ray();
    const int k = rays.k();
    rays.add_face({at(side, k), at({-side[0], -side[1]}, k), at(rays.ray(), rays.k())});
  }
  return rays.done();
}

// Each bar begins before the last one and ends behind the next.
PlainScene pinwheel(Random& random) {
  Rays rays(random);
  rays.add_source(rays.plain_shape());
  const std::array<Ray, 8> rim{{{-3, -3}, {0, -4}, {3, -3}, {4, 0}, {3, 3}, {0, 4}, {-3, 3}, {-4, 0}}};
  const int near = random.integer(1, 5);
  const int far = random.integer(6, 14);
  const std::size_t step = 2 + random.below(3);
  for (std::size_t i = 0; i < rim.size(); i += random.one_in(5) ? 2 : 1) {
    const Ray& end = rim[(i + step) % rim.size()];
    rays.add_face({at(rim[i], near), at(end, far), at({end[0] / 2, end[1]}, far)});
  }
  return rays.done();
}

// All faces pierce each other.
PlainScene piercing(Random& random) {
  Rays rays(random);
  rays.add_source(rays.plain_shape());
  for (int count = random.integer(2, 5); count > 0; --count) {
    const Ray a = rays.ray();
    rays.add_face({at(a, 2), at(rays.ray(), 10), at({-a[0], -a[1]}, random.integer(8, 13))});
  }
  rays.add_parallelogram();
  return rays.done();
}

Shape square_ring(int outer, int inner) {
  const auto square = [](int s) { return Outline{{-s, -s}, {s, -s}, {s, s}, {-s, s}}; };
  return inner == 0 ? Shape{square(outer)} : Shape{square(outer), square(inner)};
}

// Rings whose holes the next ones fill exactly, at any distances.
PlainScene nested(Random& random) {
  Rays rays(random);
  rays.add_source(random.one_in(2) ? square_ring(4, 0) : rays.shape());
  for (int outer = 4; outer > 0;) {
    const int inner = std::max(0, outer - random.integer(1, 2));
    if (!random.one_in(4)) rays.add_occluder(Rays::flat(square_ring(outer, inner), rays.k()));
    outer = inner;
  }
  return rays.done();
}

// Faces in one plane: abutting, overlapping, repeated, seen from behind, of the source and of others.
PlainScene one_plane(Random& random) {
  Rays rays(random);
  for (int count = random.integer(2, 4); count > 0; --count) {
    std::vector<Corners> rings = Rays::flat(rays.shape(), kSource);
    if (random.one_in(6)) std::ranges::reverse(rings.front());
    rays.scene().add_rings(rays.source(), rings);
    if (random.one_in(3)) rays.scene().add_rings(rays.source(), rings);
  }
  if (random.one_in(2)) rays.add_occluder(Rays::flat(rays.shape(), kSource));
  if (random.one_in(3)) rays.scene().add_rings(rays.source(), Rays::flat(rays.shape(), rays.k()));
  rays.add_some(5);
  return rays.done();
}

// Faces that contain the receiver, whose planes contain it, whose sides point at it, or that cross the source's plane.
PlainScene edge_on(Random& random) {
  Rays rays(random);
  rays.add_source(rays.shape());
  for (int count = random.integer(2, 6); count > 0; --count) {
    const Vec3 a = rays.corner();
    const Vec3 b = rays.corner();
    const Ray ray = rays.ray();
    switch (random.below(6)) {
      case 0:  // the receiver is a corner
        rays.add_face({{0, 0, 0}, a, b});
        break;
      case 1:  // or within the face
        rays.add_face({a, b, Vec3{} - (a + b)});
        break;
      case 2:  // or on a side
        rays.add_face({a, Vec3{} - a, b});
        break;
      case 3:  // or in the plane
        rays.add_face({a, a + b, a + a + b, a + a});
        break;
      case 4:  // a side points at it
        rays.add_face({at(ray, 2), at(ray, random.integer(3, 14)), b});
        break;
      default:
        rays.add_face({a, at(ray, 16), at(rays.ray(), -3)});
    }
  }
  rays.add_some(2);
  return rays.done();
}

// Tiles that cover a rectangle exactly, each at a different distance, some as two triangles that tilt.
PlainScene tiled(Random& random) {
  Rays rays(random);
  rays.add_source(random.one_in(2) ? square_ring(random.integer(2, 4), 0) : rays.shape());
  const int step = random.integer(2, 4);
  for (int a = -4; a < 4; a += step) {
    for (int b = -4; b < 4; b += step) {
      const int right = std::min(4, a + step);
      const int top = std::min(4, b + step);
      if (random.one_in(12)) continue;
      if (random.one_in(2)) {
        rays.add_occluder(Rays::flat({{{a, b}, {right, b}, {right, top}, {a, top}}}, rays.k()));
        continue;
      }
      rays.add_face({at({a, b}, rays.k()), at({right, b}, rays.k()), at({right, top}, rays.k())});
      rays.add_face({at({a, b}, rays.k()), at({right, top}, rays.k()), at({a, top}, rays.k())});
    }
  }
  return rays.done();
}

// Copies of the source's faces nearer to the receiver, whole and in fans: they cover the source exactly.
PlainScene covered(Random& random) {
  Rays rays(random);
  const Shape shape = rays.plain_shape();
  rays.add_source(shape);
  const Outline& outline = shape.front();
  const Ray centre = random.one_in(2) ? outline[random.below(outline.size())] : rays.ray();
  for (std::size_t i = 0; i < outline.size(); ++i) {
    if (random.one_in(10)) continue;
    rays.add_face({at(centre, rays.k()), at(outline[i], rays.k()), at(outline[(i + 1) % outline.size()], rays.k())});
  }
  if (random.one_in(8)) rays.add_occluder(Rays::flat(shape, rays.k()));
  return rays.done();
}

void add_solid(Rays& rays, PlainPatch& patch) {
  Random& random = rays.random();
  const Vec3 a = rays.corner();
  const Vec3 b = rays.corner();
  const Vec3 c = rays.corner();
  const Vec3 d = random.one_in(2) ? at(rays.ray(), kSource) : rays.corner();
  for (const Corners& face : {Corners{a, b, c}, Corners{a, c, d}, Corners{a, d, b}, Corners{b, d, c}}) {
    rays.scene().add_ring(patch, face);
  }
}

// Closed solids, some of which stand on the source with a corner or a face.
PlainScene solids(Random& random) {
  Rays rays(random);
  rays.add_source(rays.shape());
  for (int count = random.integer(1, 3); count > 0; --count) add_solid(rays, rays.new_patch());
  return rays.done();
}

// The source's own faces hide each other, in many planes.
PlainScene self_hiding(Random& random) {
  Rays rays(random);
  rays.add_source(rays.plain_shape());
  add_solid(rays, rays.source());
  if (random.one_in(2)) add_solid(rays, rays.source());
  rays.add_some(2);
  return rays.done();
}

// The horizon passes through corners of the source and of occluders.
PlainScene grazing(Random& random) {
  Rays rays(random);
  rays.add_source(rays.shape());
  rays.add_some(5);
  const Vec3 a = rays.any_corner();
  const Vec3 b = random.one_in(2) ? rays.any_corner() : at(rays.ray(), 1);
  const Vec3 normal = cross(a, b);
  PlainScene scene = rays.done();
  if (!(normal == Vec3{})) scene.normal = normal;
  return scene;
}

// Every face at least twice: unchanged, reversed, cut into a fan, or moved along its rays.
PlainScene repeated(Random& random) {
  Rays rays(random);
  rays.add_source(rays.plain_shape());
  for (int count = random.integer(1, 3); count > 0; --count) {
    const Shape shape = rays.plain_shape();
    for (int copies = random.integer(2, 3); copies > 0; --copies) {
      std::vector<Corners> rings = Rays::flat(shape, random.one_in(2) ? 6 : rays.k());
      if (random.one_in(2)) std::ranges::reverse(rings.front());
      rays.add_occluder(rings);
    }
    const Outline& outline = shape.front();
    if (outline.size() == 4 && random.one_in(2)) {
      rays.add_face({at(outline[0], 6), at(outline[1], 6), at(outline[2], 6)});
    }
  }
  return rays.done();
}

// Non-planar faces: corners of one outline at different distances.
Corners warp(Rays& rays, const Shape& shape, int base) {
  Corners ring;
  for (const Ray& ray : shape.front()) ring.insert(ring.begin(), at(ray, base + rays.random().integer(-1, 1)));
  return ring;
}

PlainScene warped(Random& random) {
  Rays rays(random);
  rays.scene().add_ring(rays.source(), warp(rays, rays.plain_shape(), kSource));
  for (int count = random.integer(1, 4); count > 0; --count) {
    rays.add_face(warp(rays, rays.plain_shape(), random.integer(3, 10)));
  }
  rays.add_some(2);
  return rays.done();
}

// The receiver lies on the face `on`, and more faces lie in the same plane or stand on it.
PlainScene on_a_face(Random& random) {
  Rays rays(random);
  rays.add_source(rays.shape());
  const double x = 5.0 * random.integer(-2, 2);
  const double y = 5.0 * random.integer(-2, 2);
  const auto in_plane = [&](double u, double v) { return Vec3{5 * u, 5 * v, -(x * u + y * v)}; };
  rays.scene().add_ring(rays.scene().patch("on"), {in_plane(-2, -2), in_plane(2, -2), in_plane(2, 3), in_plane(-2, 2)});
  rays.scene().vertices.back().z += random.one_in(2) ? 0 : 1;  // then it is non-planar and is cut
  if (random.one_in(2)) rays.add_face({in_plane(0, 0), in_plane(3, 0), in_plane(0, 3)});
  if (random.one_in(2)) rays.add_face({in_plane(0, 0), in_plane(1, 0), rays.corner()});
  rays.add_some(4);
  PlainScene scene = rays.done();
  scene.normal = {x, y, 5};
  return scene;
}

// Draws until the scene can be built: rounding and warping may have made a face cross itself.
template <PlainScene (*Make)(Random&)>
PlainScene framed(Random& random) {
  for (;;) {
    PlainScene scene = Make(random);
    renumber(scene, random);
    move_to_a_random_frame(scene, random);
    try {
      (void)generate::build(scene);
      return scene;
    } catch (const InputError&) {
    }
  }
}

constexpr std::array<RandomFamily, 16> kFamilies{{{"Mixed", 60, &framed<mixed>},
                                                  {"Fan", 40, &framed<fan>},
                                                  {"Concurrent", 40, &framed<concurrent>},
                                                  {"Pinwheel", 20, &framed<pinwheel>},
                                                  {"Piercing", 40, &framed<piercing>},
                                                  {"Nested", 40, &framed<nested>},
                                                  {"OnePlane", 40, &framed<one_plane>},
                                                  {"EdgeOn", 60, &framed<edge_on>},
                                                  {"Tiled", 25, &framed<tiled>},
                                                  {"Covered", 40, &framed<covered>},
                                                  {"Solids", 40, &framed<solids>},
                                                  {"SelfHiding", 30, &framed<self_hiding>},
                                                  {"Grazing", 40, &framed<grazing>},
                                                  {"Repeated", 40, &framed<repeated>},
                                                  {"Warped", 40, &framed<warped>},
                                                  {"OnAFace", 40, &framed<on_a_face>}}};

}  // namespace

std::span<const RandomFamily> families_on_rays() { return kFamilies; }

}  // namespace exactff::validation
