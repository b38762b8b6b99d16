#include "flags/scene.h"

#include <fmt/format.h>

#include <iostream>
#include <utility>

#include "exactff/matrix.h"
#include "exactff/models.h"
#include "exactff/scene_files.h"
#include "flags/file_options.h"
#include "kernel/vec.h"
#include "text/escape.h"
#include "text/phrases.h"
#include "text/refuse.h"

namespace exactff::flags {
namespace {

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
  app.add_option("--divide", divide,
                 "Cut the faces into cells with sides of at most this length, each a patch NAME:k; NAME means all of "
                 "them. A cell that is not exactly planar becomes two triangles, whose common side may be longer. In "
                 "--flip and --transparent, NAME:k is a face of the scene that is cut")
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

// --- the scene that a file of radiosities belongs to ---

namespace {

std::optional<double> agreed_length(const std::optional<double>& flag, const radiosity::SolutionFile& file) {
  const std::optional<double>& length = file.origin.divided;
  if (!flag || flag == length) return length;
  text::refuse(file.file,
               length ? "is of the scene divided by " + text::shortest(*length) : "is of the undivided scene",
               "--divide " + text::shortest(*flag) + " makes other patches",
               "leave out --divide, or compute the radiosities with it");
}

// What cannot be done to this scene is what the file wants, not the user.
Scene made_as_in(const radiosity::SolutionFile& file, SceneArguments scene) {
  const std::optional<double> length = agreed_length(std::exchange(scene.divide, {}), file);
  const std::vector<std::string>& two_sided = file.origin.two_sided;
  Scene made = scene.load();
  try {
    if (length) made = divided_with_note(made, *length);
    if (!two_sided.empty()) made = matrix::with_two_sided(made, selections_named(made, two_sided));
  } catch (const InputError& error) {
    text::refuse(file.file, "holds radiosities of a scene that was changed as this one cannot be",
                 error.problems().front().what, "give the scene and the flags that `exactff radiosity` was given");
  }
  return made;
}

}  // namespace

void SolutionArgument::add_to(CLI::App& app) {
  add_read(app, "--radiosity", file,
           "Light after all bounces: radiosities of all patches, by `exactff radiosity SCENE -o FILE`; --divide and "
           "--two-sided of that command are taken from the file");
}

LitScene load(const SceneArguments& scene, const SolutionArgument& solution) {
  if (!solution.is_given()) return {scene.load(), std::nullopt};
  const radiosity::SolutionFile file = radiosity::read_solution(solution.file);
  Scene made = made_as_in(file, scene);
  radiosity::Radiosities radiosities = radiosity::radiosities_of(made, file);
  return {std::move(made), std::move(radiosities)};
}

// --- camera ---

namespace {

bool is_along(const Vec3& direction, const Vec3& axis) {
  constexpr double kParallel = 1e-6;
  return !(kernel::max_norm(kernel::cross(kernel::unit(direction), axis)) > kParallel);
}

}  // namespace

void CameraArguments::add_to(CLI::App& app, const std::string& eye_meaning, const std::string& look_meaning) {
  add_vector_option(app, "--eye", eye, eye_meaning);
  add_vector_option(app, "--look", look, look_meaning);
  add_vector_option(app, "--up", up,
                    "The direction that points upwards in the picture (default: 0 0 1 if more area of fronts looks "
                    "along +z than along +y; else 0 1 0)");
  app.add_option("--fov", fov,
                 fmt::format("Vertical angle of view in degrees (default: {}; {} where the program places a camera "
                             "inside a closed room)",
                             text::shortest(render::Camera{}.fov), text::shortest(render::kWideFov)))
      ->type_name("DEGREES")
      ->check(is_positive);
}

bool CameraArguments::is_placed() const {
  if (is_given(eye) == is_given(look)) return is_given(eye);
  text::refuse(is_given(eye) ? "--eye is given without --look" : "--look is given without --eye",
               "a camera stands at one point and looks at another", "give both, or neither for a view of the whole");
}

render::CameraWishes CameraArguments::wishes() const {
  render::CameraWishes wishes{.fov = fov};
  if (!is_given(up)) return wishes;
  wishes.up = vector_of(up, "--up");
  if (wishes.up == Vec3{}) {
    text::refuse("--up is (0, 0, 0)", "nothing then says which side of the picture is up", "give a direction");
  }
  return wishes;
}

void MeasureArgument::add_to(CLI::App& app) {
  app.add_option(
         "--measure", name,
         "form-factor; solid-angle: in sr, of what lies above the horizon; overcast: what the receiver gets of "
         "the CIE overcast sky behind the source, over what open ground gets of all of it: the sky component of "
         "a daylight factor. Below the horizon of --up (default: 0 0 1) there is no sky")
      ->type_name("NAME")
      ->capture_default_str()
      ->check(CLI::IsMember({"form-factor", "solid-angle", "overcast"}));
}

Measure MeasureArgument::measure(const ThreeNumbers& up, bool sphere) const {
  Measure measure{.kind = *measure_named(name), .sphere = sphere};
  if (measure.kind != MeasureKind::kOvercast) return measure;
  if (is_given(up)) measure.up = vector_of(up, "--up");
  if (measure.up == Vec3{}) text::refuse("--up is (0, 0, 0)", "nothing then says where the sky is", "give a direction");
  if (!sphere) return measure;
  text::refuse("--measure overcast is given with --sphere", "illuminance needs a surface with a normal",
               "give --normal, or --measure solid-angle");
}

std::string words_of(const Measure& measure) {
  if (measure.kind == MeasureKind::kSolidAngle) return "solid angle in sr";
  if (measure.kind == MeasureKind::kOvercast) return "overcast sky";
  return measure.sphere ? "form factor of the sphere" : "form factor";
}

render::Camera CameraArguments::camera(const Scene& scene) const {
  render::Camera camera{.eye = vector_of(eye, "--eye"), .look = vector_of(look, "--look")};
  camera.up = is_given(up) ? wishes().up : render::upwards(scene);
  if (!is_given(up) && is_along(kernel::difference(camera.look, camera.eye), camera.up)) {
    camera.up = {0.0, camera.up.z, camera.up.y};
  }
  if (fov) camera.fov = *fov;
  return camera;
}

}  // namespace exactff::flags
