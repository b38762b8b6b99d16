// Pictures side by side, with captions.
#include <algorithm>

#include "exactff/render.h"
#include "render/letters.h"

namespace exactff::render {
namespace {

constexpr int kGap = 6;                // between pictures
constexpr int kBorder = 6;             // around captions
constexpr int kWidthForEachDot = 132;  // of a picture: a dot of a letter is one pixel more for each
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

  // The dots of the letters are squares of `dot` pixels. Letters that reach beyond `right` are left out.
  void write(const std::string& line, int left, int top, int right, int dot) {
    for (const char letter : line) {
      if (left + dot * kLetterWidth > right) return;
      for (int row = 0; row < dot * kLetterHeight; ++row) {
        for (int column = 0; column < dot * kLetterWidth; ++column) {
          if (has_dot(letter, column / dot, row / dot)) std::fill_n(at(left + column, top + row), 3, kInk);
        }
      }
      left += dot * kLetterWidth;
    }
  }

  [[nodiscard]] Colours take() { return std::move(colours_); }

 private:
  [[nodiscard]] std::vector<std::uint8_t>::iterator at(int column, int row) {
    return colours_.bytes.begin() + 3 * (static_cast<std::ptrdiff_t>(row) * colours_.size.width + column);
  }

  Colours colours_;
};

// Broken after blanks, commas and colons, or anywhere in longer words, so that a line has at most this many letters.
std::vector<std::string> broken(const std::vector<std::string>& lines, std::size_t most) {
  std::vector<std::string> result;
  for (std::string rest : lines) {
    while (rest.size() > most) {
      const std::size_t before = rest[most] == ' ' ? most : rest.find_last_of(" ,:", most - 1);
      const std::size_t end = before == std::string::npos ? most : before + 1;
      result.push_back(rest.substr(0, std::min(end, most)));
      rest.erase(0, end);
    }
    result.push_back(std::move(rest));
  }
  return result;
}

}  // namespace

// As captions are pictures, their letters grow with the pictures.
Colours strip(std::span<const Panel> panels) {
  Size size{-kGap, 0};
  int narrowest = kLongestSide;
  for (const auto& [picture, caption] : panels) {
    narrowest = std::min(narrowest, picture.size.width);
    size.width += picture.size.width + kGap;
    size.height = std::max(size.height, picture.size.height);
  }
  const int dot = std::max(1, narrowest / kWidthForEachDot);
  std::vector<std::vector<std::string>> captions;
  std::size_t lines = 0;
  for (const auto& [picture, caption] : panels) {
    const int letters = std::max(1, (picture.size.width - 2 * kBorder) / (dot * kLetterWidth));
    captions.push_back(broken(caption, static_cast<std::size_t>(letters)));
    lines = std::max(lines, captions.back().size());
  }
  const int line_height = dot * kLetterHeight, picture_height = size.height;
  size.height += static_cast<int>(lines) * line_height + 2 * kBorder;
  Sheet sheet(size);
  int left = 0;
  for (std::size_t i = 0; i < panels.size(); ++i) {
    sheet.paste(panels[i].first, left);
    int top = picture_height + kBorder;
    for (const std::string& line : captions[i]) {
      sheet.write(line, left + kBorder, top, left + panels[i].first.size.width, dot);
      top += line_height;
    }
    left += panels[i].first.size.width + kGap;
  }
  return sheet.take();
}

}  // namespace exactff::render
