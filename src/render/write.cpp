// Pictures to files.
#include <algorithm>
#include <cctype>

#include "exactff/render.h"
#include "text/escape.h"
#include "text/refuse.h"
#include "work/file.h"

namespace exactff::render {

ImageKind image_kind(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == ".exr") return ImageKind::kExr;
  if (extension == ".png") return ImageKind::kPng;
  text::refuse(file, extension.empty() ? "has no extension" : "has the unknown extension " + text::printable(extension),
               "the extension says in which format an image is written", "name a file that ends in .exr or .png");
}

void write_image(const std::filesystem::path& file, const Picture& picture, std::optional<double> exposure) {
  work::WholeFile whole(file, {}, work::WholeFile::WhenBusy::kWait);
  if (image_kind(file) == ImageKind::kExr) {
    whole.append(exr_of(picture));
  } else {
    const double factor = exposure ? *exposure : automatic_exposure(picture);
    whole.append(png_of(developed(picture, factor), picture.metadata));
  }
  whole.commit();
}

}  // namespace exactff::render
