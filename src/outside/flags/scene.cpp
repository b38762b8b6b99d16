#include "flags/scene.h"

#include <iostream>

#include "exactff/models.h"
#include "exactff/scene_files.h"
#include "flags/file_options.h"
#include "flags/lists.h"
#include "text/escape.h"
#include "text/phrases.h"
#include "text/refuse.h"

namespace exactff::flags {
namespace {

CLI::Option* add_names(CLI::App& app, const std::string& flag, std::vector<std::string>& names,
                       const std::string& meaning) {
  return app.add_option(flag, names, meaning + kNamesHelp)
      ->type_name("NAME[:K]")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

std::vector<Selection> changed(const Scene& scene, const std::string& flag, const std::vector<std::string>& names) {
  std::vector<Selection> selections = selections_named(scene, names);
  for (const Selection& selection : selections) {
    if (!scene.faces_of(selection).empty()) continue;
    text::refuse(flag + ": '" + scene.name_of(selection) + "' has no area", "a face without area is ignored",
                 "remove the name");
  }
  return selections;
}

}  // namespace

Scene divided_with_note(const Scene& scene, double length) {
  DividedScene divided = exactff::divided(scene, length);
  std::cerr << "note: divided into " << text::counted(divided.cells, "cell") << "; "
            << text::counted(divided.faces_cut, "face") << (divided.faces_cut == 1 ? " was" : " were") << " cut, "
            << (divided.largest_deviation == 0.0
                    ? "exactly"
                    : "and corners are off by at most " + text::short_number(divided.largest_deviation))
            << '\n';
  return std::move(divided.scene);
}

void SceneArguments::add_to(CLI::App& app) {
  command = &app;
  app.add_option("SCENE", path,
                 "File (OBJ, PLY, STL, OFF, View3D), - for an OBJ file from standard input, or "
                 "@MODEL[:SETTING=VALUE,...] for a generated scene: `exactff info @` lists them")
      ->required()
      ->check(is_read());
  app.add_option("--patches", patches,
                 "What a patch is: groups (g lines; without them, o lines) or faces (each face is a patch NAME:k)")
      ->check(CLI::IsMember({"groups", "faces"}))
      ->capture_default_str();
  app.add_flag("--skip-bad-faces", skip_bad_faces, "Leave out unusable faces with a warning instead of stopping");
  add_names(app, "--flip", flip, "Turn this patch or face round, or all: its front becomes its back");
  add_names(app, "--transparent", transparent,
            "This patch or face hides nothing; it can still be a source and carry receivers");
}

void SceneArguments::add_divide_to(CLI::App& app) {
  app.add_option(
         "--divide", divide,
         "Cut the faces into cells with sides of at most this length, each a patch NAME:k; NAME means all of them. A "
         "cell that is not exactly planar becomes two triangles, whose common side may be longer. In --flip and "
         "--transparent, NAME:k is a face of the scene that is cut")
      ->type_name("LENGTH")
      ->check(is_positive);
}

SceneOptions SceneArguments::options() const {
  return {skip_bad_faces ? BadFaces::kSkip : BadFaces::kReject,
          patches == "faces" ? PatchMode::kFaces : PatchMode::kGroups};
}

Scene SceneArguments::load() const {
  Scene scene = from_standard_input()   ? read_obj(std::cin, kStandardInput, options())
                : path.starts_with('@') ? models::make_scene(path.substr(1), options())
                                        : read_scene(path, options());
  if (command != nullptr) require_not_written(*command, scene.files());
  if (!flip.empty()) scene = scene.with_flipped(changed(scene, "--flip", flip));
  if (!transparent.empty()) scene = scene.with_transparent(changed(scene, "--transparent", transparent));
  return divide ? divided_with_note(scene, *divide) : std::move(scene);
}

std::string command_words(const SceneArguments& args) {
  std::string line;
  if (args.patches != "groups") line += " --patches " + text::shell_word(args.patches);
  if (args.skip_bad_faces) line += " --skip-bad-faces";
  for (const std::string& names : args.flip) line += " --flip " + text::shell_word(names);
  for (const std::string& names : args.transparent) line += " --transparent " + text::shell_word(names);
  if (args.divide) line += " --divide " + text::shortest(*args.divide);
  return line;
}

}  // namespace exactff::flags
