// Writes scripts for gnuplot, and runs it as a program.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "exactff/jobs.h"

namespace exactff::page {

struct PlotResult {
  enum class Outcome { kDrawn, kNoProgram, kFailed } outcome = Outcome::kFailed;
  std::string svg;      // if drawn
  std::string message;  // gnuplot's messages if it failed
};

// Runs the script, which plots to standard output, with its files in `scratch`. gnuplot is ended, and counts as failed,
// if it takes longer than a minute or if `cancelled` returns true while it runs.
[[nodiscard]] PlotResult run_gnuplot(std::string_view script, const std::filesystem::path& scratch,
                                     const std::function<bool()>& cancelled = {});

// Prepares gnuplot's SVG for an HTML page with several figures: no prolog, every id begins with `prefix`, black becomes
// the page's text colour, the title is `title`, and nothing refers to anything outside.
[[nodiscard]] std::string inline_svg(std::string_view svg, std::string_view prefix, std::string_view title);

// --- Plot script ---

// Pieces of gnuplot scripts that all figures use.

// Pairs (x, y).
using Points = std::vector<std::pair<double, double>>;

// One line of a plot. `style` numbers the colours and marks, from 1; 0 draws a grey dashed line.
inline constexpr int kOverlay = -1;  // dashed with open marks, for a line that may coincide with another
enum class Drawn { kLineAndMarks, kLine, kMarks };
struct Series {
  std::string title;
  Points points;
  int style = 1;
  Drawn drawn = Drawn::kLineAndMarks;  // used if the style is 1 or more
};

// A vertical line.
struct Mark {
  std::string title;
  double x = 0.0;
};

struct Axes {
  std::string x;
  std::string y;
  bool log_x = true;
  bool log_y = true;
  std::vector<std::string> extra = {};  // further commands
  std::vector<Mark> marks = {};         // named in the legend, where no line or point can cover the name
};

// Lines with marks. Points that a logarithmic axis cannot show are left out, and so are series without points. Empty if
// nothing remains.
[[nodiscard]] std::string line_plot(const Axes& axes, const std::vector<Series>& series);

// A bar of a histogram over the x axis.
struct Bar {
  double low = 0.0;
  double high = 0.0;
  double height = 0.0;
};

// Bars from 0, with marks over them. Values that a logarithmic x axis cannot show are left out. Empty if no bar
// remains.
[[nodiscard]] std::string bar_plot(const Axes& axes, const std::vector<Bar>& bars, const std::vector<Mark>& marks);

struct MapCell {
  int column = 1;
  int row = 1;
  double value = 0.0;
};

enum class MapColours { kSequential, kDiverging, kClasses };

struct Map {
  std::string quantity;  // label of the colour bar
  int columns = 1;
  int rows = 1;
  double width = 1.0;  // of all columns together
  double height = 1.0;
  MapColours colours = MapColours::kSequential;
  double largest = 0.0;  // the ends of a diverging scale are +-largest; larger magnitudes get the colours of the ends
  std::vector<MapCell> cells;             // others stay blank
  std::vector<std::string> classes = {};  // names of the values 0, 1, ... if the colours stand for classes
};

[[nodiscard]] std::string map_plot(const Map& map);

// --- figures ---

// A figure of a report: a gnuplot script that contains its data.

struct Figure {
  std::string id;  // unique in the page
  std::string title;
  std::string caption;  // HTML
  std::string script;   // plots one SVG to standard output
  bool map = false;     // a false-colour map over the grid
};

struct DrawnFigure {
  Figure figure;
  std::string svg;
};

struct DrawnFigures {
  std::vector<DrawnFigure> figures;
  std::vector<LeftOut> left_out;  // figures that gnuplot could not draw
  std::string none;               // why there are no figures; empty if there are
};

// Runs gnuplot, with its files in `scratch`. Adds notes for the user to `messages`.
[[nodiscard]] DrawnFigures draw_figures(std::vector<Figure> figures, const std::filesystem::path& scratch,
                                        std::vector<std::string>& messages, const Hooks& hooks);

}  // namespace exactff::page
