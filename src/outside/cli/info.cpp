// exactff info: lists the contents of a scene, so that the user knows what to pass to --source and --on.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/output.h"
#include "cli/process.h"
#include "exactff/models.h"
#include "exactff/scene.h"
#include "exactff/slips.h"
#include "exactff/version.h"
#include "flags/scene.h"
#include "flags/values.h"
#include "scene/selections.h"
#include "text/escape.h"
#include "text/phrases.h"

namespace exactff::cli {

namespace {

using nlohmann::ordered_json;

std::string six_digits(double value) { return fmt::format("{:.6g}", value == 0.0 ? 0.0 : value); }

std::string short_colour(const Rgb& c) {
  if (c.r == c.g && c.g == c.b) return six_digits(c.r);
  return fmt::format("{} {} {}", six_digits(c.r), six_digits(c.g), six_digits(c.b));
}

std::vector<FaceId> faces_of_shape(const Scene& scene, FaceShape shape) {
  return faces_where(scene, [&](const Face& face) { return face.shape == shape; });
}

// --- for people ---

std::string front_text(const PatchSummary& row) {
  if (row.area == 0.0) return "-";
  if (!row.front) return "mixed";
  const auto rounded = [](double c) { return six_digits(std::round(c * 1e4) / 1e4); };
  return fmt::format("({}, {}, {})", rounded(row.front->x), rounded(row.front->y), rounded(row.front->z));
}

std::string material_text(const Scene& scene, const PatchSummary& row) {
  constexpr std::size_t kShown = 3;
  std::string text;
  for (std::size_t i = 0; i < std::min(kShown, row.materials.size()); ++i) {
    text += (i > 0 ? ", " : "") + scene.material(row.materials[i]).name;
  }
  return row.materials.size() > kShown ? fmt::format("{} +{}", text, row.materials.size() - kShown) : text;
}

std::string colour_text(const Scene& scene, const PatchSummary& row, Rgb Material::*colour) {
  if (row.materials.empty()) return "-";
  const Rgb& first = scene.material(row.materials.front()).*colour;
  const auto same = [&](MaterialId id) { return scene.material(id).*colour == first; };
  return std::all_of(row.materials.begin(), row.materials.end(), same) ? short_colour(first) : "mixed";
}

std::string point_text(const Vec3& v) {
  return fmt::format("({}, {}, {})", six_digits(v.x), six_digits(v.y), six_digits(v.z));
}

// Where the patches are, so that one knows which of those from geometry is meant.
void print_places(const std::vector<PatchSummary>& rows) {
  TextTable table;
  table.add_columns({"patch", "centre", "from", "to"});
  for (const PatchSummary& row : rows) {
    table.add_row({row.name, point_text(row.centre), point_text(row.low), point_text(row.high)});
  }
  table.print(std::cout);
}

// "area", or "area in mm²".
std::string area_words(const Scene& scene) {
  return scene.unit() == Unit::kNone ? "area" : "area in " + std::string(name_of(scene.unit())) + "²";
}

void print_patches(const Scene& scene, const std::vector<PatchSummary>& rows) {
  TextTable table;
  table.add_column("patch");
  table.add_column("faces", Align::kRight);
  table.add_column(area_words(scene), Align::kRight);
  table.add_columns({"front", "material", "Kd", "Ke", "emits"});
  for (const PatchSummary& row : rows) {
    table.add_row({row.name, std::to_string(row.face_count), six_digits(row.area), front_text(row),
                   material_text(scene, row), colour_text(scene, row, &Material::reflectance),
                   colour_text(scene, row, &Material::radiosity), row.emits ? "yes" : "no"});
  }
  table.print(std::cout);
}

void print_totals(const Scene& scene, const std::vector<PatchSummary>& rows) {
  std::cout << text::counted(scene.patches().size(), "patch", "patches") << ", "
            << text::counted(scene.faces().size(), "face") << " in "
            << text::counted(scene.pieces().size(), "convex piece") << ", "
            << text::counted(scene.vertices().size(), "vertex", "vertices") << ", " << area_words(scene) << ' '
            << six_digits(total_area(rows)) << '\n';
}

// "TITLE: a, b, c and 7 more" or "TITLE: none".
void print_list(const std::string& title, const std::vector<std::string>& items) {
  constexpr std::size_t kShown = 12;
  std::cout << title << ": ";
  for (std::size_t i = 0; i < std::min(kShown, items.size()); ++i)
    std::cout << (i > 0 ? ", " : "") << text::printable(items[i]);
  if (items.empty()) std::cout << "none";
  if (items.size() > kShown) std::cout << " and " << items.size() - kShown << " more";
  std::cout << '\n';
}

// NAME:k even if the patch has only one face: these lists are about faces.
std::string numbered_name(const Scene& scene, FaceId face) { return scene.name_of(selection_of(scene, face)); }

std::vector<std::string> numbered_names(const Scene& scene, FaceShape shape) {
  std::vector<std::string> names;
  for (const FaceId face : faces_of_shape(scene, shape)) names.push_back(numbered_name(scene, face));
  return names;
}

std::size_t textured_faces(const Scene& scene, int set) {
  std::size_t count = 0;
  for (std::size_t f = 0; f < scene.faces().size(); ++f)
    count += scene.texture(static_cast<FaceId>(f), set).empty() ? 0 : 1;
  return count;
}

void print_faces(const Scene& scene) {
  std::vector<std::string> other;
  for (const FaceId face : faces_of_shape(scene, FaceShape::kTriangulated)) {
    other.push_back(fmt::format("{} (off by {}, {})", numbered_name(scene, face),
                                six_digits(scene.face(face).out_of_plane),
                                text::counted(scene.face(face).piece_count, "triangle")));
  }
  print_list("not exactly planar, cut into triangles (distance from the plane / diameter)", other);
  print_list("zero area, ignored", numbered_names(scene, FaceShape::kZeroArea));
  print_list("unusable, left out", numbered_names(scene, FaceShape::kSkipped));
  const std::size_t open = scene.open_edge_count();
  std::cout << "open edges: " << open
            << (open == 0 ? " (the surface is closed)" : " (an odd number of faces uses them)") << '\n';
  for (int set = 0; set < kTextureSets; ++set) {
    if (const std::size_t count = textured_faces(scene, set); count > 0) {
      std::cout << "texture coordinates " << set << ": " << count << " of "
                << text::counted(scene.faces().size(), "face") << '\n';
    }
  }
}

void print_gap(const Scene& scene, const flags::SceneArguments& arguments) {
  const std::optional<Gap> found = gap(scene);
  if (!found) return;
  std::cout << "gap: corners that should be one are up to " << six_digits(found->length) << " apart; exactff convert "
            << text::shell_word(arguments.path) << flags::command_words(*arguments.command, {"--json"})
            << " OUT.obj --weld " << text::shortest(found->length) << " leaves " << found->open_edges << " of "
            << found->open_edges_before << " open edges";
  if (const std::size_t bent = faces_of_shape(scene, FaceShape::kTriangulated).size(); bent > 0) {
    std::cout << ", and " << faces_of_shape(welded(scene, found->length).scene, FaceShape::kTriangulated).size()
              << " of " << text::counted(bent, "bent face");
  }
  std::cout << '\n';
}

void print_contacts(const Scene& scene) {
  const std::vector<slips::Contact> contacts = slips::buried_parts(scene);
  if (contacts.empty()) return;
  std::cout << "contacts (what is buried neither sends nor receives):\n";
  TextTable table;
  table.add_columns({"patch", "buried under"});
  table.add_columns({"area", "share of the patch"}, Align::kRight);
  for (const slips::Contact& one : contacts) {
    table.add_row({scene.name_of(one.patch), scene.name_of(one.under), six_digits(one.area), six_digits(one.share)});
  }
  table.print(std::cout);
}

void print_findings(const std::vector<slips::Finding>& findings) {
  for (const slips::Finding& finding : findings)
    std::cout << (slips::is_about_contacts(finding.kind) ? "note: " : "check: ")
              << text::printable(finding.words.message()) << '\n';
}

void print_suggestion(const Scene& scene, const flags::SceneArguments& arguments) {
  const std::optional<slips::FirstTry> first = slips::first_try(scene);
  if (!first) return;
  std::cout << "next: exactff compare " << text::shell_word(arguments.path)
            << flags::command_words(*arguments.command, {"--json"}) << " --on "
            << text::shell_word(scene.name_of(first->on)) << " --source "
            << text::shell_word(scene.name_of(first->source))
            << " --grid 16x16 -o DIR (--source and --on take a patch from the table, or PATCH:k for its k-th face)\n";
}

void print_text(const Scene& scene, const flags::SceneArguments& arguments) {
  const std::vector<PatchSummary> rows = summarise(scene);
  print_patches(scene, rows);
  std::cout << '\n';
  if (arguments.patches != "groups" || !arguments.names.empty() || !arguments.names_file.empty()) {
    print_places(rows);
    std::cout << '\n';
  }
  print_totals(scene, rows);
  print_list("emitters", names_of(scene, scene.emitters()));
  print_faces(scene);
  print_gap(scene, arguments);
  print_contacts(scene);
  print_findings(slips::diagnose(scene));
  print_suggestion(scene, arguments);
}

// --- for programs ---

ordered_json to_json(const Rgb& c) { return {c.r, c.g, c.b}; }
ordered_json to_json(const Vec3& v) { return {v.x, v.y, v.z}; }

ordered_json to_json(const PatchSummary& row, const Scene& scene) {
  ordered_json json;
  json["name"] = row.name;
  json["faces"] = row.face_count;
  json["area"] = row.area;
  json["front"] = row.front ? to_json(*row.front) : ordered_json();
  json["centre"] = to_json(row.centre);
  json["low"] = to_json(row.low);
  json["high"] = to_json(row.high);
  json["materials"] = ordered_json::array();
  for (const MaterialId id : row.materials) {
    const Material& material = scene.material(id);
    json["materials"].push_back(
        {{"name", material.name}, {"Kd", to_json(material.reflectance)}, {"Ke", to_json(material.radiosity)}});
  }
  json["emits"] = row.emits;
  return json;
}

ordered_json faces_to_json(const Scene& scene) {
  ordered_json json = ordered_json::array();
  for (const FaceId id : faces_of_shape(scene, FaceShape::kTriangulated)) {
    const Face& face = scene.face(id);
    json.push_back({{"name", numbered_name(scene, id)},
                    {"line", face.line},
                    {"out_of_plane", face.out_of_plane},
                    {"triangles", face.piece_count}});
  }
  return json;
}

ordered_json to_json(const slips::Finding& finding, const Scene& scene) {
  return {{"kind", to_string(finding.kind)},
          {"message", finding.words.message()},
          {"objects", names_of(scene, finding.objects)},
          {"flag", finding.flag}};
}

void print_json(const Scene& scene, const flags::SceneArguments& arguments) {
  const std::vector<PatchSummary> rows = summarise(scene);
  ordered_json json;
  json["version"] = kVersion;
  json["scene"] = arguments.path;
  json["hash"] = scene.hash();
  json["vertices"] = scene.vertices().size();
  json["faces"] = scene.faces().size();
  json["pieces"] = scene.pieces().size();
  json["unit"] = scene.unit() == Unit::kNone ? ordered_json() : ordered_json(std::string(name_of(scene.unit())));
  json["area"] = total_area(rows);
  json["open_edges"] = scene.open_edge_count();
  for (int set = 0; set < kTextureSets; ++set) json["textured_faces"].push_back(textured_faces(scene, set));
  json["gap"] = nullptr;
  if (const std::optional<Gap> found = gap(scene)) {
    json["gap"] = {
        {"length", found->length}, {"open_edges_before", found->open_edges_before}, {"open_edges", found->open_edges}};
  }
  json["patches"] = ordered_json::array();
  for (const PatchSummary& row : rows) json["patches"].push_back(to_json(row, scene));
  json["emitters"] = names_of(scene, scene.emitters());
  json["not_planar"] = faces_to_json(scene);
  json["ignored"] = numbered_names(scene, FaceShape::kZeroArea);
  json["left_out"] = numbered_names(scene, FaceShape::kSkipped);
  json["contacts"] = ordered_json::array();
  for (const slips::Contact& one : slips::buried_parts(scene)) {
    json["contacts"].push_back({{"patch", scene.name_of(one.patch)},
                                {"under", scene.name_of(one.under)},
                                {"area", one.area},
                                {"share", one.share}});
  }
  json["findings"] = ordered_json::array();
  for (const slips::Finding& finding : slips::diagnose(scene)) json["findings"].push_back(to_json(finding, scene));
  json["warnings"] = ordered_json::array();
  for (const Problem& warning : scene.warnings()) json["warnings"].push_back(warning.message());
  std::cout << text::json_document(json) << '\n';
}

// --- generated scenes ---

void print_models() {
  for (const models::Model* model : models::all_models()) std::cout << models::description(*model) << '\n';
  std::cout << "Every command accepts @MODEL or @MODEL:SETTING=VALUE,... as SCENE, such as @teapot:segments=4. "
               "Settings that are not given have the values above.\n";
}

ordered_json to_json(const SettingSpec& setting) {
  return {{"name", setting.name},
          {"default", to_string(setting.fallback)},
          {"meaning", setting.meaning},
          {"unit", setting.unit},
          {"allowed", allowed(setting)}};
}

void print_models_json() {
  ordered_json json = ordered_json::array();
  for (const models::Model* model : models::all_models()) {
    json.push_back({{"name", model->name}, {"summary", model->summary}, {"settings", ordered_json::array()}});
    for (const SettingSpec& setting : model->settings) json.back()["settings"].push_back(to_json(setting));
  }
  std::cout << text::json_document({{"version", kVersion}, {"models", json}}) << '\n';
}

struct InfoArguments {
  flags::SceneArguments scene;
  bool json = false;
};

void print(const InfoArguments& arguments) {
  if (arguments.scene.path == "@") return arguments.json ? print_models_json() : print_models();
  const Scene scene = arguments.scene.load();
  print_warnings(scene.warnings());
  (arguments.json ? print_json : print_text)(scene, arguments.scene);
}

}  // namespace

Command add_info(CLI::App& app) {
  const auto arguments = std::make_shared<InfoArguments>();
  CLI::App* info = app.add_subcommand("info", "List the patches of a scene, its emitters and suspicious faces");
  info->footer(
      "Example:\n"
      "  exactff info room.obj\n"
      "  exactff info room.obj --patches faces --json\n"
      "  exactff info housing.stl+lamp.glb --unit mm --patches planes\n"
      "  exactff info @                       # lists the generated scenes with their settings\n"
      "  exactff info @teapot:segments=4");
  arguments->scene.add_to(*info);
  info->add_flag("--json", arguments->json, "Print JSON instead of a table");
  return {info, [arguments] {
            print(*arguments);
            check_output(std::cout);
            return 0;
          }};
}

}  // namespace exactff::cli
