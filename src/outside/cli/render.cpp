// exactff render: exact images of the direct light in a scene, or of the light of given radiosities.
#include "exactff/render.h"

#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <memory>
#include <system_error>

#include "cli/commands.h"
#include "cli/output.h"
#include "cli/process.h"
#include "exactff/slips.h"
#include "files/file.h"
#include "files/numpy.h"
#include "flags/scene.h"
#include "flags/values.h"
#include "render/job.h"
#include "text/escape.h"
#include "text/names.h"
#include "text/phrases.h"
#include "text/refuse.h"
#include "text/text_lines.h"

namespace exactff::cli {
namespace {

struct RenderArguments : KeptRun {
  flags::SceneArguments scene;
  flags::SourceArguments sources;
  flags::SolutionArgument solution;
  flags::CameraArguments camera;
  std::optional<double> ortho;
  std::string size = "512x512";
  std::string lightmap;  // its size
  std::vector<std::string> on;
  int uv = 0, margin = 0;
  int spp = 1;
  bool two_sided = false;
  std::string quantity;
  flags::MeasureArgument measure;
  bool sphere = false;
  std::string ke = "radiosity";
  std::string method, against;
  bool strip = false;
  bool layers = false;
  std::optional<double> exposure;
  std::string doubles, bounds;
  flags::EngineArgument engine;
  int threads = 0;
  std::string image;
};

// --- what it writes and prints ---

struct Rendered {
  render::Picture picture = {};
  std::optional<render::Picture> judged = {};  // by the method of --against, or its file
  std::string judged_name = {};
  std::optional<render::Errors> errors = {};
};

namespace fs = std::filesystem;

// Opens the file beside its place, as writing it will, and removes it.
void check_file(const std::string& file) {
  std::error_code ignored;
  if (fs::is_other(file, ignored)) return;
  if (fs::is_directory(file, ignored)) {
    text::refuse(file, "is a folder", "the result is a file", "name a file");
  }
  const files::WholeFile probe(file);
}

void write_array(const std::string& file, const std::vector<std::size_t>& shape,
                 const std::vector<const std::vector<double>*>& parts) {
  files::NpyFile<double> array(file, shape);
  for (const std::vector<double>* part : parts) array.append(*part);
  array.commit();
}

std::string took(const render::Picture& picture) { return text::duration(picture.seconds); }

// For a method with a formula of its own, that name; the exact values have none.
std::string name_of_picture(const render::Picture& picture) {
  const auto found = std::ranges::find(picture.metadata, "method", &std::pair<std::string, std::string>::first);
  return found == picture.metadata.end() ? "" : found->second.substr(0, found->second.find(", correctly"));
}

render::Colours strip_of(const Rendered& rendered, double exposure) {
  const double scale = render::colour_scale(*rendered.errors);
  return render::strip(std::array{render::develop(rendered.picture, exposure),
                                  render::develop(*rendered.judged, exposure),
                                  render::coloured(*rendered.errors, rendered.picture.size, scale)});
}

// What the strip shows, from left to right.
std::string strip_words(const Rendered& rendered) {
  const double scale = render::colour_scale(*rendered.errors);
  return name_of_picture(rendered.picture) + " | " + rendered.judged_name +
         " | errors: red too bright, blue too dark, full colour from " + text::short_number(scale, 2) +
         " on, black outlines around regions that are mostly wrong by over 10 %";
}

std::string image_bytes(const RenderArguments& args, const Rendered& rendered) {
  const bool png = render::image_kind(args.image) == render::ImageKind::kPng;
  const auto exposure = [&] { return args.exposure ? *args.exposure : render::automatic_exposure(rendered.picture); };
  render::Metadata metadata = rendered.picture.metadata;
  if (args.strip) {
    metadata.emplace_back("strip", strip_words(rendered));
    return render::png_of(strip_of(rendered, exposure()), metadata);
  }
  if (rendered.errors) {
    if (!png) return render::exr_of(render::difference(*rendered.judged, rendered.picture));
    const double scale = render::colour_scale(*rendered.errors);
    return render::png_of(render::coloured(*rendered.errors, rendered.picture.size, scale),
                          render::difference(*rendered.judged, rendered.picture).metadata);
  }
  return png ? render::png_of(render::develop(rendered.picture, exposure()), metadata)
             : render::exr_of(rendered.picture);
}

std::string words_of_pixels(const render::Picture& picture) {
  std::array<std::uint64_t, 4> count{};
  for (const render::Shows shows : picture.shows) ++count[static_cast<std::size_t>(shows)];
  constexpr std::array kNames = {"show nothing", "black backs", "lit faces", "emitters"};
  std::string words;
  for (const std::size_t kind : {2U, 3U, 1U, 0U}) {
    if (count[kind] > 0) words += (words.empty() ? "" : ", ") + std::to_string(count[kind]) + ' ' + kNames[kind];
  }
  return words;
}

// Throws InputError if a file cannot be written.
void check_files(const RenderArguments& args) {
  check_file(args.image);
  for (const std::string& file : {args.doubles, args.bounds}) {
    if (file.empty()) continue;
    if (fs::path(file).extension() != ".npy") {
      text::refuse(file, "does not end in .npy", "it is a NumPy file, which other programs recognise by that",
                   "name a .npy file");
    }
    check_file(file);
  }
}

void write_files(const RenderArguments& args, const Rendered& rendered) {
  const render::Picture& picture = rendered.picture;
  const auto height = static_cast<std::size_t>(picture.size.height),
             width = static_cast<std::size_t>(picture.size.width);
  const std::string image = image_bytes(args, rendered);
  if (!args.doubles.empty()) write_array(args.doubles, {height, width, 3}, {&picture.values});
  if (!args.bounds.empty()) write_array(args.bounds, {2, height, width, 3}, {&picture.lower, &picture.upper});
  write_whole_file(args.image, image);
}

// "12 faces; 3 have ...; 40 texels lie in several faces: ..."
std::string words_of(const Scene& scene, const render::Charts& charts) {
  std::string words = text::counted(charts.faces, "face");
  const auto tell = [&](std::uint64_t count, const char* one, const char* several) {
    if (count > 0) words += "; " + std::to_string(count) + ' ' + (count == 1 ? one : several);
  };
  tell(charts.without, "has no texture coordinates and is left out", "have no texture coordinates and are left out");
  tell(charts.flat, "has no area in the texture", "have no area in the texture");
  tell(charts.outside, "reaches beyond 0 to 1", "reach beyond 0 to 1");
  tell(charts.missed, "is too small for a texel", "are too small for a texel");
  if (!charts.first_overlap) return words;
  const auto& [shown, other] = *charts.first_overlap;
  tell(charts.overlapping, "texel lies", "texels lie");
  return words + " in several triangles and shows the one of the lowest face, first of " + scene.name_of(shown) +
         (other == shown ? ", which overlaps itself" : " and " + scene.name_of(other));
}

// The summary on standard output. `tell_camera`: the camera was chosen by the program.
void print_rendered(const Scene& scene, const Rendered& rendered, const RenderArguments& args,
                    const std::string& camera) {
  const render::Picture& picture = rendered.picture;
  std::cout << picture.size.width << " x " << picture.size.height << (picture.charts ? " texels: " : " pixels: ")
            << words_of_pixels(picture) << '\n';
  if (picture.charts) std::cout << "charts: " << text::printable(words_of(scene, *picture.charts)) << '\n';
  std::cout << "computed in " << took(picture) << " of processor time";
  if (rendered.judged && rendered.judged->seconds > 0.0)  // not read from a file
    std::cout << ", " << text::printable(rendered.judged_name) << " in " << took(*rendered.judged);
  std::cout << '\n';
  if (!camera.empty()) std::cout << "camera: " << camera << '\n';
  if (rendered.errors) {
    const render::Errors& errors = *rendered.errors;
    std::cout << "errors: RMS " << text::short_number(errors.rms) << ", 99th percentile "
              << text::short_number(errors.p99) << ", worst " << text::short_number(errors.worst)
              << "; relative: median " << text::short_number(errors.relative_median) << ", 99th percentile "
              << text::short_number(errors.relative_p99) << "; " << text::share(errors.wrong, errors.pixels)
              << " of pixels wrong by over 10 %\n";
  }
  if (args.strip) std::cout << "strip: " << text::printable(strip_words(rendered)) << '\n';
  const bool develops = render::image_kind(args.image) == render::ImageKind::kPng && (args.strip || !rendered.errors);
  if (develops && !args.exposure) {
    std::cout << "automatic exposure: " << text::short_number(render::automatic_exposure(picture), 6) << '\n';
  }
  std::cout << "Image: " << text::printable(args.image) << '\n';
}

// Returns the exit code: 3, with a message, if a value is not certified.
int warn_of_uncertified_points(const Rendered& rendered) {
  const std::uint64_t points = rendered.picture.not_certified;
  if (points == 0) return 0;
  std::cerr << "exactff: the values of " << text::counted(points, "point")
            << " could not be certified within the precision cap; they are estimates, and their bounds are valid\n";
  return kNotAsAsked;
}

constexpr const char* kRenderFooter =
    "Each pixel shows the first face that its ray meets, decided exactly, and the light that this point receives\n"
    "directly from all sources, correctly rounded: soft shadows without noise. IMAGE is OpenEXR (.exr, 32-bit linear\n"
    "values) or PNG (.png, in sRGB, for looking). Backs of faces are black.\n"
    "With --radiosity FILE, the light is that of all bounces: Ke + Kd times the sum over all patches of form factor,\n"
    "exact at the point, and radiosity, from FILE. The channels lower.R ... upper.B of an EXR file, and --bounds,\n"
    "bound this sum for all radiosities within their bounds. They do not bound the true light, which varies over a\n"
    "patch; --divide makes patches smaller.\n"
    "Without --eye and --look, the camera shows the whole scene from its most open side, or stands in a corner of a\n"
    "closed room. It is printed, so that it can be changed.\n"
    "With --against METHOD, IMAGE shows the errors of this method: white is none, red too bright, blue too dark;\n"
    "regions that are wrong by over 10 % are outlined. --strip shows the picture, that of the method and the errors\n"
    "beside each other; what they are is printed, and not written into the image. A METHOD is a name with settings,\n"
    "as for `exactff compare`: adaptive:eps_B=0.01,rays=16. --against also takes the picture of another program, of\n"
    "the same camera, size and --quantity: a .npy array (height, width, 3) or .exr.\n"
    "With --lightmap WxH, IMAGE is in texture space, for scenes with texture coordinates: row 0 is at v = 1, the\n"
    "centre of column 0 at u = 0.5 / W. A texel whose centre lies in a face, decided exactly, has the irradiance (or\n"
    "--quantity) at the point that the centre stands for; the others are 0. In EXR, the channel A is 1 for the former\n"
    "and 0 for the latter; with --margin, `margin` is the distance in texels from where one was copied. --against\n"
    "FILE compares with a baker's map.\n"
    "Until IMAGE is complete, finished tiles are kept in IMAGE.part. After an interruption, the same command with\n"
    "--resume continues from there. The numbers do not depend on threads or interruptions.\n"
    "Exit codes: 0 done, 2 bad input, 3 done but some pixels are not certified, 128 + signal when interrupted.\n"
    "\n"
    "Examples:\n"
    "  exactff render data/scenes/cornell_box.obj --eye 278 273 -800 --look 278 273 0 --fov 39.3 -o cornell.png\n"
    "  exactff render data/scenes/blinds_room.obj --against hemicube --strip -o blinds.png\n"
    "  exactff render data/scenes/blinds_room.obj --size 256x256 --against mine.npy -o errors.png\n"
    "  exactff render data/scenes/cornell_box.obj --radiosity build/cells.csv --size 256x256 -o all_light.exr\n"
    "  exactff render room.obj --lightmap 512x512 --margin 2 --layers -o lightmap.exr";

std::string size_flag(const RenderArguments& args) { return args.lightmap.empty() ? "--size" : "--lightmap"; }

render::Size size_of(const RenderArguments& args) {
  const std::string& text = args.lightmap.empty() ? args.size : args.lightmap;
  if (const auto size = flags::numbers_across(text)) return {size->first, size->second};
  text::refuse(size_flag(args) + ": " + text::in_quotes(text) + " is not a size",
               "a picture has a width and a height in pixels", "write WIDTHxHEIGHT: " + size_flag(args) + " 512x512");
}

// By the camera of --eye and --look, or one that the program places.
render::View view_of(const RenderArguments& args, const Scene& scene, const render::Size& size) {
  render::CameraWishes wishes = args.camera.wishes();
  wishes.ortho = args.ortho;
  if (!args.camera.is_placed()) return render::View(render::default_camera(scene, wishes, size), size);
  render::Camera camera = args.camera.camera(scene);
  camera.ortho = args.ortho;
  return render::View(camera, size);
}

// What can be refused before the scene is read.
void check_arguments(const RenderArguments& args) {
  (void)size_of(args);
  (void)args.camera.is_placed();
  const render::ImageKind kind = render::image_kind(args.image);
  if (args.strip && args.against.empty()) {
    text::refuse("--strip is given without --against", "a strip shows a method beside the exact picture",
                 "add --against METHOD");
  }
  if (args.strip && kind == render::ImageKind::kExr) {
    text::refuse(args.image, "a strip is a picture to look at", "an EXR file holds numbers", "name a .png file");
  }
  if (args.exposure && kind == render::ImageKind::kExr) {
    text::refuse("--exposure is given with an EXR file", "its numbers are not scaled", "leave it out");
  }
  if (args.exposure && !args.against.empty() && !args.strip) {
    text::refuse("--exposure is given with --against", "errors have a colour scale of their own", "leave it out");
  }
  if (args.layers && (kind != render::ImageKind::kExr || !args.against.empty())) {
    text::refuse("--layers needs an EXR file and no --against", "a PNG file and a picture of errors have no layers",
                 "name a .exr file, without --against");
  }
  check_files(args);
}

// What --against names, if it is given: a method, or a picture of the same size.
struct Opponent {
  std::optional<methods::Choice> method = {};
  std::optional<render::Picture> picture = {};
};

Opponent opponent_named(const RenderArguments& args) {
  const std::string& text = args.against;
  if (text.empty()) return {};
  const std::string extension = text::in_lower_case(fs::path(text).extension().string());
  if (extension != ".npy" && extension != ".exr") return {.method = methods::parse(text)};
  render::Picture picture = render::read_picture(text);
  const render::Size size = size_of(args);
  const auto words = [](const render::Size& one) { return fmt::format("{}x{}", one.width, one.height); };
  if (words(picture.size) != words(size)) {
    text::refuse(text, fmt::format("has {} pixels, and the picture {}", words(picture.size), words(size)),
                 "each pixel is compared with one of the same place",
                 fmt::format("give {} {}", size_flag(args), words(picture.size)));
  }
  return {.picture = std::move(picture)};
}

// Of given radiosities, an EXR file has the bounds in channels of its own.
bool wants_bounds(const RenderArguments& args) {
  const bool exr = render::image_kind(args.image) == render::ImageKind::kExr;
  return !args.bounds.empty() || (args.solution.is_given() && exr && args.method.empty());
}

render::Request request_of(const RenderArguments& args, const flags::LitScene& lit,
                           std::optional<methods::Choice> method) {
  const Scene& scene = lit.scene;
  render::Request request{.scene = &scene};
  request.radiosities = lit.radiosities;
  request.scene_name = args.scene.file_name();
  const render::Size size = size_of(args);
  if (!args.lightmap.empty()) {
    request.lightmap = {size, args.uv, {}, args.margin};
    if (!args.on.empty()) request.lightmap->on = flags::selections_named(scene, args.on);
  } else {
    request.view = view_of(args, scene, size);
  }
  flags::SourcesUnderSky sources = flags::sources_under_sky(args.sources, scene);
  request.sources = std::move(sources.sources);
  request.sky = sources.sky;
  request.method = std::move(method);
  request.measure = args.measure.measure(args.camera.up, args.sphere);
  const Quantity usual = !request.measure.is_form_factor() ? Quantity::kFormFactor
                         : request.lightmap                ? Quantity::kIrradiance
                                                           : Quantity::kRadiance;
  request.quantity = quantity_named(args.quantity).value_or(usual);
  if (args.quantity == "gradient") request.shown = render::Shown::kSlope;
  request.ke = args.ke == "radiance" ? KeMeans::kRadiance : KeMeans::kRadiosity;
  request.sides = args.two_sided ? render::Sides::kBoth : render::Sides::kFront;
  request.spp = args.spp;
  request.bounds = wants_bounds(args) ? render::Bounds::kAll : render::Bounds::kNone;
  request.layers = args.layers ? render::Layers::kAll : render::Layers::kNone;
  request.engine = args.engine.engine();
  request.threads = args.threads;
  return request;
}

// What the program has chosen; empty if that is nothing.
std::string words_of_camera(const RenderArguments& args, const render::View& view) {
  const bool chose_up = !flags::is_given(args.camera.up);
  if (!args.lightmap.empty() || (args.camera.is_placed() && !chose_up)) return {};
  const bool is_z = chose_up && view.camera().up == Vec3{0, 0, 1};
  return render::flags_of(view) +
         (is_z ? " (z points upwards, since more area of fronts looks along +z than along +y)" : "");
}

// The journal beside the image. A device has none. Its first record says to which image its tiles belong.
class Kept {
 public:
  Kept(const RenderArguments& args, const std::string& identity) {
    constexpr const char* kRequest = "request";
    std::error_code ignored;
    if (std::filesystem::is_other(args.image, ignored)) return;
    journal_.emplace(jobs::journal_of_folder(args.image), args.existing());
    const std::optional<std::string> found = journal_->find(kRequest);
    if (found && *found != identity) {
      text::refuse(journal_->path(), "holds finished tiles of another image",
                   "tiles of different images cannot be mixed",
                   "use the same flags as before, name another image, or start again with --force");
    }
    if (!found) journal_->add(kRequest, identity);
    before_ = journal_->size() - 1;
  }
  ~Kept() {
    if (journal_ && !has_some()) journal_->remove();
  }
  Kept(const Kept&) = delete;
  Kept& operator=(const Kept&) = delete;

  [[nodiscard]] jobs::Journal* journal() { return journal_ ? &*journal_ : nullptr; }
  [[nodiscard]] std::string words() const {
    if (!journal_) return "nothing is kept\n";
    return "finished tiles are kept in " + text::printable(journal_->path().string()) +
           "; to continue, run the same command with --resume\n";
  }
  [[nodiscard]] bool has_some() const { return journal_ && journal_->size() > 1; }
  void done() {
    if (!journal_) return;
    journal_->remove();
    if (before_ > 0) {
      std::cerr << "note: " << text::counted(before_, "finished tile") << (before_ == 1 ? " was" : " were")
                << " reused\n";
    }
  }

 private:
  std::optional<jobs::Journal> journal_;
  std::size_t before_ = 0;
};

Rendered render_pictures(const render::Request& request, const Opponent& against, const Hooks& hooks,
                         jobs::Journal* journal) {
  Rendered result{.picture = render::render(request, hooks, journal), .judged = against.picture};
  if (against.method) {
    render::Request judged = request;
    judged.method = against.method;
    judged.bounds = render::Bounds::kNone;
    result.judged = render::render(judged, hooks, journal);
  }
  if (!result.judged) return result;
  result.judged->shows = result.picture.shows;
  result.judged_name = against.method ? against.method->text() : result.judged->metadata.front().second;
  result.errors = render::errors_of(*result.judged, result.picture);
  return result;
}

int run(const RenderArguments& args) {
  check_arguments(args);
  std::optional<methods::Choice> method;
  if (!args.method.empty()) method = methods::parse(args.method);  // before the scene is read: it may be misspelt
  const Opponent against = opponent_named(args);
  const flags::LitScene lit = with_progress([&] { return flags::load(args.scene, args.solution); });
  const Scene& scene = lit.scene;
  print_warnings(scene.warnings());
  print_hidden_faces(scene);
  print_warnings(slips::warnings_of_turned_surfaces(scene));
  const render::Request request = with_progress([&] { return request_of(args, lit, method); });
  const std::string note = flags::note_on_sources_without_emission(scene, request.sources);
  if (!note.empty()) std::cerr << "note: " << text::printable(note) << '\n';
  Kept kept(args, render::identity_of(request, against.method));
  const InterruptWatch watch("exactff: interrupted; " + kept.words());
  ProgressBar bar;
  const Hooks hooks = bar.hooks();
  Rendered result;
  try {
    result = render_pictures(request, against, hooks, kept.journal());
    bar.clear();
    leave_if_interrupted();
    write_files(args, result);
  } catch (const Cancelled&) {
    bar.clear();
    std::cerr << "exactff: interrupted; " << (kept.has_some() ? kept.words() : "nothing was written\n");
    return 128 + interrupting_signal();
  }
  kept.done();
  print_rendered(scene, result, args, words_of_camera(args, request.view));
  check_output(std::cout);
  return warn_of_uncertified_points(result);
}

void add_camera_flags(CLI::App& app, RenderArguments& args) {
  args.camera.add_to(app, "Where the camera stands (default: where it shows the whole scene)",
                     "The point that it looks at");
  flags::add_value(app, "--ortho", args.ortho, "LENGTH",
                   "Parallel rays; the picture has this height in the scene's unit")
      ->check(flags::is_positive);
  flags::add_value(app, "--size", args.size, "WxH", "Width and height in pixels")->capture_default_str();
  flags::add_value(app, "--spp", args.spp, "N",
                   "Anti-aliasing: a pixel is the mean of the exact values at the centres of N x N parts of it")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
}

void add_lightmap_flags(CLI::App& app, RenderArguments& args) {
  CLI::Option* lightmap = flags::add_value(
      app, "--lightmap", args.lightmap, "WxH",
      "Instead of a camera's picture, one in texture space: each texel has the light of the point of a "
      "face that its centre stands for, by the file's texture coordinates (vt)");
  for (const char* flag : {"--size", "--eye", "--look", "--fov", "--ortho", "--spp"})
    lightmap->excludes(app.get_option(flag));
  flags::add_names(app, "--on", args.on, "Lightmap: only of these patches or faces");
  flags::add_value(app, "--uv", args.uv, "0|1", "Lightmap: which set of texture coordinates; files of OBJ have set 0")
      ->check(CLI::Range(0, kTextureSets - 1))
      ->capture_default_str();
  flags::add_value(app, "--margin", args.margin, "N",
                   "Lightmap: copy texels at the edges of faces so many texels outwards")
      ->check(CLI::Range(0, render::kLongestSide))
      ->capture_default_str();
  for (const char* flag : {"--on", "--uv", "--margin"}) app.get_option(flag)->needs(lightmap);
}

void add_value_flags(CLI::App& app, RenderArguments& args) {
  app.add_flag("--two-sided", args.two_sided, "Light the backs of faces, too, instead of showing them black");
  args.measure.add_to(app);
  app.add_flag("--sphere", args.sphere, "Of a small sphere at the point, which sees both sides of the face");
  app.add_option("--quantity", args.quantity,
                 "What a pixel holds: the radiance B / pi, the radiosity B, the irradiance, the sum of form factors, "
                 "or the length of its gradient along the surface (default: radiance, of a lightmap irradiance; "
                 "form-factor with --measure or --sphere, which then is the sum of that measure)")
      ->check(CLI::IsMember({"radiance", "radiosity", "irradiance", "form-factor", "gradient"}));
  app.add_option("--ke", args.ke, "What Ke means in the scene")
      ->check(CLI::IsMember({"radiosity", "radiance"}))
      ->capture_default_str();
  flags::add_value(app, "--method", args.method, "METHOD", "Render by this method instead of exactly");
  flags::add_value(app, "--against", args.against, "METHOD|FILE",
                   "Show and print the errors of this method, or of this picture")
      ->check(flags::is_read());
  app.add_flag("--strip", args.strip, "With --against: the picture, that of the method and the errors side by side");
}

void add_output_flags(CLI::App& app, RenderArguments& args) {
  app.add_flag(
      "--layers", args.layers,
      "EXR: add form factor, visible part and fraction of each source, position, normal, distance, face and patch");
  flags::add_value(app, "--exposure", args.exposure, "NUMBER",
                   "PNG: multiply by this factor (default: the 99th percentile becomes 0.8)")
      ->check(flags::is_positive);
  flags::add_written(
      app, "--double", args.doubles,
      "Also write the numbers as a NumPy file of doubles, shape (height, width, 3), NaN where nothing is met",
      flags::Format::kNpy);
  flags::add_written(app, "--bounds", args.bounds,
                     "Also write their bounds as a NumPy file, shape (2, height, width, 3): lower, upper",
                     flags::Format::kNpy);
}

}  // namespace

Command add_render(CLI::App& app) {
  auto args = std::make_shared<RenderArguments>();
  CLI::App* command =
      app.add_subcommand("render", "Render an exact image of the direct light, with soft shadows, or of all light");
  args->scene.add_to(*command);
  args->scene.add_divide_to(*command);
  args->solution.add_to(*command);
  add_camera_flags(*command, *args);
  add_lightmap_flags(*command, *args);
  flags::add_source_options_under_sky(*command, args->sources);
  add_value_flags(*command, *args);
  add_output_flags(*command, *args);
  args->engine.add_to(*command);
  flags::add_threads(*command, args->threads);
  flags::add_written(*command, "-o,--output", args->image, "Image to write, .exr or .png; an existing one is replaced",
                     flags::Format::kImage, flags::Beside::kJournal)
      ->required();
  args->add_to(*command, "Start again: discard the tiles of an interrupted run");
  command->footer(kRenderFooter);
  return {command, [args] { return run(*args); }};
}

}  // namespace exactff::cli
