#include "check/images.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/float_environment.h"
#include "kernel/poll.h"
#include "text/nearest_names.h"
#include "text/phrases.h"
#include "text/refuse.h"

namespace exactff::check {
namespace {

namespace fs = std::filesystem;

// Of the layer that is named. If none is: the plain channels R, G, B, or those of the only layer that has them.
std::vector<exr::Channel> channels_of(const exr::ExrFile& file, const std::string& layer, const std::string& flag) {
  if (!layer.empty()) return file.find(layer, flag);
  std::vector<std::string> with_colours;
  for (const exr::Layer& one : file.layers()) {
    const std::string prefix = one.name.empty() ? "" : one.name + '.';
    const bool has_all = std::ranges::all_of(std::string("RGB"), [&](char letter) {
      return std::ranges::find(file.channels(), prefix + letter, &exr::Channel::name) != file.channels().end();
    });
    if (has_all) with_colours.push_back(one.name);
  }
  const bool has_plain = std::ranges::find(with_colours, "") != with_colours.end();
  return file.find(has_plain || with_colours.size() != 1 ? "" : with_colours.front(), flag);
}

std::string short_name(const exr::Channel& channel) {
  const std::size_t dot = channel.name.rfind('.');
  return dot == std::string::npos ? channel.name : channel.name.substr(dot + 1);
}

std::string names_of(const std::vector<exr::Channel>& channels) {
  std::vector<std::string> names;
  for (const exr::Channel& one : channels) names.push_back(one.name);
  return text::joined(names);
}

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
      : truth_file_(truth), candidate_file_(candidate) {
    truth_channels_ = channels_of(truth_file_, layers.truth, "--truth-column");
    candidate_channels_ = channels_of(candidate_file_, layers.candidate, "--value-column");
    if (truth_channels_.size() != candidate_channels_.size()) {
      text::refuse(candidate,
                   "'" + names_of(candidate_channels_) + "' is compared with '" + names_of(truth_channels_) + "'",
                   "each channel is compared with one of the truth", "name a layer for both, or one channel for both");
    }
    images_.window = truth_file_.data_window(truth_channels_.front());
    theirs_ = candidate_file_.data_window(candidate_channels_.front());
    images_.channels = truth_channels_.size();
    images_.candidate_file = candidate_file_.file();
    images_.truth.file = truth_file_.file();
    images_.truth.column = names_of(truth_channels_);
    images_.truth.is_image = true;
    images_.truth.faces = {""};
    for (const exr::Channel& one : truth_channels_) images_.truth.sources.push_back(short_name(one));
  }

  Images read(bool partial) {
    truth_ = truth_file_.read(truth_channels_);
    candidate_ = candidate_file_.read(candidate_channels_);
    kernel::Steps steps("pixels", images_.window.pixels());
    for (std::size_t i = 0; i < images_.window.pixels(); ++i) {
      steps.take();
      add_pixel(i);
    }
    if (images_.truth.rows.empty()) {
      text::refuse(fs::path(truth_file_.file()), "no pixel has a value in " + images_.truth.column,
                   "there is nothing to compare with", "give an image with numbers that are finite");
    }
    if (missing_ > 0 && !partial) {
      text::refuse(fs::path(candidate_file_.file()),
                   text::counted(missing_, "pixel") + " of the truth " + (missing_ == 1 ? "is" : "are") + " missing",
                   "it has " + words_of(theirs_) + ", the truth " + words_of(images_.window),
                   "render the same window, or compare the pixels that there are with --partial");
    }
    return std::move(images_);
  }

 private:
  // A truth that is not finite stands for no value.
  void add_pixel(std::size_t i) {
    const std::optional<std::size_t> there = place_in(theirs_, images_.window, i);
    bool is_missing = false;
    for (std::size_t c = 0; c < images_.channels; ++c) {
      const float exact = truth_[c][i];
      const bool counts = std::isfinite(exact);
      is_missing = is_missing || (counts && !there);
      const float theirs = there ? candidate_[c][*there] : std::numeric_limits<float>::quiet_NaN();
      images_.exact.push_back(counts ? exact : std::numeric_limits<float>::quiet_NaN());
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

  exr::ExrFile truth_file_, candidate_file_;
  std::vector<exr::Channel> truth_channels_, candidate_channels_;
  exr::Window theirs_;
  std::vector<std::vector<float>> truth_, candidate_;
  std::size_t missing_ = 0;
  Images images_;
};

}  // namespace

Images read_images(const fs::path& truth, const fs::path& candidate, const ImageLayers& layers, bool partial) {
  const kernel::StandardArithmetic arithmetic;
  return ImageReader(truth, candidate, layers).read(partial);
}

}  // namespace exactff::check
