// Checks of what a function requires of its caller: on in every build with tests, off otherwise.
#pragma once

#include <stdexcept>
#include <string>

namespace exactff::kernel {

[[noreturn]] inline void broken_requirement(const char* condition, const char* file, int line) {
  throw std::logic_error(std::string(file) + ":" + std::to_string(line) + ": requirement not met: " + condition);
}

}  // namespace exactff::kernel

// A requirement that is not kept is an error in the library. What a user of the library can get wrong is checked in
// every build, with words (scene/scene.h).
#ifdef EXACTFF_CHECKS_REQUIREMENTS
#define EXACTFF_EXPECT(condition) \
  ((condition) ? static_cast<void>(0) : ::exactff::kernel::broken_requirement(#condition, __FILE__, __LINE__))
#else
#define EXACTFF_EXPECT(condition) static_cast<void>(sizeof(!(condition)))
#endif
