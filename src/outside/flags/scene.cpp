#include "flags/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <set>
#include <string_view>
#include <unordered_set>
#include <utility>

#include "exactff/matrix.h"
#include "exactff/models.h"
#include "exactff/scene_files.h"
#include "kernel/vec.h"
#include "scene/selections.h"
#include "text/names.h"
#include "text/number_text.h"
#include "text/phrases.h"
#include "text/refuse.h"
#include "text/text_lines.h"

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

// The complaint about a value of --patches; completion offers the words in braces.
std::string not_a_way(const std::string& patches) {
  try {
    (void)scene_options(patches);
    return {};
  } catch (const InputError& error) {
    return error.what();
  }
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
                 "File (OBJ, glTF, PLY, STL, OFF, View3D), several of them as FILE+FILE, - for an OBJ file from "
                 "standard input, or "
                 "@MODEL[:SETTING=VALUE,...] for a generated scene: `exactff info @` lists them")
      ->required()
      ->check(is_read());
  add_value(app, "--unit", unit, "UNIT", "Unit of length of files that do not state theirs: mm, cm, m, in or ft")
      ->check(CLI::IsMember({"mm", "cm", "m", "in", "ft"}));
  app.add_option(
         "--patches", patches,
         "What a patch is: groups (g lines; without them, o lines) or faces (each face is a patch NAME:k); or, as "
         "patches NAME/1, NAME/2, ... of each group by falling area: planes (connected faces in one plane), "
         "smooth[:DEGREES] (connected faces that bend by less; default 30) or parts (connected faces)")
      ->check(CLI::Validator(not_a_way, "{groups,faces,planes,smooth,parts}"))
      ->capture_default_str();
  add_value(app, "--name", names, "NAME=SELECTOR",
            "NAME=SELECTOR: a name for faces. SELECTOR is box:X0,Y0,Z0,X1,Y1,Z1 (faces inside), "
            "normal:X,Y,Z[:DEGREES] (fronts within 5 degrees), plane:A,B,C,D[:DISTANCE] (on A x + B y + C z = D), "
            "PATCH:1-20,25 or PATCH, or several of them with ' & ' between; can be repeated")
      ->expected(1)
      ->take_all();
  add_read(app, "--names", names_file, "File with NAME=SELECTOR on each line, read before --name");
  app.add_flag("--skip-bad-faces", skip_bad_faces, "Leave out unusable faces with a warning instead of stopping");
  add_names(app, "--flip", flip, "Turn this patch or face round, or all: its front becomes its back");
  add_names(app, "--transparent", transparent,
            "This patch or face hides nothing; it can still be a source and carry receivers");
}

void SceneArguments::add_divide_to(CLI::App& app) {
  add_value(app, "--divide", divide, "LENGTH",
            "Cut the faces into cells with sides of at most this length, each a patch NAME:k; NAME means all of "
            "them. A cell that is not exactly planar becomes two triangles, whose common side may be longer. In "
            "--flip and --transparent, NAME:k is a face of the scene that is cut")
      ->check(is_positive);
}

SceneOptions SceneArguments::options() const {
  SceneOptions options = scene_options(patches, skip_bad_faces ? BadFaces::kSkip : BadFaces::kReject);
  if (!unit.empty()) options.unit = unit_named(unit);
  return options;
}

Scene SceneArguments::load() const {
  Scene scene = from_standard_input()   ? read_obj(std::cin, kStandardInput, options())
                : path.starts_with('@') ? models::make_scene(path.substr(1), options())
                                        : read_scene(path, options());
  if (!unit.empty() && scene.unit() != unit_named(unit) && std::filesystem::exists(path)) {  // one file
    text::refuse(path, "is in " + std::string(name_of(scene.unit())),
                 "the file says so, and --unit " + unit + " says otherwise", "leave out --unit");
  }
  if (command != nullptr) require_not_written(*command, scene.files());
  std::vector<FaceName> face_names = names_file.empty() ? std::vector<FaceName>() : read_names(names_file);
  for (const std::string& text : names) face_names.push_back(face_name(text));
  if (!face_names.empty()) scene = with_names(scene, face_names);
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
  add_value(app, "--fov", fov, "DEGREES",
            fmt::format("Vertical angle of view in degrees (default: {}; {} where the program places a camera "
                        "inside a closed room)",
                        text::shortest(render::Camera{}.fov), text::shortest(render::kWideFov)))
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
  add_value(app, "--measure", name, "NAME",
            "form-factor; solid-angle: in sr, of what lies above the horizon; overcast: what the receiver gets of "
            "the CIE overcast sky behind the source, over what open ground gets of all of it: the sky component of "
            "a daylight factor. Below the horizon of --up (default: 0 0 1) there is no sky")
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

void PrecisionArguments::add_to(CLI::App& app) {
  app.add_option("--digits", digits, "Number of significant digits to print, each of them certified")
      ->check(CLI::Range(1, kMostDigits));
  app.add_option("--precision-cap", cap, "Largest precision, in bits, of the contour integral")
      ->check(CLI::Range(32, 1 << 24))
      ->capture_default_str();
}

// --- Receivers ---

namespace {

// The given flags that say where on a patch the receivers are.
std::vector<std::string> placements(const ReceiverArguments& args) {
  std::vector<std::string> flags;
  if (!args.grid.empty()) flags.emplace_back("--grid");
  if (args.vertices) flags.emplace_back("--vertices");
  if (args.centres) flags.emplace_back("--centres");
  if (!args.samples.empty()) flags.emplace_back("--samples");
  return flags;
}

bool is_auto(const std::string& on) { return on == "auto" || on.starts_with("auto:"); }

void check_file_alone(const ReceiverArguments& args) {
  std::vector<std::string> others = placements(args);
  if (args.per_face) others.emplace_back("--per-face");
  if (!args.on.empty() && !(args.on.size() == 1 && is_auto(args.on.front()))) others.insert(others.begin(), "--on");
  if (args.file.empty() || others.empty()) return;
  text::refuse("--receivers is given together with " + text::enumerate(others),
               "receivers come either from the file or from a patch", "remove one of them");
}

GridSize grid_of(const std::string& text) {
  if (const auto cells = numbers_across(text)) return {cells->first, cells->second};
  text::refuse("--grid: " + text::in_quotes(text) + " is not a grid", "a grid is two whole numbers",
               "write columns x rows: --grid 32x32");
}

std::uint64_t to_count(const std::string& text, const std::string& flag, const std::string& why,
                       const std::string& example) {
  if (const auto count = whole_number<std::uint64_t>(text)) return *count;
  text::refuse(flag + ": " + text::in_quotes(text) + " is not a whole number in range", why,
               "write, for example, " + flag + example);
}

std::uint64_t sample_count(const ReceiverArguments& args) {
  return to_count(args.samples, "--samples", "it is the number of receivers", " 1000");
}

std::uint64_t sample_seed(const ReceiverArguments& args) {
  if (args.sample_seed.empty()) return 1;
  return to_count(args.sample_seed, "--sample-seed", "a seed is a whole number from 0 to 2^64 - 1", " 7");
}

// The named faces, and the regions that they make: of a patch those of its faces, of a face that face alone.
struct Surface {
  std::vector<FaceId> faces;
  std::vector<Region> regions;
};

Surface surface_named(const Scene& scene, const std::vector<std::string>& names) {
  Surface surface;
  std::unordered_set<std::size_t> known;
  for (const Selection& selection : selections_named(scene, names)) {
    std::ranges::move(regions(scene, selection), std::back_inserter(surface.regions));
    for (const FaceId face : scene.faces_of(selection)) {
      if (!known.insert(index_of(face)).second) {
        text::refuse("--on: '" + scene.name_of(face) + "' is named twice", "every receiver on it would occur twice",
                     "give it once");
      }
      surface.faces.push_back(face);
    }
  }
  if (surface.faces.empty()) {
    text::refuse("--on: no face has area in " + text::in_quotes(text::joined(names, ","), text::kShownName),
                 "receivers lie on faces", "choose another patch");
  }
  return surface;
}

ChosenReceivers on_faces(const ReceiverArguments& args, const Scene& scene, GridIds grid_ids) {
  const std::string on = text::joined(args.on, ",");
  const auto [faces, regions] = surface_named(scene, args.on);
  const std::string per_face = args.per_face ? ", per face" : "";
  if (!args.grid.empty()) {
    const GridSize size = grid_of(args.grid);
    return {
        args.per_face ? grid_receivers(scene, faces, size, grid_ids) : grid_receivers(scene, regions, size, grid_ids),
        on + ", grid " + args.grid + per_face};
  }
  if (args.vertices) return {vertex_receivers(scene, faces), on + ", vertices"};
  if (args.centres) {
    return {args.per_face ? centre_receivers(scene, faces) : centre_receivers(scene, regions),
            on + ", centres" + per_face};
  }
  const std::uint64_t count = sample_count(args), seed = sample_seed(args);
  return {sample_receivers(scene, faces, count, seed),
          fmt::format("{}, {}, seed {}", on, text::counted(count, "sample"), seed)};
}

// What --on says of receivers that come from a file.
std::optional<AutoFace> face_of_file(const ReceiverArguments& args, const Scene& scene) {
  if (args.on.empty()) return std::nullopt;
  if (const auto face = auto_face(args.on.front(), scene)) return face;
  text::refuse("--receivers is given together with --on " + args.on.front() + ", which is a patch of the scene",
               "receivers come either from the file or from a patch",
               "remove one of them; to find the faces automatically, rename the patch");
}

ChosenReceivers in_image(const ReceiverArguments& args, const Scene& scene) {
  exr::GBuffer gbuffer = exr::read_gbuffer(exr::ExrFile(args.file), args.layers);
  ChosenReceivers chosen;
  chosen.description = std::filesystem::path(args.file).filename().string() + ", " + gbuffer.layers;
  if (const auto face = face_of_file(args, scene)) {
    exr::place_on_faces(scene, gbuffer, face->tolerance);
    chosen.description += ", on " + args.on.front();
    chosen.warnings = exr::warnings_of(gbuffer);
  }
  const exr::Frame& frame = gbuffer.frame;
  const auto add = [&](exr::Mark mark, const std::string& what) {
    if (const std::size_t count = frame.count(mark); count > 0)
      chosen.description += fmt::format(", {} {}", count, what);
  };
  add(exr::Mark::kNothing, "without a hit");
  add(exr::Mark::kNoFace, "without a face");
  add(exr::Mark::kShadingNormal, "with a shading normal");
  chosen.receivers = std::move(gbuffer.receivers);
  chosen.frame = std::move(gbuffer.frame);
  return chosen;
}

ChosenReceivers in_file(const ReceiverArguments& args, const Scene& scene) {
  if (are_pixels(args)) return in_image(args, scene);
  ChosenReceivers chosen;
  if (args.file == "-") {
    chosen = {read_receivers(std::cin, kStandardInput, scene), kStandardInput, {}};
  } else {
    chosen = {read_receivers(args.file, scene), std::filesystem::path(args.file).filename().string(), {}};
  }
  const auto face = face_of_file(args, scene);
  if (!face) return chosen;
  chosen.description += ", on " + args.on.front();
  chosen.without_face = place_on_faces(scene, chosen.receivers, face->tolerance).size();
  if (chosen.without_face > 0) chosen.description += fmt::format(", {} without a face", chosen.without_face);
  return chosen;
}

void check_not_empty(const ReceiverArguments& args, const ChosenReceivers& chosen) {
  if (!chosen.receivers.empty()) return;
  const std::string what = "there are no receivers in " + chosen.description;
  if (!args.file.empty()) text::refuse(what, "every row of the file is a receiver", "add rows below the header");
  text::refuse(what, "no cell of the grid has its centre inside a face", "use a finer grid or another patch");
}

}  // namespace

bool are_pixels(const ReceiverArguments& args) {
  return !args.file.empty() && args.file != "-" &&
         (exr::is_exr(args.file) ||
          text::in_lower_case(std::filesystem::path(args.file).extension().string()) == ".exr");
}

std::optional<AutoFace> auto_face(const std::string& on, const Scene& scene) {
  if (!is_auto(on) || has_patch(scene, on)) return std::nullopt;
  if (on == "auto") return AutoFace{};
  const text::ParsedNumber distance = text::parse_number(on.substr(std::string_view("auto:").size()));
  if (distance.fault == text::NumberFault::kNone && distance.value > 0.0) return AutoFace{distance.value};
  text::refuse("--on " + text::in_quotes(on) + ": the distance is no positive number",
               "faces further away from a receiver are not considered", "write, for example, --on auto:1e-4");
}

void add_receiver_options(CLI::App& app, ReceiverArguments& args) {
  add_names(app, "--on", args.on, "Patch or face on which the receivers lie",
            "; all: every patch; with --receivers: auto or auto:DISTANCE finds the face of each receiver");
  add_value(app, "--grid", args.grid, "UxV",
            "A receiver in the centre of each cell of a grid on each surface: columns x rows, such as 32x32");
  app.add_flag("--vertices", args.vertices, "A receiver at each vertex of each face, with that face's normal");
  app.add_flag("--centres", args.centres, "A receiver at the centre of each surface");
  app.add_flag("--per-face", args.per_face,
               "With --grid or --centres: treat each face by itself, instead of joining neighbours in one plane");
  add_value(app, "--samples", args.samples, "N", "N receivers at random, uniformly by area");
  add_value(app, "--sample-seed", args.sample_seed, "S", "Seed of --samples; it does not affect rays (default: 1)");
  add_read(app, "--receivers", args.file,
           "CSV file with the columns id,x,y,z,nx,ny,nz,on, or a truth file, instead of --on; - for standard input; or "
           "an EXR file with the visible point and normal of each pixel");
  add_value(app, "--position-layer", args.layers.position, "LAYER",
            "Layer of the points in an EXR file, in world coordinates (default: position or P)");
  add_value(app, "--normal-layer", args.layers.normal, "LAYER",
            "Layer of the normals in an EXR file (default: normal or N)");
}

void check_receiver_options(const ReceiverArguments& args) {
  const std::vector<std::string> placed = placements(args);
  check_file_alone(args);
  if (!(args.layers.position.empty() && args.layers.normal.empty()) && !are_pixels(args)) {
    text::refuse(std::string(args.layers.position.empty() ? "--normal-layer" : "--position-layer") +
                     " is given without an image",
                 "it names a layer of an EXR file", "add --receivers FILE.exr, or remove it");
  }
  if (!args.sample_seed.empty() && args.samples.empty()) {
    text::refuse("--sample-seed is given without --samples", "only --samples draws receivers at random",
                 "add --samples 1000, or remove it");
  }
  if (!args.file.empty()) return;
  if (args.per_face && args.grid.empty() && !args.centres) {
    text::refuse("--per-face is given without --grid or --centres", "vertices and samples are always made per face",
                 "remove it");
  }
  if (args.on.empty() && placed.empty()) {
    text::refuse("there are no receivers", "values are computed at receivers",
                 "give --on NAME with --grid 32x32, --vertices, --centres or --samples 1000; or --receivers FILE.csv");
  }
  if (args.on.empty()) {
    text::refuse(placed.front() + " is given without --on", "it places receivers on a patch",
                 "name the patch with --on NAME");
  }
  if (placed.empty()) {
    text::refuse("--on is given without --grid, --vertices, --centres or --samples",
                 "they say where the receivers lie on the patch", "add one of them, for example --grid 32x32");
  }
  if (placed.size() > 1) {
    text::refuse(text::enumerate(placed) + " are given together", "each places the receivers in a different way",
                 "keep only one of them");
  }
  if (!args.grid.empty()) (void)grid_of(args.grid);
  if (!args.samples.empty()) (void)sample_count(args);
  (void)sample_seed(args);
}

void check_standard_input(const SceneArguments& scene, const ReceiverArguments& receivers) {
  if (!scene.from_standard_input() || receivers.file != "-") return;
  text::refuse("the scene and the receivers are both to be read from standard input",
               "where one ends and the other begins is unknown", "name a file for one of them");
}

ChosenReceivers receivers_of(const ReceiverArguments& args, const Scene& scene, GridIds grid_ids) {
  check_receiver_options(args);
  ChosenReceivers chosen = args.file.empty() ? on_faces(args, scene, grid_ids) : in_file(args, scene);
  check_not_empty(args, chosen);
  return chosen;
}

std::vector<Problem> warnings_of_receivers(const ChosenReceivers& chosen) {
  if (chosen.without_face == 0) return chosen.warnings;
  return {{.what = "--on auto found no face for " + std::to_string(chosen.without_face) + " of " +
                   text::counted(chosen.receivers.size(), "receiver"),
           .why = "they now lie on none",
           .suggestion = "--on auto:DISTANCE looks further away"}};
}

// --- sources ---

namespace {

void refuse_sky(const Scene& scene, std::vector<std::string> names) {
  if (!take_sky(scene, names)) return;
  text::refuse("--source: the sky is not a source of this command", "its sources are patches",
               "exactff view prints the sky's form factor as (open); truth and render take sky as a source");
}

void add_option(CLI::App& app, SourceArguments& args, const std::string& sky) {
  add_names(app, "--source", args.names, "Source patch or face",
            "; all: every patch" + sky + " (default: every emitting patch)");
}

}  // namespace

void add_source_options(CLI::App& app, SourceArguments& args) { add_option(app, args, ""); }

void add_source_options_under_sky(CLI::App& app, SourceArguments& args) {
  add_option(app, args, "; sky: what is open, all directions that meet nothing, with a radiosity of 1");
}

std::vector<Selection> sources_of(const SourceArguments& args, const Scene& scene) {
  refuse_sky(scene, args.names);
  std::vector<Selection> sources = selections_named(scene, args.names);
  std::set<std::pair<PatchId, std::optional<FaceId>>> named;
  for (const Selection& source : sources) {
    if (named.emplace(source.patch, source.face).second) continue;
    text::refuse("--source: '" + scene.name_of(source) + "' is named twice", "its light would count twice",
                 "give it once");
  }
  return sources;
}

SourcesUnderSky sources_under_sky(const SourceArguments& args, const Scene& scene) {
  SourceArguments patches = args;
  const bool sky = take_sky(scene, patches.names);
  return {sources_of(patches, scene), sky};
}

std::string note_on_sources_without_emission(const Scene& scene, const std::vector<Selection>& sources) {
  constexpr std::size_t kNamed = 5;
  std::vector<std::string> names;
  std::size_t count = 0;
  for (const Selection& source : sources) {
    if (emits(scene, source)) continue;
    if (++count <= kNamed) names.push_back(text::in_quotes(scene.name_of(source)));
  }
  if (count == 0) return {};
  if (count > kNamed) names.push_back(std::to_string(count - kNamed) + " more");
  return count == 1
             ? names.front() + " emits nothing (Ke 0): as a named source it counts with a radiosity of 1"
             : text::enumerate(names) + " emit nothing (Ke 0): as named sources they count with a radiosity of 1 each";
}

}  // namespace exactff::flags
