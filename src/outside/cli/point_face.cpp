// The face that the receiver of exactff point was probably meant to lie on.
#include "cli/output.h"
#include "cli/point.h"
#include "text/number_text.h"
#include "text/phrases.h"

namespace exactff::cli {

namespace {

// "the form factor of 'light' is 0.0179 instead of 0"
std::string effect_of(const Scene& scene, const PointResult& point, const std::vector<FaceId>& on) {
  Receiver receiver = point.receiver;
  receiver.on = on;
  std::string text;
  for (const PointTerm& one : point.sources) {
    const FormFactor there = exact_form_factor(scene, receiver, ExactSource(scene, one.source));
    if (there.value == one.exact.value) continue;
    text += (text.empty() ? "the form factor of '" : ", of '") + shown_name(scene, one.source) + "' is " +
            text::shortest(there.value) + " instead of " + text::shortest(one.exact.value);
  }
  return text.empty() ? "no form factor changes" : text;
}

}  // namespace

void warn_of_near_face(const Scene& scene, const PointResult& point) {
  warn_of_near_face(scene, point.receiver, [&](const std::vector<FaceId>& on) { return effect_of(scene, point, on); });
}

}  // namespace exactff::cli
