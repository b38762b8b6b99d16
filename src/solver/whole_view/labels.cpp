#include "whole_view/labels.h"

#include <algorithm>
#include <cmath>

namespace exactff::whole_view {

namespace {

constexpr double kSquare = 4.0;
constexpr double kMargin = 3.0;  // beside the text

int squares(double length) { return static_cast<int>(std::ceil(length / kSquare)); }

// Estimated from above for usual fonts. The letters of other alphabets may be wider, up to squares.
double width_of(const std::string& text) {
  constexpr double kNarrow = 7.0;
  double width = 2 * kMargin;
  for (const char byte : text) {
    const auto code = static_cast<unsigned char>(byte);
    const bool continues = (code & 0xC0U) == 0x80U;  // a letter that has begun
    if (!continues) width += code < 0x80U ? kNarrow : Labels::kFontSize;
  }
  return width;
}

}  // namespace

Labels::Labels(double width, double height)
    : columns_(squares(width)),
      rows_(squares(height)),
      thing_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), 0) {}

void Labels::add(std::uint32_t thing, std::span<const PixelLoop> loops) {
  std::map<int, std::vector<double>> crossings;  // of the middle line of a row
  for (const PixelLoop& loop : loops) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Pixel &p = loop[i], &q = loop[(i + 1) % loop.size()];
      const auto [low, high] = std::minmax(p.y, q.y);
      const int first = std::max(0, static_cast<int>(std::ceil(low / kSquare - 0.5)));
      for (int row = first; row < rows_ && (row + 0.5) * kSquare < high; ++row) {
        crossings[row].push_back(p.x + ((row + 0.5) * kSquare - p.y) / (q.y - p.y) * (q.x - p.x));
      }
    }
  }
  if (crossings.empty()) return;
  SquareBounds bounds{columns_, crossings.begin()->first, 0, crossings.rbegin()->first + 1};
  for (auto& [row, places] : crossings) {
    std::ranges::sort(places);
    for (std::size_t i = 0; i + 1 < places.size(); i += 2) {
      const int left = std::max(0, static_cast<int>(std::ceil(places[i] / kSquare - 0.5)));
      const int right = std::min(columns_, static_cast<int>(std::ceil(places[i + 1] / kSquare - 0.5)));
      for (int column = left; column < right; ++column) thing_[index(column, row)] = std::uint64_t{1} + thing;
      if (left < right)
        bounds = {std::min(bounds.left, left), bounds.top, std::max(bounds.right, right), bounds.bottom};
    }
  }
  bounds_[thing] = bounds;
}

void Labels::count_runs() {
  run_.assign(thing_.size(), 1);
  for (int row = 0; row < rows_; ++row) {
    for (int column = columns_ - 2; column >= 0; --column) {
      const std::size_t here = index(column, row);
      if (thing_[here] == thing_[here + 1]) run_[here] = run_[here + 1] + 1;
    }
  }
}

bool Labels::fits(std::uint32_t thing, int column, int row, int width, int height) const {
  for (int r = row; r < row + height; ++r) {
    const std::size_t here = index(column, r);
    if (thing_[here] != std::uint64_t{1} + thing || run_[here] < width) return false;
  }
  return true;
}

std::optional<Pixel> Labels::place(std::uint32_t thing, const std::string& text) {
  if (run_.empty()) count_runs();
  const auto found = bounds_.find(thing);
  if (found == bounds_.end()) return {};
  const SquareBounds& bounds = found->second;
  const int width = squares(width_of(text)), height = squares(kHeight);
  std::vector<Pixel> middles;
  Pixel mean;
  for (int row = bounds.top; row + height <= bounds.bottom; ++row) {
    for (int column = bounds.left; column + width <= bounds.right; ++column) {
      if (!fits(thing, column, row, width, height)) continue;
      middles.push_back({(column + 0.5 * width) * kSquare, (row + 0.5 * height) * kSquare});
      mean = {mean.x + middles.back().x, mean.y + middles.back().y};
    }
  }
  if (middles.empty()) return {};
  const auto count = static_cast<double>(middles.size());
  return *std::ranges::min_element(middles, {}, [&](const Pixel& middle) {
    return std::hypot(middle.x - mean.x / count, middle.y - mean.y / count);
  });
}

}  // namespace exactff::whole_view
