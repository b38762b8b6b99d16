// exactff_generate: writes a generated scene as OBJ (and MTL if it has materials): any model, or a family chosen by
// flags.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <vector>

#include "exactff/models.h"
#include "generate/families.h"
#include "generate/patched_rooms.h"
#include "models/registry.h"

namespace {

using namespace exactff::models;

struct Request {
  std::string scene;
  FamilyOptions options;
  double scale = 1.0;
  std::string output;
};

std::vector<Family> all_families() {
  std::vector<Family> all(families().begin(), families().end());
  all.insert(all.end(), patched_rooms().begin(), patched_rooms().end());
  return all;
}

std::string scene_list() {
  std::string out = "Families, which the flags describe:\n";
  for (const Family& family : all_families())
    out += "  " + std::string(family.name) + ": " + std::string(family.summary) + '\n';
  out += "\nModels, as MODEL:SETTING=VALUE,... (@MODEL of the program exactff; exactff info @ tells the settings):\n ";
  for (const Model* model : all_models()) out += ' ' + model->name;
  return out +
         "\n\nExamples: exactff_generate soup --n 1000 --seed 7 -o soup.obj\n"
         "          exactff_generate teapot:segments=4 -o teapot.obj";
}

void declare(CLI::App& app, Request& request) {
  app.add_option("scene", request.scene, "Family, or model with settings")->required();
  app.add_option("--n", request.options.n, "Size, as the family understands it")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  app.add_option("--seed", request.options.seed, "Seed of the random families")->capture_default_str();
  app.add_option("--cover", request.options.cover, "Random families: summed shadow area over the source's area")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  app.add_option("--drop", request.options.drop, "tiles: leave out every so many-th tile; 0 for none")
      ->capture_default_str();
  app.add_option("--scale", request.scale, "Factor on every coordinate; a power of two keeps the form factor's bits")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  app.add_option("-o", request.output, "OBJ file to write; standard output if absent");
  app.footer(scene_list());
}

std::string provenance(const Request& request) {
  std::string text = "exactff_generate " + request.scene + " --n " + std::to_string(request.options.n) + " --seed " +
                     std::to_string(request.options.seed) + " --cover " + to_text(request.options.cover);
  if (request.options.drop > 0) text += " --drop " + std::to_string(request.options.drop);
  return text + " --scale " + to_text(request.scale);
}

PlainScene made(const Request& request) {
  const std::vector<Family> all = all_families();
  const auto family = std::ranges::find(all, request.scene, &Family::name);
  PlainScene scene = family != all.end() ? family->make(request.options) : make_plain(request.scene);
  scale(scene, request.scale);
  if (family != all.end()) scene.comments.insert(scene.comments.begin(), provenance(request));
  return scene;
}

void write_file(const std::filesystem::path& path, const std::string& text) {
  std::ofstream out(path, std::ios::binary);
  out << text << std::flush;
  if (!out) throw std::runtime_error("cannot write " + path.string());
}

void write(const PlainScene& scene, const std::string& output) {
  if (output.empty()) {
    std::cout << to_obj(scene);
    return;
  }
  const std::filesystem::path mtl = std::filesystem::path(output).replace_extension(".mtl");
  write_file(output, to_obj(scene, scene.materials.empty() ? "" : mtl.filename().string()));
  if (!scene.materials.empty()) write_file(mtl, to_mtl(scene));
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Writes a generated scene as Wavefront OBJ. The same arguments give the same bytes on every machine."};
  Request request;
  declare(app, request);
  CLI11_PARSE(app, argc, argv);
  try {
    write(made(request), request.output);
  } catch (const std::exception& error) {
    std::cerr << "exactff_generate: " << error.what() << '\n';
    return 2;
  }
  return 0;
}
