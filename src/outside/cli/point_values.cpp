#include <algorithm>
#include <utility>

#include "cli/output.h"
#include "cli/point.h"
#include "exactff/study.h"
#include "flags/lists.h"
#include "flags/sources.h"
#include "scene/selections.h"
#include "text/number_text.h"
#include "text/phrases.h"

namespace exactff::cli {

namespace {

constexpr std::size_t kMostSharesComputed = 200;

std::vector<Selection> make_sources(const PointArguments& args, const Scene& scene) {
  std::vector<Selection> sources = flags::sources_of({args.sources}, scene);
  if (sources.empty()) sources = scene.emitters();
  if (sources.empty()) {
    throw InputError({.file = args.scene.path,
                      .what = "no patch of the scene emits (Ke is 0 everywhere)",
                      .why = "without --source, every emitting patch is a source",
                      .suggestion = "name a source with --source NAME; `exactff info` lists the names"});
  }
  if (args.plain && sources.size() != 1) {
    throw InputError({.file = {},
                      .what = "--plain prints one value, but there are " + std::to_string(sources.size()) + " sources",
                      .why = {},
                      .suggestion = "name one with --source NAME, or use --json"});
  }
  return sources;
}

Rgb make_reflectance(const PointArguments& args, const Scene& scene, const Receiver& receiver) {
  if (args.reflectance.empty()) return scene.receiver_reflectance(receiver.on);
  return {args.reflectance.front(), args.reflectance[args.reflectance.size() / 2], args.reflectance.back()};
}

void add_shares(const Scene& scene, const Receiver& receiver, const ExactSource& source, PointTerm& result) {
  const std::vector<FaceId> none;
  ExactOptions options{.only_occluders = &none};
  const double open = exact_form_factor(scene, receiver, source, options).value;
  result.unoccluded = open;
  if (open == 0.0) return;  // an underflow: there is nothing to compare with
  for (const FaceId face : result.exact.cutters) {
    if (result.shares.size() == kMostSharesComputed) break;
    const std::vector<FaceId> only{face};
    options.only_occluders = &only;
    result.shares.push_back({face, 1.0 - exact_form_factor(scene, receiver, source, options).value / open});
  }
  std::stable_sort(result.shares.begin(), result.shares.end(),
                   [](const PointTerm::Share& a, const PointTerm::Share& b) { return a.alone > b.alone; });
}

AdaptiveOptions adaptive_options(const PointArguments& args) {
  AdaptiveOptions options = args.adaptive_options;
  options.pattern = *pattern_named(args.pattern);
  options.variant = *variant_named(args.variant);
  options.record_leaves = !args.svg.empty();  // for the drawing only: there can be millions
  options.most_recorded_leaves = kMostDrawnLeaves;
  options.most_leaves = kMostPointLeaves;
  return options;
}

// Whether one sweep finds all that is printed, in less time than one patch after another. It says nothing of how a
// value was found, and nothing about transparent patches.
bool one_sweep_will_do(const PointArguments& args, const Scene& scene, const std::vector<Selection>& sources) {
  constexpr std::size_t kFewestFaces = 400;
  const bool shows_more =
      args.fraction || args.gradient || args.exact_fraction || args.explain || args.json || !args.svg.empty();
  const bool every_patch = flags::names_all(scene, args.sources) &&
                           std::ranges::none_of(sources, [](const Selection& s) { return s.face.has_value(); });
  return every_patch && !shows_more && scene.faces().size() >= kFewestFaces && scene.transparent().empty() &&
         args.engine.engine() == Engine::kEdges;
}

// The form factor of a patch in the whole view, which lists those above 0.
FormFactor factor_in_view(const WholeView& seen, const Selection& source) {
  const auto found = std::ranges::lower_bound(seen.patches, source.patch, {}, &SeenPatch::patch);
  if (found == seen.patches.end() || found->patch != source.patch) return {};
  return as_form_factor(found->form_factor);
}

// Whether the sum of all form factors counts a part of the view twice.
bool has_stacked(const PointArguments& args, const Scene& scene, const PointResult& point) {
  const auto is_stacked = [](const SeenPatch& patch) { return patch.share.value != patch.form_factor.value; };
  const auto some = [&](const WholeView& seen) { return std::ranges::any_of(seen.patches, is_stacked); };
  return some(point.seen ? *point.seen : view(scene, point.receiver, {.precision_cap = args.precision_cap}));
}

std::optional<Vec3> direction_of(const PointArguments& args) {
  return flags::is_given(args.along) ? std::optional(flags::vector_of(args.along, "--along")) : std::nullopt;
}

FormFactor exact_value(const PointArguments& args, const Scene& scene, const PointResult& point,
                       const ExactSource& source) {
  if (point.seen) return factor_in_view(*point.seen, source.selection());
  const ExactOptions options{.engine = args.engine.engine(),
                             .visible_fraction = args.fraction || args.exact_fraction,
                             .exact_fraction = args.exact_fraction,
                             .list_cutters = args.explain || !args.svg.empty(),
                             .gradient = args.gradient,
                             .list_arcs = args.gradient && args.explain,
                             .vertices = args.vertices,
                             .along = direction_of(args),
                             .digits = args.digits,
                             .precision_cap = args.precision_cap};
  return exact_form_factor(scene, point.receiver, source, options);
}

PointTerm compute_source(const PointArguments& args, const Scene& scene, const PointResult& point,
                         const ExactSource& source, const std::optional<AdaptiveSolver>& sampler) {
  PointTerm result{.source = source.selection(), .emits = emits(scene, source.selection())};
  result.exact = exact_value(args, scene, point, source);
  const Rgb b = scene.source_radiosity(result.source);
  const Rgb& rho = point.reflectance;
  result.largest_rho_b = std::max({rho.r * b.r, rho.g * b.g, rho.b * b.b});
  const double f = result.exact.value;
  result.radiosity = {rho.r * b.r * f, rho.g * b.g * f, rho.b * b.b * f};
  if (args.explain) add_shares(scene, point.receiver, source, result);
  if (sampler) {
    result.adaptive = sampler->form_factor(point.receiver, result.source, result.largest_rho_b, adaptive_options(args));
  }
  return result;
}

void add(Rgb& sum, const Rgb& part) { sum = {sum.r + part.r, sum.g + part.g, sum.b + part.b}; }

// Sources that emit nothing count with a radiosity of 1, which cannot be added to the radiosity of lamps.
void add_up(PointResult& result) {
  for (const PointTerm& one : result.sources) {
    result.sum += one.exact.enclosure;
    if (one.emits) {
      ++result.emitters;
      result.sum_of_emitters += one.exact.enclosure;
      add(result.radiosity, one.radiosity);
    } else {
      add(result.radiosity_of_others, one.radiosity);
    }
  }
  if (result.emitters == 0) std::swap(result.radiosity, result.radiosity_of_others);
}

void require_one(const std::vector<Selection>& sources, const std::string& picture) {
  if (sources.size() == 1) return;
  throw InputError({.file = picture,
                    .what = "--svg draws one source, but there are " + std::to_string(sources.size()),
                    .why = {},
                    .suggestion = "name one with --source NAME"});
}

}  // namespace

Scene load_point_scene(const PointArguments& args) {
  Scene scene = args.scene.load();
  print_warnings(scene.warnings());
  return scene;
}

PointResult compute_point(const PointArguments& args, const Scene& scene) {
  PointResult result{.receiver = args.receiver.make(scene)};
  result.reflectance = make_reflectance(args, scene, result.receiver);
  std::optional<AdaptiveSolver> sampler;
  if (args.adaptive) sampler.emplace(scene);
  const std::vector<Selection> sources = make_sources(args, scene);
  if (!args.svg.empty()) require_one(sources, args.svg);
  result.every_patch = flags::names_all(scene, args.sources);
  if (one_sweep_will_do(args, scene, sources)) {
    result.seen = view(scene, result.receiver, {.digits = args.digits, .precision_cap = args.precision_cap});
  }
  for (const Selection& selection : sources) {
    const ExactSource source(scene, selection);
    result.sources.push_back(compute_source(args, scene, result, source, sampler));
  }
  add_up(result);
  result.stacked = result.every_patch && has_stacked(args, scene, result);
  return result;
}

}  // namespace exactff::cli
