// Scenes of several files, and units that files state.
#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "exactff/scene_files.h"
#include "formats/mesh_input.h"
#include "scene/scene.h"
#include "text/text_lines.h"

namespace exactff::formats {

namespace fs = std::filesystem;

SceneOptions with_unit_of(std::string_view bytes, SceneOptions options) {
  constexpr std::size_t kHeadBytes = 4096, kLines = 20;
  text::PlainLines lines(bytes.substr(0, kHeadBytes));
  for (text::TextLine line; line.number < kLines && lines.next(line);) {
    const std::vector<std::string_view> words = text::words(line.text);
    if (words.size() != 3 || (words[0] != "#" && words[0] != "comment") || words[1] != "unit") continue;
    try {
      options.unit = unit_named(words[2]);
      break;
    } catch (const InputError&) {  // a comment about something else
    }
  }
  return options;
}

std::vector<fs::path> files_named(const fs::path& path) {
  std::error_code ignored;
  const std::string all = path.string();
  std::vector<fs::path> files;
  bool some_exist = false;
  for (std::size_t begin = 0; begin <= all.size();) {
    std::size_t end = all.size();
    const auto is_file = [&] { return fs::exists(all.substr(begin, end - begin), ignored); };
    while (end != std::string::npos && end > begin && !is_file()) end = all.rfind('+', end - 1);
    const bool exists = end != std::string::npos && end > begin;
    if (!exists) end = std::min(all.find('+', begin), all.size());  // its own name, to complain about
    some_exist = some_exist || exists;
    files.emplace_back(all.substr(begin, end - begin));
    begin = end + 1;
  }
  if (!some_exist) return {path};
  return files;
}

namespace {

// Puts the contents of scenes behind each other.
class Joining {
 public:
  explicit Joining(const fs::path& path) { joined_->file = path.string(); }

  // `names`: of its patches.
  void add(const Scene& scene, const std::string& file, const std::vector<std::string>& names) {
    const SceneInside::Data& data = SceneInside::data(scene);
    const auto vertices = static_cast<std::uint32_t>(joined_->vertices.size());
    const auto pieces = static_cast<std::uint32_t>(joined_->pieces.size());
    const auto corners = static_cast<std::uint32_t>(joined_->corners.size());
    const auto faces = static_cast<std::uint32_t>(joined_->faces.size());
    const auto patches = static_cast<std::uint32_t>(joined_->patches.size());
    append(joined_->vertices, data.vertices);
    append(joined_->files, data.files);
    joined_->warnings.insert(joined_->warnings.end(), data.warnings.begin() + static_cast<long>(data.warnings_of_glass),
                             data.warnings.end());
    std::vector<MaterialId> materials;
    for (const Material& material : data.materials) materials.push_back(place_of(material, file));
    for (std::size_t p = 0; p < names.size(); ++p) {
      Patch patch{names[p], data.patches[p].faces};
      for (FaceId& face : patch.faces) face = moved(face, faces);
      joined_->patch_by_name.emplace(patch.name, static_cast<PatchId>(joined_->patches.size()));
      joined_->patches.push_back(std::move(patch));
    }
    for (Face face : data.faces) {
      face.patch = moved(face.patch, patches);
      face.material = materials[index_of(face.material)];
      face.line = 0;
      face.first_piece += pieces;
      for (std::vector<std::uint32_t>& ring : face.rings) {
        for (std::uint32_t& v : ring) v += vertices;
      }
      joined_->faces.push_back(std::move(face));
    }
    for (Piece piece : data.pieces) {
      piece.face = moved(piece.face, faces);
      piece.first_corner += corners;
      for (std::uint32_t& v : piece.frame) v += vertices;
      joined_->pieces.push_back(piece);
    }
    for (const std::uint32_t v : data.corners) joined_->corners.push_back(v + vertices);
    for (std::size_t set = 0; set < data.textures.size(); ++set)
      add_texture(joined_->textures[set], data.textures[set], faces);
    joined_->unit = data.unit;
  }

  Scene take() { return SceneInside::of(std::move(joined_)); }

 private:
  template <class T>
  static void append(std::vector<T>& to, const std::vector<T>& from) {
    to.insert(to.end(), from.begin(), from.end());
  }
  template <class Id>
  static Id moved(Id id, std::uint32_t by) {
    return static_cast<Id>(static_cast<std::uint32_t>(id) + by);
  }

  static void add_texture(Texture& to, const Texture& from, std::size_t faces) {
    if (from.points.empty()) return;
    const auto points = static_cast<std::uint32_t>(to.points.size());
    to.first.resize(faces, Texture::kNone);
    for (const std::uint32_t first : from.first) to.first.push_back(first == Texture::kNone ? first : first + points);
    append(to.points, from.points);
  }

  // Of the same one, if it is there.
  MaterialId place_of(Material material, const std::string& file) {
    const auto found = std::ranges::find(joined_->materials, material.name, &Material::name);
    const bool same = found != joined_->materials.end() && found->reflectance == material.reflectance &&
                      found->radiosity == material.radiosity && found->see_through == material.see_through;
    if (same) return static_cast<MaterialId>(found - joined_->materials.begin());
    if (found != joined_->materials.end()) material.name = file + '/' + material.name;
    joined_->materials.push_back(std::move(material));
    return static_cast<MaterialId>(joined_->materials.size() - 1);
  }

  std::unique_ptr<SceneInside::Data> joined_ = std::make_unique<SceneInside::Data>();
};

// Each name once: those that several files use begin with the file's.
std::vector<std::vector<std::string>> distinct_names(const std::vector<Scene>& scenes,
                                                     const std::vector<std::string>& files) {
  std::vector<std::vector<std::string>> names;
  std::map<std::string, std::size_t> uses;
  for (std::size_t s = 0; s < scenes.size(); ++s) {
    names.emplace_back();
    for (const Patch& patch : scenes[s].patches())
      names[s].push_back(patch.name == kDefaultPatch ? files[s] : patch.name);
    for (const std::string& name : std::set<std::string>(names[s].begin(), names[s].end())) ++uses[name];
  }
  std::set<std::string> taken;
  for (std::size_t s = 0; s < scenes.size(); ++s) {
    for (std::string& name : names[s]) {
      if (uses[name] > 1 && name != files[s]) name = files[s] + '/' + name;
      const std::string stem = name;
      for (std::size_t k = 2; !taken.insert(name).second; ++k) name = stem + '_' + std::to_string(k);
    }
  }
  return names;
}

}  // namespace

Scene read_several(const fs::path& path, const std::vector<fs::path>& files, const SceneOptions& options) {
  SceneOptions one = options;
  one.patches = PatchMode::kGroups;
  std::vector<Scene> scenes;
  std::vector<std::string> stems;
  text::ProblemList problems;
  for (const fs::path& file : files) {
    try {
      scenes.push_back(read_scene(file, one));
      stems.push_back(file.stem().string());
      if (one.convert_to == Unit::kNone) one.convert_to = scenes.front().unit();
      if (scenes.back().unit() != scenes.front().unit())
        problems.add(
            {files.front().string(), 0, "does not say its unit of length", file.string() + " does", "give --unit"});
    } catch (const InputError& error) {
      for (const Problem& problem : error.problems()) problems.add(problem);
    }
  }
  problems.throw_if_any();
  Joining joining(path);
  const std::vector<std::vector<std::string>> names = distinct_names(scenes, stems);
  for (std::size_t s = 0; s < scenes.size(); ++s) joining.add(scenes[s], stems[s], names[s]);
  Scene joined = joining.take();
  return options.patches == PatchMode::kGroups ? std::move(joined) : with_patches(joined, options);
}

}  // namespace exactff::formats
