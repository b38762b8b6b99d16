// Images as truths and candidates, and their errors as images.
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "check/report.h"
#include "exr/exr_file.h"
#include "kernel/poll.h"
#include "text/names.h"
#include "text/phrases.h"
#include "text/refuse.h"

namespace exactff::check {
namespace {

namespace fs = std::filesystem;

std::string short_name(const std::string& channel) { return channel.substr(channel.rfind('.') + 1); }

// Where a pixel of one window is in another.
std::optional<std::size_t> place_in(const exr::Window& window, const exr::Window& of, std::size_t index) {
  const auto width = static_cast<std::size_t>(of.width);
  const long x = long{of.x} + static_cast<long>(index % width) - window.x;
  const long y = long{of.y} + static_cast<long>(index / width) - window.y;
  if (x < 0 || y < 0 || x >= window.width || y >= window.height) return std::nullopt;
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(window.width) + static_cast<std::size_t>(x);
}

std::string words_of(const exr::Window& window) {
  return std::to_string(window.width) + " x " + std::to_string(window.height) + " pixels from x" +
         std::to_string(window.x) + "y" + std::to_string(window.y);
}

class ImageReader {
 public:
  ImageReader(const fs::path& truth, const fs::path& candidate, const ImageLayers& layers)
      : truth_(exr::read_image(truth, layers.truth, "--truth-column")),
        candidate_(exr::read_image(candidate, layers.candidate, "--value-column")) {
    if (truth_.channels.size() != candidate_.channels.size()) {
      text::refuse(
          candidate,
          "'" + text::joined(candidate_.channels) + "' is compared with '" + text::joined(truth_.channels) + "'",
          "each channel is compared with one of the truth", "name a layer for both, or one channel for both");
    }
    place_like(candidate_, truth_);
    place_like(truth_, candidate_);
    images_.window = truth_.data;
    images_.channels = truth_.channels.size();
    images_.candidate_file = candidate_.file;
    images_.truth.file = truth_.file;
    images_.truth.column = text::joined(truth_.channels);
    images_.truth.kind = kImage;
    images_.truth.faces = {""};
    for (const std::string& one : truth_.channels) images_.truth.sources.push_back(short_name(one));
  }

  Images read(bool partial) {
    kernel::Steps steps("pixels", images_.window.pixels());
    for (std::size_t i = 0; i < images_.window.pixels(); ++i) {
      steps.take();
      add_pixel(i);
    }
    if (images_.truth.rows.empty()) {
      text::refuse(truth_.file, "no pixel has a value in " + images_.truth.column, "there is nothing to compare with",
                   "give an image with numbers that are finite");
    }
    if (missing_ > 0 && !partial) {
      text::refuse(candidate_.file,
                   text::counted(missing_, "pixel") + " of the truth " + (missing_ == 1 ? "is" : "are") + " missing",
                   "it has " + words_of(candidate_.data) + ", the truth " + words_of(images_.window),
                   "render the same window, or compare the pixels that there are with --partial");
    }
    return std::move(images_);
  }

 private:
  // A truth that is not finite stands for no value.
  void add_pixel(std::size_t i) {
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    const std::optional<std::size_t> there = place_in(candidate_.data, images_.window, i);
    bool is_missing = false;
    for (std::size_t c = 0; c < images_.channels; ++c) {
      const double exact = truth_.values[c][i];
      const bool counts = std::isfinite(exact);
      is_missing = is_missing || (counts && !there);
      const double theirs = there ? candidate_.values[c][*there] : kNaN;
      images_.exact.push_back(counts ? exact : kNaN);
      images_.theirs.push_back(theirs);
      if (!counts) continue;
      const auto row = static_cast<std::uint32_t>(images_.truth.rows.size());
      TruthRow& added = images_.truth.rows.emplace_back();
      added.receiver = exr::name_of_pixel(images_.window, i);
      added.source = static_cast<std::uint32_t>(c);
      added.value = added.lower = added.upper = exact;
      if (there) images_.values.push_back({row, 0, theirs});
    }
    if (is_missing) ++missing_;
  }

  exr::OtherImage truth_, candidate_;
  std::size_t missing_ = 0;
  Images images_;
};

}  // namespace

Images read_images(const fs::path& truth, const fs::path& candidate, const ImageLayers& layers, bool partial) {
  return ImageReader(truth, candidate, layers).read(partial);
}

// --- Errors as images ---

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
