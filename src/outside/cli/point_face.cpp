// The face that the receiver of exactff point was probably meant to lie on.
#include <algorithm>

#include "cli/output.h"
#include "cli/point.h"
#include "exactff/view.h"
#include "text/number_text.h"
#include "text/phrases.h"

namespace exactff::cli {

namespace {

// "the form factor of 'light' is 0.0179 instead of 0". Empty if none changes.
std::string effect_of(const Scene& scene, const PointResult& point, const Receiver& receiver) {
  std::string text;
  for (const PointTerm& one : point.sources) {
    const FormFactor there = exact_form_factor(scene, receiver, ExactSource(scene, one.source));
    if (there.value == one.exact.value) continue;
    text += (text.empty() ? "the form factor of '" : ", of '") + shown_name(scene, one.source) + "' is " +
            text::shortest(there.value) + " instead of " + text::shortest(one.exact.value);
  }
  return text;
}

}  // namespace

void warn_of_near_face(const Scene& scene, const PointResult& point) {
  const auto sees_no_front = [&] {
    const auto is_zero = [](const PointTerm& one) { return one.exact.status == Status::kZero; };
    return std::ranges::all_of(point.sources, is_zero) && sees_only_backs(view(scene, point.receiver));
  };
  warn_of_near_face(scene, point.receiver, sees_no_front,
                    [&](const Receiver& there) { return effect_of(scene, point, there); });
}

}  // namespace exactff::cli
