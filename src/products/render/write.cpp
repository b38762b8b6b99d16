// Pictures to files.
#include "exactff/render.h"
#include "files/file.h"
#include "text/escape.h"
#include "text/names.h"
#include "text/refuse.h"

namespace exactff::render {

ImageKind image_kind(const std::filesystem::path& file) {
  const std::string extension = text::in_lower_case(file.extension().string());
  if (extension == ".exr") return ImageKind::kExr;
  if (extension == ".png") return ImageKind::kPng;
  text::refuse(file, extension.empty() ? "has no extension" : "has the unknown extension " + text::printable(extension),
               "the extension says in which format an image is written", "name a file that ends in .exr or .png");
}

void write_image(const std::filesystem::path& file, const Picture& picture, std::optional<double> exposure) {
  files::WholeFile whole(file, {}, files::WholeFile::WhenBusy::kWait);
  if (image_kind(file) == ImageKind::kExr) {
    whole.append(exr_of(picture));
  } else {
    const double factor = exposure ? *exposure : automatic_exposure(picture);
    whole.append(png_of(develop(picture, factor), picture.metadata));
  }
  whole.commit();
}

}  // namespace exactff::render
