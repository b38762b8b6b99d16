#include "models/plain_scene.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <map>
#include <stdexcept>

#include "kernel/numbers.h"

namespace exactff::models {

void PlainScene::add_ring(PlainPatch& patch, const std::vector<Vec3>& corners) { add_rings(patch, {corners}); }

void PlainScene::add_rings(PlainPatch& patch, const std::vector<std::vector<Vec3>>& rings) {
  PlainFace face;
  for (const std::vector<Vec3>& corners : rings) {
    Ring ring;
    for (const Vec3& corner : corners) {
      ring.push_back(static_cast<std::uint32_t>(vertices.size()));
      vertices.push_back(corner);
    }
    face.rings.push_back(std::move(ring));
  }
  patch.faces.push_back(std::move(face));
}

PlainPatch& PlainScene::patch(std::string_view name) {
  const auto found = std::ranges::find(patches, name, &PlainPatch::name);
  return found != patches.end() ? *found : patches.emplace_back(PlainPatch{std::string(name), {}, {}});
}

std::string to_text(double value, Digits digits) {
  std::array<char, 40> text{};
  if (digits == Digits::kSeventeen)
    return {text.data(), static_cast<std::size_t>(std::snprintf(text.data(), text.size(), "%.17g", value))};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

namespace {

std::string triple(const Vec3& v, Digits digits) {
  return to_text(v.x, digits) + ' ' + to_text(v.y, digits) + ' ' + to_text(v.z, digits);
}

std::string triple(const Rgb& c) { return triple(Vec3{c.r, c.g, c.b}, Digits::kShortest); }

void append_patch(std::string& out, const PlainScene& scene, const PlainPatch& patch) {
  out += "g " + patch.name + '\n';
  if (!patch.material.empty()) out += "usemtl " + patch.material + '\n';
  for (const PlainFace& face : patch.faces) {
    out += 'f';
    for (const std::uint32_t index : keyhole(scene.vertices, face)) out += ' ' + std::to_string(index + 1);
    out += '\n';
  }
}

}  // namespace

std::string to_obj(const PlainScene& scene, const std::string& mtl, Digits digits) {
  std::string out;
  for (const std::string& comment : scene.comments) out += "# " + comment + '\n';
  out += "# receiver: --at " + triple(scene.point, digits) + " --normal " + triple(scene.normal, digits) +
         " --source " + scene.source + '\n';
  if (!mtl.empty()) out += "mtllib " + mtl + '\n';
  for (const Vec3& vertex : scene.vertices) out += "v " + triple(vertex, digits) + '\n';
  for (const PlainPatch& patch : scene.patches) append_patch(out, scene, patch);
  return out;
}

std::string to_mtl(const PlainScene& scene) {
  std::string out;
  for (const Material& material : scene.materials) {
    out += "newmtl " + material.name + "\nKd " + triple(material.reflectance) + "\nKe " + triple(material.radiosity) +
           '\n';
  }
  return out;
}

// --- Keyholes: exact signs in the plane's least slanted projection; no arithmetic is ever rounded. ---
namespace {

using kernel::Rational;
using kernel::sign;

struct Flat {
  Rational u;
  Rational v;
};

int turn(const Flat& a, const Flat& b, const Flat& c) {
  return sign(Rational((b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u)));
}

bool between(const Flat& a, const Flat& b, const Flat& c) {  // c on the closed segment ab
  return turn(a, b, c) == 0 && std::min(a.u, b.u) <= c.u && c.u <= std::max(a.u, b.u) && std::min(a.v, b.v) <= c.v &&
         c.v <= std::max(a.v, b.v);
}

bool cross(const Flat& a, const Flat& b, const Flat& c, const Flat& d) {  // properly
  return turn(a, b, c) * turn(a, b, d) < 0 && turn(c, d, a) * turn(c, d, b) < 0;
}

Rational twice_area(const std::vector<Flat>& points, const Ring& ring) {
  Rational sum = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Flat& a = points[ring[i]];
    const Flat& b = points[ring[(i + 1) % ring.size()]];
    sum += a.u * b.v - a.v * b.u;
  }
  return sum;
}

// Drops the first axis for which the projected outer ring has nonzero area.
std::vector<Flat> flatten(const std::vector<Vec3>& vertices, const Ring& outer) {
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<Flat> points;
    for (const Vec3& v : vertices) {
      const std::array<double, 3> c{v.x, v.y, v.z};
      points.push_back({Rational(c[(axis + 1) % 3]), Rational(c[(axis + 2) % 3])});
    }
    if (sign(twice_area(points, outer)) != 0) return points;
  }
  throw std::invalid_argument("a face with holes has no area");
}

bool blocks(const std::vector<Flat>& points, const Ring& ring, std::uint32_t a, std::uint32_t b) {
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const std::uint32_t c = ring[i];
    const std::uint32_t d = ring[(i + 1) % ring.size()];
    if (cross(points[a], points[b], points[c], points[d])) return true;
    if (c != a && c != b && between(points[a], points[b], points[c])) return true;
  }
  return false;
}

// The first bridge from a corner of `ring` to one of `holes` that meets nothing else: {position, hole, position}.
std::array<std::size_t, 3> find_bridge(const std::vector<Flat>& points, const Ring& ring,
                                       const std::vector<Ring>& holes) {
  for (std::size_t i = 0; i < ring.size(); ++i) {
    if (std::ranges::count(ring, ring[i]) != 1) continue;  // at the end of an earlier bridge the sector is ambiguous
    for (std::size_t h = 0; h < holes.size(); ++h) {
      for (std::size_t j = 0; j < holes[h].size(); ++j) {
        const auto hit = [&](const Ring& other) { return blocks(points, other, ring[i], holes[h][j]); };
        if (!hit(ring) && std::ranges::none_of(holes, hit)) return {i, h, j};
      }
    }
  }
  throw std::invalid_argument("no bridge joins the rings of a face");
}

Ring joined(const Ring& ring, std::size_t at, const Ring& hole, std::size_t from) {
  Ring out(ring.begin(), ring.begin() + static_cast<std::ptrdiff_t>(at) + 1);
  for (std::size_t k = 0; k <= hole.size(); ++k) out.push_back(hole[(from + k) % hole.size()]);
  out.insert(out.end(), ring.begin() + static_cast<std::ptrdiff_t>(at), ring.end());
  return out;
}

}  // namespace

Ring keyhole(const std::vector<Vec3>& vertices, const PlainFace& face) {
  Ring ring = face.rings.front();
  if (face.rings.size() == 1) return ring;
  const std::vector<Flat> points = flatten(vertices, ring);
  std::vector<Ring> holes(face.rings.begin() + 1, face.rings.end());
  for (Ring& hole : holes) {
    if (sign(twice_area(points, hole)) == sign(twice_area(points, ring))) std::ranges::reverse(hole);
  }
  while (!holes.empty()) {
    const auto [at, hole, from] = find_bridge(points, ring, holes);
    ring = joined(ring, at, holes[hole], from);
    holes.erase(holes.begin() + static_cast<std::ptrdiff_t>(hole));
  }
  return ring;
}

namespace {

// Numbers materials as read_obj() does: first the one of faces without a material, then each at its first use.
class Materials {
 public:
  Materials(const PlainScene& scene, SceneBuilder& builder) : scene_(scene), builder_(builder) {
    ids_.emplace("", builder_.add_material({.name = "(none)"}));
  }

  MaterialId id(const std::string& name) {
    const auto known = ids_.find(name);
    if (known != ids_.end()) return known->second;
    const auto material = std::ranges::find(scene_.materials, name, &Material::name);
    if (material == scene_.materials.end()) throw std::invalid_argument("there is no material '" + name + "'");
    return ids_.emplace(name, builder_.add_material(*material)).first->second;
  }

 private:
  const PlainScene& scene_;
  SceneBuilder& builder_;
  std::map<std::string, MaterialId> ids_;
};

}  // namespace

Scene build(const PlainScene& scene, const std::string& name, const SceneOptions& options) {
  SceneBuilder builder(name, options);
  for (const Vec3& vertex : scene.vertices) builder.add_vertex(vertex);
  Materials materials(scene, builder);
  for (const PlainPatch& patch : scene.patches) {
    if (patch.faces.empty()) continue;
    const PatchId id = builder.patch(patch.name);
    for (const PlainFace& face : patch.faces) builder.add_face(id, materials.id(patch.material), face.rings);
  }
  return builder.build();
}

Receiver receiver_of(const PlainScene& scene) { return {scene.point, scene.normal, {}, {}}; }

}  // namespace exactff::models
