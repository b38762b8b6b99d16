#include "study/plot_script.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "study/text.h"

namespace exactff::study {
namespace {

// Okabe and Ito's colours, told apart with every common colour blindness; marks and dashes differ as well, for
// print. Chosen from the middle of their range: readable on white and on near-black.
constexpr std::array<std::string_view, 7> kLineStyles = {"lc rgb '#0072B2' pt 7 dt 1",  "lc rgb '#D55E00' pt 5 dt 1",
                                                         "lc rgb '#009E73' pt 9 dt 1",  "lc rgb '#CC79A7' pt 13 dt 1",
                                                         "lc rgb '#E69F00' pt 11 dt 1", "lc rgb '#56B4E9' pt 6 dt 1",
                                                         "lc rgb '#8A8A8A' pt 4 dt 1"};
// For a line that may lie upon another: its open marks leave the other's to be seen.
constexpr std::string_view kOverlayStyle = "with linespoints lw 1.2 ps 1.3 lc rgb '#CC79A7' pt 12 dt 3";

// Ten samples of viridis; a diverging scale that is light grey in the middle.
constexpr std::string_view kViridis =
    "set palette defined (0 '#440154', 1 '#482878', 2 '#3e4989', 3 '#31688e', 4 '#26828e', 5 '#1f9e89', 6 '#35b779', "
    "7 '#6ece58', 8 '#b5de2b', 9 '#fde725')\n";
constexpr std::string_view kDiverging =
    "set palette defined (0 '#2166ac', 1 '#67a9cf', 2 '#d1e5f0', 3 '#f7f7f7', 4 '#fddbc7', 5 '#ef8a62', 6 '#b2182b')\n";

// Figures of a page have its background; those that stand alone are white everywhere.
enum class Background { kOfPage, kWhite };

std::string head(int width, int height, Background background = Background::kOfPage) {
  return "set encoding utf8\nset terminal svg size " + std::to_string(width) + ',' + std::to_string(height) +
         " dynamic enhanced font 'sans-serif,15' linewidth 1.2" +
         (background == Background::kWhite ? " background rgb 'white'" : "") + "\n";
}

std::string quoted(std::string_view text) {
  std::string safe = "'";
  for (char c : text) {
    if (c == '\'') safe += '\'';
    safe += c == '\n' ? ' ' : c;
  }
  return safe + '\'';
}

Points drawable(const Points& points, const Axes& axes) {
  Points kept;
  for (const auto& [x, y] : points) {
    if (!std::isfinite(x) || !std::isfinite(y)) continue;
    if ((axes.log_x && x <= 0.0) || (axes.log_y && y <= 0.0)) continue;
    kept.emplace_back(x, y);
  }
  std::sort(kept.begin(), kept.end());
  return kept;
}

std::string data_block(const std::string& name, const Points& points) {
  std::string text = '$' + name + " << END\n";
  for (const auto& [x, y] : points) text += shortest(x) + ' ' + shortest(y) + '\n';
  return text + "END\n";
}

std::string axis_commands(const Axes& axes) {
  std::string text =
      "set xlabel " + quoted(axes.x) + "\nset ylabel " + quoted(axes.y) +
      "\nset grid lw 0.5 lc rgb '#8A8A8A' dt 3\nset key tmargin center horizontal maxrows 2 samplen 2 width 1\n"
      "set border 3 lw 0.8\nset tics nomirror\n";
  if (axes.log_x) text += "set logscale x\nset format x '10^{%T}'\n";
  if (axes.log_y) text += "set logscale y\nset format y '10^{%T}'\n";
  for (const std::string& command : axes.extra) text += command + '\n';
  return text;
}

// A logarithmic axis would otherwise reach to the next power of ten.
std::string x_range(const Axes& axes, const std::vector<Points>& drawn) {
  if (!axes.log_x) return {};
  std::vector<double> all = axes.marks;
  for (const Points& points : drawn) {
    for (const auto& point : points) all.push_back(point.first);
  }
  const auto [low, high] = std::minmax_element(all.begin(), all.end());
  return "set xrange [" + shortest(*low / 1.5) + ':' + shortest(*high * 1.5) + "]\n";
}

std::string style_of(const Series& series) {
  if (series.style == kOverlay) return std::string(kOverlayStyle);
  if (series.style == 0) return "with lines lw 1.2 dt 2 lc rgb '#8A8A8A'";
  return "with linespoints lw 1.8 ps 0.7 " +
         std::string(kLineStyles[static_cast<std::size_t>(series.style - 1) % kLineStyles.size()]);
}

// Of a mark over bars, which have the first colour.
std::string mark_style(std::size_t i) {
  constexpr std::array<std::string_view, 4> kColours = {"#D55E00", "#CC79A7", "#009E73", "#E69F00"};
  return "lw 2 dt " + std::to_string(1 + i % 5) + " lc rgb '" + std::string(kColours[i % kColours.size()]) + '\'';
}

double largest_value(const Map& map) {
  double largest = 0.0;
  for (const MapCell& cell : map.cells) largest = std::max(largest, cell.value);
  return largest;
}

// A few marks, so that their numbers do not run into one another on a narrow bar.
std::string colour_range(double low, double middle, double high) {
  const auto mark = [](double value) { return '\'' + rounded(value, 2) + "' " + shortest(value); };
  return "set cbrange [" + shortest(low) + ':' + shortest(high) + "]\nset cbtics (" + mark(low) + ", " + mark(middle) +
         ", " + mark(high) + ") offset 0,2.1 nomirror scale 0\n";
}

std::string colour_commands(const Map& map) {
  if (map.colours == MapColours::kDiverging) {
    return std::string(kDiverging) + colour_range(-map.largest, 0.0, map.largest);
  }
  const double largest = largest_value(map);
  if (map.colours == MapColours::kLogarithmic && largest > 10.0) {
    return std::string(kViridis) + "set logscale cb\n" + colour_range(1.0, std::round(std::sqrt(largest)), largest);
  }
  return std::string(kViridis) + colour_range(0.0, 0.5 * largest, largest);
}

}  // namespace

std::string line_plot(const Axes& axes, const std::vector<Series>& series) {
  std::string data, plot;
  std::vector<Points> drawn;
  for (const Series& line : series) {
    Points points = drawable(line.points, axes);
    if (points.empty()) continue;
    const std::string name = "series" + std::to_string(drawn.size());
    data += data_block(name, points);
    plot += (plot.empty() ? "plot " : ", \\\n     ") + ('$' + name) + " using 1:2 " + style_of(line) +
            (line.title.empty() ? " notitle" : " title " + quoted(line.title));
    drawn.push_back(std::move(points));
  }
  if (plot.empty()) return {};
  return head(560, 430) + axis_commands(axes) + x_range(axes, drawn) + data + plot + '\n';
}

std::string bar_plot(const Axes& axes, const std::vector<Bar>& bars, const std::vector<Mark>& marks) {
  const auto is_drawable = [&](double x) { return std::isfinite(x) && (x > 0.0 || !axes.log_x); };
  std::string data, arrows, keys;
  Points ends;
  for (const Bar& bar : bars) {
    if (!is_drawable(bar.low) || !is_drawable(bar.high)) continue;
    data += shortest(bar.low) + ' ' + shortest(bar.high) + ' ' + shortest(bar.height) + '\n';
    ends.insert(ends.end(), {{bar.low, 0.0}, {bar.high, 0.0}});
  }
  if (data.empty()) return {};
  for (std::size_t i = 0; i < marks.size(); ++i) {
    if (!is_drawable(marks[i].x)) continue;
    const std::string at = shortest(marks[i].x), style = mark_style(i);
    ends.emplace_back(marks[i].x, 0.0);
    arrows += "set arrow from " + at + ", graph 0 to " + at + ", graph 1 nohead front " + style + '\n';
    keys += ", \\\n     keyentry with lines " + style + " title " + quoted(marks[i].title);
  }
  return head(560, 430, Background::kWhite) + axis_commands(axes) + x_range(axes, {ends}) + "set yrange [0:*]\n" +
         arrows + "$bars << END\n" + data +
         "END\nplot $bars using 1:3:1:2:(0):3 with boxxyerror lc rgb '#0072B2' fs solid 0.6 noborder notitle" + keys +
         '\n';
}

std::string map_plot(const Map& map) {
  std::string text = head(460, 460);
  text += "set size ratio " + shortest(std::clamp(map.height_over_width, 0.4, 1.6)) + '\n';
  text +=
      "set xrange [0.5:" + std::to_string(map.columns) + ".5]\nset yrange [0.5:" + std::to_string(map.rows) + ".5]\n";
  text += "set xlabel 'column of the grid (u)'\nset ylabel 'row of the grid (v)' offset 0.5,0\nset tics nomirror out\n";
  text += colour_commands(map);
  text +=
      "set colorbox horizontal user origin graph 0, graph 1.06 size graph 1, graph 0.04\n"
      "set cblabel " +
      quoted(map.quantity) +
      " offset 0,4.9\n"
      "set lmargin at screen 0.18\nset rmargin at screen 0.94\n"
      "set tmargin at screen 0.83\nset bmargin at screen 0.17\n";
  text += "$cells << END\n";
  for (const MapCell& cell : map.cells) {
    text += std::to_string(cell.column) + ' ' + std::to_string(cell.row) + ' ' + shortest(cell.value) + '\n';
  }
  return text + "END\nplot $cells using 1:2:3 with image pixels notitle\n";
}

}  // namespace exactff::study
