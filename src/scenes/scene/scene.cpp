#include "scene/scene.h"

#include <fnmatch.h>

#include <algorithm>
#include <atomic>
#include <limits>
#include <numeric>
#include <set>
#include <tuple>
#include <utility>

#include "kernel/float_environment.h"
#include "kernel/vec.h"
#include "text/encoding.h"
#include "text/hashes.h"
#include "text/names.h"
#include "text/phrases.h"
#include "text/refuse.h"
#include "text/text_lines.h"

namespace exactff {

Scene::Scene(std::unique_ptr<Data> data) : data_(std::move(data)) {}
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;
Scene::~Scene() = default;

SceneId Scene::Data::next_id() {
  static std::atomic<std::uint64_t> last = 0;
  return SceneId{++last};
}

const Scene::Data& Scene::data() const { return owned_by(data_, "Scene"); }
SceneId Scene::id() const { return data().id; }
std::span<const Vec3> Scene::vertices() const { return data().vertices; }
std::span<const Material> Scene::materials() const { return data().materials; }
std::span<const Patch> Scene::patches() const { return data().patches; }
std::span<const Face> Scene::faces() const { return data().faces; }
std::span<const Piece> Scene::pieces() const { return data().pieces; }
std::span<const Problem> Scene::warnings() const { return data().warnings; }
Unit Scene::unit() const { return data().unit; }

std::span<const std::filesystem::path> Scene::files() const { return data().files; }

std::span<const std::uint32_t> Scene::corners(const Piece& piece) const {
  return std::span(data().corners).subspan(piece.first_corner, piece.corner_count);
}

std::span<const Piece> Scene::pieces_of(FaceId id) const {
  return pieces().subspan(face(id).first_piece, face(id).piece_count);
}

std::vector<FaceId> Scene::faces_of(const Selection& selection) const {
  require_of_scene(*this, selection);
  std::vector<FaceId> candidates;
  if (selection.face) {
    candidates.push_back(*selection.face);
  } else {
    candidates = patch(selection.patch).faces;
  }
  std::erase_if(candidates, [&](FaceId id) { return face(id).piece_count == 0; });
  return candidates;
}

namespace {

std::string choice_of_names(const Scene& scene, std::string_view wanted) {
  if (scene.patches().empty()) return "the scene has no patches";
  std::vector<std::string_view> names;
  for (const Patch& patch : scene.patches()) names.push_back(patch.name);
  constexpr std::size_t kShown = 6;
  std::string text =
      names.size() > kShown ? "the closest of its " + std::to_string(names.size()) + " patches are" : "the patches are";
  char separator = ':';
  for (const std::string_view name : text::nearest_names(names, wanted, kShown)) {
    text += separator;
    text += ' ' + text::in_quotes(name, text::kShownName);
    separator = ',';
  }
  return text;
}

}  // namespace

Selection Scene::select(std::string_view name) const {
  const auto& by_name = data().patch_by_name;
  if (const auto exact = by_name.find(std::string(name)); exact != by_name.end()) return {exact->second, {}, id()};
  const auto parts = text::numbered_name(name);
  const auto owner = parts ? by_name.find(parts->patch) : by_name.end();
  if (owner == by_name.end()) {
    if (!text::is_utf8(name)) return select(text::in_utf8(name));  // as the readers of scenes do with names
    text::refuse(data().file, "there is no patch named " + text::in_quotes(name, text::kShownName),
                 "names must match exactly", choice_of_names(*this, parts ? parts->patch : name));
  }
  const std::vector<FaceId>& faces = patch(owner->second).faces;
  if (parts->number < 1 || parts->number > faces.size()) {
    text::refuse(
        data().file, "there is no face " + text::in_quotes(name, text::kShownName),
        "patch " + text::in_quotes(parts->patch, text::kShownName) + " has " + text::counted(faces.size(), "face"),
        "faces are numbered from 1");
  }
  const FaceId face_id = faces[parts->number - 1];
  if (face(face_id).shape == FaceShape::kSkipped) {
    throw InputError({data().file, face(face_id).line,
                      "face " + text::in_quotes(name, text::kShownName) + " cannot be used",
                      "it was skipped as a bad face", "see the warning about it"});
  }
  return {owner->second, face_id, this->id()};
}

namespace {

// Whether the name is `whole`, followed by numbers after colons or slashes.
bool is_part_of(const std::string& name, std::string_view whole) {
  for (auto parts = text::part_name(name); parts; parts = text::part_name(parts->patch)) {
    if (parts->patch == whole) return true;
  }
  return false;
}

template <class IsWanted>
std::vector<Selection> selections_of_patches(const Scene& scene, const IsWanted& is_wanted) {
  std::vector<Selection> found;
  for (std::size_t p = 0; p < scene.patches().size(); ++p) {
    if (is_wanted(scene.patches()[p].name)) found.push_back({static_cast<PatchId>(p), {}, scene.id()});
  }
  return found;
}

// Patches whose names match; if there are none, faces NAME:k. Those without area only if no other matches.
std::vector<Selection> selections_like(const Scene& scene, std::string_view text) {
  const std::string pattern = text::is_utf8(text) ? std::string(text) : text::in_utf8(text);
  const auto matches = [&](const std::string& name) { return fnmatch(pattern.c_str(), name.c_str(), 0) == 0; };
  std::vector<Selection> found = selections_of_patches(scene, matches);
  if (found.empty()) {
    for (std::size_t f = 0; f < scene.faces().size(); ++f) {
      const Selection face{scene.faces()[f].patch, static_cast<FaceId>(f), scene.id()};
      if (scene.face(*face.face).shape != FaceShape::kSkipped && matches(scene.name_of(face))) found.push_back(face);
    }
  }
  const auto has_area = [&](const Selection& selection) { return !scene.faces_of(selection).empty(); };
  if (std::ranges::any_of(found, has_area)) std::erase_if(found, [&](const Selection& s) { return !has_area(s); });
  return found;
}

}  // namespace

bool Scene::is_pattern(std::string_view name) { return name.find_first_of("*?[") != std::string_view::npos; }

std::vector<Selection> Scene::select_all(std::string_view name) const {
  if (data().patch_by_name.contains(std::string(name))) return {select(name)};
  std::vector<Selection> found =
      selections_of_patches(*this, [&](const std::string& patch) { return is_part_of(patch, name); });
  if (!found.empty()) return found;
  if (!is_pattern(name)) return {select(name)};
  found = selections_like(*this, name);
  if (!found.empty()) return found;
  text::refuse(data().file, "no patch or face has a name like " + text::in_quotes(name, text::kShownName),
               "* stands for any text, ? for one character, [...] for one of several", choice_of_names(*this, name));
}

std::string Scene::name_of(const Selection& selection) const {
  require_of_scene(*this, selection);
  return selection.face ? patch(selection.patch).name + ":" + std::to_string(face(*selection.face).number)
                        : patch(selection.patch).name;
}

std::string Scene::name_of(FaceId id) const {
  const PatchId owner = face(id).patch;
  if (patch(owner).faces.size() == 1) return patch(owner).name;
  return name_of(Selection{owner, id, this->id()});
}

std::string Scene::name_of(std::span<const FaceId> faces) const {
  if (faces.empty()) return {};
  if (faces.size() == 1) return name_of(faces.front());
  std::string name = name_of(Selection{face(faces.front()).patch, faces.front(), id()});
  for (const FaceId id : faces.subspan(1)) name += '+' + std::to_string(face(id).number);
  return name;
}

std::vector<Selection> Scene::emitters() const {
  const kernel::StandardArithmetic arithmetic;
  std::vector<Selection> result;
  for (std::size_t p = 0; p < patches().size(); ++p) {
    const Selection whole{PatchId(static_cast<std::uint32_t>(p)), {}, id()};
    const std::vector<FaceId> faces = faces_of(whole);
    const auto emits = [&](FaceId id) { return material(face(id).material).emits(); };
    if (std::any_of(faces.begin(), faces.end(), emits)) result.push_back(whole);
  }
  return result;
}

Rgb Scene::source_radiosity(const Selection& source) const {
  const kernel::StandardArithmetic arithmetic;
  const std::vector<FaceId> faces = faces_of(source);
  const Rgb unit{1.0, 1.0, 1.0};
  if (faces.empty()) return unit;
  const Material& first = material(face(faces.front()).material);
  for (const FaceId id : faces) {
    const Material& other = material(face(id).material);
    if (other.radiosity == first.radiosity) continue;
    throw InputError({data().file, face(id).line, "the faces of source '" + name_of(source) + "' differ in Ke",
                      "'" + name_of(faces.front()) + "' has material '" + first.name + "', '" + name_of(id) +
                          "' has '" + other.name + "'; a source has one radiosity",
                      "name a single face, or put the faces into separate groups"});
  }
  return first.emits() ? first.radiosity : unit;
}

Rgb Scene::receiver_reflectance(std::span<const FaceId> on) const {
  if (on.empty()) return {1.0, 1.0, 1.0};
  require_face(*this, on.front());
  return material(face(on.front()).material).reflectance;
}

namespace {

void add_text(text::Fnv1a& hash, const std::string& text) {
  hash.add(std::uint64_t{text.size()});
  hash.add_bytes(text);
}

void add_colour(text::Fnv1a& hash, const Rgb& c) {
  for (const double v : {c.r, c.g, c.b}) hash.add(v);
}

constexpr std::uint64_t kTransparentBit = 0x100;

void add_face(text::Fnv1a& hash, const Face& face) {
  hash.add(static_cast<std::uint64_t>(face.patch));
  hash.add(static_cast<std::uint64_t>(face.material));
  hash.add(static_cast<std::uint64_t>(face.shape) | (face.transparent ? kTransparentBit : 0));
  hash.add(static_cast<std::uint64_t>(face.rings.size()));
  for (const auto& ring : face.rings) {
    hash.add(static_cast<std::uint64_t>(ring.size()));
    for (const std::uint32_t v : ring) hash.add(static_cast<std::uint64_t>(v));
  }
}

}  // namespace

std::string Scene::hash() const {
  text::Fnv1a hash;
  hash.add(static_cast<std::uint64_t>(vertices().size()));
  for (const Vec3& vertex : vertices()) hash.add(vertex);
  hash.add(static_cast<std::uint64_t>(materials().size()));
  for (const Material& m : materials()) {
    add_text(hash, m.name);
    add_colour(hash, m.reflectance);
    add_colour(hash, m.radiosity);
  }
  hash.add(static_cast<std::uint64_t>(patches().size()));
  for (const Patch& patch : patches()) add_text(hash, patch.name);
  hash.add(static_cast<std::uint64_t>(faces().size()));
  for (const Face& face : faces()) add_face(hash, face);
  return hash.digits();
}

namespace {

// For each vertex the first vertex at its position.
std::vector<std::uint32_t> position_ids(std::span<const Vec3> vertices) {
  const auto key = [&](std::uint32_t v) { return std::tuple(vertices[v].x, vertices[v].y, vertices[v].z); };
  std::vector<std::uint32_t> order(vertices.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return std::tuple(key(a), a) < std::tuple(key(b), b); });
  std::vector<std::uint32_t> id(vertices.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && vertices[order[i]] == vertices[order[i - 1]];
    id[order[i]] = same ? id[order[i - 1]] : order[i];
  }
  return id;
}

}  // namespace

std::span<const std::uint32_t> places(const Scene& scene) {
  const SceneInside::Data& data = SceneInside::data(scene);
  return data.places.made_by([&] { return position_ids(data.vertices); });
}

std::size_t Scene::open_edge_count() const {
  const kernel::StandardArithmetic arithmetic;
  const std::span<const std::uint32_t> id = places(*this);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const Face& face : faces()) {
    if (face.piece_count == 0) continue;
    for (const auto& ring : face.rings) {
      for (std::size_t i = 0; i < ring.size(); ++i) {
        edges.push_back(std::minmax(id[ring[i]], id[ring[(i + 1) % ring.size()]]));
      }
    }
  }
  std::sort(edges.begin(), edges.end());
  std::size_t open = 0;
  for (auto run = edges.begin(); run != edges.end();) {
    const auto end = std::find_if(run, edges.end(), [&](const auto& edge) { return edge != *run; });
    if ((end - run) % 2 == 1) ++open;
    run = end;
  }
  return open;
}

// --- Misuse ---

void refuse_argument(const std::string& what, const std::string& why) {
  throw std::invalid_argument(what + " (" + why + ")");
}

namespace {

void require_index(std::size_t index, std::size_t count, const std::string& kind, const std::string& kinds) {
  if (index < count) return;
  refuse_argument("there is no " + kind + " " + std::to_string(index),
                  "the scene has " + std::to_string(count) + " " + kinds + ", counted from 0");
}

}  // namespace

void require_face(const Scene& scene, FaceId face) {
  require_index(index_of(face), scene.faces().size(), "face", "faces");
}

void require_of_scene(const Scene& scene, SceneId made_by, const char* what) {
  if (made_by == scene.id()) return;
  refuse_argument("the " + std::string(what) + " belongs to another scene", "its ids have another meaning there");
}

void require_scene(const Scene* scene) {
  if (scene == nullptr)
    refuse_argument("the request has no scene", "set the pointer to a scene that lives as long as the request");
}

void require_of_scene(const Scene& scene, const Selection& selection) {
  require_of_scene(scene, selection.scene, "selection");
  require_index(index_of(selection.patch), scene.patches().size(), "patch", "patches");
  if (!selection.face) return;
  require_face(scene, *selection.face);
  if (scene.face(*selection.face).patch == selection.patch) return;
  refuse_argument("face " + std::to_string(index_of(*selection.face)) + " does not belong to patch '" +
                      scene.patch(selection.patch).name + "'",
                  "a selection is a patch or one of its own faces");
}

// --- Summary ---

namespace {

std::vector<MaterialId> materials_of(const Scene& scene, const Patch& patch) {
  std::vector<MaterialId> used;
  std::set<MaterialId> seen;
  for (const FaceId face : patch.faces) {
    const MaterialId material = scene.face(face).material;
    if (seen.insert(material).second) used.push_back(material);
  }
  return used;
}

std::optional<Vec3> common_front(const Scene& scene, const std::vector<FaceId>& faces) {
  constexpr double kSameWay = 0.999;  // the cosine of about 2.6 degrees
  Vec3 mean;
  for (const FaceId face : faces) mean = kernel::sum(mean, kernel::unit_by_inverse(scene.face(face).newell));
  mean = kernel::unit_by_inverse(mean);
  for (const FaceId face : faces) {
    const Vec3 n = kernel::unit_by_inverse(scene.face(face).newell);
    if (kernel::dot(n, mean) < kSameWay) return std::nullopt;
  }
  return faces.empty() ? std::nullopt : std::optional(mean);
}

// An estimate. Clamped to finite numbers, as the areas of faces are.
double sum_of_areas(double a, double b) { return std::min(a + b, std::numeric_limits<double>::max()); }

// Its corners and, weighted by its area, the mean of its pieces' centres.
void add_place(const Scene& scene, const Face& face, PatchSummary& summary) {
  Vec3 moment;
  double whole = 0.0;
  for (std::uint32_t p = 0; p < face.piece_count; ++p) {
    const std::span<const std::uint32_t> corners = scene.corners(scene.pieces()[face.first_piece + p]);
    const Vec3& a = scene.vertices()[corners[0]];
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
      const Vec3 &b = scene.vertices()[corners[i]], &c = scene.vertices()[corners[i + 1]];
      const double area = kernel::length(kernel::cross(kernel::difference(b, a), kernel::difference(c, a)));
      moment = kernel::along(moment, kernel::scaled(kernel::sum(kernel::sum(a, b), c), 1.0 / 3.0), area);
      whole += area;
    }
  }
  if (whole > 0.0) summary.centre = kernel::along(summary.centre, moment, face.area / whole);
  for (const auto& ring : face.rings) {
    for (const std::uint32_t v : ring) {
      const Vec3& x = scene.vertices()[v];
      summary.low = {std::min(summary.low.x, x.x), std::min(summary.low.y, x.y), std::min(summary.low.z, x.z)};
      summary.high = {std::max(summary.high.x, x.x), std::max(summary.high.y, x.y), std::max(summary.high.z, x.z)};
    }
  }
}

}  // namespace

PatchSummary summarise(const Scene& scene, PatchId id) {
  const kernel::StandardArithmetic arithmetic;
  const Patch& patch = scene.patch(id);
  std::vector<FaceId> faces = scene.faces_of({id, {}, scene.id()});
  std::ranges::sort(faces, {}, [&](FaceId face) {  // so that no digit of a sum depends on the order of faces
    const Face& f = scene.face(face);
    const Vec3& first = scene.vertices()[f.rings[0][0]];
    return std::tuple(f.area, f.newell.x, f.newell.y, f.newell.z, first.x, first.y, first.z);
  });
  PatchSummary summary{patch.name, patch.faces.size(), 0.0, common_front(scene, faces), materials_of(scene, patch)};
  if (!faces.empty()) {
    summary.low = {HUGE_VAL, HUGE_VAL, HUGE_VAL};
    summary.high = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
  }
  for (const FaceId face : faces) {
    summary.area = sum_of_areas(summary.area, scene.face(face).area);
    add_place(scene, scene.face(face), summary);
    summary.emits = summary.emits || scene.material(scene.face(face).material).emits();
  }
  if (summary.area > 0.0) summary.centre = kernel::scaled(summary.centre, 1.0 / summary.area);
  return summary;
}

std::vector<PatchSummary> summarise(const Scene& scene) {
  std::vector<PatchSummary> rows;
  for (std::size_t i = 0; i < scene.patches().size(); ++i) rows.push_back(summarise(scene, static_cast<PatchId>(i)));
  return rows;
}

double total_area(const std::vector<PatchSummary>& rows) {
  const kernel::StandardArithmetic arithmetic;
  double area = 0.0;
  for (const PatchSummary& row : rows) area = sum_of_areas(area, row.area);
  return area;
}

}  // namespace exactff
