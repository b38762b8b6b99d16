// Pictures to files.
#include <png.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <csetjmp>
#include <new>

#include "exactff/exr.h"
#include "exactff/render.h"
#include "exr/exr_file.h"
#include "files/file.h"
#include "kernel/float_environment.h"
#include "render/job.h"
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

// --- The picture of another program, to be judged ---

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

// --- Pictures as OpenEXR files ---

namespace {

std::uint32_t bits_of(double value, bool whole) {
  if (whole) return static_cast<std::uint32_t>(value);
  return std::bit_cast<std::uint32_t>(std::isnan(value) ? 0.0F : static_cast<float>(value));
}

}  // namespace

std::string exr_of(const Picture& picture) {
  const kernel::StandardArithmetic arithmetic;
  const exr::Window window{0, 0, picture.size.width, picture.size.height};
  exr::Image image{window, window, {}, picture.metadata};
  const auto add = [&](std::string name, bool whole, const double* values, std::size_t step) {
    exr::Numbers& channel =
        image.channels.emplace_back(exr::Numbers{std::move(name), whole ? exr::Kind::kWhole : exr::Kind::kFloat, {}});
    channel.bits.reserve(picture.pixels());
    for (std::size_t i = 0; i < picture.pixels(); ++i) channel.bits.push_back(bits_of(values[step * i], whole));
  };
  for (std::size_t c = 0; c < 3; ++c) add(std::string(1, "RGB"[c]), false, &picture.values[c], 3);
  for (const Layer& layer : picture.layers) add(layer.name, layer.whole, layer.values.data(), 1);
  return exr::exr_of(image);
}

// --- PNG files. Only this source knows the library ---

namespace {

void append(png_structp png, png_bytep bytes, png_size_t count) {
  auto& text = *static_cast<std::string*>(png_get_io_ptr(png));
  text.append(reinterpret_cast<const char*>(bytes), count);
}

void flush(png_structp) {}

std::vector<png_text> texts_of(Metadata& metadata) {
  std::vector<png_text> texts;
  for (auto& [name, value] : metadata) {
    png_text text{};
    text.compression = PNG_ITXT_COMPRESSION_NONE;  // UTF-8
    text.key = name.data();
    text.text = value.data();
    texts.push_back(text);
  }
  return texts;
}

// Without objects that a jump out of the library would not destroy.
bool write(png_structp png, png_infop info, const Colours& colours, const std::vector<png_text>& texts) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_IHDR(png, info, static_cast<png_uint_32>(colours.size.width), static_cast<png_uint_32>(colours.size.height),
               8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_set_text(png, info, texts.data(), static_cast<int>(texts.size()));
  png_set_compression_level(png, 9);
  png_write_info(png, info);
  for (int row = 0; row < colours.size.height; ++row)
    png_write_row(png, &colours.bytes[3 * pixel_at(colours.size, 0, row)]);
  png_write_end(png, nullptr);
  return true;
}

}  // namespace

std::string png_of(const Colours& colours, const Metadata& metadata) {
  std::string bytes;
  Metadata copy = metadata;
  const std::vector<png_text> texts = texts_of(copy);
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
  if (info == nullptr) {
    png_destroy_write_struct(&png, nullptr);
    throw std::bad_alloc();
  }
  png_set_write_fn(png, &bytes, append, flush);
  const bool written = write(png, info, colours, texts);
  png_destroy_write_struct(&png, &info);
  if (!written) throw std::bad_alloc();  // nothing else can fail in memory
  return bytes;
}

// --- Pictures side by side ---

namespace {

constexpr std::uint8_t kPaper = 255;
constexpr int kGap = 6;  // between pictures

Colours empty_sheet(std::span<const Colours> pictures) {
  Size size{-kGap, 0};
  for (const Colours& picture : pictures) {
    size.width += picture.size.width + kGap;
    size.height = std::max(size.height, picture.size.height);
  }
  return {size, std::vector<std::uint8_t>(3 * pixels_of(size), kPaper)};
}

void paste(const Colours& picture, int left, Colours& sheet) {
  for (int row = 0; row < picture.size.height; ++row) {
    std::copy_n(&picture.bytes[3 * pixel_at(picture.size, 0, row)], 3 * picture.size.width,
                &sheet.bytes[3 * pixel_at(sheet.size, left, row)]);
  }
}

}  // namespace

Colours strip(std::span<const Colours> pictures) {
  Colours sheet = empty_sheet(pictures);
  int left = 0;
  for (const Colours& picture : pictures) {
    paste(picture, left, sheet);
    left += picture.size.width + kGap;
  }
  return sheet;
}

}  // namespace exactff::render
