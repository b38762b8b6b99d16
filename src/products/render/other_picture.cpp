// The picture of another program, to be judged.
#include <algorithm>

#include "exactff/render.h"
#include "exr/other_image.h"
#include "kernel/float_environment.h"
#include "text/refuse.h"

namespace exactff::render {

Picture read_picture(const std::filesystem::path& file) {
  const kernel::StandardArithmetic arithmetic;
  const exr::OtherImage image = exr::read_image(file, "", "");
  if (image.channels.size() != 3 || image.data != image.display) {
    text::refuse(file, "does not hold three numbers for each pixel of its display window",
                 "every pixel of a picture is compared", "save the whole picture, red, green and blue");
  }
  Picture picture;
  picture.size = {image.data.width, image.data.height};
  picture.values.reserve(3 * image.data.pixels());
  for (std::size_t i = 0; i < image.data.pixels(); ++i) {
    for (const std::vector<double>& channel : image.values) picture.values.push_back(channel[i]);
  }
  picture.shows.assign(image.data.pixels(), Shows::kFace);
  picture.metadata = {{"method", file.filename().string()}};
  return picture;
}

}  // namespace exactff::render
