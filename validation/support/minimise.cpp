#include "support/minimise.h"

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

// The case format knows patches of one polygon or of triangles.
std::vector<PlainPatch> one_face_each(const PlainPatch& patch) {
  std::vector<PlainPatch> out;
  for (const PlainFace& face : patch.faces) {
    out.push_back({patch.name + '_' + std::to_string(out.size()), patch.material, {face}});
  }
  return out;
}

}  // namespace

PlainScene minimised(PlainScene scene, const Fails& fails) {
  while (drop_a_patch(scene, fails) || drop_a_face(scene, fails)) {
  }
  return without_unused_corners(scene);
}

CaseFile as_case(const std::string& name, const PlainScene& scene) {
  CaseFile file{name, scene, {}};
  file.scene.patches.clear();
  for (const PlainPatch& patch : scene.patches) {
    if (patch.name == scene.source || patch.faces.size() == 1) {
      file.scene.patches.push_back(patch);
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
