#include "render/job.h"

#include <map>

#include "exactff/version.h"
#include "jobs/kept_work.h"
#include "kernel/float_environment.h"
#include "scene/scene.h"
#include "scene/selections.h"
#include "text/escape.h"
#include "text/names.h"
#include "text/phrases.h"
#include "text/refuse.h"

namespace exactff::render {

Job::Job(const Request& request) : request_(request) {
  require_scene(request_.scene);
  if (request_.lightmap) {
    require_possible_lightmap();
    atlas_ = std::make_unique<const Atlas>(*request_.scene, *request_.lightmap);
  }
  if (request_.radiosities) {
    take_radiosities();
  } else {
    take_sources();
  }
  require_possible();
  if (!request_.method) return;
  prepared_ = request_.method->method->prepare(*request_.scene);
  for (const Selection& source : sources_) {
    prepared_sources_.push_back(prepared_->prepare_source(source));
    source_pointers_.push_back(prepared_sources_.back().get());
  }
}

void Job::take_radiosities() {
  require_light_of_patches();
  sources_ = request_.radiosities->patches;
  weights_ = request_.radiosities->value;
  gather_ = std::make_unique<radiosity::Gather>(*request_.scene, *request_.radiosities, request_.scene_name);
}

void Job::take_sources() {
  sources_ = request_.sources.empty() && !request_.sky ? request_.scene->emitters() : request_.sources;
  if (sources_.empty() && !request_.sky) {
    text::refuse(request_.scene_name, "no patch emits", "the picture would be black", "name a source with --source");
  }
  factors_ = std::make_unique<whole_view::SourceFactors>(
      *request_.scene, sources_, request_.sky ? whole_view::Sky::kLastSource : whole_view::Sky::kLeftOut);
  weights_ = whole_view::light_weights(*request_.scene, *factors_, request_.quantity, request_.scene_name);
  light_ = std::make_unique<whole_view::Light>(*factors_, weights_);
}

whole_view::Channels Job::light_at(const Receiver& receiver, const whole_view::LightFormula& formula,
                                   const ExactOptions& options, whole_view::Light::Results& results) const {
  if (!gather_) return light_->at(receiver, formula, options, results);
  const bool bounds = request_.bounds == Bounds::kAll;
  return gather_->at(receiver, formula, options,
                     bounds ? radiosity::GatherBounds::kAll : radiosity::GatherBounds::kNone, results);
}

void Job::require_light_of_patches() const {
  if (!request_.sources.empty() || request_.sky) {
    text::refuse("sources are named, and radiosities are given", "the light of all bounces comes from all patches",
                 "leave out the radiosities, or the sources");
  }
  if (request_.quantity == Quantity::kFormFactor || request_.shown != Shown::kLight) {
    text::refuse("form factors or their slopes are requested, and radiosities are given",
                 "a form factor does not depend on the light",
                 "leave out the radiosities, or ask for another quantity");
  }
  if (request_.sides == Sides::kBoth) {
    text::refuse("backs are to be lit, and radiosities are given",
                 "in the solution, light that meets a back is lost, unless the back is a patch",
                 "leave out --two-sided here, and give it to `exactff radiosity`");
  }
}

void Job::require_possible_lightmap() const {
  if (request_.sides == Sides::kFront && request_.spp == 1) return;
  text::refuse(request_.spp == 1 ? "a lightmap of both sides of faces is requested"
                                 : "a lightmap with several points in a texel is requested",
               request_.spp == 1 ? "a texel shows the front of its face" : "a texel shows the point of its centre",
               request_.spp == 1 ? "leave out --two-sided; make the backs faces of their own if they need texels"
                                 : "leave out --spp, or make the lightmap larger");
}

void Job::require_possible() const {
  constexpr double kMostBytes = 8e9;
  if (request_.spp < 1 || request_.spp > 64) {
    text::refuse("a pixel has " + std::to_string(request_.spp) + " x " + std::to_string(request_.spp) + " points",
                 "the number along a side is between 1 and 64", "give a number such as 4");
  }
  if (request_.layers == Layers::kAll && (request_.spp > 1 || request_.method)) {
    text::refuse(request_.spp > 1 ? "layers are requested of pixels with several points"
                                  : "layers are requested of a picture by an approximate method",
                 request_.spp > 1 ? "a mean of positions or face numbers means nothing" : "they hold exact results",
                 request_.spp > 1 ? "leave out --layers or --spp" : "leave out --layers or --method");
  }
  if (request_.sky && (request_.layers == Layers::kAll || request_.method)) {
    text::refuse(
        request_.method ? "sky is a source, and the method is approximate"
                        : "sky is a source, and layers are requested",
        request_.method ? "such methods know patches only" : "the sky has no area of which a fraction is visible",
        request_.method ? "leave out sky or --method" : "leave out sky or --layers");
  }
  if (!request_.measure.is_form_factor() && (request_.quantity != Quantity::kFormFactor || request_.method ||
                                             request_.radiosities || request_.shown == Shown::kSlope)) {
    text::refuse("another measure than the form factor is requested together with light, a method or the gradient",
                 "it is a sum over the sources, whatever they emit, and only its exact value is known",
                 "ask for the quantity form-factor, and leave out --method, --against METHOD and --radiosity");
  }
  if (request_.bounds == Bounds::kAll && request_.method) {
    text::refuse("bounds are requested of a picture by an approximate method", "such a method proves nothing",
                 "leave out --bounds or --method");
  }
  if (request_.shown == Shown::kSlope &&
      (request_.method || request_.sky || request_.layers == Layers::kAll || request_.bounds == Bounds::kAll)) {
    text::refuse("the gradient is requested together with a method, the sky, layers or bounds",
                 "it is computed exactly, for patches, and its components are layers of their own",
                 "leave out --method, --against METHOD, sky, --layers and --bounds");
  }
  const Size& size = this->size();
  const double bytes = 8.0 * size.width * size.height * static_cast<double>(numbers_per_pixel());
  if (bytes <= kMostBytes) return;
  text::refuse("the picture needs " + text::rounded(bytes / 1e9) + " GB of memory",
               "a picture is kept in memory, and at most 8 GB are used for it", "make it smaller, or ask for less");
}

std::size_t Job::numbers_per_pixel() const {
  return kLower + (request_.bounds == Bounds::kAll ? 6 : 0) + layers().size() + (request_.spp > 1 ? kLamps : 0);
}

std::vector<std::string> Job::source_names() const {
  constexpr std::size_t kLongest = 200;  // of an OpenEXR file: 255 bytes for a channel
  std::vector<std::string> names;
  std::map<std::string, int> used;
  for (std::size_t s = 0; s < factors().count(); ++s) {
    std::string name = text::printable(factors().name_of(s));
    if (name.empty() || name.size() > kLongest) name = "source" + std::to_string(s + 1);
    if (const int times = used[name]++; times > 0) name += '#' + std::to_string(times + 1);
    names.push_back(std::move(name));
  }
  return names;
}

std::vector<Layer> Job::layers() const {
  std::vector<Layer> layers;
  if (request_.shown == Shown::kSlope) {
    for (const char* name : {"gradient.X", "gradient.Y", "gradient.Z", "kink"}) layers.push_back({name, false, {}});
  }
  if (request_.layers == Layers::kNone) return layers;
  for (const std::string& name : source_names()) {
    layers.push_back({"F." + name, false, {}});
    layers.push_back({"visible." + name, true, {}});
    layers.push_back({"fraction." + name, false, {}});
  }
  for (const char* name : {"position.X", "position.Y", "position.Z", "normal.X", "normal.Y", "normal.Z"})
    layers.push_back({name, false, {}});
  if (!atlas_) layers.push_back({"distance", false, {}});
  for (const char* name : {"id.face", "id.patch"}) layers.push_back({name, true, {}});
  return layers;
}

namespace {

std::string words_of(const Vec3& v) {
  return text::shortest(v.x) + ' ' + text::shortest(v.y) + ' ' + text::shortest(v.z);
}

std::string words_of(const Scene& scene, const std::vector<Selection>& selections) {
  return text::printable(text::joined(names_of(scene, selections), " + "));
}

std::string words_of_measure(const Measure& measure) {
  std::string words(to_string(measure.kind));
  if (measure.sphere) words += " of a sphere";
  if (measure.kind != MeasureKind::kOvercast) return words;
  return words + ", up " + words_of(measure.up);
}

}  // namespace

std::string flags_of(const View& view) {
  const kernel::StandardArithmetic arithmetic;
  const Camera& camera = view.camera();
  return "--eye " + words_of(camera.eye) + " --look " + words_of(camera.look) + " --up " + words_of(camera.up) +
         (camera.ortho ? " --ortho " + text::shortest(*camera.ortho) : " --fov " + text::shortest(camera.fov)) +
         " --size " + std::to_string(view.size().width) + 'x' + std::to_string(view.size().height);
}

std::string Job::names_of_sources() const {
  std::vector<std::string> names;
  for (std::size_t s = 0; s < factors().count(); ++s) names.push_back(text::printable(factors().name_of(s)));
  return text::joined(names, " + ");
}

Metadata Job::metadata() const {
  const Scene& scene = *request_.scene;
  const bool slope = request_.shown == Shown::kSlope;
  Metadata metadata = {
      {"software", text::program_version()},
      {"scene", text::printable(request_.scene_name)},
      {"scene hash", scene.hash()},
      atlas_ ? std::pair<std::string, std::string>{"lightmap", words_of(scene, *request_.lightmap)}
             : std::pair<std::string, std::string>{"camera", flags_of(request_.view)},
      {"quantity", slope ? "slope of the form factors along the surface, per unit of length"
                   : !request_.measure.is_form_factor()
                       ? words_of_measure(request_.measure)
                       : std::string(to_string(request_.quantity)) + ", in " + unit_of(request_.quantity, request_.ke)},
      {"Ke", request_.ke == KeMeans::kRadiance ? "radiance" : "radiosity"},
      {"sides", request_.sides == Sides::kBoth ? "both" : "front"},
      {"sources", request_.radiosities ? "all patches, with their radiosities after all bounces" : names_of_sources()},
      {"method", request_.method ? request_.method->text()
                 : slope         ? "exact derivatives"
                                 : "exact, correctly rounded"},
      {"points per pixel", std::to_string(request_.spp * request_.spp)}};
  if (request_.radiosities) {
    metadata.emplace_back("radiosities", text::printable(request_.radiosities->name) + ", hash " +
                                             radiosity::hash_of(*request_.radiosities));
    if (request_.bounds == Bounds::kAll) {
      metadata.emplace_back("bounds",
                            "lower and upper bound the sum over patches of form factor and radiosity, one "
                            "number for each patch; not the light that varies over patches; " +
                                radiosity::words_of_claim(*request_.radiosities));
    }
  }
  if (const auto flipped = scene.flipped(); !flipped.empty())
    metadata.emplace_back("flipped", words_of(scene, flipped));
  if (const auto clear = scene.transparent(); !clear.empty()) {
    metadata.emplace_back("transparent", words_of(scene, clear));
  }
  return metadata;
}

std::string Job::hash() const {
  std::string all = request_.bounds == Bounds::kAll ? "bounds" : "";
  if (request_.layers == Layers::kAll) all += " layers";
  for (const auto& [name, value] : metadata()) all += '\n' + name + '=' + value;
  return jobs::short_hash(all);
}

whole_view::LightFormula Job::formula(FaceId face, bool back) const {
  return whole_view::light_formula(*request_.scene, std::span(&face, 1),
                                   back ? whole_view::FaceSide::kBack : whole_view::FaceSide::kFront, request_.quantity,
                                   request_.ke);
}

std::string identity_of(const Request& request, const std::optional<methods::Choice>& against) {
  std::string all = request.scene->hash() + '\n' +
                    (request.lightmap ? words_of(*request.scene, *request.lightmap) : flags_of(request.view)) + '\n' +
                    std::string(to_string(request.quantity)) + '\n';
  if (!request.measure.is_form_factor()) all += words_of_measure(request.measure) + '\n';
  for (const Selection& source : request.sources) all += request.scene->name_of(source) + '\n';
  if (request.sky) all += "and the sky\n";
  if (request.radiosities) all += "radiosities of " + request.radiosities->name + '\n';
  all += (request.method ? request.method->text() : "exact") + '\n' + (against ? against->text() : "") + '\n';
  for (const int number :
       {static_cast<int>(request.ke), static_cast<int>(request.sides), request.spp, static_cast<int>(request.bounds),
        static_cast<int>(request.layers), static_cast<int>(request.shown)}) {
    all += std::to_string(number) + ' ';
  }
  return all;
}

}  // namespace exactff::render
