// Which picture unfinished tiles belong to.
#pragma once

#include <optional>
#include <string>

#include "exactff/render.h"

namespace exactff::render {

// "overcast, up 0 0 1".
[[nodiscard]] std::string words_of_measure(const Measure& measure);

// Everything that the tiles of a picture, and those of the method that it is compared with, depend on.
[[nodiscard]] std::string identity_of(const Request& request, const std::optional<methods::Choice>& against);

}  // namespace exactff::render
