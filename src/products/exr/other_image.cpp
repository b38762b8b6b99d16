#include "exr/other_image.h"

#include <algorithm>

#include "files/numpy.h"
#include "kernel/poll.h"
#include "text/refuse.h"

namespace exactff::exr {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kColours = 3;

// Of the layer that is named. If none is: the plain channels R, G, B, or those of the only layer that has them.
std::vector<Channel> channels_of(const ExrFile& file, const std::string& layer, const std::string& flag) {
  if (!layer.empty()) return file.find(layer, flag);
  std::vector<std::string> with_colours;
  for (const Layer& one : file.layers()) {
    const std::string prefix = one.name.empty() ? "" : one.name + '.';
    const bool has_all = std::ranges::all_of(std::string("RGB"), [&](char letter) {
      return std::ranges::find(file.channels(), prefix + letter, &Channel::name) != file.channels().end();
    });
    if (has_all) with_colours.push_back(one.name);
  }
  const bool has_plain = std::ranges::find(with_colours, "") != with_colours.end();
  return file.find(has_plain || with_colours.size() != 1 ? "" : with_colours.front(), flag);
}

OtherImage read_exr(const fs::path& path, const std::string& layer, const std::string& flag) {
  const ExrFile file(path);
  const std::vector<Channel> channels = channels_of(file, layer, flag);
  OtherImage image{file.file(), file.data_window(channels.front()), file.display_window(channels.front()), true, {},
                   {}};
  for (const Channel& one : channels) image.channels.push_back(one.name);
  for (const std::vector<float>& numbers : file.read(channels))
    image.values.emplace_back(numbers.begin(), numbers.end());
  return image;
}

std::string words_of(const std::vector<std::size_t>& shape) {
  std::string words;
  for (const std::size_t extent : shape) words += (words.empty() ? "" : ", ") + std::to_string(extent);
  return '(' + words + ')';
}

Window window_of(const fs::path& path, const std::vector<std::size_t>& shape) {
  constexpr std::size_t kLargest = 1 << 24;
  const bool has_pixels = shape.size() == 3 && shape[2] == kColours && shape[0] > 0 && shape[1] > 0;
  if (has_pixels && shape[0] <= kLargest && shape[1] <= kLargest) {
    return {0, 0, static_cast<int>(shape[1]), static_cast<int>(shape[0])};
  }
  const bool has_alpha = shape.size() == 3 && shape[2] == kColours + 1;
  text::refuse(path, "is a NumPy array of the shape " + words_of(shape),
               "an image has the shape (height, width, 3), its rows from the top",
               has_alpha ? "save array[:, :, :3], without the fourth channel" : "save an array of this shape");
}

OtherImage read_array(const fs::path& path, const std::string& layer, const std::string& flag) {
  if (!layer.empty()) {
    text::refuse(path, "is a NumPy array, and " + flag + " names a layer", "an array has no names", "remove it");
  }
  const files::NpyArray array = files::read_npy(path);
  const Window window = window_of(path, array.shape);
  OtherImage image{path.string(), window, window, false, {"R", "G", "B"}, {}};
  image.values.resize(kColours);
  kernel::Steps steps("pixels", window.pixels());
  for (std::size_t i = 0; i < window.pixels(); ++i) {
    steps.take();
    for (std::size_t c = 0; c < kColours; ++c) image.values[c].push_back(array.values[kColours * i + c]);
  }
  return image;
}

}  // namespace

bool is_image(const fs::path& file) { return is_exr(file) || files::is_npy_file(file); }

OtherImage read_image(const fs::path& file, const std::string& layer, const std::string& flag) {
  return files::is_npy_file(file) ? read_array(file, layer, flag) : read_exr(file, layer, flag);
}

void place_like(const OtherImage& other, OtherImage& image) {
  if (image.is_placed) return;
  const bool in_data = image.data.width == other.data.width && image.data.height == other.data.height;
  const Window& place = in_data ? other.data : other.display;
  image.data.x = image.display.x = place.x;
  image.data.y = image.display.y = place.y;
}

}  // namespace exactff::exr
