#include "study/prepared_method.h"

namespace exactff::study {

PreparedMethod::PreparedMethod(const methods::Method& method, const Scene& given, std::span<const Selection> selections)
    : scene(method.prepare(given)) {
  for (const Selection& selection : selections) {
    owned.push_back(scene->prepare_source(selection));
    sources.push_back(owned.back().get());
  }
}

const PreparedMethod& PreparedMethods::of(const methods::Method& method) {
  return prepared_.try_emplace(&method, method, *request_.scene, request_.sources).first->second;
}

methods::Choice with_seed(methods::Choice choice, std::uint64_t seed) {
  if (seed > 0) choice.settings.set("seed", static_cast<std::int64_t>(seed));
  return choice;
}

}  // namespace exactff::study
