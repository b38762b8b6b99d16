// The flags of one receiver, and warnings on where it lies. Shared by `exactff point` and `exactff view`.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

#include "exactff/receiver.h"
#include "exactff/view.h"
#include "flags/values.h"

namespace exactff::cli {

struct OneReceiver {
  flags::ThreeNumbers at, normal;
  bool sphere = false;  // without a normal
  std::string on;

  void add_to(CLI::App& app);
  // The normal of a sphere is (0, 0, 0).
  [[nodiscard]] Receiver make(const Scene& scene) const;
};

// No front, and the back of some face.
[[nodiscard]] bool sees_only_backs(const WholeView& seen);

// A typing error in --at or --on would otherwise go unnoticed.
void warn_if_off_its_face(const Scene& scene, const Receiver& receiver);
// For a receiver that sees backs: which surfaces are probably turned the wrong way. Nothing of large scenes, where this
// would take longer than the values.
void warn_of_turned_surfaces(const Scene& scene);
// Says on stderr that x lies near a face that is not its own, and what would follow if it were: effect(receiver there),
// which is empty if nothing would. Or that the receiver looks away from the front of its own face. Or, if it sees
// nothing but backs, and would see something on the face before it, how to place it there.
void warn_of_near_face(const Scene& scene, const Receiver& receiver, const std::function<bool()>& sees_no_front,
                       const std::function<std::string(const Receiver&)>& effect);

}  // namespace exactff::cli
