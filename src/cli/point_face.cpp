// The face that the receiver of exactff point was probably meant to lie on.
#include <iostream>

#include "cli/output.h"
#include "cli/point.h"
#include "text/escape.h"
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

void warn_of_turned_normal(const Scene& scene, const Receiver& receiver) {
  if (near_misses(scene, std::span(&receiver, 1)).turned == 0) return;
  std::cerr << "exactff: warning: the normal points away from the front of '"
            << text::printable(scene.name_of(receiver.on)) << "', so the receiver looks through its back\n";
}

}  // namespace

void warn_of_near_face(const Scene& scene, const PointResult& point) {
  const Receiver& receiver = point.receiver;
  if (!receiver.on.empty()) return warn_of_turned_normal(scene, receiver);
  const NearFaces near = find_faces(scene, receiver, face_tolerance(scene, receiver.point));
  if (near.faces.empty() || near.side == 0) return;
  const std::string name = scene.name_of(near.faces);
  const bool looks_through = (near.side < 0) != near.turned;
  std::cerr << "exactff: " << (looks_through ? "warning" : "note") << ": x lies "
            << text::rounded_plainly(near.distance, 2) << (near.side < 0 ? " behind '" : " in front of '")
            << text::printable(name) << '\'' << (near.turned ? ", turned against its front" : "")
            << (looks_through ? ", which then hides everything beyond it" : "") << ". With --on "
            << text::shell_word(name) << ' ' << effect_of(scene, point, near.faces) << '\n';
}

}  // namespace exactff::cli
