// glTF 2.0.
//
// 1. The nodes of the default scene are visited from its roots. Their transforms are composed in rational numbers. A
//    rotation is q v q* / |q|^2, so that it is orthogonal although its quaternion was rounded, and a quarter turn is
//    exact.
// 2. Each vertex that a triangle uses is mapped exactly, and rounded once. Equal positions become one vertex.
// 3. A patch is a node with a mesh, or several of one name; one for each material where the mesh has several.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "formats/gltf_model.h"
#include "kernel/numbers.h"
#include "kernel/vec.h"
#include "text/phrases.h"

namespace exactff::formats {
namespace {

using kernel::Integer;
using kernel::Rational;

// --- Transforms ---

using Affine = std::array<std::array<Rational, 4>, 3>;  // rows; the last column is the translation

Affine identity() {
  Affine a;
  for (std::size_t k = 0; k < 3; ++k) a[k][k] = 1;
  return a;
}

Affine composed(const Affine& outer, const Affine& inner) {
  Affine a;
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 4; ++c) {
      for (std::size_t k = 0; k < 3; ++k) a[r][c] += outer[r][k] * inner[k][c];
    }
    a[r][3] += outer[r][3];
  }
  return a;
}

Rational determinant(const Affine& a) {
  const auto minor = [&](std::size_t p, std::size_t q) -> Rational { return a[1][p] * a[2][q] - a[1][q] * a[2][p]; };
  return a[0][0] * minor(1, 2) - a[0][1] * minor(0, 2) + a[0][2] * minor(0, 1);
}

// Of the longest number in it.
std::size_t bits(const Affine& a) {
  std::size_t most = 0;
  for (const auto& row : a) {
    for (const Rational& c : row)
      most = std::max({most, mpz_sizeinbase(c.get_num_mpz_t(), 2), mpz_sizeinbase(c.get_den_mpz_t(), 2)});
  }
  return most;
}

// The rotation of a quaternion (x, y, z, w) of any length but 0.
Affine rotation(const std::vector<double>& q) {
  const Rational x(q[0]), y(q[1]), z(q[2]), w(q[3]);
  const Rational n = x * x + y * y + z * z + w * w;
  Affine a;
  a[0] = {w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y), 0};
  a[1] = {2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x), 0};
  a[2] = {2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z, 0};
  for (auto& row : a) {
    for (Rational& entry : row) entry /= n;
  }
  return a;
}

// An affine map in integers over a common denominator.
class Placement {
 public:
  explicit Placement(const Affine& a) : is_identity_(a == identity()), flips_(kernel::sign(determinant(a)) < 0) {
    for (const auto& row : a) {
      for (const Rational& entry : row) denominator_ = lcm(denominator_, entry.get_den());
    }
    for (std::size_t r = 0; r < 3; ++r) {
      const auto over = [&](const Rational& entry) {
        return Integer(entry.get_num() * (denominator_ / entry.get_den()));
      };
      rows_[r] = {over(a[r][0]), over(a[r][1]), over(a[r][2])};
      shifts_[r] = over(a[r][3]);
    }
  }

  [[nodiscard]] bool flips() const { return flips_; }

  // Where it maps the point p / divisor, each coordinate rounded once. Adds to `rounded` if one is not exact.
  [[nodiscard]] Vec3 operator()(const Vec3& p, long divisor, std::size_t& rounded) const {
    if (is_identity_ && divisor == 1) return p;
    const kernel::ScaledVec3 exact = kernel::exact_vector(p);
    const long exponent = std::min(exact.exponent, 0L);
    const auto up = [](const Integer& value, long bits) { return Integer(value << static_cast<mp_bitcnt_t>(bits)); };
    const Integer denominator = denominator_ * divisor;
    bool is_exact = true;
    std::array<double, 3> result{};
    for (std::size_t k = 0; k < 3; ++k) {
      const Integer numerator =
          up(kernel::dot(rows_[k], exact.v), exact.exponent - exponent) + up(shifts_[k] * divisor, -exponent);
      result[k] = kernel::nearest_double(numerator, denominator, exponent);
      is_exact = is_exact && std::isfinite(result[k]) &&
                 Rational(result[k]) * denominator == kernel::times_power_of_two(Rational(numerator), exponent);
    }
    if (!is_exact) ++rounded;
    return {result[0], result[1], result[2]};
  }

 private:
  bool is_identity_, flips_;
  std::array<kernel::ExactVec3, 3> rows_;
  std::array<Integer, 3> shifts_;
  Integer denominator_ = 1;
};

// --- Accessors ---

// The numbers of an accessor as they are stored, each exact; they mean number / divisor.
struct Values {
  std::vector<double> numbers;
  std::size_t count = 0, per = 1;
  long divisor = 1;

  [[nodiscard]] double at(std::size_t element, std::size_t component) const {
    return numbers[element * per + component];
  }
};

template <class T>
double number_at(const unsigned char* bytes) {
  T value{};
  std::memcpy(&value, bytes, sizeof value);
  return static_cast<double>(value);
}

struct Component {
  int type;
  std::size_t size;
  long largest;  // that 1 is stored as if normalized; 0: it cannot be
  double (*read)(const unsigned char*);
};
constexpr std::array<Component, 6> kComponents = {
    {{TINYGLTF_COMPONENT_TYPE_FLOAT, 4, 0, number_at<float>},
     {TINYGLTF_COMPONENT_TYPE_BYTE, 1, 127, number_at<std::int8_t>},
     {TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, 1, 255, number_at<std::uint8_t>},
     {TINYGLTF_COMPONENT_TYPE_SHORT, 2, 32767, number_at<std::int16_t>},
     {TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, 2, 65535, number_at<std::uint16_t>},
     {TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, 4, 0, number_at<std::uint32_t>}}};

// What an accessor is for.
struct Use {
  const char* noun;
  int type;
  std::size_t per;
};
constexpr Use kPositions{"positions", TINYGLTF_TYPE_VEC3, 3}, kTextures{"texture coordinates", TINYGLTF_TYPE_VEC2, 2},
    kIndices{"indices", TINYGLTF_TYPE_SCALAR, 1};

bool fits(const Component& component, const Use& use) {
  if (use.per == 1) return component.type % 2 == 1;  // the unsigned ones
  return component.size < 4 || component.type == TINYGLTF_COMPONENT_TYPE_FLOAT;
}

std::string in_order(const char* noun, std::size_t index, const std::string& name) {
  return std::string(noun) + ' ' + std::to_string(index) + (name.empty() ? "" : ' ' + text::in_quotes(name));
}

// --- Reader ---

// 1 for a file without the extension.
double emissive_strength(const tinygltf::Material& material) {
  const auto found = material.extensions.find("KHR_materials_emissive_strength");
  if (found == material.extensions.end() || !found->second.Has("emissiveStrength")) return 1.0;
  return found->second.Get("emissiveStrength").GetNumberAsDouble();
}

// What glTF says about transparency (Material::see_through).
std::string transparency(const tinygltf::Material& material) {
  if (material.extensions.contains("KHR_materials_transmission")) return "transmission";
  const double alpha = material.pbrMetallicRoughness.baseColorFactor.back();
  return material.alphaMode == "BLEND" && alpha < 1.0 ? "alpha " + text::shortest(alpha) : "";
}

// The corners of triangle t of a list, a strip or a fan; nothing after the last one.
std::optional<std::array<std::size_t, 3>> triangle(int mode, std::size_t t, std::size_t corners) {
  if (mode == TINYGLTF_MODE_TRIANGLES) t *= 3;
  if (t + 3 > corners) return std::nullopt;
  if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) return {{t, t + 1 + t % 2, t + 2 - t % 2}};
  if (mode == TINYGLTF_MODE_TRIANGLE_FAN) return {{t + 1, t + 2, 0}};
  return {{t, t + 1, t + 2}};
}

class GltfReader {
 public:
  GltfReader(std::string_view bytes, const std::filesystem::path& path, const SceneOptions& options)
      : input_(path, options, "a glTF file"), model_(load_gltf(bytes, path, input_)), vertices_(input_) {}

  Scene run() {
    require_known_extensions();
    for (std::size_t m = 0; m < model_.materials.size(); ++m) materials_.push_back(add_material(m));
    visited_.resize(model_.nodes.size());
    for (const int root : roots()) visit(root, identity(), {}, 0);
    tell();
    return input_.build();
  }

 private:
  // All problems are at a place like "mesh 0 'wall', primitive 1".
  [[noreturn]] void give_up(const std::string& place, const std::string& what, std::string why,
                            std::string suggestion) {
    input_.give_up({}, place + ": " + what, std::move(why), std::move(suggestion));
  }
  [[noreturn]] void give_up_index(const std::string& place, const std::string& noun, std::size_t index,
                                  std::size_t count) {
    give_up(place, noun + ' ' + std::to_string(index) + " does not exist",
            "there " + std::string(count == 1 ? "is " : "are ") + std::to_string(count), "correct the index");
  }
  template <class T>
  const T& element(const std::vector<T>& all, int index, const char* noun, const std::string& place) {
    const auto at = static_cast<std::size_t>(index);
    if (at >= all.size()) give_up_index(place, noun, at, all.size());
    return all[at];
  }

  void require_known_extensions() {
    if (!model_.asset.version.starts_with("2.")) {
      input_.give_up({}, "is glTF " + text::in_quotes(model_.asset.version), "exactff reads glTF 2.0",
                     "export it as glTF 2.0");
    }
    for (const std::string& name : model_.extensionsRequired) {
      const bool harmless = name.starts_with("KHR_materials_") || name.starts_with("KHR_texture_") ||
                            name.starts_with("EXT_texture_") || name == "KHR_mesh_quantization" ||
                            name == "KHR_lights_punctual";
      if (harmless) continue;
      input_.give_up({}, "requires the extension " + text::in_quotes(name), "exactff does not read it",
                     "export the file without it, for example without compression");
    }
  }

  MaterialId add_material(std::size_t m) {
    const tinygltf::Material& given = model_.materials[m];
    const std::string place = in_order("material", m, given.name);
    const std::vector<double>&base = given.pbrMetallicRoughness.baseColorFactor, &light = given.emissiveFactor;
    if (base.size() != 4 || light.size() != 3)
      give_up(place, "a colour has not all its numbers", "baseColorFactor has 4 and emissiveFactor 3", "correct it");
    const double strength = emissive_strength(given);
    Material material{.name = given.name.empty() ? "material_" + std::to_string(m) : given.name,
                      .reflectance = {base[0], base[1], base[2]},
                      .radiosity = {light[0] * strength, light[1] * strength, light[2] * strength},
                      .see_through = transparency(given)};
    if (!material.see_through.empty()) material.file = input_.file();
    const MaterialId id = input_.material(std::move(material));
    if (given.pbrMetallicRoughness.baseColorTexture.index >= 0 || given.emissiveTexture.index >= 0)
      textured_.push_back(id);
    return id;
  }

  // The nodes that the default scene names; in a file without scenes, all nodes without a parent.
  std::vector<int> roots() {
    const std::size_t scenes = model_.scenes.size();
    const int index = std::max(model_.defaultScene, 0);
    if (scenes > 1) {
      input_.warn({}, "has " + std::to_string(scenes) + " scenes",
                  "only the default one, number " + std::to_string(index) + ", is read", "");
    }
    if (scenes > 0) return element(model_.scenes, index, "scene", "the default scene").nodes;
    std::set<int> all;
    for (std::size_t n = 0; n < model_.nodes.size(); ++n) all.insert(static_cast<int>(n));
    for (const tinygltf::Node& node : model_.nodes) {
      for (const int child : node.children) all.erase(child);
    }
    return {all.begin(), all.end()};
  }

  void visit(int index, const Affine& parent, const std::string& inherited, std::size_t depth) {
    constexpr std::size_t kDeepest = 500, kLongest = 1U << 15U;  // levels and bits: far more than programs write
    const tinygltf::Node& node = element(model_.nodes, index, "node", "nodes");
    const std::string place = in_order("node", static_cast<std::size_t>(index), node.name);
    if (visited_[static_cast<std::size_t>(index)])
      give_up(place, "has two parents, or is inside of itself", "nodes are a tree", "correct the children of nodes");
    visited_[static_cast<std::size_t>(index)] = true;
    const Affine here = composed(parent, transform(node, place));
    if (depth == kDeepest || bits(here) > kLongest)
      give_up(place, "is nested too deeply", "its transform is composed exactly", "export the scene with fewer levels");
    if (node.mesh >= 0) {
      const tinygltf::Mesh& mesh = element(model_.meshes, node.mesh, "mesh", place);
      const std::string name = !node.name.empty() ? node.name : !mesh.name.empty() ? mesh.name : inherited;
      if (node.skin >= 0) ++deformed_;
      add_mesh(mesh, in_order("mesh", static_cast<std::size_t>(node.mesh), mesh.name),
               name.empty() ? std::string(kDefaultPatch) : name, Placement(here));
    }
    for (const int child : node.children) visit(child, here, node.name.empty() ? inherited : node.name, depth + 1);
  }

  Affine transform(const tinygltf::Node& node, const std::string& place) {
    const auto has = [&](const std::vector<double>& numbers, std::size_t count) {
      if (numbers.empty()) return false;
      if (numbers.size() == count) return true;
      give_up(place, "a transform has " + text::counted(numbers.size(), "number"), "it needs " + std::to_string(count),
              "write a matrix of 16 numbers, or translation, rotation and scale of 3, 4 and 3");
    };
    Affine a = identity();
    if (has(node.matrix, 16)) {
      const std::vector<double>& m = node.matrix;  // by columns
      if (m[3] != 0.0 || m[7] != 0.0 || m[11] != 0.0 || m[15] != 1.0)
        give_up(place, "its matrix is not affine", "its last row is 0 0 0 1 in glTF", "correct it");
      for (std::size_t r = 0; r < 3; ++r) {
        for (std::size_t c = 0; c < 4; ++c) a[r][c] = Rational(m[4 * c + r]);
      }
      return a;
    }
    if (has(node.rotation, 4)) {
      if (std::ranges::all_of(node.rotation, [](double c) { return c == 0.0; }))
        give_up(place, "its rotation is 0 0 0 0", "that is no rotation", "write 0 0 0 1 for none");
      a = rotation(node.rotation);
    }
    const bool scaled = has(node.scale, 3), moved = has(node.translation, 3);
    for (std::size_t r = 0; r < 3; ++r) {
      for (std::size_t c = 0; c < 3 && scaled; ++c) a[r][c] *= Rational(node.scale[c]);
      if (moved) a[r][3] = Rational(node.translation[r]);
    }
    return a;
  }

  void add_mesh(const tinygltf::Mesh& mesh, const std::string& place, const std::string& name,
                const Placement& placement) {
    placement_ = &placement;
    placed_.clear();
    std::set<int> materials;
    for (const tinygltf::Primitive& primitive : mesh.primitives) materials.insert(primitive.material);
    for (std::size_t p = 0; p < mesh.primitives.size(); ++p) {
      const tinygltf::Primitive& primitive = mesh.primitives[p];
      const std::string here = place + ", primitive " + std::to_string(p);
      std::string patch = name;
      if (primitive.material >= 0) {
        const tinygltf::Material& material = element(model_.materials, primitive.material, "material", here);
        const auto m = static_cast<std::size_t>(primitive.material);
        if (materials.size() > 1)
          patch += '/' + (material.name.empty() ? "material_" + std::to_string(m) : material.name);
        if (material.doubleSided) two_sided_.insert(patch);
      }
      patches_.insert(patch);
      if (!primitive.targets.empty()) ++deformed_;
      if (primitive.mode >= 0 && primitive.mode < TINYGLTF_MODE_TRIANGLES)
        ++points_and_lines_;
      else
        add_primitive(primitive, here, patch);
    }
  }

  void add_primitive(const tinygltf::Primitive& primitive, const std::string& place, const std::string& patch) {
    if (primitive.mode > TINYGLTF_MODE_TRIANGLE_FAN)
      give_up(place, "mode " + std::to_string(primitive.mode) + " is unknown", "modes are 0 to 6", "correct it");
    const auto accessor = [&](const std::string& attribute) {
      const auto found = primitive.attributes.find(attribute);
      return found == primitive.attributes.end() ? -1 : found->second;
    };
    const int position = accessor("POSITION");
    if (position < 0)
      give_up(place, "has no POSITION", "its vertices are not known", "export the file without compression");
    const std::size_t count = values(position, kPositions, place).count;
    std::array<const Values*, kTextureSets> textures{};
    for (int set = 0; set < kTextureSets; ++set) {
      const int index = accessor("TEXCOORD_" + std::to_string(set));
      if (index < 0) continue;
      textures[static_cast<std::size_t>(set)] = &values(index, kTextures, place);
      if (textures[static_cast<std::size_t>(set)]->count != count)
        give_up(place, "TEXCOORD_" + std::to_string(set) + " and POSITION have different counts",
                "each vertex has one of both", "correct them");
    }
    const std::vector<std::size_t> corners = indices(primitive, count, place);
    if (corners.size() < 3 || (primitive.mode == TINYGLTF_MODE_TRIANGLES && corners.size() % 3 != 0))
      give_up(place, "has " + text::counted(corners.size(), "corner"), "they are no whole triangles",
              "correct the count");
    const PatchId id = input_.patch(patch);
    const MaterialId material =
        primitive.material < 0 ? input_.no_material() : materials_[static_cast<std::size_t>(primitive.material)];
    for (std::size_t t = 0; auto three = triangle(primitive.mode, t, corners.size()); ++t) {
      if (placement_->flips()) std::swap((*three)[1], (*three)[2]);
      std::vector<std::uint32_t> ring;
      for (const std::size_t c : *three) ring.push_back(vertex(position, corners[c], place));
      input_.add_face(id, material, std::move(ring), {});
      for (int set = 0; set < kTextureSets; ++set) {
        const Values* const texture = textures[static_cast<std::size_t>(set)];
        if (texture == nullptr) continue;
        std::vector<TexturePoint> points;  // v runs downwards in glTF
        const auto one = static_cast<double>(texture->divisor);
        for (const std::size_t c : *three)
          points.push_back({texture->at(corners[c], 0) / one, (one - texture->at(corners[c], 1)) / one});
        input_.builder().state_texture(set, std::move(points));
      }
    }
  }

  std::uint32_t vertex(int accessor, std::size_t index, const std::string& place) {
    const Values& positions = values(accessor, kPositions, place);
    std::vector<std::uint32_t>& placed = placed_[accessor];
    placed.resize(positions.count, kUnplaced);
    if (placed[index] != kUnplaced) return placed[index];
    const Vec3 stored{positions.at(index, 0), positions.at(index, 1), positions.at(index, 2)};
    const bool finite = kernel::is_finite(stored);
    const Vec3 here = finite ? (*placement_)(stored, positions.divisor, rounded_) : stored;
    if (!kernel::is_finite(here)) {
      give_up(place + ", accessor " + std::to_string(accessor), "vertex " + std::to_string(index) + " is not finite",
              finite ? "the transforms of its nodes make it too large" : "a coordinate is one exact number",
              "give finite coordinates");
    }
    ++mapped_;
    return placed[index] = vertices_.vertex(here, {});
  }

  std::vector<std::size_t> indices(const tinygltf::Primitive& primitive, std::size_t count, const std::string& place) {
    std::vector<std::size_t> all;
    if (primitive.indices < 0) {
      for (std::size_t i = 0; i < count; ++i) all.push_back(i);
      return all;
    }
    for (const double number : values(primitive.indices, kIndices, place).numbers) {
      all.push_back(static_cast<std::size_t>(number));
      if (all.back() >= count) give_up_index(place, "vertex", all.back(), count);
    }
    return all;
  }

  const Values& values(int accessor, const Use& use, const std::string& place) {
    const auto found = values_.find(accessor);
    if (found != values_.end() && found->second.per == use.per) return found->second;
    const tinygltf::Accessor& given = element(model_.accessors, accessor, "accessor", place);
    return values_[accessor] =
               read(given, use, place + ", " + in_order("accessor", static_cast<std::size_t>(accessor), given.name));
  }

  Values read(const tinygltf::Accessor& accessor, const Use& use, const std::string& place) {
    constexpr std::size_t kMostZeros = std::size_t{1} << 24U;
    const auto* const component = std::ranges::find(kComponents, accessor.componentType, &Component::type);
    if (accessor.type != use.type || component == kComponents.end() || !fits(*component, use)) {
      give_up(place, std::string("has the wrong type for ") + use.noun,
              "positions are VEC3 and texture coordinates VEC2, of floats or short integers; indices unsigned SCALARs",
              "correct it");
    }
    Values values{.numbers = {}, .count = accessor.count, .per = use.per};
    if (accessor.normalized && component->largest > 0) values.divisor = component->largest;
    const auto number = [&](const unsigned char* at) {
      const double stored = component->read(at);
      return values.divisor == 1 ? stored : std::max(stored, -static_cast<double>(values.divisor));
    };
    const std::size_t size = component->size * values.per;
    std::size_t stride = 0;
    if (accessor.bufferView >= 0) {
      const unsigned char* at = bytes_of(accessor.bufferView, accessor.byteOffset, values.count, size, &stride, place);
      values.numbers.reserve(values.count * values.per);
      for (std::size_t i = 0; i < values.count; ++i) {
        for (std::size_t c = 0; c < values.per; ++c)
          values.numbers.push_back(number(at + i * stride + c * component->size));
      }
    } else if (!accessor.sparse.isSparse || values.count > kMostZeros) {
      give_up(place, "has no bufferView", "its numbers are not known", "export the file without compression");
    } else {
      values.numbers.resize(values.count * values.per);
    }
    if (!accessor.sparse.isSparse) return values;

    const auto& sparse = accessor.sparse;
    const auto* const index_type = std::ranges::find(kComponents, sparse.indices.componentType, &Component::type);
    if (index_type == kComponents.end() || !fits(*index_type, kIndices) || sparse.count < 0)
      give_up(place, "has sparse indices of a wrong type", "they are unsigned integers", "correct it");
    const auto count = static_cast<std::size_t>(sparse.count);
    std::size_t index_stride = 0;
    const unsigned char* const indices =
        bytes_of(sparse.indices.bufferView, static_cast<std::size_t>(sparse.indices.byteOffset), count,
                 index_type->size, &index_stride, place);
    const unsigned char* const news = bytes_of(
        sparse.values.bufferView, static_cast<std::size_t>(sparse.values.byteOffset), count, size, &stride, place);
    for (std::size_t i = 0; i < count; ++i) {
      const auto index = static_cast<std::size_t>(index_type->read(indices + i * index_stride));
      if (index >= values.count) give_up_index(place, "element", index, values.count);
      for (std::size_t c = 0; c < values.per; ++c)
        values.numbers[index * values.per + c] = number(news + i * stride + c * component->size);
    }
    return values;
  }

  // The first of `count` elements of this size, `*stride` bytes apart: where the view says nothing, without gaps.
  const unsigned char* bytes_of(int view, std::size_t offset, std::size_t count, std::size_t size, std::size_t* stride,
                                const std::string& place) {
    const tinygltf::BufferView& given = element(model_.bufferViews, view, "bufferView", place);
    const std::vector<unsigned char>& bytes = element(model_.buffers, given.buffer, "buffer", place).data;
    *stride = given.byteStride == 0 ? size : given.byteStride;
    const bool view_fits = given.byteOffset <= bytes.size() && given.byteLength <= bytes.size() - given.byteOffset;
    const std::size_t length = given.byteLength;
    const bool fits = view_fits && *stride >= size && offset <= length && count <= length &&
                      (count == 0 || (count - 1) * *stride + size <= length - offset);
    if (fits) return bytes.data() + given.byteOffset + offset;
    give_up(place, text::counted(count, "element") + " of " + text::counted(size, "byte") + " do not fit",
            "bufferView " + std::to_string(view) + " has " + text::counted(length, "byte") + " of the " +
                std::to_string(bytes.size()) + " of its buffer",
            "is the file complete?");
  }

  void tell() {
    const auto note = [&](std::size_t count, const std::string& what, std::string why, std::string suggestion = {}) {
      if (count > 0) input_.warn({}, what, std::move(why), std::move(suggestion));
    };
    note(points_and_lines_, text::counted(points_and_lines_, "primitive") + " of points or lines left out",
         "they have no area");
    note(deformed_, text::counted(deformed_, "mesh", "meshes") + " with a skin or morph targets read undeformed",
         "exactff poses no figures", "apply the pose before you export");
    note(textured_.size(), text::counted(textured_.size(), "material") + " with an image as colour",
         "exactff has one colour for a material: Kd and Ke are the factors in the file");
    note(rounded_,
         text::counted_of(rounded_, mapped_, "vertice") + " rounded, once, after the exact transforms of their nodes",
         "their places are no doubles");
    std::string names;
    for (const std::string& name : two_sided_) names += (names.empty() ? "" : ",") + name;
    if (two_sided_ == patches_ || names.size() > text::kShownName) names = "all";
    note(two_sided_.size(), text::counted(two_sided_.size(), "patch", "patches") + " of double-sided materials",
         "a face sends and receives on its front alone",
         "if the backs matter, give --two-sided " + text::in_quotes(names, text::kShownName));
  }

  MeshInput input_;
  tinygltf::Model model_;
  SharedVertices vertices_;
  std::vector<MaterialId> materials_;
  std::vector<bool> visited_;
  std::map<int, Values> values_;
  const Placement* placement_ = nullptr;              // of the present node
  std::map<int, std::vector<std::uint32_t>> placed_;  // its vertices, by accessor; kUnplaced
  static constexpr std::uint32_t kUnplaced = 0xFFFFFFFF;
  std::size_t mapped_ = 0, rounded_ = 0, points_and_lines_ = 0, deformed_ = 0;
  std::set<std::string> patches_, two_sided_;
  std::vector<MaterialId> textured_;
};

}  // namespace

Scene read_gltf(std::string_view bytes, const std::filesystem::path& path, const SceneOptions& options) {
  SceneOptions in_metres = options;
  in_metres.unit = Unit::kMetre;  // as glTF prescribes
  return GltfReader(bytes, path, in_metres).run();
}

}  // namespace exactff::formats
