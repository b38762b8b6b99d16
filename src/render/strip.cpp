// Pictures side by side, with captions.
#include <algorithm>

#include "exactff/render.h"
#include "render/letters.h"

namespace exactff::render {
namespace {

constexpr int kGap = 6;     // between pictures, and above captions
constexpr int kBorder = 6;  // left of captions, and below them
constexpr std::uint8_t kPaper = 255, kInk = 30;

using Panel = std::pair<Colours, std::vector<std::string>>;

class Sheet {
 public:
  explicit Sheet(const Size& size)
      : colours_{size, std::vector<std::uint8_t>(
                           3 * static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height), kPaper)} {}

  void paste(const Colours& picture, int left) {
    for (int row = 0; row < picture.size.height; ++row) {
      const auto width = static_cast<std::ptrdiff_t>(picture.size.width);
      std::copy_n(picture.bytes.begin() + 3 * row * width, 3 * width, at(left, row));
    }
  }

  void write(const std::string& line, int left, int top, int right) {
    for (const char letter : line) {
      if (left + kLetterWidth > right) return;
      for (int row = 0; row < kLetterHeight; ++row) {
        for (int column = 0; column < kLetterWidth; ++column) {
          if (has_dot(letter, column, row)) std::fill_n(at(left + column, top + row), 3, kInk);
        }
      }
      left += kLetterWidth;
    }
  }

  [[nodiscard]] Colours take() { return std::move(colours_); }

 private:
  [[nodiscard]] std::vector<std::uint8_t>::iterator at(int column, int row) {
    return colours_.bytes.begin() + 3 * (static_cast<std::ptrdiff_t>(row) * colours_.size.width + column);
  }

  Colours colours_;
};

// Broken between words, so that the lines fit into this many letters.
std::vector<std::string> broken(const std::vector<std::string>& lines, std::size_t most) {
  std::vector<std::string> result;
  for (std::string rest : lines) {
    while (rest.size() > most) {
      std::size_t end = rest.find_last_of(" ,", most);
      if (end == std::string::npos || end == 0) end = most - 1;
      result.push_back(rest.substr(0, end + 1));
      rest.erase(0, end + 1);
    }
    result.push_back(std::move(rest));
  }
  return result;
}

}  // namespace

Colours strip(std::span<const Panel> panels) {
  std::vector<std::vector<std::string>> captions;
  Size size{-kGap, 0};
  std::size_t lines = 0;
  for (const auto& [picture, caption] : panels) {
    const int letters = std::max(1, (picture.size.width - 2 * kBorder) / kLetterWidth);
    captions.push_back(broken(caption, static_cast<std::size_t>(letters)));
    lines = std::max(lines, captions.back().size());
    size.width += picture.size.width + kGap;
    size.height = std::max(size.height, picture.size.height);
  }
  const int picture_height = size.height;
  size.height += kGap + static_cast<int>(lines) * kLetterHeight + kBorder;
  Sheet sheet(size);
  int left = 0;
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const Colours& picture = panels[i].first;
    sheet.paste(picture, left);
    int top = picture_height + kGap;
    for (const std::string& line : captions[i]) {
      sheet.write(line, left + kBorder, top, left + picture.size.width);
      top += kLetterHeight;
    }
    left += picture.size.width + kGap;
  }
  return sheet.take();
}

}  // namespace exactff::render
