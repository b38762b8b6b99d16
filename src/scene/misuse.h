// What a program that uses the library can get wrong without the compiler seeing it: exceptions with words.
#pragma once

#include <stdexcept>
#include <string>

#include "exactff/scene.h"

namespace exactff {

// For objects that hold what they own by a pointer, null once they have been moved from: std::logic_error.
template <class Owner>
auto& owned_by(const Owner& owner, const char* what) {
  if (!owner) throw std::logic_error(std::string("this ") + what + " was moved from: only assign to it or destroy it");
  return *owner;
}

// The following throw std::invalid_argument.
[[noreturn]] void refuse_argument(const std::string& what, const std::string& why);
void require_face(const Scene& scene, FaceId face);
// A selection by its ids, too.
void require_of_scene(const Scene& scene, const Selection& selection);
// `what`: "source"
void require_of_scene(const Scene& scene, SceneId made_by, const char* what);
void require_scene(const Scene* scene);  // of a request

}  // namespace exactff
