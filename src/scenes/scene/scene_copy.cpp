#include "scene/scene_copy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <memory>
#include <utility>

#include "kernel/float_environment.h"
#include "scene/scene.h"
#include "scene/selections.h"
#include "text/phrases.h"
#include "text/text_lines.h"

namespace exactff {
namespace {

// --- Glass ---

// Materials that let light through in the program that made the scene, but occlude here.

constexpr std::size_t kMostWarnings = 20;

Problem warning(const Scene& scene, const Material& material, const std::vector<FaceId>& faces) {
  const std::vector<Selection> users = selections_of(scene, faces);
  const std::string flag = flag_words(scene, "--transparent", users);
  return {material.file, material.line,
          "material " + text::in_quotes(material.name, text::kShownName) + " lets light through (" +
              material.see_through + "), but " + listed(scene, users) + (users.size() == 1 ? " occludes" : " occlude"),
          "every material is treated as opaque",
          "if it does not hide what is behind it, give " +
              (flag.empty() ? "the patches of this material to --transparent" : flag)};
}

// One warning for each such material that is used by a face which is not transparent.
std::vector<Problem> warnings_of_opaque_glass(const Scene& scene) {
  std::vector<std::vector<FaceId>> users(scene.materials().size());
  for (std::size_t i = 0; i < scene.faces().size(); ++i) {
    const Face& face = scene.faces()[i];
    const bool occludes = face.piece_count > 0 && !face.transparent;
    if (occludes && !scene.material(face.material).see_through.empty())
      users[index_of(face.material)].push_back(static_cast<FaceId>(i));
  }
  std::vector<Problem> warnings;
  std::size_t others = 0;
  for (std::size_t m = 0; m < users.size(); ++m) {
    if (users[m].empty()) continue;
    if (warnings.size() == kMostWarnings) {
      ++others;
    } else {
      warnings.push_back(warning(scene, scene.materials()[m], users[m]));
    }
  }
  if (others > 0)
    warnings.push_back({.what = text::counted(others, "more material") + " let light through, but occlude"});
  return warnings;
}

// --- Copies to be added to ---

using Rings = std::vector<std::vector<std::uint32_t>>;

// A face that was left out stays so, whatever vertices are added.
Rings rings_of(const Face& face) { return face.piece_count > 0 ? face.rings : Rings{{0, 0, 0}}; }

}  // namespace

SceneBuilder begun_as(const Scene& scene) {
  SceneBuilder builder(SceneInside::data(scene).file, {.unit = scene.unit()});
  for (const std::filesystem::path& file : scene.files()) builder.read_from(file);
  for (const Material& material : scene.materials()) builder.add_material(material);
  return builder;
}

SceneCopy::SceneCopy(const Scene& scene, const Vec3& origin)
    : scene_(scene), builder_({}, {.bad_faces = BadFaces::kSkip, .unit = scene.unit()}) {
  for (const Vec3& v : scene.vertices()) builder_.add_vertex({v.x - origin.x, v.y - origin.y, v.z - origin.z});
  for (const Material& material : scene.materials()) builder_.add_material(material);
  for (const Patch& patch : scene.patches()) (void)builder_.patch(patch.name);
  for (std::size_t f = 0; f < scene.faces().size(); ++f) {
    const Face& face = scene.faces()[f];
    const auto id = static_cast<FaceId>(f);
    builder_.add_face(face.patch, face.material, rings_of(face));
    if (face.piece_count > 0) copy_texture(scene, id, face.rings, builder_);
    if (face.is_twin) builder_.mark_as_twin();
    if (face.transparent) transparent_.push_back(id);
  }
}

PatchId SceneCopy::add_patch(std::string name) {
  while (has_patch(scene_, name)) name += '\'';
  return builder_.patch(name);
}

void SceneCopy::add_face(PatchId patch, std::vector<std::uint32_t> corners) {
  transparent_.push_back(next_face());
  builder_.add_face(patch, scene_.faces().front().material, {std::move(corners)});
}

void SceneCopy::add_twin(PatchId patch, const Face& face) {
  const FaceId twin = next_face();
  if (face.transparent) transparent_.push_back(twin);
  Rings rings = face.rings;
  for (std::vector<std::uint32_t>& ring : rings) std::ranges::reverse(ring);
  builder_.add_face(patch, face.material, std::move(rings));
  builder_.mark_as_twin();
}

std::optional<Scene> near_origin(const Scene& scene) {
  constexpr double kFar = 16.0;
  struct Range {
    double low = HUGE_VAL, high = -HUGE_VAL;
  };
  std::array<Range, 3> ranges;
  for (const Vec3& v : scene.vertices()) {
    const std::array<double, 3> at{v.x, v.y, v.z};
    for (std::size_t k = 0; k < 3; ++k) {
      ranges[k].low = std::min(ranges[k].low, at[k]);
      ranges[k].high = std::max(ranges[k].high, at[k]);
    }
  }
  double extent = 0.0;
  for (const Range& range : ranges) extent = std::max(extent, range.high - range.low);
  const auto origin_of = [&](const Range& range) {
    const double nearest = range.low > 0.0 ? range.low : range.high < 0.0 ? -range.high : 0.0;
    return nearest >= kFar * extent ? range.low : 0.0;
  };
  const Vec3 origin{origin_of(ranges[0]), origin_of(ranges[1]), origin_of(ranges[2])};
  if (!(extent > 0.0) || (origin.x == 0.0 && origin.y == 0.0 && origin.z == 0.0)) return std::nullopt;
  return SceneCopy(scene, origin).take();
}

// --- Copies in which some faces are turned round or transparent ---

namespace {

void flip(Face& face) {
  for (std::vector<std::uint32_t>& ring : face.rings) std::reverse(ring.begin(), ring.end());
  face.newell = {0.0 - face.newell.x, 0.0 - face.newell.y, 0.0 - face.newell.z};  // never -0
  face.flipped = !face.flipped;
  if (face.file_normals != FileNormals::kNone) {
    face.file_normals = face.file_normals == FileNormals::kAgree ? FileNormals::kContradict : FileNormals::kAgree;
  }
}

void flip(Texture& texture, const Face& face, FaceId id) {
  if (index_of(id) >= texture.first.size() || texture.first[index_of(id)] == Texture::kNone) return;
  auto first = texture.points.begin() + texture.first[index_of(id)];
  for (const std::vector<std::uint32_t>& ring : face.rings) {
    const auto last = first + static_cast<std::ptrdiff_t>(ring.size());
    std::reverse(first, last);
    first = last;
  }
}

void flip(Piece& piece, std::vector<std::uint32_t>& corners) {
  const auto first = corners.begin() + piece.first_corner;
  std::reverse(first, first + piece.corner_count);
  std::swap(piece.frame[1], piece.frame[2]);
}

std::unique_ptr<SceneInside::Data> copy_of(const SceneInside::Data& data) {
  auto copy = std::make_unique<SceneInside::Data>();
  copy->file = data.file;
  copy->files = data.files;
  copy->unit = data.unit;
  copy->vertices = data.vertices;
  copy->materials = data.materials;
  copy->patches = data.patches;
  copy->patch_by_name = data.patch_by_name;
  copy->faces = data.faces;
  copy->pieces = data.pieces;
  copy->corners = data.corners;
  copy->textures = data.textures;
  copy->warnings = data.warnings;
  copy->warnings_of_glass = data.warnings_of_glass;
  return copy;
}

}  // namespace

Scene regrouped(const Scene& scene, const std::vector<std::string>& names,
                const std::vector<std::size_t>& patch_of_face, std::vector<Problem> warnings) {
  auto copy = copy_of(SceneInside::data(scene));
  std::ranges::move(warnings, std::back_inserter(copy->warnings));
  std::vector<std::vector<FaceId>> faces(names.size());
  for (std::size_t f = 0; f < patch_of_face.size(); ++f) faces[patch_of_face[f]].push_back(static_cast<FaceId>(f));
  copy->patches.clear();
  copy->patch_by_name.clear();
  for (std::size_t p = 0; p < names.size(); ++p) {
    if (faces[p].empty()) continue;
    const auto patch = static_cast<PatchId>(copy->patches.size());
    for (std::size_t k = 0; k < faces[p].size(); ++k) {
      Face& face = copy->faces[index_of(faces[p][k])];
      face.patch = patch;
      face.number = static_cast<std::uint32_t>(k + 1);
    }
    copy->patch_by_name.emplace(names[p], patch);
    copy->patches.push_back({names[p], std::move(faces[p])});
  }
  return SceneInside::of(std::move(copy));
}

Scene Scene::with_flipped(std::span<const Selection> selections) const {
  const kernel::StandardArithmetic arithmetic;
  auto copy = copy_of(data());
  for (const FaceId id : exactff::faces_of(*this, selections)) {
    Face& face = copy->faces[index_of(id)];
    for (Texture& texture : copy->textures) flip(texture, face, id);
    flip(face);
    for (std::uint32_t p = 0; p < face.piece_count; ++p) flip(copy->pieces[face.first_piece + p], copy->corners);
  }
  return Scene(std::move(copy));
}

Scene Scene::with_transparent(std::span<const Selection> selections) const {
  const kernel::StandardArithmetic arithmetic;
  auto copy = copy_of(data());
  for (const FaceId id : exactff::faces_of(*this, selections)) {
    Face& face = copy->faces[index_of(id)];
    face.transparent = true;
    for (std::uint32_t p = 0; p < face.piece_count; ++p) copy->pieces[face.first_piece + p].transparent = true;
  }
  Scene changed(std::move(copy));
  changed.set_warnings_of_glass();
  return changed;
}

Scene with_faces(const Scene& scene, std::vector<FaceId> flipped, std::vector<FaceId> transparent) {
  if (flipped.empty()) return scene.with_transparent(selections_of(scene, std::move(transparent)));
  const Scene turned = scene.with_flipped(selections_of(scene, std::move(flipped)));
  return turned.with_transparent(selections_of(turned, std::move(transparent)));
}

Scene Scene::with_unit(Unit unit) const {
  auto copy = copy_of(data());
  copy->unit = unit;
  return Scene(std::move(copy));
}

void Scene::set_warnings_of_glass() {
  std::vector<Problem>& warnings = data_->warnings;
  warnings.erase(warnings.begin(), warnings.begin() + static_cast<std::ptrdiff_t>(data_->warnings_of_glass));
  std::vector<Problem> glass = warnings_of_opaque_glass(*this);
  data_->warnings_of_glass = glass.size();
  warnings.insert(warnings.begin(), std::move_iterator(glass.begin()), std::move_iterator(glass.end()));
}

std::vector<Selection> Scene::flipped() const {
  return selections_of(*this, faces_where(*this, [](const Face& face) { return face.flipped; }));
}

std::vector<Selection> Scene::transparent() const {
  return selections_of(*this, faces_where(*this, [](const Face& face) { return face.transparent; }));
}

}  // namespace exactff
