#include "check/error_image.h"

#include <bit>
#include <cmath>
#include <cstdint>

#include "exactff/exr.h"
#include "text/phrases.h"

namespace exactff::check {
namespace {

// NaN stands for no value.
std::string exr_of_errors(const Images& images) {
  exr::Image image{images.window, images.window, {}, {}};
  image.about = {{"software", text::program_version()},
                 {"difference", images.candidate_file + " minus " + images.truth.file}};
  for (std::size_t c = 0; c < images.channels; ++c) {
    exr::Numbers& channel = image.channels.emplace_back();
    channel.name = images.truth.sources[c];
    for (std::size_t i = c; i < images.exact.size(); i += images.channels) {
      channel.bits.push_back(std::bit_cast<std::uint32_t>(static_cast<float>(images.theirs[i] - images.exact[i])));
    }
  }
  return exr::exr_of(image);
}

// A single channel is shown in all three.
std::string png_of_errors(const Images& images) {
  render::Picture exact, theirs;
  exact.size = theirs.size = {images.window.width, images.window.height};
  for (std::size_t i = 0; i < images.window.pixels(); ++i) {
    bool compared = false;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t at = images.channels * i + (images.channels == 3 ? c : 0);
      const bool counts = !std::isnan(images.exact[at]);
      compared = compared || counts;
      exact.values.push_back(counts ? images.exact[at] : 0.0);
      theirs.values.push_back(counts ? images.theirs[at] : 0.0);
    }
    exact.shows.push_back(compared ? render::Shows::kFace : render::Shows::kNothing);
  }
  theirs.shows = exact.shows;
  const render::Errors errors = render::errors_of(theirs, exact);
  const double scale = render::colour_scale(errors);
  return render::png_of(render::coloured(errors, exact.size, scale),
                        {{"software", text::program_version()},
                         {"difference", images.candidate_file + " minus " + images.truth.file},
                         {"full colour at", text::shortest(scale)}});
}

}  // namespace

std::string error_image(const Images& images, render::ImageKind kind) {
  return kind == render::ImageKind::kPng ? png_of_errors(images) : exr_of_errors(images);
}

}  // namespace exactff::check
