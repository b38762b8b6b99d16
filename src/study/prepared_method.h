// A method made ready for a study's scene and sources.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "exactff/study.h"

namespace exactff::study {

struct PreparedMethod {
  std::unique_ptr<methods::PreparedScene> scene;
  std::vector<std::unique_ptr<methods::PreparedSource>> owned;
  std::vector<const methods::PreparedSource*> sources;

  PreparedMethod(const methods::Method& method, const Request& request) : scene(method.prepare(*request.scene)) {
    for (const Selection& source : request.sources) {
      owned.push_back(scene->prepare_source(source));
      sources.push_back(owned.back().get());
    }
  }
};

// A choice's settings with this seed; 0 leaves them as they are.
[[nodiscard]] inline methods::Settings seeded(const methods::Choice& choice, std::uint64_t seed) {
  methods::Settings settings = choice.settings;
  if (seed > 0) settings.set("seed", static_cast<std::int64_t>(seed));
  return settings;
}

}  // namespace exactff::study
