#include "support/transform.h"

#include <gmpxx.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace exactff::validation {

using generate::PlainFace;
using generate::PlainPatch;
using generate::PlainScene;
using generate::Random;
using generate::Ring;

bool Symmetry::odd() const {
  const bool cyclic = (axis[0] + 1) % 3 == axis[1];
  return (sign[0] * sign[1] * sign[2] > 0) != cyclic;
}

std::vector<Symmetry> all_symmetries() {
  std::vector<Symmetry> out;
  std::array<int, 3> axis{0, 1, 2};
  do {
    for (int flips = 0; flips < 8; ++flips) {
      out.push_back({axis, {flips & 1 ? -1 : 1, flips & 2 ? -1 : 1, flips & 4 ? -1 : 1}});
    }
  } while (std::next_permutation(axis.begin(), axis.end()));
  return out;
}

PlainScene turned(const PlainScene& scene, const Symmetry& symmetry) {
  const auto turn = [&](const Vec3& v) {
    const std::array<double, 3> old{v.x, v.y, v.z};
    const auto component = [&](std::size_t k) {
      return symmetry.sign[k] * old[static_cast<std::size_t>(symmetry.axis[k])];
    };
    return Vec3{component(0), component(1), component(2)};
  };
  PlainScene out = scene;
  for (Vec3& vertex : out.vertices) vertex = turn(vertex);
  out.point = turn(scene.point);
  out.normal = turn(scene.normal);
  if (!symmetry.odd()) return out;
  for (PlainPatch& patch : out.patches) {
    for (PlainFace& face : patch.faces) {
      for (Ring& ring : face.rings) std::ranges::reverse(ring);
    }
  }
  return out;
}

namespace {

void shuffle_vertices(PlainScene& scene, Random& random) {
  std::vector<std::uint32_t> order(scene.vertices.size());
  std::iota(order.begin(), order.end(), 0u);
  shuffle(random, order);
  const std::vector<Vec3> old = scene.vertices;
  for (std::size_t i = 0; i < old.size(); ++i) scene.vertices[order[i]] = old[i];
  for (PlainPatch& patch : scene.patches) {
    for (PlainFace& face : patch.faces) {
      for (Ring& ring : face.rings) {
        for (std::uint32_t& index : ring) index = order[index];
      }
    }
  }
}

void rotate(Ring& ring, Random& random) {
  std::rotate(ring.begin(), ring.begin() + static_cast<std::ptrdiff_t>(random.below(ring.size())), ring.end());
}

// The diagonal of a non-planar face depends on the vertex order, so such a scene keeps its vertices.
bool all_planar(const Scene& scene) {
  return std::ranges::none_of(scene.faces(), [](const Face& face) { return face.shape == FaceShape::kTriangulated; });
}

}  // namespace

PlainScene shuffled(const PlainScene& scene, Random& random) {
  PlainScene out = scene;
  shuffle(random, out.patches);
  for (PlainPatch& patch : out.patches) {
    shuffle(random, patch.faces);
    for (PlainFace& face : patch.faces) {
      for (Ring& ring : face.rings) rotate(ring, random);
    }
  }
  if (all_planar(build(scene))) shuffle_vertices(out, random);
  return out;
}

namespace {

std::optional<double> halfway(double a, double b) {
  const mpq_class middle = (mpq_class(a) + mpq_class(b)) / 2;
  const double rounded = middle.get_d();
  return mpq_class(rounded) == middle ? std::optional(rounded) : std::nullopt;
}

std::optional<Vec3> halfway(const Vec3& a, const Vec3& b) {
  const auto x = halfway(a.x, b.x);
  const auto y = halfway(a.y, b.y);
  const auto z = halfway(a.z, b.z);
  return x && y && z ? std::optional(Vec3{*x, *y, *z}) : std::nullopt;
}

class Cutter {
 public:
  Cutter(PlainScene& scene, PlainPatch& patch, Random& random) : scene_(scene), patch_(patch), random_(random) {}

  void add_fan(Ring ring) {
    rotate(ring, random_);
    for (std::size_t i = 1; i + 1 < ring.size(); ++i) add_triangle({ring[0], ring[i], ring[i + 1]}, 2);
  }

 private:
  void add_triangle(Ring ring, int splits_left) {
    rotate(ring, random_);
    const auto middle = halfway(scene_.vertices[ring[1]], scene_.vertices[ring[2]]);
    if (splits_left == 0 || !middle || random_.one_in(2)) {
      patch_.faces.push_back({{ring}});
      return;
    }
    const auto index = static_cast<std::uint32_t>(scene_.vertices.size());
    scene_.vertices.push_back(*middle);
    add_triangle({ring[0], ring[1], index}, splits_left - 1);
    add_triangle({ring[0], index, ring[2]}, splits_left - 1);
  }

  PlainScene& scene_;
  PlainPatch& patch_;
  Random& random_;
};

}  // namespace

PlainScene retriangulated(const PlainScene& scene, Random& random) {
  const Scene built = build(scene);
  PlainScene out = scene;
  for (std::size_t i = 0; i < scene.patches.size(); ++i) {
    if (scene.patches[i].name == scene.source) continue;
    out.patches[i].faces.clear();
    Cutter cutter(out, out.patches[i], random);
    const Patch& patch = built.patch(built.select(scene.patches[i].name).patch);
    for (const FaceId id : patch.faces) {
      for (const Piece& piece : built.pieces_of(id)) {
        const auto corners = built.corners(piece);
        cutter.add_fan({corners.begin(), corners.end()});
      }
    }
  }
  return out;
}

namespace {

Ring with_idle_corners(PlainScene& scene, const Ring& ring, Random& random) {
  Ring out;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    out.push_back(ring[i]);
    if (random.one_in(6)) out.push_back(ring[i]);
    const auto middle = halfway(scene.vertices[ring[i]], scene.vertices[ring[(i + 1) % ring.size()]]);
    if (!middle || !random.one_in(3)) continue;
    out.push_back(static_cast<std::uint32_t>(scene.vertices.size()));
    scene.vertices.push_back(*middle);
  }
  return out;
}

}  // namespace

PlainScene with_idle_corners(const PlainScene& scene, Random& random) {
  PlainScene out = scene;
  if (!all_planar(build(scene))) return out;
  for (PlainPatch& patch : out.patches) {
    for (PlainFace& face : patch.faces) {
      for (Ring& ring : face.rings) ring = with_idle_corners(out, ring, random);
    }
  }
  return out;
}

namespace {

std::uint32_t add_vertex(PlainScene& scene, const Vec3& position) {
  scene.vertices.push_back(position);
  return static_cast<std::uint32_t>(scene.vertices.size() - 1);
}

// A point halfway from corner i of a convex ring to the midpoint of two other corners, if all of this is exact.
Ring with_spike(PlainScene& scene, const Ring& ring, Random& random) {
  const std::size_t n = ring.size(), i = random.below(n);
  const Vec3 corner = scene.vertices[ring[i]];
  const auto across = halfway(scene.vertices[ring[(i + 1) % n]], scene.vertices[ring[(i + n - 1) % n]]);
  const auto tip = across ? halfway(corner, *across) : std::nullopt;
  const auto middle = tip ? halfway(corner, *tip) : std::nullopt;
  if (!middle) return ring;
  Ring spike = {ring[i]};
  const bool two_steps = !random.one_in(3);
  const std::uint32_t inner = two_steps ? add_vertex(scene, *middle) : 0;
  if (two_steps) spike.push_back(inner);
  spike.push_back(add_vertex(scene, *tip));
  if (two_steps) spike.push_back(inner);
  Ring out = ring;
  out.insert(out.begin() + static_cast<std::ptrdiff_t>(i), spike.begin(), spike.end());
  return out;
}

}  // namespace

PlainScene with_spikes(const PlainScene& scene, Random& random) {
  const Scene built = build(scene);
  PlainScene out = scene;
  if (!all_planar(built)) return out;
  for (PlainPatch& patch : out.patches) {
    const Patch& same = built.patch(built.select(patch.name).patch);
    for (std::size_t f = 0; f < patch.faces.size(); ++f) {
      std::vector<Ring>& rings = patch.faces[f].rings;
      if (rings.size() > 1 || built.pieces_of(same.faces[f]).size() != 1) continue;
      for (int spikes = random.integer(0, 2); spikes > 0; --spikes) {
        if (rings[0].size() > 8) break;
        rings[0] = with_spike(out, rings[0], random);
      }
    }
  }
  return out;
}

PlainScene slid_along_rays(const PlainScene& scene, int range, Random& random) {
  PlainScene out = scene;
  std::vector<bool> is_source(scene.vertices.size(), false);
  for (const PlainPatch& patch : scene.patches) {
    if (patch.name != scene.source) continue;
    for (const PlainFace& face : patch.faces) {
      for (const std::uint32_t index : face.rings.front()) is_source[index] = true;
    }
  }
  for (std::size_t i = 0; i < scene.vertices.size(); ++i) {
    const int exponent = random.integer(0, range);
    const double factor = std::ldexp(1.0, is_source[i] ? exponent : -exponent);
    const Vec3& v = scene.vertices[i];
    out.vertices[i] = {v.x * factor, v.y * factor, v.z * factor};
  }
  return out;
}

PlainScene sheared(const PlainScene& scene, Random& random) {
  std::array<Vec3, 3> rows{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  for (Vec3& row : rows) {
    row = {row.x + random.between(-0.3, 0.3), row.y + random.between(-0.3, 0.3), row.z + random.between(-0.3, 0.3)};
  }
  const auto times = [&](const Vec3& v) {
    const auto component = [&](const Vec3& row) { return row.x * v.x + row.y * v.y + row.z * v.z; };
    return Vec3{component(rows[0]), component(rows[1]), component(rows[2])};
  };
  PlainScene out = scene;
  for (Vec3& vertex : out.vertices) vertex = times(vertex);
  out.point = times(scene.point);
  out.normal = times(scene.normal);
  return out;
}

PlainScene nudged(const PlainScene& scene, Random& random) {
  PlainScene out = scene;
  const auto nudge = [&](double& c) {
    if (random.one_in(10)) c = std::nextafter(c, random.one_in(2) ? 1e300 : -1e300);
  };
  for (Vec3& vertex : out.vertices) {
    nudge(vertex.x);
    nudge(vertex.y);
    nudge(vertex.z);
  }
  nudge(out.point.x);
  nudge(out.point.y);
  nudge(out.point.z);
  return out;
}

PlainScene in_triangles(const PlainScene& plain) {
  const Scene scene = generate::build(plain);
  PlainScene result = plain;
  result.vertices.assign(scene.vertices().begin(), scene.vertices().end());
  for (generate::PlainPatch& patch : result.patches) patch.faces.clear();
  for (const Piece& piece : scene.pieces()) {
    const std::string& name = scene.patch(scene.face(piece.face).patch).name;
    const auto patch = std::ranges::find(result.patches, name, &generate::PlainPatch::name);
    const auto corners = scene.corners(piece);
    for (std::size_t c = 2; c < corners.size(); ++c) {
      if (name == plain.source && !patch->faces.empty()) break;
      generate::PlainFace face;
      face.rings = {{corners[0], corners[c - 1], corners[c]}};
      patch->faces.push_back(face);
    }
  }
  std::erase_if(result.patches, [](const generate::PlainPatch& patch) { return patch.faces.empty(); });
  return result;
}

bool has_only_area(const PlainScene& plain) {
  if (std::ranges::find(plain.patches, plain.source, &generate::PlainPatch::name) == plain.patches.end()) return false;
  const Scene scene = generate::build(plain);
  return std::ranges::none_of(scene.faces(), [](const Face& face) { return face.shape == FaceShape::kZeroArea; });
}

}  // namespace exactff::validation
