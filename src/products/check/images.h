// Images as truths and candidates: a row for each pixel and channel.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "exactff/check.h"
#include "exactff/exr.h"
#include "exactff/render.h"

namespace exactff::check {

// Names of layers or channels (exr::ExrFile::find). Empty: R, G, B.
struct ImageLayers {
  std::string truth = {};
  std::string candidate = {};
};

// Two images, each an OpenEXR file or a NumPy array, pixel by pixel. Pixels are matched by their coordinates; an array
// has the place of the other image.
struct Images {
  Truth truth;                   // a row for each pixel and channel whose true value is finite
  std::vector<Measured> values;  // in its order
  std::string candidate_file;
  exr::Window window;                 // of the truth
  std::size_t channels = 3;           // 1 or 3
  std::vector<double> exact, theirs;  // `channels` for each pixel of the window; NaN where there is none
};
// Throws InputError if a file cannot be read, if channels are missing, or if the candidate lacks a pixel that the truth
// has, unless `partial`; throws Cancelled.
[[nodiscard]] Images read_images(const std::filesystem::path& truth, const std::filesystem::path& candidate,
                                 const ImageLayers& layers = {}, bool partial = false);

// The bytes of candidate minus truth: as EXR, a channel for each that was compared, NaN where nothing was; as PNG, in
// colours.
[[nodiscard]] std::string error_image(const Images& images, render::ImageKind kind);

}  // namespace exactff::check
