#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include "kernel/expect.h"
#include "kernel/float_environment.h"
#include "kernel/numbers.h"
#include "kernel/vec.h"
#include "scene/scene.h"
#include "scene/triangulation.h"
#include "text/names.h"
#include "text/phrases.h"
#include "text/refuse.h"
#include "text/text_lines.h"

namespace exactff {
namespace {

struct UnitRow {
  Unit unit;
  std::string_view name;
  int tenths;  // of a millimetre
};
constexpr std::array<UnitRow, 6> kUnits = {{{Unit::kNone, "", 0},
                                            {Unit::kMillimetre, "mm", 10},
                                            {Unit::kCentimetre, "cm", 100},
                                            {Unit::kMetre, "m", 10000},
                                            {Unit::kInch, "in", 254},
                                            {Unit::kFoot, "ft", 3048}}};

int tenths_of_millimetres(Unit unit) { return std::ranges::find(kUnits, unit, &UnitRow::unit)->tenths; }

}  // namespace

std::string_view name_of(Unit unit) { return std::ranges::find(kUnits, unit, &UnitRow::unit)->name; }

double metres(Unit unit) {
  const kernel::StandardArithmetic arithmetic;
  return unit == Unit::kNone ? 1.0 : tenths_of_millimetres(unit) / 1e4;
}

Unit unit_named(std::string_view text) {
  const auto* const found = std::ranges::find(kUnits, text, &UnitRow::name);
  if (found != kUnits.end() && found->unit != Unit::kNone) return found->unit;
  text::refuse(text::in_quotes(text) + " is no unit of length", "units are mm, cm, m, in and ft", "choose one of them");
}

using Rings = std::vector<std::vector<std::uint32_t>>;

struct SceneBuilder::State {
  SceneOptions options;
  std::unique_ptr<Scene::Data> data = std::make_unique<Scene::Data>();
  text::ProblemList problems;
  text::ProblemList warnings;
  std::size_t zero_area_count = 0;
  std::size_t first_zero_area = 0;
  std::size_t bent_count = 0;  // faces that are worth a warning
  std::size_t first_bent = 0;
  double most_bent = 0.0;
  std::vector<std::pair<FaceId, Vec3>> stated_normals;

  void check_vertices();
  void convert_unit();
  void check_materials();
  void check_names();
  bool check_indices(const Face& face);
  void drop_texture_points(FaceId id, const Rings& kept);
  void cut(FaceId id);
  void refuse(const Face& face, const FaceFault& fault);
  void add_parts(FaceId id, const std::vector<ConvexPart>& parts);
  void warn_out_of_plane();
  void judge_normals();
  void warn_zero_area();
  void warn_hidden_names();
  void split_patches();
  void index_names();

  std::string quoted(const Face& face) const {
    const std::string& name = data->patches[index_of(face.patch)].name;
    const std::string number = ":" + std::to_string(face.number);
    return "face " + (name.size() <= text::kShownName ? text::in_quotes(name + number, name.size() + number.size())
                                                      : text::in_quotes(name, text::kShownName) + number);
  }
};

SceneBuilder::SceneBuilder(std::string file, SceneOptions options) : state_(std::make_unique<State>()) {
  state_->options = options;
  state_->data->file = std::move(file);
  state_->data->unit = options.unit;
}
SceneBuilder::SceneBuilder(SceneBuilder&&) noexcept = default;
SceneBuilder& SceneBuilder::operator=(SceneBuilder&&) noexcept = default;
SceneBuilder::~SceneBuilder() = default;

SceneBuilder::State& SceneBuilder::state() const { return owned_by(state_, "SceneBuilder"); }

std::uint32_t SceneBuilder::add_vertex(const Vec3& position) {
  const kernel::StandardArithmetic arithmetic;
  auto& vertices = state().data->vertices;
  EXACTFF_EXPECT(vertices.size() < std::numeric_limits<std::uint32_t>::max());
  vertices.push_back({position.x + 0.0, position.y + 0.0, position.z + 0.0});  // turns -0 into +0
  return static_cast<std::uint32_t>(vertices.size() - 1);
}

std::size_t SceneBuilder::vertex_count() const { return state().data->vertices.size(); }

MaterialId SceneBuilder::add_material(Material material) {
  auto& materials = state().data->materials;
  materials.push_back(std::move(material));
  return MaterialId(static_cast<std::uint32_t>(materials.size() - 1));
}

PatchId SceneBuilder::patch(std::string_view name) {
  Scene::Data& data = *state().data;
  const auto next = static_cast<PatchId>(data.patches.size());
  const auto [place, is_new] = data.patch_by_name.emplace(name, next);
  if (is_new) data.patches.push_back({std::string(name), {}});
  return place->second;
}

void SceneBuilder::add_face(PatchId patch, MaterialId material, std::vector<std::vector<std::uint32_t>> rings,
                            std::size_t line) {
  Scene::Data& data = *state().data;
  if (index_of(patch) >= data.patches.size()) {
    refuse_argument("there is no patch " + std::to_string(index_of(patch)), "SceneBuilder::patch() creates patches");
  }
  if (index_of(material) >= data.materials.size()) {
    refuse_argument("there is no material " + std::to_string(index_of(material)), "add_material() creates materials");
  }
  std::vector<FaceId>& siblings = data.patches[index_of(patch)].faces;
  siblings.push_back(FaceId(static_cast<std::uint32_t>(data.faces.size())));
  Face face;
  face.patch = patch;
  face.material = material;
  face.number = static_cast<std::uint32_t>(siblings.size());
  face.line = line;
  face.rings = std::move(rings);
  data.faces.push_back(std::move(face));
}

void SceneBuilder::state_normal(const Vec3& normal) {
  const std::size_t count = state().data->faces.size();
  if (count == 0) refuse_argument("there is no face yet", "state_normal() is about the face added last");
  state().stated_normals.emplace_back(static_cast<FaceId>(count - 1), normal);
}

void SceneBuilder::state_texture(int set, std::vector<TexturePoint> corners) {
  Scene::Data& data = *state().data;
  Texture& all = data.textures[texture_set(set)];
  if (data.faces.empty()) refuse_argument("there is no face yet", "state_texture() is about the face added last");
  if (const std::size_t count = corner_count(data.faces.back().rings); corners.size() != count) {
    refuse_argument("there are " + std::to_string(corners.size()) + " texture coordinates",
                    "the face has " + std::to_string(count) + " corners");
  }
  const auto is_finite = [](const TexturePoint& p) { return std::isfinite(p.u) && std::isfinite(p.v); };
  if (!std::ranges::all_of(corners, is_finite)) return;
  EXACTFF_EXPECT(all.points.size() + corners.size() < Texture::kNone);
  all.first.resize(data.faces.size(), Texture::kNone);
  all.first.back() = static_cast<std::uint32_t>(all.points.size());
  all.points.insert(all.points.end(), corners.begin(), corners.end());
}

void SceneBuilder::mark_as_twin() {
  if (state().data->faces.empty())
    refuse_argument("there is no face yet", "mark_as_twin() is about the face added last");
  state().data->faces.back().is_twin = true;
}

void SceneBuilder::warn(Problem warning) { state().warnings.add(std::move(warning)); }

void SceneBuilder::set_unit(Unit unit) { state().data->unit = unit; }

void SceneBuilder::read_from(std::filesystem::path file) { state().data->files.push_back(std::move(file)); }

Scene SceneBuilder::build() {
  const kernel::StandardArithmetic arithmetic;
  static_cast<void>(state());
  const std::unique_ptr<State> taken = std::exchange(state_, std::make_unique<State>());
  State& state = *taken;
  state.check_vertices();
  state.convert_unit();
  state.check_materials();
  state.check_names();
  if (state.problems.empty()) {
    for (std::size_t i = 0; i < state.data->faces.size(); ++i) state.cut(FaceId(static_cast<std::uint32_t>(i)));
  }
  state.problems.throw_if_any();
  state.judge_normals();
  state.warn_zero_area();
  state.warn_out_of_plane();
  if (state.options.patches == PatchMode::kFaces) state.split_patches();
  state.warn_hidden_names();
  state.data->warnings = state.warnings.take("warnings");
  Scene scene(std::move(state.data));
  scene.set_warnings_of_glass();
  return state.options.patches > PatchMode::kFaces ? with_patches(scene, state.options) : std::move(scene);
}

void SceneBuilder::State::check_vertices() {
  for (std::size_t i = 0; i < data->vertices.size(); ++i) {
    const Vec3& v = data->vertices[i];
    if (kernel::is_finite(v)) continue;
    problems.add({data->file, 0, "vertex " + std::to_string(i + 1) + " is not finite",
                  "a coordinate is one exact number", "give finite coordinates"});
  }
}

void SceneBuilder::State::convert_unit() {
  const Unit from = std::exchange(data->unit, options.convert_to == Unit::kNone ? data->unit : options.convert_to);
  if (from == data->unit || !problems.empty()) return;
  if (from == Unit::kNone) {
    return problems.add({data->file, 0, "does not say its unit of length",
                         "another file is in " + std::string(name_of(data->unit)), "give --unit"});
  }
  const kernel::Rational factor(kernel::Integer(tenths_of_millimetres(from)), tenths_of_millimetres(data->unit));
  std::size_t rounded = 0;
  for (Vec3& v : data->vertices) {
    const Vec3 before = v;
    for (double Vec3::*const c : {&Vec3::x, &Vec3::y, &Vec3::z})
      v.*c = kernel::nearest_double(kernel::to_rational(before.*c) * factor);
    const kernel::RationalVec3 back = kernel::to_rational(kernel::is_finite(v) ? v : Vec3{});
    if (!kernel::is_zero(back - kernel::to_rational(before) * factor)) ++rounded;
  }
  check_vertices();
  warnings.add(
      {data->file, 0, "was converted from " + std::string(name_of(from)) + " to " + std::string(name_of(data->unit)),
       rounded == 0 ? "exactly" : text::counted_of(rounded, data->vertices.size(), "vertice") + " rounded, once", ""});
}

void SceneBuilder::State::check_materials() {
  const auto usable = [](const Rgb& c) {
    return std::ranges::all_of(std::array{c.r, c.g, c.b}, [](double v) { return std::isfinite(v) && v >= 0.0; });
  };
  for (const Material& material : data->materials) {
    if (usable(material.reflectance) && usable(material.radiosity)) continue;
    problems.add(
        {data->file, 0,
         "material " + text::in_quotes(material.name, text::kShownName) + " has a negative or infinite Kd or Ke",
         "reflectances and radiosities are finite and not negative", "correct it"});
  }
}

// A face is named by its patch's name and its number in messages, tables and, on request, as a patch of its own. If
// many faces shared a long name, their names would take far more memory than the file.
void SceneBuilder::State::check_names() {
  constexpr std::size_t kLongName = 255;
  constexpr std::size_t kMostBytes = std::size_t{1} << 26;
  for (const Patch& patch : data->patches) {
    if (patch.name.size() <= kLongName || patch.faces.size() < 2) continue;
    if (patch.faces.size() < kMostBytes / patch.name.size()) continue;
    problems.add({data->file, data->faces[index_of(patch.faces.front())].line,
                  "the name " + text::in_quotes(patch.name) + " of " + std::to_string(patch.name.size()) +
                      " characters belongs to " + std::to_string(patch.faces.size()) + " faces",
                  "the name of every face contains it", "choose a name of at most 255 characters"});
  }
}

bool SceneBuilder::State::check_indices(const Face& face) {
  for (const auto& ring : face.rings) {
    for (const std::uint32_t v : ring) {
      if (v < data->vertices.size()) continue;
      problems.add({data->file, face.line, quoted(face) + " refers to vertex " + std::to_string(v + 1ULL),
                    "there are " + std::to_string(data->vertices.size()) + " vertices", ""});
      return false;
    }
  }
  return true;
}

// Of corners that repeat their neighbours' position. Those kept are the first of their ring at that vertex.
void SceneBuilder::State::drop_texture_points(FaceId id, const Rings& kept) {
  const Rings& before = data->faces[index_of(id)].rings;
  if (corner_count(kept) == corner_count(before)) return;
  for (Texture& texture : data->textures) {
    if (index_of(id) >= texture.first.size() || texture.first[index_of(id)] == Texture::kNone) continue;
    auto from = texture.points.begin() + texture.first[index_of(id)], to = from;
    std::vector<TexturePoint> points;
    for (std::size_t r = 0; r < kept.size(); from += static_cast<std::ptrdiff_t>(before[r++].size())) {
      for (const std::uint32_t v : kept[r])
        points.push_back(*(from + (std::ranges::find(before[r], v) - before[r].begin())));
    }
    std::ranges::copy(points, to);
  }
}

void SceneBuilder::State::cut(FaceId id) {
  Face& face = data->faces[index_of(id)];
  if (!check_indices(face)) return;
  CutFace cut = cut_face(data->vertices, face.rings);
  drop_texture_points(id, cut.rings);
  face.rings = std::move(cut.rings);
  face.shape = cut.shape;
  face.newell = cut.newell;
  face.area = cut.area;
  face.out_of_plane = cut.out_of_plane;
  if (cut.fault) return refuse(face, *cut.fault);
  if (face.shape == FaceShape::kZeroArea && zero_area_count++ == 0) first_zero_area = index_of(id);
  add_parts(id, cut.parts);
  constexpr double kWorthSaying = 1e-6;
  if (face.out_of_plane <= kWorthSaying) return;
  if (bent_count++ == 0) first_bent = index_of(id);
  most_bent = std::max(most_bent, face.out_of_plane);
}

void SceneBuilder::State::refuse(const Face& face, const FaceFault& fault) {
  Problem problem{data->file, face.line, quoted(face) + " " + fault.what, fault.why, fault.suggestion};
  if (options.bad_faces == BadFaces::kReject) {
    problem.suggestion += ", or skip bad faces with --skip-bad-faces";
    problems.add(std::move(problem));
  } else {
    problem.suggestion = "the face is skipped";
    warnings.add(std::move(problem));
  }
}

void SceneBuilder::State::add_parts(FaceId id, const std::vector<ConvexPart>& parts) {
  Face& face = data->faces[index_of(id)];
  face.first_piece = static_cast<std::uint32_t>(data->pieces.size());
  face.piece_count = static_cast<std::uint32_t>(parts.size());
  for (const ConvexPart& part : parts) {
    data->pieces.push_back({id,
                            static_cast<std::uint32_t>(data->corners.size()),
                            static_cast<std::uint32_t>(part.corners.size()),
                            {part.frame[0], part.frame[1], part.frame[2]}});
    data->corners.insert(data->corners.end(), part.corners.begin(), part.corners.end());
  }
}

namespace {

std::string two_digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g", value);
  return text;
}

}  // namespace

// One warning for all, so that others are seen.
void SceneBuilder::State::warn_out_of_plane() {
  if (bent_count == 0) return;
  const Face& first = data->faces[first_bent];
  const std::string are = bent_count == 1
                              ? " is out of plane by "
                              : " and " + std::to_string(bent_count - 1) + " more are out of plane by up to ";
  warnings.add({data->file, first.line, quoted(first) + are + two_digits(most_bent) + " of the diameter",
                "a face that is not planar is cut into triangles, and another cut would give another surface",
                "use triangles if this matters; `exactff convert --triangulate` writes those of this cut, and where "
                "`exactff info` finds a gap, --weld makes walls along the axes planar"});
}

namespace {

// Zero and anything not finite give a vector without direction.
Vec3 unit_or_zero(const Vec3& v) {
  const double largest = kernel::max_norm(v);
  return largest > 0.0 && std::isfinite(largest) ? kernel::unit(v) : Vec3{};
}

}  // namespace

void SceneBuilder::State::judge_normals() {
  constexpr double kBesideThePlane = 0.1;  // the cosine; smoothed normals may lie almost in the plane of a face
  for (const auto& [id, normal] : stated_normals) {
    Face& face = data->faces[index_of(id)];
    const Vec3 a = unit_or_zero(face.newell), b = unit_or_zero(normal);
    const double cosine = kernel::dot(a, b);
    if (std::abs(cosine) <= kBesideThePlane) continue;
    face.file_normals = cosine > 0.0 ? FileNormals::kAgree : FileNormals::kContradict;
  }
}

void SceneBuilder::State::warn_zero_area() {
  if (zero_area_count == 0) return;
  const Face& first = data->faces[first_zero_area];
  const std::string what =
      zero_area_count == 1
          ? quoted(first) + " has no area and is ignored"
          : std::to_string(zero_area_count) + " faces have no area and are ignored, the first is " + quoted(first);
  warnings.add({data->file, first.line, what, "", ""});
}

// An exact patch name wins over NAME:k.
void SceneBuilder::State::warn_hidden_names() {
  for (const Patch& rival : data->patches) {
    const std::optional<text::NumberedName> hidden = text::numbered_name(rival.name);
    if (!hidden) continue;
    const auto owner = data->patch_by_name.find(hidden->patch);
    if (owner == data->patch_by_name.end()) continue;
    const std::vector<FaceId>& faces = data->patches[index_of(owner->second)].faces;
    if (hidden->number < 1 || hidden->number > faces.size()) continue;
    const Face& face = data->faces[index_of(faces[hidden->number - 1])];
    if (rival.name != hidden->patch + ":" + std::to_string(face.number)) continue;  // such as NAME:01
    warnings.add({data->file, face.line, quoted(face) + " cannot be named",
                  "a patch has the same name, and patch names take precedence", "rename the patch"});
  }
}

// Names stay distinct: the text after the last colon identifies the face, the text before it the group.
void SceneBuilder::State::split_patches() {
  std::vector<Patch> split;
  for (std::size_t i = 0; i < data->faces.size(); ++i) {
    Face& face = data->faces[i];
    const std::string& group = data->patches[index_of(face.patch)].name;
    split.push_back({group + ":" + std::to_string(face.number), {FaceId(static_cast<std::uint32_t>(i))}});
    face.patch = PatchId(static_cast<std::uint32_t>(i));
    face.number = 1;
  }
  data->patches = std::move(split);
  index_names();
}

void SceneBuilder::State::index_names() {
  data->patch_by_name.clear();
  for (std::size_t i = 0; i < data->patches.size(); ++i) {
    data->patch_by_name.emplace(data->patches[i].name, PatchId(static_cast<std::uint32_t>(i)));
  }
}

}  // namespace exactff
