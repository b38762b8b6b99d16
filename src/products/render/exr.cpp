// Pictures as OpenEXR files.
#include "exactff/exr.h"

#include <bit>
#include <cmath>

#include "exactff/render.h"

namespace exactff::render {
namespace {

std::uint32_t bits_of(double value, bool whole) {
  if (whole) return static_cast<std::uint32_t>(value);
  return std::bit_cast<std::uint32_t>(std::isnan(value) ? 0.0F : static_cast<float>(value));
}

}  // namespace

std::string exr_of(const Picture& picture) {
  const exr::Window window{0, 0, picture.size.width, picture.size.height};
  exr::Image image{window, window, {}, picture.metadata};
  for (std::size_t c = 0; c < 3; ++c) {
    exr::Numbers& channel = image.channels.emplace_back();
    channel.name = "RGB"[c];
    channel.bits.reserve(picture.pixels());
    for (std::size_t i = 0; i < picture.pixels(); ++i)
      channel.bits.push_back(bits_of(picture.values[3 * i + c], false));
  }
  for (const Layer& layer : picture.layers) {
    exr::Numbers& channel = image.channels.emplace_back();
    channel.name = layer.name;
    channel.kind = layer.whole ? exr::Kind::kWhole : exr::Kind::kFloat;
    channel.bits.reserve(picture.pixels());
    for (const double value : layer.values) channel.bits.push_back(bits_of(value, layer.whole));
  }
  return exr::exr_of(image);
}

}  // namespace exactff::render
