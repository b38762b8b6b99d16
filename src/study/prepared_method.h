// A method prepared for the scene and the sources of a study.
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

// The settings of a choice with this seed; seed 0 leaves them unchanged.
[[nodiscard]] inline Settings seeded(const methods::Choice& choice, std::uint64_t seed) {
  Settings settings = choice.settings;
  if (seed > 0) settings.set("seed", static_cast<std::int64_t>(seed));
  return settings;
}

}  // namespace exactff::study
