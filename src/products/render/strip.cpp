// Pictures side by side.
#include <algorithm>

#include "exactff/render.h"

namespace exactff::render {
namespace {

constexpr std::uint8_t kPaper = 255;
constexpr int kGap = 6;  // between pictures

// The place of a pixel in the bytes of a picture.
std::ptrdiff_t place(const Colours& picture, int column, int row) {
  return 3 * (static_cast<std::ptrdiff_t>(row) * picture.size.width + column);
}

Colours empty_sheet(std::span<const Colours> pictures) {
  Size size{-kGap, 0};
  for (const Colours& picture : pictures) {
    size.width += picture.size.width + kGap;
    size.height = std::max(size.height, picture.size.height);
  }
  const std::size_t pixels = static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
  return {size, std::vector<std::uint8_t>(3 * pixels, kPaper)};
}

void paste(const Colours& picture, int left, Colours& sheet) {
  for (int row = 0; row < picture.size.height; ++row) {
    std::copy_n(picture.bytes.begin() + place(picture, 0, row), 3 * picture.size.width,
                sheet.bytes.begin() + place(sheet, left, row));
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
