// An image of another program: an OpenEXR file, or a NumPy array of shape (height, width, 3).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "exactff/exr.h"

namespace exactff::exr {

struct OtherImage {
  std::string file;
  Window data, display;
  bool is_placed = true;                    // false: an array has a size, and no place
  std::vector<std::string> channels;        // one, or three
  std::vector<std::vector<double>> values;  // of each channel, row by row from the top; may be infinite or NaN
};

// By its content. False if it cannot be read.
[[nodiscard]] bool is_image(const std::filesystem::path& file);

// Of an OpenEXR file, the channels of the layer (ExrFile::find; `flag` is the flag that names it). If none is named: R,
// G, B, or those of the only layer that has them. Throws InputError, also for an array of another shape or with a
// layer; throws Cancelled.
[[nodiscard]] OtherImage read_image(const std::filesystem::path& file, const std::string& layer,
                                    const std::string& flag);

// Puts an array where the other image is: in its data window if it has that size, else at the corner of its display
// window.
void place_like(const OtherImage& other, OtherImage& image);

}  // namespace exactff::exr
