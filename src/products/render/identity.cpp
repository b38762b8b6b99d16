#include "render/identity.h"

#include "text/phrases.h"

namespace exactff::render {

std::string words_of_measure(const Measure& measure) {
  std::string words(to_string(measure.kind));
  if (measure.sphere) words += " of a sphere";
  if (measure.kind != MeasureKind::kOvercast) return words;
  words += ", up";
  for (const double c : {measure.up.x, measure.up.y, measure.up.z}) words += ' ' + text::shortest(c);
  return words;
}

std::string identity_of(const Request& request, const std::optional<methods::Choice>& against) {
  std::string all =
      request.scene->hash() + '\n' + flags_of(request.view) + '\n' + std::string(to_string(request.quantity)) + '\n';
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
