// Wavefront OBJ.
//
// 1. Lines are read once, in order; vertices go to the builder, faces are kept with the current group, object and
//    material. A positive index may refer to a vertex further down, so the indices are checked at the end.
// 2. The patches are the groups if the file has any, otherwise the objects.
// 3. The MTL files are read, materials get their values, the faces go to the builder.
// Problems are collected throughout; those found so far are thrown before the builder looks at the faces.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <unordered_map>
#include <utility>

#include "exactff/scene_files.h"
#include "formats/mesh_input.h"
#include "formats/mtl_reader.h"
#include "kernel/float_environment.h"
#include "kernel/vec.h"
#include "scene/scene.h"
#include "text/encoding.h"
#include "text/number_text.h"
#include "text/phrases.h"
#include "text/refuse.h"
#include "text/text_lines.h"

namespace exactff {
namespace {

namespace fs = std::filesystem;

using formats::at_line;
using formats::kDefaultPatch;
using formats::kNoMaterial;

constexpr const char* kPurpose = "a Wavefront OBJ file";
constexpr std::uint32_t kNoTexture = std::numeric_limits<std::uint32_t>::max(), kBadTexture = kNoTexture - 1;
constexpr std::size_t kMostIndices = std::numeric_limits<std::uint32_t>::max();

// Distinct names in the order of their first use, in UTF-8.
class NameTable {
 public:
  explicit NameTable(std::string_view first) { index(first); }

  std::uint32_t index(std::string_view name) {
    const auto [place, is_new] = index_.emplace(name, static_cast<std::uint32_t>(names_.size()));
    if (is_new) names_.push_back(text::in_utf8(name));
    return place->second;
  }
  // As it is in the file.
  bool contains(const std::string& name) const { return index_.contains(name); }
  const std::vector<std::string>& names() const { return names_; }

 private:
  std::vector<std::string> names_;
  std::unordered_map<std::string, std::uint32_t> index_;
};

struct ObjFace {
  std::size_t line = 0;
  std::uint32_t group = 0;
  std::uint32_t object = 0;
  std::uint32_t material = 0;
  std::size_t first_corner = 0;
  std::size_t corner_count = 0;
};

// Lines of one kind, reported in one warning together.
struct Tally {
  std::size_t count = 0;
  std::size_t first_line = 0;
  std::string first;

  void add(std::size_t line, std::string_view text) {
    if (count++ > 0) return;
    first_line = line;
    first = text::in_quotes(text);
  }
  std::string others() const {
    if (count < 2) return {};
    return " (and on " + std::to_string(count - 1) + (count == 2 ? " more line)" : " more lines)");
  }
};

// Numbers and indices hold no '#': there, a comment may follow without a blank.
std::string_view before_comment(std::string_view values) { return values.substr(0, values.find('#')); }

enum class IndexText { kNumber, kTooLong, kOther };

IndexText parse_index(std::string_view text, long& index) {
  if (text.starts_with('+')) text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
  if (end != text.data() + text.size() || text.empty() || error == std::errc::invalid_argument)
    return IndexText::kOther;
  return error == std::errc() ? IndexText::kNumber : IndexText::kTooLong;
}

// v, v/vt, v//vn, v/vt/vn, also v/ and v//: vt and vn must be numbers.
bool well_formed_tail(std::string_view tail) {
  if (std::count(tail.begin(), tail.end(), '/') > 2) return false;
  while (!tail.empty()) {
    tail.remove_prefix(1);
    const std::string_view part = tail.substr(0, tail.find('/'));
    long ignored = 0;
    if (!part.empty() && parse_index(part, ignored) == IndexText::kOther) return false;
    tail.remove_prefix(part.size());
  }
  return true;
}

class ObjReader {
 public:
  ObjReader(std::string_view text, const fs::path& path, const SceneOptions& options)
      : path_(path), input_(path, options, kPurpose, formats::MeshInput::Materials::kOfReader), lines_(text) {}

  Scene run() {
    while (lines_.next(line_)) read_line();
    input_.warn_if_cut_off(lines_, line_.number);
    check_indices();
    check_names();
    warn_tallies();
    read_libraries();
    input_.problems().throw_if_any();
    add_materials();
    add_faces();
    return input_.build();
  }

 private:
  void read_line() {
    std::string_view rest = line_.text;
    const std::string_view keyword = text::take_word(rest);
    if (keyword.empty()) return;
    if (keyword == "v") return read_vertex(rest);
    if (keyword == "vn") return read_normal(rest);
    if (keyword == "vt") return read_texture(rest);
    if (keyword == "f" || keyword == "fo") return read_face(rest);
    if (keyword == "g") return read_group(rest);
    if (keyword == "o") {
      const std::string_view name = text::trimmed(rest);
      current_.object = index_in(objects_, name.empty() ? kDefaultPatch : name);
    } else if (keyword == "usemtl") {
      use_material(text::trimmed(rest));
    } else if (keyword == "mtllib") {
      libraries_.emplace_back(line_.number, text::trimmed(rest));
    } else {
      static const std::set<std::string_view> kGeometry = {"curv", "curv2", "surf", "bzp", "bsp",
                                                           "cdc",  "cdp",   "res",  "call"};
      static const std::set<std::string_view> kPassedOver = {
          "vp",        "p",     "l",        "s",        "mg",     "lod", "usemap", "maplib", "shadow_obj",
          "trace_obj", "bevel", "c_interp", "d_interp", "cstype", "deg", "bmat",   "step",   "parm",
          "trim",      "hole",  "scrv",     "sp",       "end",    "con", "ctech",  "stech",  "csh"};
      if (kGeometry.contains(keyword))
        unread_geometry_.add(line_.number, keyword);
      else if (!kPassedOver.contains(keyword))
        unknown_.add(line_.number, keyword);
    }
  }

  // A faulty vertex still counts, so that the indices in the faces below stay correct. Text after x, y and z (a weight
  // or a colour) is ignored.
  void read_vertex(std::string_view values) {
    values = before_comment(values);
    input_.add_vertex(input_.take_point(values, line_.number, "write v x y z"), at_line(line_.number));
  }

  // No value depends on a normal, so an unreadable one only counts, with a length of 0.
  void read_normal(std::string_view values) {
    values = before_comment(values);
    std::array<double, 3> xyz{};
    for (double& coordinate : xyz) {
      const text::ParsedNumber number = text::parse_number(text::take_word(values));
      if (number.fault != text::NumberFault::kNone) {
        xyz = {};
        break;
      }
      coordinate = number.value;
    }
    const double largest = std::max({std::abs(xyz[0]), std::abs(xyz[1]), std::abs(xyz[2])});
    for (double& coordinate : xyz) coordinate = largest > 0.0 ? coordinate / largest : 0.0;
    normals_.push_back({xyz[0], xyz[1], xyz[2]});
  }

  // A lone number is u; v is 0 then. No form factor depends on them, so an unreadable one is no problem.
  void read_texture(std::string_view values) {
    values = before_comment(values);
    const text::ParsedNumber u = text::parse_number(text::take_word(values));
    const std::string_view second = text::take_word(values);
    const text::ParsedNumber v = text::parse_number(second.empty() ? "0" : second);
    const bool sound = u.fault == text::NumberFault::kNone && v.fault == text::NumberFault::kNone;
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    textures_.push_back(sound ? TexturePoint{u.value, v.value} : TexturePoint{kNaN, kNaN});
  }

  // The second number of a corner. It may refer to a vt further down.
  void note_texture_of(std::string_view corner) {
    const std::size_t slash = corner.find('/');
    if (slash == std::string_view::npos) return;
    const std::string_view text = corner.substr(slash + 1, corner.find('/', slash + 1) - slash - 1);
    if (text.empty()) return;
    long index = 0;
    const bool is_number = parse_index(text, index) == IndexText::kNumber;
    const long position = index > 0 ? index - 1 : static_cast<long>(textures_.size()) + index;
    const bool possible = is_number && index != 0 && position >= 0 && std::cmp_less(position, kNoTexture);
    texture_corners_.resize(corners_.size(), kNoTexture);
    texture_corners_.back() = possible ? static_cast<std::uint32_t>(position) : kBadTexture;
  }

  // The third number of a corner. A vn further down says nothing: all programs write them before the faces.
  void add_normal_of(std::string_view corner, Vec3& sum) const {
    const std::size_t slash = corner.rfind('/');
    if (slash == std::string_view::npos || corner.find('/') == slash) return;
    long index = 0;
    if (parse_index(corner.substr(slash + 1), index) != IndexText::kNumber || index == 0) return;
    const auto count = static_cast<long>(normals_.size());
    const long position = index > 0 ? index - 1 : count + index;
    if (position < 0 || position >= count) return;
    sum = kernel::sum(sum, normals_[static_cast<std::size_t>(position)]);
  }

  void read_face(std::string_view corners) {
    ObjFace face = current_;
    face.line = line_.number;
    face.first_corner = corners_.size();
    bool sound = true;
    Vec3 normal;
    corners = before_comment(corners);
    for (std::string_view word = text::take_word(corners); !word.empty(); word = text::take_word(corners)) {
      const std::optional<std::uint32_t> corner = read_corner(word);
      sound = sound && corner;
      if (corner) corners_.push_back(*corner);
      if (corner) note_texture_of(word);
      if (corner && !normals_.empty()) add_normal_of(word, normal);
    }
    if (normal != Vec3{}) face_normals_.emplace_back(faces_.size(), normal);
    face.corner_count = corners_.size() - face.first_corner;
    if (corners_.size() > kMostIndices || faces_.size() == kMostIndices) {
      input_.give_up(at_line(line_.number), "more than 4294967295 faces or corners of faces", "indices have 32 bits",
                     "split the scene");
    }
    if (sound) (void)input_.is_polygon(face.corner_count, at_line(line_.number));
    faces_.push_back(face);
  }

  // Counted from 0; not yet checked against the end of the vertex list.
  std::optional<std::uint32_t> read_corner(std::string_view corner) {
    const std::size_t slash = std::min(corner.find('/'), corner.size());
    const auto count = static_cast<long>(input_.vertex_count());
    long index = 0;
    const IndexText kind = parse_index(corner.substr(0, slash), index);
    if (kind == IndexText::kOther || !well_formed_tail(corner.substr(slash))) {
      fail(text::in_quotes(corner) + " is not a valid corner of a face", "a corner is a vertex number",
           "write v, v/vt, v//vn or v/vt/vn");
      return std::nullopt;
    }
    if (kind == IndexText::kNumber && index == 0) {
      fail("vertex 0 does not exist", "vertices are numbered from 1, or backwards from -1", "correct the index");
      return std::nullopt;
    }
    const long position = index > 0 ? index - 1 : count + index;
    if (kind == IndexText::kTooLong || position < 0 || std::cmp_greater_equal(position, kMostIndices)) {
      fail("vertex " + std::string(corner.substr(0, std::min<std::size_t>(slash, 40))) + " does not exist",
           "the lines before define " + std::to_string(count) + " vertices", "correct the index");
      return std::nullopt;
    }
    return static_cast<std::uint32_t>(position);
  }

  std::uint32_t index_in(NameTable& table, std::string_view name) {
    if (!text::is_utf8(name)) converted_.add(line_.number, name);
    return table.index(name);
  }

  void read_group(std::string_view names) {
    has_groups_ = true;
    const std::string_view all = text::trimmed(names);
    const std::string_view first = text::take_word(names);
    current_.group = index_in(groups_, first.empty() ? kDefaultPatch : first);
    if (!text::trimmed(names).empty()) several_groups_.add(line_.number, all);
  }

  void use_material(std::string_view name) {
    current_.material = index_in(materials_, name.empty() ? kNoMaterial : name);
    if (current_.material == material_line_.size()) material_line_.push_back(line_.number);
  }

  void check_indices() {
    const std::size_t count = input_.vertex_count();
    for (const ObjFace& face : faces_) {
      for (std::size_t i = face.first_corner; i < face.first_corner + face.corner_count; ++i) {
        if (corners_[i] < count) continue;
        input_.fail(at_line(face.line), "vertex " + std::to_string(corners_[i] + 1ULL) + " does not exist",
                    "the file has " + text::counted(count, "vertex", "vertices"), "correct the index");
      }
    }
  }

  // A file that mixes encodings may have two names that become one.
  void check_names() {
    for (const std::string& name : converted_.names()) {
      const std::string converted = text::in_utf8(name);
      for (const NameTable* table : {&groups_, &objects_, &materials_}) {
        if (!table->contains(name) || !table->contains(converted)) continue;
        input_.fail({}, "the name " + text::in_quotes(converted) + " is written in UTF-8 and in Latin-1",
                    "they might be meant as two names", "save the file as UTF-8");
      }
    }
  }

  void warn_tallies() {
    if (!converted_.names().empty()) input_.builder().warn(converted_.warning(input_.file()));
    warn(several_groups_, "g " + several_groups_.first + " names several groups", "a face belongs to one patch",
         "the first name is used");
    warn(unread_geometry_, unread_geometry_.first + " is not read",
         "curves, surfaces and references to other files are not polygons", "convert them to faces");
    warn(unknown_, "unknown keyword " + unknown_.first, "the line is ignored", "is it a Wavefront OBJ file?");
  }

  void read_libraries() {
    std::set<fs::path> done;
    for (const auto& [line, names] : libraries_) {
      for (const fs::path& path : library_paths(names)) {
        if (done.insert(path).second) read_library(path, line);
      }
    }
  }

  void read_library(const fs::path& path, std::size_t line) {
    std::error_code error;
    std::optional<std::string> text;
    std::string why;
    try {
      // Only a plain file: a device or a pipe named in a scene could keep the reader waiting for ever.
      if (fs::is_regular_file(path, error)) text = text::read_text_file(path, "a Wavefront MTL file");
    } catch (const InputError& unreadable) {
      const Problem& problem = unreadable.problems().front();
      why = problem.what + ": " + problem.why + "; ";
    }
    if (!text) {
      library_missing_ = true;
      return input_.warn(at_line(line),
                         "material file " + text::in_quotes(path.string(), text::kShownName) + " cannot be read",
                         why + "its materials get Kd 1, Ke 0", "add the file if colours or emission matter");
    }
    input_.builder().read_from(path);
    text::ProblemList warnings;
    for (Material& material : read_mtl(*text, path.string(), input_.problems(), warnings)) {
      defined_.try_emplace(material.name, std::move(material));
    }
    for (Problem& warning : warnings.take("warnings")) input_.builder().warn(std::move(warning));
  }

  // A name may contain blanks; one line may hold several names. Backslashes are read as slashes if necessary.
  std::vector<fs::path> library_paths(std::string_view names) const {
    const auto beside = [&](std::string_view name) {
      const fs::path as_written = path_.parent_path() / name;
      if (name.find('\\') == std::string_view::npos) return as_written;
      std::string other(name);
      std::replace(other.begin(), other.end(), '\\', '/');
      std::error_code ignored;
      return fs::exists(as_written, ignored) ? as_written : path_.parent_path() / other;
    };
    std::error_code ignored;
    if (fs::exists(beside(names), ignored)) return {beside(names)};
    std::set<std::string_view> seen;
    std::vector<fs::path> paths;
    for (std::string_view name = text::take_word(names); !name.empty(); name = text::take_word(names)) {
      if (seen.insert(name).second) paths.push_back(beside(name));
    }
    return paths;
  }

  void add_materials() {
    const std::vector<std::string>& names = materials_.names();
    for (std::size_t i = 0; i < names.size(); ++i) {
      const auto definition = defined_.find(names[i]);
      input_.material(definition != defined_.end() ? definition->second : Material{names[i]});
      if (definition != defined_.end() || i == 0 || library_missing_) continue;
      input_.warn(at_line(material_line_[i]), "material " + text::in_quotes(names[i]) + " is not defined",
                  "it gets Kd 1, Ke 0", "define it in a file named by mtllib");
    }
  }

  // Patches are made in the order of their first faces.
  void add_faces() {
    const std::vector<std::string>& names = has_groups_ ? groups_.names() : objects_.names();
    std::vector<std::optional<PatchId>> patches(names.size());
    auto normal = face_normals_.begin();
    for (std::size_t i = 0; i < faces_.size(); ++i) {
      const ObjFace& face = faces_[i];
      const std::uint32_t name = has_groups_ ? face.group : face.object;
      if (!patches[name]) patches[name] = input_.patch(names[name]);
      const auto first = corners_.begin() + static_cast<std::ptrdiff_t>(face.first_corner);
      input_.add_face(*patches[name], static_cast<MaterialId>(face.material),
                      {first, first + static_cast<std::ptrdiff_t>(face.corner_count)}, at_line(face.line));
      add_texture_of(face);
      if (normal != face_normals_.end() && normal->first == i) input_.builder().state_normal((normal++)->second);
    }
    warn(without_texture_, "a face has no valid vt at one of its corners",
         "it has none then, and lightmaps leave it out; nothing else depends on it",
         "give every corner the number of a vt");
  }

  void add_texture_of(const ObjFace& face) {
    std::vector<TexturePoint> points;
    std::size_t faults = 0;
    for (std::size_t c = face.first_corner; c < face.first_corner + face.corner_count; ++c) {
      const std::uint32_t index = c < texture_corners_.size() ? texture_corners_[c] : kNoTexture;
      const bool exists = index < textures_.size() && std::isfinite(textures_[index].u);
      if (exists) points.push_back(textures_[index]);
      if (!exists && index != kNoTexture) ++faults;
    }
    const bool whole = points.size() == face.corner_count;
    if (faults > 0 || (!whole && !points.empty())) return without_texture_.add(face.line, "");
    if (whole && !points.empty()) input_.builder().state_texture(0, std::move(points));
  }

  void fail(std::string what, std::string why, std::string suggestion) {
    input_.fail(at_line(line_.number), std::move(what), std::move(why), std::move(suggestion));
  }
  // Of lines of one kind.
  void warn(const Tally& tally, const std::string& what, const char* why, const char* suggestion) {
    if (tally.count > 0) input_.warn(at_line(tally.first_line), what + tally.others(), why, suggestion);
  }

  const fs::path path_;
  formats::MeshInput input_;
  text::TextLines lines_;
  text::TextLine line_;

  std::vector<ObjFace> faces_;
  std::vector<std::uint32_t> corners_;                      // of all faces
  std::vector<TexturePoint> textures_;                      // vt; NaN if it cannot be read
  std::vector<std::uint32_t> texture_corners_;              // of the corners up to the last one with vt; kNoTexture
  std::vector<Vec3> normals_;                               // vn
  std::vector<std::pair<std::size_t, Vec3>> face_normals_;  // index into faces_, sum over its corners; by face
  NameTable groups_{kDefaultPatch};
  NameTable objects_{kDefaultPatch};
  NameTable materials_{kNoMaterial};
  std::vector<std::size_t> material_line_{0};  // of its first usemtl
  ObjFace current_;                            // group, object and material for the next face
  bool has_groups_ = false;
  std::vector<std::pair<std::size_t, std::string>> libraries_;  // line, names
  std::unordered_map<std::string, Material> defined_;
  bool library_missing_ = false;
  ConvertedNames converted_;
  Tally several_groups_;
  Tally unread_geometry_;
  Tally unknown_;
  Tally without_texture_;
};

}  // namespace

Scene formats::read_obj(std::string_view text, const fs::path& path, const SceneOptions& options) {
  if (text.empty()) text::refuse(path, "is empty", "there is nothing to compute with", "give a Wavefront OBJ file");
  return ObjReader(text, path, with_unit_of(text, options)).run();
}

Scene read_obj(std::istream& in, const fs::path& name, const SceneOptions& options) {
  const kernel::StandardArithmetic arithmetic;
  return formats::read_obj(text::read_text(in, name.string(), kPurpose), name, options);
}

Scene read_obj(const fs::path& path, const SceneOptions& options) {
  const kernel::StandardArithmetic arithmetic;
  return SceneInside::read_from(path, formats::read_obj(text::read_text_file(path, kPurpose), path, options));
}

}  // namespace exactff
