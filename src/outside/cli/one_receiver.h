// The flags of one receiver, and warnings on where it lies. Shared by `exactff point` and `exactff view`.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

#include "exactff/receiver.h"
#include "flags/vector.h"

namespace exactff::cli {

struct OneReceiver {
  flags::ThreeNumbers at, normal;
  std::string on;

  void add_to(CLI::App& app);
  [[nodiscard]] Receiver make(const Scene& scene) const;
};

// A typing error in --at or --on would otherwise go unnoticed.
void warn_if_off_its_face(const Scene& scene, const Receiver& receiver);
// Says on stderr that x lies near a face that is not its own, and what would follow if it were: effect(faces). Or that
// the receiver looks away from the front of its own face.
void warn_of_near_face(const Scene& scene, const Receiver& receiver,
                       const std::function<std::string(const std::vector<FaceId>&)>& effect);

}  // namespace exactff::cli
