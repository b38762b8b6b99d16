#include "support/minimise.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <map>

#include "support/oracle.h"

namespace exactff::validation {

using generate::PlainFace;
using generate::PlainPatch;
using generate::PlainScene;
using generate::Ring;

namespace {

using Fails = std::function<bool(const PlainScene&)>;

PlainScene without_unused_corners(const PlainScene& scene) {
  PlainScene out = scene;
  out.vertices.clear();
  std::map<std::uint32_t, std::uint32_t> renamed;
  for (PlainPatch& patch : out.patches) {
    for (PlainFace& face : patch.faces) {
      for (Ring& ring : face.rings) {
        for (std::uint32_t& index : ring) {
          const auto [entry, is_new] = renamed.try_emplace(index, static_cast<std::uint32_t>(out.vertices.size()));
          if (is_new) out.vertices.push_back(scene.vertices[index]);
          index = entry->second;
        }
      }
    }
  }
  return out;
}

bool drop_a_patch(PlainScene& scene, const Fails& fails) {
  for (std::size_t i = 0; i < scene.patches.size(); ++i) {
    if (scene.patches[i].name == scene.source) continue;
    PlainScene smaller = scene;
    smaller.patches.erase(smaller.patches.begin() + static_cast<std::ptrdiff_t>(i));
    if (!fails(smaller)) continue;
    scene = std::move(smaller);
    return true;
  }
  return false;
}

bool drop_a_face(PlainScene& scene, const Fails& fails) {
  for (std::size_t i = 0; i < scene.patches.size(); ++i) {
    for (std::size_t k = 0; scene.patches[i].faces.size() > 1 && k < scene.patches[i].faces.size(); ++k) {
      PlainScene smaller = scene;
      auto& faces = smaller.patches[i].faces;
      faces.erase(faces.begin() + static_cast<std::ptrdiff_t>(k));
      if (!fails(smaller)) continue;
      scene = std::move(smaller);
      return true;
    }
  }
  return false;
}

struct RingPlace {
  std::size_t patch = 0;
  std::size_t face = 0;
  std::size_t ring = 0;
};

// Calls change(scene, ring) for every ring until a change is found for which the scene still fails.
template <class Change>
bool change_a_ring(PlainScene& scene, const Fails& fails, const Change& change) {
  for (std::size_t i = 0; i < scene.patches.size(); ++i) {
    for (std::size_t k = 0; k < scene.patches[i].faces.size(); ++k) {
      for (std::size_t r = 0; r < scene.patches[i].faces[k].rings.size(); ++r) {
        if (change(scene, fails, RingPlace{i, k, r})) return true;
      }
    }
  }
  return false;
}

std::vector<Ring>& rings_at(PlainScene& scene, const RingPlace& place) {
  return scene.patches[place.patch].faces[place.face].rings;
}

bool drop_this_hole(PlainScene& scene, const Fails& fails, const RingPlace& place) {
  if (place.ring == 0) return false;
  PlainScene smaller = scene;
  std::vector<Ring>& rings = rings_at(smaller, place);
  rings.erase(rings.begin() + static_cast<std::ptrdiff_t>(place.ring));
  if (!fails(smaller)) return false;
  scene = std::move(smaller);
  return true;
}

bool drop_a_corner_here(PlainScene& scene, const Fails& fails, const RingPlace& place) {
  const std::size_t count = rings_at(scene, place)[place.ring].size();
  for (std::size_t c = 0; count > 3 && c < count; ++c) {
    PlainScene smaller = scene;
    Ring& ring = rings_at(smaller, place)[place.ring];
    ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(c));
    if (!fails(smaller)) continue;
    scene = std::move(smaller);
    return true;
  }
  return false;
}

bool drop_a_hole(PlainScene& scene, const Fails& fails) { return change_a_ring(scene, fails, &drop_this_hole); }
bool drop_a_corner(PlainScene& scene, const Fails& fails) { return change_a_ring(scene, fails, &drop_a_corner_here); }

// The complexity of a number: the bits of its mantissa, and the distance of its exponent from 0.
int complexity(double value) {
  if (value == 0.0) return 0;
  int exponent = 0;
  const auto mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(value, &exponent), 53));
  const int bits = 53 - std::countr_zero(static_cast<std::uint64_t>(std::abs(mantissa)));
  return bits + std::abs(exponent) + (value < 0.0 ? 1 : 0);
}

// Its first bits, rounded.
double shortened(double value, int bits) {
  int exponent = 0;
  const double mantissa = std::frexp(value, &exponent);
  return std::ldexp(std::round(std::ldexp(mantissa, bits)), exponent - bits);
}

bool simplify(double& value, const std::function<bool()>& fails) {
  const double old = value;
  for (const double simpler : {0.0, 1.0, -1.0, std::round(old), shortened(old, 1), shortened(old, 2), shortened(old, 4),
                               shortened(old, 10), shortened(old, 26)}) {
    if (!(complexity(simpler) < complexity(old))) continue;  // infinite numbers are not simpler
    value = simpler;
    if (fails()) return true;
  }
  value = old;
  return false;
}

bool simplify_a_coordinate(PlainScene& scene, const Fails& fails) {
  const auto still = [&] { return fails(scene); };
  const auto simplify_in = [&](Vec3& v) {
    return simplify(v.x, still) || simplify(v.y, still) || simplify(v.z, still);
  };
  return simplify_in(scene.point) || simplify_in(scene.normal) || std::ranges::any_of(scene.vertices, simplify_in);
}

// A change may make a face cross itself; its refusal is not a failure.
bool is_a_scene(const PlainScene& scene) {
  try {
    (void)generate::build(scene);
    return scene.normal != Vec3{};
  } catch (const InputError&) {
    return false;
  }
}

// --- The case format knows patches of one polygon or of triangles. ---

std::vector<PlainPatch> one_face_each(const PlainPatch& patch) {
  std::vector<PlainPatch> out;
  for (const PlainFace& face : patch.faces) {
    out.push_back({patch.name + '_' + std::to_string(out.size()), patch.material, {face}});
  }
  return out;
}

bool all_triangles(const PlainPatch& patch) {
  return std::ranges::all_of(
      patch.faces, [](const PlainFace& face) { return face.rings.size() == 1 && face.rings.front().size() == 3; });
}

PlainPatch in_triangles(const PlainScene& scene, const PlainPatch& patch) {
  const Scene built = generate::build(scene);
  PlainPatch out{patch.name, patch.material, {}};
  for (const FaceId id : built.faces_of(built.select(patch.name))) {
    for (const Piece& piece : built.pieces_of(id)) {
      const auto corners = built.corners(piece);
      // If the fan starts in the middle of a side, it has triangles without area, which are ignored.
      for (std::size_t k = 1; k + 1 < corners.size(); ++k) {
        out.faces.push_back({{{corners[0], corners[k], corners[k + 1]}}});
      }
    }
  }
  return out;
}

}  // namespace

PlainScene minimised(PlainScene scene, const Fails& fails) {
  const Fails still_fails = [&](const PlainScene& smaller) { return is_a_scene(smaller) && fails(smaller); };
  while (drop_a_patch(scene, still_fails) || drop_a_face(scene, still_fails) || drop_a_hole(scene, still_fails) ||
         drop_a_corner(scene, still_fails)) {
  }
  // Non-planar faces are cut by the order of their vertices, so this is also a change.
  if (PlainScene renumbered = without_unused_corners(scene); fails(renumbered)) scene = std::move(renumbered);
  while (simplify_a_coordinate(scene, still_fails)) {
  }
  return scene;
}

CaseFile as_case(const std::string& name, const PlainScene& scene) {
  CaseFile file{name, scene, {}};
  file.scene.patches.clear();
  for (const PlainPatch& patch : scene.patches) {
    if (patch.faces.size() == 1) {
      file.scene.patches.push_back(patch);
    } else if (patch.name == scene.source) {
      file.scene.patches.push_back(all_triangles(patch) ? patch : in_triangles(scene, patch));
    } else {
      for (PlainPatch& single : one_face_each(patch)) file.scene.patches.push_back(std::move(single));
    }
  }
  const Scene built = generate::build(file.scene);
  const OracleResult truth = oracle(built, generate::receiver_of(scene), built.select(scene.source));
  file.expected = {truth.decimals, truth.zero, truth.value, {}};
  for (const OraclePlane& plane : truth.planes)
    file.expected.visible_fractions.push_back(plane.visible_fraction.get_d());
  return file;
}

}  // namespace exactff::validation
