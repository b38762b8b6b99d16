// What exactff check does with two images.
#pragma once

#include <string>

#include "exactff/check.h"

namespace exactff::cli {

// Throws InputError unless it can be written as an image, and if one of the compared files is not an image.
void check_error_image(const std::string& file, bool are_images);

// Candidate minus truth, as EXR (a channel for each that was compared; NaN where nothing was) or as PNG in colours.
void write_error_image(const std::string& file, const check::Images& images);

}  // namespace exactff::cli
