// The errors of an image as an image.
#pragma once

#include <string>

#include "check/images.h"
#include "exactff/render.h"

namespace exactff::check {

// The bytes of candidate minus truth: as EXR, a channel for each that was compared, NaN where nothing was; as PNG, in
// colours.
[[nodiscard]] std::string error_image(const Images& images, render::ImageKind kind);

}  // namespace exactff::check
