// PNG files. Only this source knows the library.
#include <png.h>

#include <csetjmp>
#include <new>

#include "exactff/render.h"

namespace exactff::render {
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
  for (int row = 0; row < colours.size.height; ++row) {
    png_write_row(
        png, colours.bytes.data() + 3 * static_cast<std::size_t>(row) * static_cast<std::size_t>(colours.size.width));
  }
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

}  // namespace exactff::render
