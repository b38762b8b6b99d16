// Writes Wavefront OBJ and MTL.
#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "formats/mesh_input.h"
#include "formats/writers.h"
#include "scene/scene.h"
#include "text/phrases.h"
#include "text/refuse.h"

namespace exactff::formats {

namespace {

constexpr NameRules kObjNames = {.comment = '#', .only_before_word = true, .joins_lines = true};

bool is_default(const Material& material) {
  return material.name == kNoMaterial && material.reflectance == Rgb{1.0, 1.0, 1.0} && !material.emits();
}

std::vector<std::string> material_names(const Scene& scene, Losses& losses) {
  std::vector<std::string> names;
  for (const Material& material : scene.materials()) names.push_back(material.name);
  return output_names(std::move(names), kObjNames, "material", losses);
}

// The name of a group is one word, that of an object the rest of its line.
bool patches_are_groups(const std::vector<std::string>& patches) {
  return std::none_of(patches.begin(), patches.end(),
                      [](const std::string& name) { return name.find_first_of(" \t\v\f") != std::string::npos; });
}

// True if the faces use all materials in their order, the default one apart. Otherwise they are named before the faces,
// since a reader numbers them by their first use.
bool used_in_order(const Scene& scene, const std::vector<OutputFace>& faces) {
  std::size_t next = !scene.materials().empty() && scene.materials()[0].name == kNoMaterial ? 1 : 0;
  for (const OutputFace& face : faces) {
    const std::size_t material = index_of(scene.face(face.face).material);
    if (material == next) ++next;
    if (material > next) return false;
  }
  return next == scene.materials().size();
}

// The vt lines of the file, each pair of numbers once, and which one each corner has; 0 for none.
class TextureLines {
 public:
  TextureLines(std::string& out, const Scene& scene, const std::vector<OutputFace>& faces) {
    if (!scene.has_texture()) return;
    std::map<std::pair<double, double>, std::size_t> known;
    for (const OutputFace& face : faces) {
      for (const TexturePoint& point : texture_of(scene, face)) {
        const auto [place, is_new] = known.try_emplace({point.u, point.v}, known.size() + 1);
        corners_.push_back(place->second);
        if (is_new) out += "vt " + text::shortest(point.u) + ' ' + text::shortest(point.v) + '\n';
      }
      if (scene.texture(face.face).empty()) corners_.resize(corners_.size() + face.corners.size());
    }
  }

  // Of the next corner.
  void append(std::string& out) {
    if (const std::size_t line = next_ < corners_.size() ? corners_[next_++] : 0; line > 0)
      (out += '/') += std::to_string(line);
  }

 private:
  static std::vector<TexturePoint> texture_of(const Scene& scene, const OutputFace& face) {
    const std::span<const TexturePoint> all = scene.texture(face.face);
    if (all.empty() || (scene.face(face.face).rings.size() == 1 && face.corners == scene.face(face.face).rings.front()))
      return {all.begin(), all.end()};
    const FaceTexture texture(scene, face.face, 0);
    std::vector<TexturePoint> points;
    for (const std::uint32_t v : face.corners) points.push_back(*texture.find(places(scene)[v]));
    return points;
  }

  std::vector<std::size_t> corners_;
  std::size_t next_ = 0;
};

void append_faces(std::string& out, const Scene& scene, const std::vector<OutputFace>& faces,
                  const std::vector<std::string>& patches, const std::vector<std::string>& materials) {
  TextureLines textures(out, scene, faces);
  const char* const keyword = patches_are_groups(patches) ? "g " : "o ";
  std::optional<PatchId> patch;
  std::optional<MaterialId> material;
  for (const OutputFace& output : faces) {
    const Face& face = scene.face(output.face);
    if (patch != face.patch) out += keyword + patches[index_of(face.patch)] + '\n';
    const bool same = material == face.material || (!material && scene.material(face.material).name == kNoMaterial);
    if (!same) out += "usemtl " + materials[index_of(face.material)] + '\n';
    if (!same || material) material = face.material;
    patch = face.patch;
    out += 'f';
    for (const std::uint32_t corner : output.corners) {
      (out += ' ') += std::to_string(corner + 1ULL);
      textures.append(out);
    }
    out += '\n';
  }
}

}  // namespace

bool needs_mtl(const Scene& scene) {
  return !std::all_of(scene.materials().begin(), scene.materials().end(), is_default);
}

std::string write_mtl(const Scene& scene, Losses& losses) {
  const std::vector<std::string> names = material_names(scene, losses);
  std::string out;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const Material& material = scene.materials()[i];
    if (is_default(material)) continue;
    out += "newmtl " + names[i] + '\n';
    for (const auto& [keyword, c] : {std::pair("Kd ", material.reflectance), std::pair("Ke ", material.radiosity)})
      append_point(out, keyword, {c.r, c.g, c.b});
  }
  return out;
}

std::string write_obj(const Scene& scene, const std::string& mtl, Losses& losses) {
  const std::vector<OutputFace> faces = output_faces(scene, Polygons::kAny, "OBJ", losses);
  const std::vector<std::string> patches = output_names(patch_names(scene), kObjNames, "patch", losses);
  Losses told_by_mtl({});
  const std::vector<std::string> materials = material_names(scene, told_by_mtl);
  std::string out = unit_line(scene, "#");
  if (!mtl.empty()) {
    if (fit_name(mtl, kObjNames) != mtl) {
      text::refuse(losses.file(), "the name of its MTL file cannot be written into an OBJ file",
                   "it contains characters that OBJ does not allow", "choose another name");
    }
    out += "mtllib " + mtl + '\n';
  }
  for (const Vec3& vertex : scene.vertices()) append_point(out, "v ", vertex);
  if (!used_in_order(scene, faces)) {
    for (const std::string& name : materials) out += "usemtl " + name + '\n';
    if (!materials.empty()) out += "usemtl " + std::string(kNoMaterial) + '\n';
  }
  append_faces(out, scene, faces, patches, materials);
  return out;
}

}  // namespace exactff::formats
