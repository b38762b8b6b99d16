#include "whole_view/light.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "exact/region.h"
#include "kernel/expect.h"
#include "text/text_lines.h"

namespace exactff::whole_view {

void require_agreement(const Scene& scene, const Receiver& receiver, const ViewOptions& options,
                       const WholeView& seen) {
  auto next = seen.patches.begin();
  for (std::size_t p = 0; p < scene.patches().size(); ++p) {
    const Selection patch{.patch = static_cast<PatchId>(p), .face = {}, .scene = scene.id()};
    const std::vector<FaceId> faces = scene.faces_of(patch);
    const bool clear = std::ranges::any_of(faces, [&](FaceId face) { return scene.face(face).transparent; });
    const FormFactor f = exact_form_factor(scene, receiver, {scene, patch},
                                           {.engine = Engine::kBoth,
                                            .measure = options.measure,
                                            .digits = options.digits,
                                            .precision_cap = options.precision_cap});
    const bool is_seen = next != seen.patches.end() && next->patch == patch.patch;
    const ViewShare found = is_seen ? next->form_factor : ViewShare{};
    if (is_seen) ++next;
    if (clear || f.status == Status::kNotCertified || found.status == Status::kNotCertified) continue;
    if (found.value == f.value && found.status == f.status && found.enclosure.overlaps(f.enclosure)) continue;
    throw std::logic_error("the sweep and the per-source solver disagree on '" + scene.name_of(patch) +
                           "': " + found.enclosure.midpoint() + " and " + f.enclosure.midpoint());
  }
}

// --- Source factors ---

namespace {

// The whole view leaves transparent faces out.
bool is_opaque(const Scene& scene, const Selection& source) {
  const std::vector<FaceId> faces = scene.faces_of(source);
  return std::ranges::none_of(faces, [&](FaceId face) { return scene.face(face).transparent; });
}

std::size_t faces_with_area(const Scene& scene) {
  const auto has_area = [](const Face& face) { return face.piece_count > 0; };
  return static_cast<std::size_t>(std::ranges::count_if(scene.faces(), has_area));
}

// A sweep costs what the whole scene costs, however few the sources are. Of all faces as sources, one by one and a
// sweep cost about the same in closed rooms and clouds of 200 to 400 faces; a sweep takes half the time for 500 lamps
// or 1,000 triangles of a teapot. Of half the faces, one by one is never much slower. Of patches with a face each, in
// which a divided Cornell box is cut, it costs the same for 110 and half for 188 and 380.
bool are_most_of(const Scene& scene, std::span<const Selection> sources) {
  constexpr std::size_t kFewest = 400, kFewestSources = 128;
  std::size_t faces = 0;
  for (const Selection& source : sources) faces += scene.faces_of(source).size();
  return (faces >= kFewest || sources.size() >= kFewestSources) && 4 * faces >= 3 * faces_with_area(scene);
}

}  // namespace

SourceFactors::SourceFactors(const Scene& scene, std::span<const Selection> sources, Sky sky)
    : scene_(scene), sky_(sky) {
  const auto is_face = [](const Selection& source) { return source.face.has_value(); };
  faces_ = !sources.empty() && std::ranges::all_of(sources, is_face);
  in_view_ = (faces_ || std::ranges::none_of(sources, is_face)) &&
             std::ranges::all_of(sources, [&](const Selection& source) { return is_opaque(scene, source); });
  are_most_ = are_most_of(scene, sources);
  for (const Selection& source : sources) sources_.emplace_back(scene, source);
}

std::string SourceFactors::name_of(std::size_t source) const {
  return is_sky(source) ? std::string(kSky) : scene_.name_of(sources_[source].selection());
}

Rgb SourceFactors::radiosity(std::size_t source) const {
  return is_sky(source) ? Rgb{1.0, 1.0, 1.0} : scene_.source_radiosity(sources_[source].selection());
}

bool SourceFactors::sweeps(const ExactOptions& options) const {
  const bool values_alone = !options.visible_fraction && !options.exact_fraction && !options.list_cutters &&
                            !options.gradient && !options.list_arcs && !options.along;
  return in_view_ && (are_most_ || sky_ == Sky::kLastSource) && values_alone && options.engine == Engine::kEdges &&
         options.only_occluders == nullptr;
}

void SourceFactors::find_all(const Receiver& receiver, const ExactOptions& options, std::vector<FormFactor>& factors,
                             Results& memory) const {
  factors.resize(count());
  const bool sweeps_all = sweeps(options);
  if (sweeps_all || sky_ == Sky::kLastSource) look_around(receiver, options, memory);
  for (std::size_t s = 0; s < count(); ++s) {
    if (sweeps_all || is_sky(s)) {
      take_from_view(s, memory.view, factors[s]);
    } else {
      exact_form_factor(scene_, receiver, sources_[s], options, factors[s], memory.workspace);
    }
  }
}

void SourceFactors::find_one(const Receiver& receiver, std::size_t source, const ExactOptions& options,
                             FormFactor& factor, Results& memory) const {
  if (!is_sky(source)) {
    return exact_form_factor(scene_, receiver, sources_[source], options, factor, memory.workspace);
  }
  look_around(receiver, options, memory);
  take_from_view(source, memory.view, factor);
}

void SourceFactors::measure_all(const Receiver& receiver, const ExactOptions& options, std::vector<FormFactor>& factors,
                                Results& memory) const {
  EXACTFF_EXPECT(sweeps(options));
  measure_again(scene_, receiver, all_of(options), memory.view, memory.workspace);
  factors.resize(count());
  for (std::size_t s = 0; s < count(); ++s) take_from_view(s, memory.view, factors[s]);
}

void SourceFactors::measure_one(const Receiver& receiver, std::size_t source, const ExactOptions& options,
                                FormFactor& factor, Results& memory) const {
  EXACTFF_EXPECT(options.engine != Engine::kBoth);
  if (is_sky(source)) {
    measure_again(scene_, receiver, all_of(options), memory.view, memory.workspace);
    return take_from_view(source, memory.view, factor);
  }
  WorkspaceInside::memory(memory.workspace)
      .region.measure(options.measure, options.digits, options.precision_cap, factor);
}

ViewOptions SourceFactors::all_of(const ExactOptions& options) const {
  return {
      .faces = faces_, .measure = options.measure, .digits = options.digits, .precision_cap = options.precision_cap};
}

void SourceFactors::look_around(const Receiver& receiver, const ExactOptions& options, Results& memory) const {
  view(scene_, receiver, all_of(options), memory.view, memory.workspace);
}

// The view lists what has a share, by index.
void SourceFactors::take_from_view(std::size_t source, const WholeView& view, FormFactor& factor) const {
  if (is_sky(source)) return as_form_factor(view.open, factor);
  const auto index = [&](const SeenPatch& seen) { return faces_ ? index_of(*seen.face) : index_of(seen.patch); };
  const Selection& wanted = sources_[source].selection();
  const std::size_t at = faces_ ? index_of(*wanted.face) : index_of(wanted.patch);
  const auto found = std::ranges::lower_bound(view.patches, at, {}, index);
  const bool is_seen = found != view.patches.end() && index(*found) == at;
  as_form_factor(is_seen ? found->form_factor : ViewShare{}, factor);
}

// --- Light ---

namespace {

double component(const Rgb& colour, int channel) {
  return channel == 0 ? colour.r : channel == 1 ? colour.g : colour.b;
}

constexpr long kFirstBits = 128;  // more than the balls of the double-double tier have
constexpr int kFirstDigits = 40;
constexpr int kMostDigits = 20000;  // more than 65,536 bits determine

CertifiedNumber certified(double value) {
  return {value, std::max(0.0, std::nextafter(value, -1.0)),
          std::nextafter(value, std::numeric_limits<double>::infinity()), true};
}

CertifiedNumber not_certified(const Ball& ball) {
  const Enclosure enclosure = EnclosureInside::of(ball);
  return {kernel::nearest_to_midpoint(ball), std::max(0.0, enclosure.lower()), enclosure.upper(), false};
}

}  // namespace

LightFormula light_formula(const Scene& scene, std::span<const FaceId> on, FaceSide side, Quantity quantity,
                           KeMeans ke) {
  const bool ke_is_radiance = ke == KeMeans::kRadiance;
  if (quantity == Quantity::kFormFactor) return {};
  if (quantity == Quantity::kIrradiance) return {.pi_power = ke_is_radiance ? 1 : 0};
  const int power = (quantity == Quantity::kRadiosity ? 0 : -1) + (ke_is_radiance ? 1 : 0);
  const bool emits = !on.empty() && side == FaceSide::kFront;
  return {emits ? scene.material(scene.face(on.front()).material).radiosity : Rgb{}, scene.receiver_reflectance(on),
          power};
}

std::vector<Rgb> light_weights(const Scene& scene, const SourceFactors& sources, Quantity quantity,
                               const std::string& scene_name) {
  std::vector<Rgb> weights;
  Rgb sum;
  for (std::size_t s = 0; s < sources.count(); ++s) {
    const Rgb radiosity = sources.radiosity(s);
    sum = {sum.r + radiosity.r, sum.g + radiosity.g, sum.b + radiosity.b};
    weights.push_back(quantity == Quantity::kFormFactor ? Rgb{1.0, 1.0, 1.0} : radiosity);
  }
  if (std::optional<Problem> problem = problem_of_strength(scene, sum, scene_name)) {
    throw InputError(std::move(*problem));
  }
  return weights;
}

std::optional<Problem> problem_of_strength(const Scene& scene, const Rgb& sum, const std::string& scene_name) {
  constexpr double kMost = 1e290;
  for (const Material& material : scene.materials()) {
    const Rgb &kd = material.reflectance, &ke = material.radiosity;
    const double least = std::min({kd.r, kd.g, kd.b, ke.r, ke.g, ke.b});
    if (least >= 0.0 && kd.largest() * sum.largest() + ke.largest() <= kMost && sum.largest() <= kMost) continue;
    return Problem{.file = scene_name,
                   .what = "the light is negative or too strong: material " + text::in_quotes(material.name),
                   .why = "radiosities are added, and Kd, Ke and their sums must be between 0 and 1e290",
                   .suggestion = "give Kd and Ke in other units"};
  }
  return std::nullopt;
}

Light::Light(const SourceFactors& sources, std::vector<Rgb> radiosities)
    : sources_(sources), radiosities_(std::move(radiosities)) {}

Channels Light::at(const Receiver& receiver, const LightFormula& formula, const ExactOptions& options,
                   Results& results) const {
  sources_.find_all(receiver, options, results.at);
  return again(receiver, formula, options, results);
}

Channels Light::again(const Receiver& receiver, const LightFormula& formula, const ExactOptions& options,
                      Results& results) const {
  results.finer.clear();
  Channels channels;
  for (int c = 0; c < 3; ++c) {
    int same = 0;
    while (same < c && !same_weights(formula, same, c)) ++same;
    channels[c] = same < c ? channels[same] : channel(receiver, formula, c, options, results);
  }
  return channels;
}

bool Light::same_weights(const LightFormula& formula, int a, int b) const {
  return component(formula.emitted, a) == component(formula.emitted, b) &&
         component(formula.reflectance, a) == component(formula.reflectance, b) &&
         std::ranges::all_of(radiosities_, [&](const Rgb& r) { return component(r, a) == component(r, b); });
}

bool Light::is_zero(const std::vector<FormFactor>& factors, const LightFormula& formula, int channel) const {
  if (component(formula.emitted, channel) != 0.0) return false;
  if (component(formula.reflectance, channel) == 0.0) return true;
  for (std::size_t s = 0; s < factors.size(); ++s) {
    if (factors[s].status != Status::kZero && component(radiosities_[s], channel) != 0.0) return false;
  }
  return true;
}

Ball Light::ball(const std::vector<FormFactor>& factors, const LightFormula& formula, int channel, long bits) const {
  Ball received(bits);
  for (std::size_t s = 0; s < factors.size(); ++s) {
    if (factors[s].status == Status::kZero) continue;
    received.add_product(kernel::to_ball(component(radiosities_[s], channel), bits),
                         EnclosureInside::ball(factors[s].enclosure));
  }
  Ball leaving = kernel::to_ball(component(formula.emitted, channel), bits);
  leaving.add_product(kernel::to_ball(component(formula.reflectance, channel), bits), received);
  return formula.pi_power == 0  ? leaving
         : formula.pi_power > 0 ? leaving * kernel::pi(bits)
                                : leaving / kernel::pi(bits);
}

CertifiedNumber Light::channel(const Receiver& receiver, const LightFormula& formula, int channel,
                               const ExactOptions& options, Results& results) const {
  if (is_zero(results.at.factors, formula, channel)) return {};
  Ball best = ball(results.at.factors, formula, channel, kFirstBits);
  if (const auto nearest = EnclosureInside::of(best).nearest()) return certified(*nearest);
  ExactOptions finer = options;
  finer.visible_fraction = finer.exact_fraction = finer.list_cutters = false;
  for (finer.digits = kFirstDigits; finer.digits <= kMostDigits; finer.digits *= 2) {
    sources_.find_all(receiver, finer, results.finer, results.at);
    best = ball(results.finer, formula, channel, 4L * finer.digits + kFirstBits);
    if (const auto nearest = EnclosureInside::of(best).nearest()) return certified(*nearest);
  }
  return not_certified(best);
}

}  // namespace exactff::whole_view
