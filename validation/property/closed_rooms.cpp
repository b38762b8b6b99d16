#include "property/closed_rooms.h"

#include <gmpxx.h>

#include "support/test.h"

namespace exactff::validation {

using generate::PlainFace;
using generate::PlainPatch;
using generate::Ring;

namespace {

using Exact = std::array<mpq_class, 3>;

Exact difference(const Vec3& a, const Vec3& b) {
  return {mpq_class(a.x) - b.x, mpq_class(a.y) - b.y, mpq_class(a.z) - b.z};
}

// Positive if d lies on the side of the plane of a, b, c from which they run counter-clockwise.
int side(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Exact u = difference(b, a);
  const Exact v = difference(c, a);
  const Exact w = difference(d, a);
  return sgn(mpq_class(w[0] * (u[1] * v[2] - u[2] * v[1]) + w[1] * (u[2] * v[0] - u[0] * v[2]) +
                       w[2] * (u[0] * v[1] - u[1] * v[0])));
}

int side(const Solid& solid, const PlainFace& face, const Vec3& x) {
  const Ring& ring = face.rings.front();
  return side(solid.corners[ring[0]], solid.corners[ring[1]], solid.corners[ring[2]], x);
}

}  // namespace

Solid box(const Vec3& low, const Vec3& high) {
  return prism({{{low.x, low.y}, {high.x, low.y}, {high.x, high.y}, {low.x, high.y}}}, low.z, high.z);
}

Solid prism(const FloorPlan& plan, double bottom, double top) {
  Solid solid;
  PlainFace floor;
  PlainFace ceiling;
  for (const auto& ring : plan) {
    const auto first = static_cast<std::uint32_t>(solid.corners.size());
    const auto count = static_cast<std::uint32_t>(ring.size());
    Ring& low = floor.rings.emplace_back();
    Ring& high = ceiling.rings.emplace_back();
    for (std::uint32_t i = 0; i < count; ++i) {
      for (const double z : {bottom, top}) solid.corners.push_back({ring[i][0], ring[i][1], z});
      const std::uint32_t here = first + 2 * i;
      const std::uint32_t next = first + 2 * ((i + 1) % count);
      low.insert(low.begin(), here);
      high.push_back(here + 1);
      solid.faces.push_back({{{here, next, next + 1, here + 1}}});
    }
  }
  solid.faces.push_back(floor);
  solid.faces.push_back(ceiling);
  return solid;
}

bool in_general_position(const std::vector<Vec3>& points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      for (std::size_t k = 0; k < j; ++k) {
        for (std::size_t l = 0; l < k; ++l) {
          if (side(points[i], points[j], points[k], points[l]) == 0) return false;
        }
      }
    }
  }
  return true;
}

// A triangle is a face if no point lies in front of it.
Solid hull(const std::vector<Vec3>& points) {
  Solid solid{points, {}};
  const auto n = static_cast<std::uint32_t>(points.size());
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t j = i + 1; j < n; ++j) {
      for (std::uint32_t k = i + 1; k < n; ++k) {
        if (j == k) continue;
        const auto before = [&](const Vec3& p) { return side(points[i], points[j], points[k], p) > 0; };
        if (std::ranges::none_of(points, before)) solid.faces.push_back({{{i, j, k}}});
      }
    }
  }
  return solid;
}

bool strictly_outside(const Solid& convex, const Vec3& x) {
  return std::ranges::any_of(convex.faces, [&](const PlainFace& face) { return side(convex, face, x) > 0; });
}

bool strictly_inside(const Solid& convex, const Vec3& x) {
  return std::ranges::all_of(convex.faces, [&](const PlainFace& face) { return side(convex, face, x) < 0; });
}

namespace {

std::uint32_t add_corners(PlainScene& scene, const std::vector<Vec3>& corners) {
  const auto first = static_cast<std::uint32_t>(scene.vertices.size());
  scene.vertices.insert(scene.vertices.end(), corners.begin(), corners.end());
  return first;
}

PlainFace renumbered(PlainFace face, std::uint32_t first) {
  for (Ring& ring : face.rings) {
    for (std::uint32_t& index : ring) index += first;
  }
  return face;
}

PlainFace turned_round(PlainFace face) {
  for (Ring& ring : face.rings) std::ranges::reverse(ring);
  return face;
}

}  // namespace

void add_room(PlainScene& scene, const Solid& solid) {
  const std::uint32_t first = add_corners(scene, solid.corners);
  for (std::size_t k = 0; k < solid.faces.size(); ++k) {
    PlainPatch& wall = scene.patch("wall" + std::to_string(k));
    wall.faces.push_back(turned_round(renumbered(solid.faces[k], first)));
  }
}

void add_thing(PlainScene& scene, const Solid& solid) {
  const std::uint32_t first = add_corners(scene, solid.corners);
  for (const PlainFace& face : solid.faces) scene.patch("things").faces.push_back(renumbered(face, first));
}

// Both sides share their corners, so a non-planar polygon is cut along the same diagonals on both sides.
void add_sheet(PlainScene& scene, const std::vector<Vec3>& corners) {
  const std::uint32_t first = add_corners(scene, corners);
  PlainFace front{{{}}};
  for (std::uint32_t i = 0; i < corners.size(); ++i) front.rings.front().push_back(first + i);
  scene.patch("things").faces.push_back(front);
  scene.patch("things").faces.push_back(turned_round(front));
}

// --- Buildings ---

namespace {

constexpr double kHeight = 8;

// Boxes that fill a floor plan together; they may overlap.
struct Building {
  FloorPlan plan;
  std::vector<std::array<double, 4>> cells;  // x from, x to, y from, y to
};

const std::vector<Building>& buildings() {
  static const std::vector<Building> all{
      {{{{0, 0}, {8, 0}, {8, 8}, {0, 8}}}, {{0, 8, 0, 8}}},
      {{{{0, 0}, {8, 0}, {8, 4}, {4, 4}, {4, 8}, {0, 8}}}, {{0, 8, 0, 4}, {0, 4, 0, 8}}},  // an L
      {{{{0, 0}, {8, 0}, {8, 8}, {5, 8}, {5, 3}, {3, 3}, {3, 8}, {0, 8}}},                 // a U
       {{0, 8, 0, 3}, {0, 3, 0, 8}, {5, 8, 0, 8}}},
      {{{{0, 0}, {8, 0}, {8, 8}, {0, 8}}, {{3, 3}, {3, 5}, {5, 5}, {5, 3}}},  // a pillar
       {{0, 3, 0, 8}, {5, 8, 0, 8}, {0, 8, 0, 3}, {0, 8, 5, 8}}},
      {{{{0, 0}, {8, 0}, {8, 8}, {0, 8}}, {{0, 0}, {2, 4}, {4, 2}}},  // a pillar that touches a corner's edge
       {{5, 8, 0, 8}, {0, 8, 5, 8}}},
  };
  return all;
}

class BuildingMaker {
 public:
  explicit BuildingMaker(Random& random) : random_(random), building_(buildings()[random.below(buildings().size())]) {}

  ClosedRoom make() {
    Solid shell = prism(building_.plan, 0, kHeight);
    room_.holes = building_.plan.size() > 1;
    if (building_.cells.size() == 1 && random_.one_in(2)) add_window(shell);
    add_room(room_.scene, shell);
    for (int count = random_.integer(0, 3); count > 0; --count) add_something();
    do {
      place_receiver();
    } while (!std::ranges::all_of(solids_, [&](const Solid& s) { return strictly_outside(s, room_.scene.point); }));
    room_.scene.normal = normal();
    return std::move(room_);
  }

 private:
  const std::array<double, 4>& cell() { return building_.cells[random_.below(building_.cells.size())]; }
  double whole(double low, double high) { return random_.integer(static_cast<int>(low), static_cast<int>(high)); }

  // Cuts a hole into the ceiling and fills it with another patch.
  void add_window(Solid& shell) {
    const std::vector<std::vector<std::array<double, 2>>> outlines{
        {{2, 2}, {6, 2}, {6, 6}, {2, 6}}, {{0, 0}, {6, 2}, {4, 4}, {7, 7}, {2, 6}}, {{4, 0}, {8, 4}, {4, 8}, {0, 4}}};
    Ring window;
    for (const auto& [x, y] : outlines[random_.below(outlines.size())]) {
      window.push_back(static_cast<std::uint32_t>(shell.corners.size()));
      shell.corners.push_back({x, y, kHeight});
    }
    shell.faces.back().rings.push_back(window);
    shell.faces.push_back({{window}});
    room_.holes = true;
  }

  Vec3 corner_in(const std::array<double, 4>& cell, int margin) {
    const double x = whole(cell[0] + margin, cell[1] - margin);
    const double y = whole(cell[2] + margin, cell[3] - margin);
    return {x, y, whole(margin, kHeight - margin)};
  }

  void add_something() {
    const auto& where = cell();
    if (random_.one_in(3)) return add_sheet_in(where);
    Solid solid = random_.one_in(2) ? some_box(where) : some_tetrahedron(where);
    add_thing(room_.scene, solid);
    solids_.push_back(std::move(solid));
  }

  // Keeps a distance from the walls: a sheet on a wall would be seen twice.
  void add_sheet_in(const std::array<double, 4>& where) {
    std::vector<Vec3> corners;
    do {
      corners = {corner_in(where, 1), corner_in(where, 1), corner_in(where, 1)};
    } while (on_one_line(corners));
    if (random_.one_in(2)) {  // a fourth corner, in the plane or one off it
      const Vec3 d{corners[0].x + corners[2].x - corners[1].x, corners[0].y + corners[2].y - corners[1].y,
                   corners[0].z + corners[2].z - corners[1].z + random_.integer(0, 1)};
      const bool off_the_walls = d.x > where[0] && d.x < where[1] && d.y > where[2] && d.y < where[3];
      if (off_the_walls && d.z > 0 && d.z < kHeight) corners.push_back(d);
    }
    add_sheet(room_.scene, corners);
  }

  static bool on_one_line(const std::vector<Vec3>& c) {
    const auto no_plane_with = [&](const Vec3& direction) {
      return side(c[0], c[1], c[2], {c[0].x + direction.x, c[0].y + direction.y, c[0].z + direction.z}) == 0;
    };
    return no_plane_with({1, 0, 0}) && no_plane_with({0, 1, 0}) && no_plane_with({0, 0, 1});
  }

  Solid some_box(const std::array<double, 4>& where) {
    for (;;) {
      const Vec3 a = corner_in(where, 0);
      const Vec3 b = corner_in(where, 0);
      if (a.x < b.x && a.y < b.y && a.z < b.z && (b.x - a.x) * (b.y - a.y) * (b.z - a.z) < 100) return box(a, b);
    }
  }

  Solid some_tetrahedron(const std::array<double, 4>& where) {
    for (;;) {
      const std::vector<Vec3> corners{corner_in(where, 0), corner_in(where, 0), corner_in(where, 0),
                                      corner_in(where, 0)};
      if (in_general_position(corners)) return hull(corners);
    }
  }

  void place_receiver() {
    const auto& where = cell();
    room_.receiver_is_eighths = true;
    const double x = coordinate(where[0], where[1], &Vec3::x);
    const double y = coordinate(where[2], where[3], &Vec3::y);
    room_.scene.point = {x, y, coordinate(0, kHeight, &Vec3::z)};
  }

  // Strictly between low and high: anywhere, in the plane of something, or next to a plane.
  double coordinate(double low, double high, double Vec3::*axis) {
    const double between = low + random_.integer(1, static_cast<int>(8 * (high - low)) - 1) / 8.0;
    const double corner = room_.scene.vertices[random_.below(room_.scene.vertices.size())].*axis;
    const double plane = low < corner && corner < high ? corner : between;
    switch (random_.below(10)) {
      case 0:
        return plane;
      case 1:
        room_.receiver_is_eighths = false;
        return std::nextafter(plane, random_.one_in(2) ? low : high);
      case 2:
        room_.receiver_is_eighths = false;
        return beside(low, high);
      default:
        return between;
    }
  }

  // As near to a wall as 1e-300, or as doubles allow.
  double beside(double low, double high) {
    const std::array<double, 4> distances{1e-3, 1e-9, 1e-15, 1e-300};
    const double distance = distances[random_.below(distances.size())];
    const bool at_low = random_.one_in(2);
    const double near = at_low ? low + distance : high - distance;
    if (low < near && near < high) return near;
    return at_low ? std::nextafter(low, high) : std::nextafter(high, low);
  }

  Vec3 normal() {
    const double scale = random_.one_in(4) ? 1e-300 : 1.0;
    const double x = scale * random_.integer(-2, 2);
    const double y = scale * random_.integer(-2, 2);
    if (random_.one_in(3)) return {scale * random_.between(-1, 1), scale * random_.between(-1, 1), scale};
    return x == 0 && y == 0 ? Vec3{0, 0, -scale} : Vec3{x, y, scale * random_.integer(-2, 2)};
  }

  Random& random_;
  const Building& building_;
  ClosedRoom room_;
  std::vector<Solid> solids_;
};

// --- Hulls ---

Vec3 random_point(Random& random) {
  const double x = random.between(-1, 1);
  const double y = random.between(-1, 1);
  return {x, y, random.between(-1, 1)};
}

std::vector<Vec3> random_points(Random& random, std::size_t count) {
  std::vector<Vec3> points(count);
  do {
    for (Vec3& point : points) point = random_point(random);
  } while (!in_general_position(points));
  return points;
}

Vec3 shrunk(const Vec3& v, double factor, const Vec3& centre) {
  return {centre.x + factor * v.x, centre.y + factor * v.y, centre.z + factor * v.z};
}

// A point from `corner` towards `middle`, by 1 to 1e-15 of the way.
Vec3 towards(const Vec3& corner, const Vec3& middle, Random& random) {
  const double t = std::pow(0.1, random.integer(0, 15));
  return {corner.x + t * (middle.x - corner.x), corner.y + t * (middle.y - corner.y),
          corner.z + t * (middle.z - corner.z)};
}

Vec3 middle_of(const Solid& solid, const PlainFace& face) {
  Vec3 sum;
  for (const std::uint32_t i : face.rings.front()) {
    const Vec3& c = solid.corners[i];
    sum = {sum.x + c.x / 3, sum.y + c.y / 3, sum.z + c.z / 3};
  }
  return sum;
}

}  // namespace

ClosedRoom random_building(Random& random) { return BuildingMaker(random).make(); }

PlainScene random_hull_room(Random& random) {
  PlainScene scene;
  const Solid room = hull(random_points(random, 6 + random.below(6)));
  add_room(scene, room);
  std::vector<Solid> things;
  for (int count = random.integer(0, 3); count > 0; --count) {
    std::vector<Vec3> points = random_points(random, 4 + random.below(3));
    const Vec3 centre = shrunk(random_point(random), 0.3, {});
    for (Vec3& point : points) point = shrunk(point, 0.2, centre);
    if (!in_general_position(points)) continue;
    things.push_back(hull(points));
    add_thing(scene, things.back());
  }
  const auto free = [&](const Vec3& x) {
    return strictly_inside(room, x) &&
           std::ranges::all_of(things, [&](const Solid& thing) { return strictly_outside(thing, x); });
  };
  do {
    const PlainFace& wall = room.faces[random.below(room.faces.size())];
    scene.point = towards(middle_of(room, wall), shrunk(random_point(random), 0.4, {}), random);
  } while (!free(scene.point));
  scene.normal = random_point(random);
  return scene;
}

// --- Rooms from CAD ---

namespace {

FloorPlan random_plan(Random& random) {
  const double a = random.integer(2, 5), b = random.integer(2, 5);
  const double c = random.integer(1, static_cast<int>(a) - 1), d = random.integer(1, static_cast<int>(b) - 1);
  if (random.one_in(3)) return {{{0, 0}, {a, 0}, {a, b}, {0, b}}};
  if (random.one_in(2)) return {{{0, 0}, {a, 0}, {a, b}, {c, b}, {c, d}, {0, d}}};
  return {{{0, 0}, {a, 0}, {a, d}, {a + 1, d}, {a + 1, b}, {0, b}}};
}

}  // namespace

PlainScene random_plain_room(Random& random) {
  PlainScene room;
  const FloorPlan plan = random_plan(random);
  add_room(room, prism(plan, 0.0, random.integer(1, 3)));
  return room;
}

// Every face with corners of its own, all within `moved` of where they were in each coordinate.
PlainScene with_moved_corners(const PlainScene& room, double moved, std::uint64_t seed) {
  Random random(seed);
  PlainScene result;
  for (const generate::PlainPatch& patch : room.patches) {
    for (const generate::PlainFace& face : patch.faces) {
      std::vector<Vec3> ring;
      for (const std::uint32_t corner : face.rings.front()) {
        Vec3 v = room.vertices[corner];
        for (double* x : {&v.x, &v.y, &v.z}) *x += random.between(-moved, moved);
        ring.push_back(v);
      }
      result.add_ring(result.patch(patch.name), ring);
    }
  }
  return result;
}

}  // namespace exactff::validation
