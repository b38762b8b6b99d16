#include "whole_view/source_factors.h"

#include <algorithm>
#include <optional>

namespace exactff::whole_view {
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

void SourceFactors::look_around(const Receiver& receiver, const ExactOptions& options, Results& memory) const {
  const ViewOptions all{.faces = faces_, .digits = options.digits, .precision_cap = options.precision_cap};
  view(scene_, receiver, all, memory.view, memory.workspace);
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

}  // namespace exactff::whole_view
