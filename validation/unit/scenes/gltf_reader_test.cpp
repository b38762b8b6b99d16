// glTF files: what they mean, against rational arithmetic and OBJ files of the same scene, and what is refused.
#include <gmpxx.h>

#include "support/gltf_file.h"
#include "support/test.h"
#include "unit/scenes/format_support.h"

namespace exactff {
namespace {

using validation::GltfFile;
using Json = GltfFile::Json;
using Floats = std::vector<float>;
using PatchNames = std::vector<std::string>;

const Floats kSquare = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};

Scene read(const GltfFile& file) { return read_scene(file.binary(), "s.glb"); }
std::string refusal(const GltfFile& file) {
  return error_of([&] { return read(file); });
}

// Two triangles in the node `wall`.
GltfFile square() {
  GltfFile file;
  const int positions = file.accessor(kSquare, "VEC3");
  const int indices = file.accessor(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}, "SCALAR");
  file.node({{"name", "wall"}, {"mesh", file.mesh({{"attributes", {{"POSITION", positions}}}, {"indices", indices}})}});
  return file;
}

using Exact = std::array<mpq_class, 3>;

// A node's transform of a point, step by step: by its matrix, or scale, then q v q* / |q|^2, then translation.
Exact transformed(const Json& node, const Exact& p) {
  Exact r = p;
  if (node.contains("matrix")) {
    const Json& m = node["matrix"];
    for (std::size_t k = 0; k < 3; ++k) {
      r[k] = mpq_class(m[12 + k].get<double>());
      for (std::size_t c = 0; c < 3; ++c) r[k] += mpq_class(m[4 * c + k].get<double>()) * p[c];
    }
    return r;
  }
  if (node.contains("scale"))
    for (std::size_t k = 0; k < 3; ++k) r[k] *= mpq_class(node["scale"][k].get<double>());
  if (node.contains("rotation")) {
    std::array<mpq_class, 4> q;
    for (std::size_t k = 0; k < 4; ++k) q[k] = mpq_class(node["rotation"][k].get<double>());
    const auto cross = [&](const Exact& v) {
      return Exact{q[1] * v[2] - q[2] * v[1], q[2] * v[0] - q[0] * v[2], q[0] * v[1] - q[1] * v[0]};
    };
    // v + 2 (w u x v + u x (u x v)) / |q|^2, u = (x, y, z)
    const Exact once = cross(r), twice = cross(once);
    const mpq_class n = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
    for (std::size_t k = 0; k < 3; ++k) r[k] += 2 * (q[3] * once[k] + twice[k]) / n;
  }
  if (node.contains("translation"))
    for (std::size_t k = 0; k < 3; ++k) r[k] += mpq_class(node["translation"][k].get<double>());
  return r;
}

bool is_nearest(double value, const mpq_class& exact) {
  const mpq_class off = abs(mpq_class(value) - exact);
  return off <= abs(mpq_class(std::nextafter(value, HUGE_VAL)) - exact) &&
         off <= abs(mpq_class(std::nextafter(value, -HUGE_VAL)) - exact);
}

Json random_node(std::mt19937_64& random) {
  const auto number = [&] { return std::ldexp(static_cast<double>(random() >> 11U), -53) * 4.0 - 2.0; };
  const auto numbers = [&](int count) {
    Json list = Json::array();
    for (int i = 0; i < count; ++i) list.push_back(number());
    return list;
  };
  Json node = Json::object();
  if (random() % 3 == 0) {
    node["matrix"] = numbers(16);
    for (const int k : {3, 7, 11}) node["matrix"][static_cast<std::size_t>(k)] = 0;
    node["matrix"][15] = 1;
    return node;
  }
  if (random() % 2 == 0) node["scale"] = numbers(3);
  if (random() % 4 != 0) node["rotation"] = numbers(4);
  if (random() % 2 == 0) node["translation"] = numbers(3);
  return node;
}

TEST(GltfReader, CoordinatesAreExactCompositionsRoundedOnce) {
  std::mt19937_64 random(62);
  for (int trial = 0; trial < 60; ++trial) {
    GltfFile file;
    Floats corners;
    for (int i = 0; i < 9; ++i) corners.push_back(static_cast<float>(random() % 4096) / 64.0F + 0.1F);
    const int mesh = file.mesh({{"attributes", {{"POSITION", file.accessor(corners, "VEC3")}}}});
    const std::size_t depth = 1 + random() % 5;
    std::vector<Json> chain;
    for (std::size_t d = 0; d < depth; ++d) {
      chain.push_back(random_node(random));
      Json node = chain.back();
      if (d + 1 < depth) node["children"] = {d + 1};
      if (d + 1 == depth) node["mesh"] = mesh;
      file.json["nodes"].push_back(node);
    }
    file.json["scenes"][0]["nodes"] = {0};
    const Scene scene = read(file);
    ASSERT_EQ(scene.vertices().size(), 3U);
    std::array<Exact, 3> exact;
    for (std::size_t v = 0; v < 3; ++v) {
      exact[v] = {mpq_class(corners[3 * v]), mpq_class(corners[3 * v + 1]), mpq_class(corners[3 * v + 2])};
      for (std::size_t d = depth; d-- > 0;) exact[v] = transformed(chain[d], exact[v]);
    }
    // A map that mirrors swaps the last two corners; its determinant is that of the images of the axes.
    const auto image = [&](int axis) {
      Exact at{0, 0, 0}, zero{0, 0, 0};
      if (axis >= 0) at[static_cast<std::size_t>(axis)] = 1;
      for (std::size_t d = depth; d-- > 0;) {
        at = transformed(chain[d], at);
        zero = transformed(chain[d], zero);
      }
      return Exact{at[0] - zero[0], at[1] - zero[1], at[2] - zero[2]};
    };
    const Exact a = image(0), b = image(1), c = image(2);
    const mpq_class det =
        a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
    if (det < 0) std::swap(exact[1], exact[2]);
    for (std::size_t v = 0; v < 3; ++v) {
      const Vec3& got = scene.vertices()[ring(scene)[v]];
      EXPECT_TRUE(is_nearest(got.x, exact[v][0]) && is_nearest(got.y, exact[v][1]) && is_nearest(got.z, exact[v][2]))
          << file.json.dump();
    }
    EXPECT_HOLDS(warnings_of(scene), "rounded, once, after the exact transforms");
  }
}

TEST(GltfReader, AQuarterTurnIsExactAlthoughItsQuaternionIsRounded) {
  GltfFile file = square();
  file.json["nodes"][0]["rotation"] = {-0.70710677F, 0, 0, 0.70710677F};  // y up to z up and back
  const Scene scene = read(file);
  EXPECT_EQ(scene.vertices()[2], (Vec3{1, 0, -1}));
  EXPECT_EQ(warnings_of(scene), "");
}

TEST(GltfReader, MaterialsHaveReflectancesAndRadiosities) {
  GltfFile file = square();
  file.json["meshes"][0]["primitives"][0]["material"] = 0;
  file.json["materials"] = {{{"name", "lamp"},
                             {"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.25, 0.75, 1}}}},
                             {"emissiveFactor", {0.375, 0.25, 0.125}},
                             {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 8}}}}}}};
  for (const bool binary : {false, true}) {
    const Scene scene = read_scene(binary ? file.binary() : file.text(), binary ? "s.glb" : "s.gltf");
    const Material& lamp = scene.material(scene.faces()[0].material);
    EXPECT_EQ(lamp.name, "lamp");
    EXPECT_EQ(lamp.reflectance, (Rgb{0.5, 0.25, 0.75}));
    EXPECT_EQ(lamp.radiosity, (Rgb{3, 2, 1}));
    EXPECT_EQ(warnings_of(scene), "");
  }
}

TEST(GltfReader, PatchesAreNodesByMaterial) {
  GltfFile file = square();
  const Json triangles = file.json["meshes"][0]["primitives"][0];
  file.json["materials"] = {{{"name", "paint"}}, Json::object()};
  EXPECT_EQ(patch_names(read(file)), PatchNames{"wall"});
  Json painted = triangles, other = triangles;
  painted["material"] = 0;
  other["material"] = 1;
  file.json["meshes"][0]["primitives"] = {triangles, painted, other};
  EXPECT_EQ(patch_names(read(file)), (PatchNames{"wall", "wall/paint", "wall/material_1"}));
  file.json["meshes"][0]["primitives"] = Json::array({painted});
  EXPECT_EQ(patch_names(read(file)), PatchNames{"wall"});
  EXPECT_EQ(patch_names(read_scene(file.binary(), "s.glb", {.patches = PatchMode::kPlanes})), PatchNames{"wall/1"});
  file.json["meshes"][0]["name"] = "plate";
  file.json["nodes"][0].erase("name");
  EXPECT_EQ(patch_names(read(file)), PatchNames{"plate"});
  file.json["meshes"][0].erase("name");
  EXPECT_EQ(patch_names(read(file)), PatchNames{"default"});
  file.json["nodes"].push_back({{"name", "house"}, {"children", {0}}});
  file.json["scenes"][0]["nodes"] = {1};
  EXPECT_EQ(patch_names(read(file)), PatchNames{"house"});
}

TEST(GltfReader, ListsStripsAndFansOfAllIndexTypesAreTheSameTriangles) {
  const auto faces = [](int mode, auto indices) {
    GltfFile file = square();
    Json& primitive = file.json["meshes"][0]["primitives"][0];
    primitive["mode"] = mode;
    primitive["indices"] = file.accessor(indices, "SCALAR");
    const Scene scene = read(file);
    std::vector<std::vector<Vec3>> all;
    for (const Face& face : scene.faces()) {
      std::vector<Vec3> corners;
      for (const std::uint32_t v : face.rings[0]) corners.push_back(scene.vertices()[v]);
      const auto first = std::ranges::min_element(corners, {}, [](const Vec3& v) { return 2 * v.x + v.y; });
      std::rotate(corners.begin(), first, corners.end());
      all.push_back(corners);
    }
    return all;
  };
  const auto list = faces(4, std::vector<std::uint8_t>{0, 1, 3, 1, 2, 3});
  EXPECT_EQ(faces(5, std::vector<std::uint32_t>{0, 1, 3, 2}), list);
  EXPECT_EQ(faces(6, std::vector<std::uint16_t>{3, 0, 1, 2}), list);
}

TEST(GltfReader, SparseAndQuantizedNumbersAreRead) {
  GltfFile file = square();
  const int indices = file.view(std::vector<std::uint8_t>{2, 0}), values = file.view(Floats{5, 6, 7, -1, -2, -3});
  file.json["accessors"][0]["sparse"] = {{"count", 2},
                                         {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                                         {"values", {{"bufferView", values}}}};
  EXPECT_EQ(read(file).vertices()[2], (Vec3{5, 6, 7}));
  EXPECT_EQ(read(file).vertices()[0], (Vec3{-1, -2, -3}));

  GltfFile small;
  const int positions = small.accessor(std::vector<std::int16_t>{-32768, 0, 0, 32767, 1, 2, 0, 32767, 0}, "VEC3");
  const int texture = small.accessor(std::vector<std::uint16_t>{0, 0, 65535, 13107, 1, 2}, "VEC2");
  small.json["accessors"][0]["normalized"] = small.json["accessors"][1]["normalized"] = true;
  small.node({{"mesh", small.mesh({{"attributes", {{"POSITION", positions}, {"TEXCOORD_1", texture}}}})}});
  const Scene scene = read(small);
  EXPECT_EQ(scene.vertices()[0], (Vec3{-1, 0, 0}));
  EXPECT_EQ(scene.vertices()[1], (Vec3{1, 1.0 / 32767, 2.0 / 32767}));
  EXPECT_FALSE(scene.has_texture(0));
  EXPECT_EQ(scene.texture(FaceId{0}, 1)[1], (TexturePoint{1.0, 0.8}));  // v runs downwards in the file
}

TEST(GltfReader, MirroredNodesKeepTheirFronts) {
  GltfFile file = square();
  const int texture = file.accessor(Floats{0, 1, 1, 1, 1, 0, 0, 0}, "VEC2");
  file.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = texture;
  file.json["nodes"][0]["scale"] = {-1, 1, 1};
  const Scene scene = read(file);
  EXPECT_GT(scene.faces()[0].newell.z, 0.0);
  for (std::size_t c = 0; c < 3; ++c) {
    const Vec3& v = scene.vertices()[ring(scene)[c]];
    EXPECT_EQ(scene.texture(FaceId{0})[c], (TexturePoint{-v.x, v.y}));
  }
}

TEST(GltfReader, NotesSayWhatIsLeftOut) {
  GltfFile file = square();
  const Json triangles = file.json["meshes"][0]["primitives"][0];
  Json lines = triangles;
  lines["mode"] = 1;
  file.json["meshes"][0]["primitives"].push_back(lines);
  file.json["meshes"][0]["primitives"][0]["material"] = 0;
  file.json["images"] = {{{"uri", "/dev/zero"}}};
  file.json["textures"] = {{{"source", 0}}};
  file.json["materials"] = {
      {{"name", "glass"},
       {"doubleSided", true},
       {"alphaMode", "BLEND"},
       {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 0.5}}, {"baseColorTexture", {{"index", 0}}}}}}};
  file.json["scenes"].push_back({{"name", "other"}});
  const std::string notes = warnings_of(read(file));
  for (const char* part :
       {"s.glb: material 'glass' lets light through (alpha 0.5), but 'wall/glass' occludes",
        "s.glb: has 2 scenes (only the default one, number 0, is read)", "1 primitive of points or lines left out",
        "1 material with an image as colour",
        "1 patch of double-sided materials (a face sends and receives on its front alone); if the backs matter, give "
        "--two-sided 'wall/glass'"})
    EXPECT_HOLDS(notes, part) << part << "\n" << notes;
}

TEST(GltfReader, BuffersInOtherFilesBelongToTheScene) {
  const TemporaryDirectory folder;
  const GltfFile file = square();
  const auto path = folder.write("s.gltf", file.text_with("a%20b.bin"));
  EXPECT_EQ(error_of([&] { return read_scene(path); }),
            path.string() + ": its buffer '" + (folder.path() / "a b.bin").string() +
                "' cannot be read (it holds the geometry); put it beside the file, or export a .glb file, which holds "
                "all");
  const auto bin = folder.write("a b.bin", file.bytes + "padding");
  const Scene scene = read_scene(path);
  ASSERT_EQ(scene.files().size(), 2U);
  EXPECT_EQ(scene.files()[1], bin);
  EXPECT_EQ(scene.hash(), read(file).hash());
}

TEST(GltfReader, FaultsAreNamedWithTheirPlace) {
  struct Fault {
    std::string at;  // JSON pointer
    Json value;
    std::string message;
  };
  const Fault faults[] = {
      {"/nodes/0/mesh", 1, "node 0 'wall': mesh 1 does not exist (there is 1); correct the index"},
      {"/nodes/0/children", {0}, "node 0 'wall': has two parents, or is inside of itself"},
      {"/nodes/0/children", {7}, "nodes: node 7 does not exist (there is 1)"},
      {"/nodes/0/rotation", {0, 0, 0, 0}, "node 0 'wall': its rotation is 0 0 0 0"},
      {"/nodes/0/scale", {1, 1}, "node 0 'wall': a transform has 2 numbers (it needs 3)"},
      {"/nodes/0/matrix", {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, "its matrix is not affine"},
      {"/nodes/0/translation", "up", "'nodes[0].translation' is not an array"},
      {"/nodes/0/translation", {1, "up", 0}, "'nodes[0].translation[1]' is not a number"},
      {"/nodes/0/translation", {1e308, 0, 0}, "no error"},
      {"/scene", 3, "scene 3 does not exist"},
      {"/meshes/0/primitives/0/attributes/POSITION", 4294967296, "is 4294967296, which is too large"},
      {"/meshes/0/primitives/0/attributes/POSITION", 1, "mesh 0, primitive 0, accessor 1: has the wrong type for pos"},
      {"/meshes/0/primitives/0/attributes/TEXCOORD_0", 0, "accessor 0: has the wrong type for texture coordinates"},
      {"/meshes/0/primitives/0/indices", 0, "mesh 0, primitive 0, accessor 0: has the wrong type for indices"},
      {"/meshes/0/primitives/0/indices", 9, "is not read by tinygltf (primitive indices accessor out of bounds)"},
      {"/meshes/0/primitives/0/material", 2, "mesh 0, primitive 0: material 2 does not exist"},
      {"/meshes/0/primitives/0/mode", 7, "mesh 0, primitive 0: mode 7 is unknown"},
      {"/accessors/0/count", 3, "mesh 0, primitive 0: vertex 3 does not exist (there are 3)"},
      {"/accessors/0/count", 5, "accessor 0: 5 elements of 12 bytes do not fit (bufferView 0 has 48 bytes of the 60"},
      {"/accessors/0/count", 2147483647, "accessor 0: 2147483647 elements of 12 bytes do not fit"},
      {"/accessors/1/count", 5, "mesh 0, primitive 0: has 5 corners (they are no whole triangles)"},
      {"/accessors/0/byteOffset", 4, "do not fit"},
      {"/bufferViews/0/buffer", 1, "buffer 1 does not exist"},
      {"/bufferViews/0/byteOffset", 9007199254740992, "do not fit"},
      {"/bufferViews/0/byteLength", 100, "do not fit"},
      {"/bufferViews/0/byteStride", 8, "do not fit"},
      {"/asset/version", "1.0", "s.glb: is glTF '1.0' (exactff reads glTF 2.0); export it as glTF 2.0"},
      {"/extensionsRequired", {"KHR_draco_mesh_compression"}, "requires the extension 'KHR_draco_mesh_compression'"},
      {"/extras", Json::parse(std::string(150, '[') + std::string(150, ']')), "is nested deeper than 100"},
  };
  for (const Fault& fault : faults) {
    GltfFile file = square();
    file.json[Json::json_pointer(fault.at)] = fault.value;
    EXPECT_HOLDS(refusal(file), fault.message) << fault.at << ": " << refusal(file);
  }
  GltfFile huge = square();
  huge.json["nodes"][0]["scale"] = {1e308, 1, 1};
  huge.json["nodes"][0]["mesh"] = 0;
  huge.json["nodes"].push_back({{"children", {0}}, {"scale", {1e308, 1, 1}}});
  huge.json["scenes"][0]["nodes"] = {1};
  EXPECT_HOLDS(refusal(huge), "accessor 0: vertex 1 is not finite (the transforms of its nodes make it too large)");
  GltfFile nan = square();
  const float value = NAN;
  std::memcpy(nan.bytes.data() + 4, &value, 4);
  EXPECT_HOLDS(refusal(nan), "mesh 0, primitive 0, accessor 0: vertex 0 is not finite");
  EXPECT_HOLDS(error_of([&] { return read_scene("{\"asset\": {},\n \"nodes\": [{},]}", "s.gltf"); }),
               "s.gltf:2: is no JSON");
  const std::string whole = square().binary();
  for (std::size_t size = 4; size < whole.size(); size += 7) {
    const std::string error = error_of([&] { return read_scene(whole.substr(0, size), "s.glb"); });
    EXPECT_HOLDS(error, "byte " + std::to_string(size)) << size << ' ' << error;
  }
}

}  // namespace
}  // namespace exactff
