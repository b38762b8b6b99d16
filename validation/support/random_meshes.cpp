#include "support/random_meshes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "generate/vectors.h"
#include "support/oracle_check.h"

namespace exactff::validation {

using generate::PlainScene;
using generate::Random;
using generate::operator+;
using generate::operator-;
using generate::operator*;

namespace {

struct Mesh {
  std::vector<Vec3> corners;
  std::vector<std::array<std::uint32_t, 3>> faces;

  std::uint32_t add(const Vec3& corner) {
    corners.push_back(corner);
    return static_cast<std::uint32_t>(corners.size() - 1);
  }
  void add_square(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    faces.push_back({a, b, c});
    faces.push_back({a, c, d});
  }
};

// A band of squares; its last column continues with the first, turned over if `twisted`.
Mesh band(int around, int across, bool twisted, bool closed_across) {
  Mesh mesh;
  const int rows = closed_across ? across : across + 1;
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < rows; ++j) mesh.add({});
  }
  const auto at = [&](int i, int j) {
    const bool over = i == around;
    if (closed_across) j %= across;
    return static_cast<std::uint32_t>((over ? 0 : i) * rows + (over && twisted ? rows - 1 - j : j));
  };
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) mesh.add_square(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
  }
  return mesh;
}

// Corners of a band about a ring in the plane of x and y; `radius` and `width` as they look.
void bend(Mesh& mesh, int around, int rows, bool twisted, bool tube) {
  for (int i = 0; i < around; ++i) {
    const double turn = 2 * M_PI * i / around;
    for (int j = 0; j < rows; ++j) {
      const double s = tube ? 2 * M_PI * j / rows : (rows > 1 ? 2.0 * j / (rows - 1) - 1.0 : 0.0);
      const double tilt = twisted ? turn / 2 : 0.3;
      const double out = tube ? 0.35 * std::cos(s) : 0.4 * s * std::cos(tilt);
      const double up = tube ? 0.35 * std::sin(s) : 0.4 * s * std::sin(tilt);
      mesh.corners[static_cast<std::size_t>(i * rows + j)] = {(0.8 + out) * std::cos(turn),
                                                              (0.8 + out) * std::sin(turn), up};
    }
  }
}

Mesh ball(int levels) {
  Mesh mesh;
  mesh.corners = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh.faces = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [at, is_new] = middles.try_emplace({std::min(a, b), std::max(a, b)});
      if (is_new) {
        const Vec3 m = 0.5 * (mesh.corners[a] + mesh.corners[b]);
        at->second = mesh.add((1 / std::sqrt(m.x * m.x + m.y * m.y + m.z * m.z)) * m);
      }
      return at->second;
    };
    std::vector<std::array<std::uint32_t, 3>> finer;
    for (const auto& [a, b, c] : mesh.faces) {
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      for (const auto& face : {std::array{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}}) finer.push_back(face);
    }
    mesh.faces = std::move(finer);
  }
  return mesh;
}

Mesh sheet(int side, Random& random) {
  Mesh mesh;
  for (int i = 0; i <= side; ++i) {
    for (int j = 0; j <= side; ++j) mesh.add({2.0 * i / side - 1, 2.0 * j / side - 1, 0.25 * random.integer(-1, 1)});
  }
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) {
      const auto at = [&](int u, int v) { return static_cast<std::uint32_t>(u * (side + 1) + v); };
      mesh.add_square(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
    }
  }
  return mesh;
}

// A box, each side of which is cut into triangles around some points inside.
Mesh box(Random& random) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i) mesh.add({i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0});
  constexpr std::array<std::array<std::uint32_t, 4>, 6> kSides{
      {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
  for (const auto& [a, b, c, d] : kSides) mesh.add_square(a, b, c, d);
  for (int cuts = random.integer(0, 8); cuts > 0; --cuts) {
    const std::size_t k = random.below(mesh.faces.size());
    const auto [a, b, c] = mesh.faces[k];
    // In the plane of the face, exactly: its corners are multiples of a power of two.
    const Vec3 inner = 0.25 * (mesh.corners[a] + mesh.corners[b]) + 0.5 * mesh.corners[c];
    const std::uint32_t m = mesh.add(inner);
    mesh.faces[k] = {a, b, m};
    mesh.faces.push_back({b, c, m});
    mesh.faces.push_back({c, a, m});
  }
  return mesh;
}

double on_lattice(double x, double step) { return step * std::round(x / step); }

class MeshScene {
 public:
  explicit MeshScene(Random& random) : random_(random) {}

  PlainScene make(Mesh mesh) {
    place(mesh);
    if (random_.one_in(3)) turn_some_over(mesh);
    if (random_.one_in(3)) remove_some(mesh);
    if (random_.one_in(3)) repeat_some(mesh);
    if (random_.one_in(3)) cut_some(mesh);
    PlainScene scene;
    if (random_.one_in(3)) scene.normal = {random_.between(-1, 1), random_.between(-1, 1), random_.between(-0.2, 1)};
    if (random_.one_in(4)) scene.point = {random_.integer(-2, 2) * 0.5, random_.integer(-2, 2) * 0.5, 0};
    add_source(scene, mesh);
    const bool own = random_.one_in(5);
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) add_face(scene, mesh, f, own && f == mesh.faces.size() / 2);
    if (random_.one_in(4)) add_copy(scene, mesh);
    if (random_.one_in(4)) add_touching(scene, mesh);
    if (random_.one_in(8)) scene.point = mesh.corners[random_.below(mesh.corners.size())];
    return scene;
  }

 private:
  // Between the receiver and the source, at z = 2; some reach through both planes.
  void place(Mesh& mesh) {
    const double size = random_.one_in(3) ? 1.2 : random_.between(0.2, 0.8);
    const Vec3 middle{random_.between(-0.5, 0.5), random_.between(-0.5, 0.5), random_.between(0.4, 1.8)};
    const int turns = random_.integer(0, 2);
    const double step = random_.one_in(2) ? 1.0 / 16 : random_.one_in(2) ? 1.0 / 4096 : 0.0;
    for (Vec3& corner : mesh.corners) {
      for (int t = 0; t < turns; ++t) corner = {corner.y, corner.z, corner.x};
      corner = middle + size * corner;
      if (step > 0) corner = {on_lattice(corner.x, step), on_lattice(corner.y, step), on_lattice(corner.z, step)};
    }
  }
  void turn_some_over(Mesh& mesh) {
    for (auto& face : mesh.faces) {
      if (random_.one_in(4)) std::swap(face[0], face[1]);
    }
  }
  void remove_some(Mesh& mesh) {
    std::erase_if(mesh.faces, [&](const auto&) { return random_.one_in(6); });
    if (mesh.faces.empty()) mesh.faces.push_back({0, 1, 2});
  }
  void repeat_some(Mesh& mesh) {
    const std::size_t count = mesh.faces.size();
    for (std::size_t f = 0; f < count; ++f) {
      if (!random_.one_in(8)) continue;
      auto face = mesh.faces[f];
      if (random_.one_in(2)) std::swap(face[0], face[2]);
      mesh.faces.push_back(face);
    }
  }
  // Cuts faces at the middle of a side, whatever is on the other side of it.
  void cut_some(Mesh& mesh) {
    const std::size_t count = mesh.faces.size();
    for (std::size_t f = 0; f < count; ++f) {
      if (!random_.one_in(6)) continue;
      const auto [a, b, c] = mesh.faces[f];
      const std::uint32_t m = mesh.add(0.5 * (mesh.corners[a] + mesh.corners[b]));
      mesh.faces[f] = {a, m, c};
      mesh.faces.push_back({m, b, c});
    }
  }
  void add_source(PlainScene& scene, Mesh& mesh) {
    generate::PlainPatch& source = scene.patch("source");
    if (random_.one_in(4)) {  // a part of the mesh
      for (int k = random_.integer(1, 3); k > 0 && mesh.faces.size() > 1; --k) {
        add_triangle(scene, source, mesh, mesh.faces.back());
        mesh.faces.pop_back();
      }
    } else if (random_.one_in(3)) {
      scene.add_ring(source, {{-1, 1, 2}, {0, 1, 2}, {0, 0, 2}, {1, 0, 2}, {1, -1, 2}, {-1, -1, 2}});
    } else if (random_.one_in(3)) {
      scene.add_ring(source, {{-1, 1, 2}, {1, 1, 2}, {1, -1, 2}});
      scene.add_ring(source, {{-1, 1, 2}, {1, -1, 2}, {-1, -1, 2}});
    } else {
      scene.add_ring(source, {{-1, 1, 2}, {1, 1, 2}, {1, -1, 2}, {-1, -1, 2}});
    }
  }
  static void add_triangle(PlainScene& scene, generate::PlainPatch& patch, const Mesh& mesh,
                           const std::array<std::uint32_t, 3>& face) {
    const Vec3 &a = mesh.corners[face[0]], &b = mesh.corners[face[1]], &c = mesh.corners[face[2]];
    scene.add_ring(patch, {a, b, c});
  }
  void add_face(PlainScene& scene, const Mesh& mesh, std::size_t f, bool is_own) {
    add_triangle(scene, scene.patch(is_own ? "on" : "occ"), mesh, mesh.faces[f]);
    if (!is_own) return;
    const Vec3 &a = mesh.corners[mesh.faces[f][0]], &b = mesh.corners[mesh.faces[f][1]],
               &c = mesh.corners[mesh.faces[f][2]];
    scene.point = 0.25 * a + 0.25 * b + 0.5 * c;
  }
  void add_copy(PlainScene& scene, const Mesh& mesh) {
    Mesh moved = mesh;
    for (Vec3& corner : moved.corners) corner.x = std::nextafter(corner.x, 10.0);
    for (const auto& face : moved.faces) add_triangle(scene, scene.patch("copy"), moved, face);
  }
  void add_touching(PlainScene& scene, const Mesh& mesh) {
    const auto& [a, b, c] = mesh.faces[random_.below(mesh.faces.size())];
    Mesh other;
    const Vec3 apex{random_.integer(-8, 8) / 8.0, random_.integer(-8, 8) / 8.0, random_.integer(1, 15) / 8.0};
    other.corners = {mesh.corners[a], random_.one_in(2) ? mesh.corners[b] : Vec3{0.5, 0.25, 1.5}, apex, {-0.5, 0.5, 1}};
    other.faces = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {0, 2, 3}};
    for (const auto& face : other.faces) add_triangle(scene, scene.patch("touching"), other, face);
    static_cast<void>(c);
  }

  Random& random_;
};

PlainScene ball_scene(Random& random) { return MeshScene(random).make(ball(random.integer(0, 2))); }

PlainScene sheet_scene(Random& random) { return MeshScene(random).make(sheet(random.integer(2, 6), random)); }

PlainScene box_scene(Random& random) { return MeshScene(random).make(box(random)); }

PlainScene band_scene(Random& random) {
  const bool tube = random.one_in(2), twisted = !tube && random.one_in(2);
  const int around = random.integer(3, 8), across = random.integer(tube ? 3 : 1, 5), rows = tube ? across : across + 1;
  Mesh mesh = band(around, across, twisted, tube);
  bend(mesh, around, rows, twisted, tube);
  return MeshScene(random).make(std::move(mesh));
}

}  // namespace

std::vector<Receiver> receivers_about(const Scene& scene, const PlainScene& plain, Random& random) {
  std::vector<Receiver> receivers{receiver_in(scene, plain)};
  Receiver moved = receivers.front();
  moved.on.clear();
  moved.point.x += random.integer(-2, 2) / 4.0;
  moved.point.y += random.integer(-2, 2) / 4.0;
  receivers.push_back(moved);
  // That says it is on a face elsewhere: a hole in a mesh, where the tree of edges takes all for smooth.
  moved.on = {FaceId{static_cast<std::uint32_t>(random.below(scene.faces().size()))}};
  receivers.push_back(moved);
  return receivers;
}

std::span<const RandomFamily> mesh_families() {
  static constexpr std::array<RandomFamily, 4> kFamilies{
      {{"Balls", 60, ball_scene}, {"Sheets", 60, sheet_scene}, {"Boxes", 60, box_scene}, {"Bands", 60, band_scene}}};
  return kFamilies;
}

}  // namespace exactff::validation
