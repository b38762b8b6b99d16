#include "whole_view/referee.h"

#include <algorithm>
#include <stdexcept>

#include "exactff/exact.h"

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

}  // namespace exactff::whole_view
