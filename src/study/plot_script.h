// Pieces of gnuplot scripts that all figures share.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace exactff::study {

// A value and another, in that order along the axes.
using Points = std::vector<std::pair<double, double>>;

// One line of a plot. `style` numbers the colours and marks, from 1; 0 draws a grey dashed line.
inline constexpr int kOverlay = -1;  // dashed with open marks, for a line that may lie upon another
enum class Drawn { kLineAndMarks, kLine, kMarks };
struct Series {
  std::string title;
  Points points;
  int style = 1;
  Drawn drawn = Drawn::kLineAndMarks;  // where the style is a number from 1
};

struct Axes {
  std::string x;
  std::string y;
  bool log_x = true;
  bool log_y = true;
  std::vector<std::string> extra = {};  // further commands
  std::vector<double> marks = {};       // values on the x axis that are to be seen as well
};

// Lines with marks. Points that a logarithmic axis cannot show are left out; so are series without points.
// Empty if nothing remains.
[[nodiscard]] std::string line_plot(const Axes& axes, const std::vector<Series>& series);

// Points alone, thousands of them, small and half transparent; series of style 0 and kOverlay are lines, as above.
[[nodiscard]] std::string scatter_plot(const Axes& axes, const std::vector<Series>& series);

// A bar of a histogram over the x axis.
struct Bar {
  double low = 0.0;
  double high = 0.0;
  double height = 0.0;
};

// A vertical line.
struct Mark {
  std::string title;
  double x = 0.0;
};

// Bars from 0, with marks over them. What a logarithmic x axis cannot show is left out. Empty if no bar remains.
[[nodiscard]] std::string bar_plot(const Axes& axes, const std::vector<Bar>& bars, const std::vector<Mark>& marks);

struct MapCell {
  int column = 1;
  int row = 1;
  double value = 0.0;
};

enum class MapColours { kSequential, kDiverging, kLogarithmic, kClasses };

struct Map {
  std::string quantity;  // of the colour bar
  int columns = 1;
  int rows = 1;
  double height_over_width = 1.0;
  MapColours colours = MapColours::kSequential;
  double largest = 0.0;  // ends of a diverging scale; larger magnitudes take the colours of its ends
  std::vector<MapCell> cells;
  std::vector<std::string> classes = {};  // names of the values 0, 1, ... where the colours are of classes
};

[[nodiscard]] std::string map_plot(const Map& map);

}  // namespace exactff::study
