// Checks for misuse of the library that the compiler cannot find: exceptions with a message.
#pragma once

#include <stdexcept>
#include <string>

#include "exactff/scene.h"

namespace exactff {

// For objects that own their data by a pointer, which is null after a move. Throws std::logic_error if it is null.
template <class Owner>
auto& owned_by(const Owner& owner, const char* what) {
  if (!owner)
    throw std::logic_error(std::string("this ") + what + " was moved from; it can only be assigned to or destroyed");
  return *owner;
}

// The following throw std::invalid_argument.
[[noreturn]] void refuse_argument(const std::string& what, const std::string& why);
void require_face(const Scene& scene, FaceId face);
// Also checks the ids of the selection.
void require_of_scene(const Scene& scene, const Selection& selection);
// `what`: "source"
void require_of_scene(const Scene& scene, SceneId made_by, const char* what);
void require_scene(const Scene* scene);  // of a request

}  // namespace exactff
