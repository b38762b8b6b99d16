// Where the names of things fit into a picture. The picture is a grid of squares, each of which belongs to the thing
// at its middle. A name is a box of squares.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace exactff::whole_view {

struct Pixel {
  double x = 0.0, y = 0.0;
};
using PixelLoop = std::vector<Pixel>;  // the last one is joined to the first one

class Labels {
 public:
  static constexpr double kFontSize = 12.0, kHeight = 20.0;  // in pixels; the height is that of a line with margins

  Labels(double width, double height);

  // What lies within the loops, by the even-odd rule, belongs to `thing`, and no longer to a thing added before.
  void add(std::uint32_t thing, std::span<const PixelLoop> loops);
  // The middle of a box for the text that lies in the thing: of all such boxes, the one next to their mean. None if the
  // text fits nowhere. After the last `add`.
  [[nodiscard]] std::optional<Pixel> place(std::uint32_t thing, const std::string& text);

 private:
  struct SquareBounds {  // of squares; the last ones do not belong to it
    int left = 0, top = 0, right = 0, bottom = 0;
  };

  [[nodiscard]] std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
  }
  [[nodiscard]] bool fits(std::uint32_t thing, int column, int row, int width, int height) const;
  void count_runs();

  int columns_, rows_;
  std::vector<std::uint64_t> thing_;  // of each square: 1 + the thing, or 0
  std::vector<int> run_;              // the number of squares of its thing from each square to the right
  std::map<std::uint32_t, SquareBounds> bounds_;
};

}  // namespace exactff::whole_view
