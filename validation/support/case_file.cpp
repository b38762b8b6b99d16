#include "support/case_file.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace exactff::validation {

namespace {

using Json = nlohmann::ordered_json;

double number(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0') throw std::runtime_error("not a number: " + text);
  return value;
}

// Both texts must give the same double; otherwise the file is damaged.
double number(const Json& decimal, const Json& hex) {
  const double value = number(decimal.get<std::string>());
  if (std::bit_cast<std::uint64_t>(value) != std::bit_cast<std::uint64_t>(number(hex.get<std::string>()))) {
    throw std::runtime_error(decimal.get<std::string>() + " is not " + hex.get<std::string>());
  }
  return value;
}

Vec3 vector(const Json& decimal, const Json& hex) {
  return {number(decimal.at(0), hex.at(0)), number(decimal.at(1), hex.at(1)), number(decimal.at(2), hex.at(2))};
}

generate::PlainPatch read_patch(const Json& json) {
  generate::PlainPatch patch{json.at("id"), {}, {}};
  if (json.contains("rings")) patch.faces.push_back({json.at("rings").get<std::vector<generate::Ring>>()});
  if (json.contains("triangles")) {
    for (const Json& triangle : json.at("triangles")) patch.faces.push_back({{triangle.get<generate::Ring>()}});
  }
  return patch;
}

generate::PlainScene read_scene(const Json& json) {
  generate::PlainScene scene;
  scene.source = json.at("source");
  scene.point = vector(json.at("receiver").at("point"), json.at("receiver").at("point_hex"));
  scene.normal = vector(json.at("receiver").at("normal"), json.at("receiver").at("normal_hex"));
  for (std::size_t i = 0; i < json.at("vertices").size(); ++i) {
    scene.vertices.push_back(vector(json.at("vertices")[i], json.at("vertices_hex")[i]));
  }
  for (const Json& patch : json.at("patches")) scene.patches.push_back(read_patch(patch));
  return scene;
}

Expected read_expected(const Json& json) {
  return {json.at("F"), json.at("exact_zero"), number(json.at("nearest_double"), json.at("nearest_double_hex")),
          json.at("visible_area_fraction").get<std::vector<double>>()};
}

}  // namespace

CaseFile read_case(const std::filesystem::path& path) {
  std::ifstream in(path);
  if (!in) throw std::runtime_error("cannot read " + path.string());
  const Json json = Json::parse(in);
  if (json.at("format") != "ffcase-1") throw std::runtime_error(path.string() + " is no ffcase-1 file");
  return {json.at("name"), read_scene(json), read_expected(json.at("expected"))};
}

namespace {

std::string hex(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%a", value);
  return text;
}

Json decimals(const Vec3& v) { return {generate::to_text(v.x), generate::to_text(v.y), generate::to_text(v.z)}; }
Json hexes(const Vec3& v) { return {hex(v.x), hex(v.y), hex(v.z)}; }

Json to_json(const generate::PlainPatch& patch) {
  Json json{{"id", patch.name}};
  if (patch.faces.size() == 1) {
    json["rings"] = patch.faces.front().rings;
    return json;
  }
  for (const generate::PlainFace& face : patch.faces) {
    if (face.rings.size() != 1 || face.rings.front().size() != 3) {
      throw std::invalid_argument("a case's patch is one face or many triangles: " + patch.name);
    }
    json["triangles"].push_back(face.rings.front());
  }
  return json;
}

}  // namespace

std::string to_json(const CaseFile& file, const std::string& description) {
  Json json{{"format", "ffcase-1"}, {"name", file.name}, {"description", description}};
  const generate::PlainScene& scene = file.scene;
  json["receiver"] = {{"point", decimals(scene.point)},
                      {"point_hex", hexes(scene.point)},
                      {"normal", decimals(scene.normal)},
                      {"normal_hex", hexes(scene.normal)}};
  json["source"] = scene.source;
  for (const generate::PlainPatch& patch : scene.patches) json["patches"].push_back(to_json(patch));
  for (const Vec3& vertex : scene.vertices) {
    json["vertices"].push_back(decimals(vertex));
    json["vertices_hex"].push_back(hexes(vertex));
  }
  json["expected"] = {{"F", file.expected.decimals},
                      {"exact_zero", file.expected.exact_zero},
                      {"nearest_double", generate::to_text(file.expected.nearest)},
                      {"nearest_double_hex", hex(file.expected.nearest)},
                      {"visible_area_fraction", file.expected.visible_fractions}};
  return json.dump(1) + '\n';
}

std::vector<std::filesystem::path> case_paths(const std::filesystem::path& directory) {
  std::vector<std::filesystem::path> paths;
  if (!std::filesystem::exists(directory)) return paths;
  for (const auto& entry : std::filesystem::directory_iterator(directory)) {
    if (entry.path().extension() == ".json") paths.push_back(entry.path());
  }
  std::ranges::sort(paths);
  return paths;
}

std::string test_name(const std::string& name) {
  std::string out = name;
  std::ranges::replace_if(
      out, [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return out;
}

}  // namespace exactff::validation
