#include "page/gnuplot.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstring>
#include <fstream>
#include <sstream>
#include <thread>

#include "files/parallel.h"
#include "text/encoding.h"
#include "text/escape.h"
#include "text/phrases.h"

namespace exactff::page {
namespace {

namespace fs = std::filesystem;

std::string contents(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

// How the child is started: with files in place of its streams, and the default action of SIGXFSZ (file size limit
// exceeded), whatever this process does.
class Spawn {
 public:
  Spawn() {
    ::posix_spawn_file_actions_init(&actions_);
    ::posix_spawnattr_init(&attributes_);
    sigset_t restored;
    ::sigemptyset(&restored);
    ::sigaddset(&restored, SIGXFSZ);
    ::posix_spawnattr_setsigdefault(&attributes_, &restored);
    ::posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGDEF);
  }
  ~Spawn() {
    ::posix_spawn_file_actions_destroy(&actions_);
    ::posix_spawnattr_destroy(&attributes_);
  }
  Spawn(const Spawn&) = delete;
  Spawn& operator=(const Spawn&) = delete;

  void open(int descriptor, const char* path, int flags) {
    ::posix_spawn_file_actions_addopen(&actions_, descriptor, path, flags, 0600);
  }
  // Returns 0, or why the program could not be started.
  [[nodiscard]] int run(char* const* arguments, char* const* environment, pid_t& child) const {
    return ::posix_spawnp(&child, arguments[0], &actions_, &attributes_, arguments, environment);
  }

 private:
  posix_spawn_file_actions_t actions_{};
  posix_spawnattr_t attributes_{};
};

// Our environment with another locale: the scripts are UTF-8 on every machine.
class Utf8Environment {
 public:
  Utf8Environment() {
    for (char** entry = environ; *entry != nullptr; ++entry) {
      if (!std::string_view(*entry).starts_with("LC_ALL=")) entries_.push_back(*entry);
    }
    entries_.push_back(locale_.data());
    entries_.push_back(nullptr);
  }
  [[nodiscard]] char* const* get() const { return entries_.data(); }

 private:
  std::string locale_ = "LC_ALL=C.UTF-8";
  std::vector<char*> entries_;
};

struct Child {
  int error = 0;  // why it could not be started; 0 if it was
  int status = 0;
  std::string given_up;  // why it was ended early; empty if it was not
};

bool has_ended(pid_t child, int& status) {
  const pid_t result = ::waitpid(child, &status, WNOHANG);
  return result == child || (result < 0 && errno != EINTR);
}

void wait_for(pid_t pid, const std::function<bool()>& cancelled, Child& child) {
  constexpr auto kLongest = std::chrono::seconds(60);
  const auto start = std::chrono::steady_clock::now();
  for (auto pause = std::chrono::milliseconds(1); !has_ended(pid, child.status);) {
    if (cancelled && cancelled()) child.given_up = "interrupted";
    if (std::chrono::steady_clock::now() - start > kLongest) child.given_up = "it took longer than a minute";
    if (!child.given_up.empty()) {
      ::kill(pid, SIGKILL);
      while (::waitpid(pid, &child.status, 0) < 0 && errno == EINTR) {
      }
      return;
    }
    std::this_thread::sleep_for(pause);
    pause = std::min(2 * pause, std::chrono::milliseconds(20));
  }
}

// Started without a shell, so no name needs quoting.
Child run(const fs::path& script, const fs::path& out, const fs::path& err, const std::function<bool()>& cancelled) {
  Spawn spawn;
  spawn.open(STDIN_FILENO, "/dev/null", O_RDONLY);
  spawn.open(STDOUT_FILENO, out.c_str(), O_WRONLY | O_CREAT | O_TRUNC);
  spawn.open(STDERR_FILENO, err.c_str(), O_WRONLY | O_CREAT | O_TRUNC);
  std::string program = "gnuplot", defaults = "-d", file = script.string();
  const std::array<char*, 4> arguments = {program.data(), defaults.data(), file.data(), nullptr};
  const Utf8Environment environment;
  Child child;
  pid_t pid = 0;
  child.error = spawn.run(arguments.data(), environment.get(), pid);
  if (child.error == 0) wait_for(pid, cancelled, child);
  return child;
}

bool is_missing(const Child& child) {
  const bool unable = WIFEXITED(child.status) && WEXITSTATUS(child.status) == 127;
  return child.error == ENOENT || child.error == EACCES || (child.error == 0 && unable);
}

std::string complaint(const Child& child, const fs::path& err) {
  constexpr std::size_t kShown = 500;
  if (child.error != 0) return std::strerror(child.error);
  if (!child.given_up.empty()) return child.given_up;
  return std::string(text::beginning(contents(err), kShown));
}

void remove_between(std::string& text, std::string_view begin, std::string_view end) {
  for (std::size_t at = text.find(begin); at != std::string::npos; at = text.find(begin, at)) {
    const std::size_t close = text.find(end, at + begin.size());
    if (close == std::string::npos) return;
    text.erase(at, close + end.size() - at);
  }
}

}  // namespace

PlotResult run_gnuplot(std::string_view script, const fs::path& scratch, const std::function<bool()>& cancelled) {
  const fs::path in = scratch / "figure.gp", out = scratch / "figure.svg", err = scratch / "figure.err";
  PlotResult result;
  std::ofstream file(in, std::ios::binary);
  file << script;
  file.close();
  if (!file) {
    result.message = "its script could not be written; the disk may be full";
  } else if (const Child child = run(in, out, err, cancelled); is_missing(child)) {
    result.outcome = PlotResult::Outcome::kNoProgram;
  } else {
    result.svg = contents(out);
    result.message = complaint(child, err);
    const bool drawn = child.error == 0 && child.status == 0 && result.svg.find("</svg>") != std::string::npos;
    if (drawn) result.outcome = PlotResult::Outcome::kDrawn;
  }
  std::error_code ignored;
  for (const fs::path& used : {in, out, err}) fs::remove(used, ignored);
  return result;
}

std::string inline_svg(std::string_view svg, std::string_view prefix, std::string_view title) {
  const std::size_t begin = svg.find("<svg");
  const std::size_t end = svg.rfind("</svg>");
  if (begin == std::string_view::npos || end == std::string_view::npos) return {};
  std::string text(svg.substr(begin, end + 6 - begin));
  remove_between(text, "<title>", "</title>");
  remove_between(text, "<desc>", "</desc>");
  remove_between(text, "xmlns=\"", "\"");
  remove_between(text, "xmlns:xlink=\"", "\"");
  const std::string mark(prefix);
  text::replace_all(text, "id='", "id='" + mark + '-');
  text::replace_all(text, "id=\"", "id=\"" + mark + '-');
  text::replace_all(text, "xlink:href='#", "href='#" + mark + '-');
  text::replace_all(text, "url(#", "url(#" + mark + '-');
  text::replace_all(text, " color=\"black\"", "");
  text::replace_all(text, "'black'", "'currentColor'");
  text::replace_all(text, "\"black\"", "\"currentColor\"");
  text::replace_all(text, "fill=\"#ffffff\"",
                    "fill=\"none\"");  // a background of its own; the page has one for every figure
  text::replace_all(text, "stroke-width='0.178'", "stroke-width='0.3'");  // open marks, which are thin on a phone
  text.insert(4, " role=\"img\" aria-label=\"" + text::html(title) + "\"");
  return text;
}

// --- Plot script ---

namespace {

// The colours of Okabe and Ito, which can be distinguished with every common colour blindness, then the page's text
// colour and a grey. Marks and dashes differ as well, for print. Their yellow is left out: it cannot be seen on white.
// The light colours come late, and the last five lines are dashed, so that the eighth line is not mistaken for the
// first.
constexpr std::array<std::string_view, 9> kLineStyles = {
    "lc rgb '#0072B2' pt 7 dt 1",  "lc rgb '#D55E00' pt 5 dt 1",       "lc rgb '#009E73' pt 9 dt 1",
    "lc rgb '#CC79A7' pt 13 dt 1", "lc rgb '#E69F00' pt 11 dt (16,4)", "lc rgb '#56B4E9' pt 6 dt (8,3)",
    "lc black pt 4 dt (12,3,2,3)", "lc rgb '#8A8A8A' pt 2 dt (4,3)",   "lc rgb '#9467BD' pt 8 dt (6,4)"};
// For a line that may coincide with another: the other line stays visible through its open marks.
constexpr std::string_view kOverlayStyle = "with linespoints lw 1.2 ps 1.3 lc rgb '#CC79A7' pt 12 dt 3";

// Ten samples of viridis; a diverging scale that is light grey in the middle.
constexpr std::string_view kViridis =
    "set palette defined (0 '#440154', 1 '#482878', 2 '#3e4989', 3 '#31688e', 4 '#26828e', 5 '#1f9e89', 6 '#35b779', "
    "7 '#6ece58', 8 '#b5de2b', 9 '#fde725')\n";
constexpr std::string_view kDiverging =
    "set palette defined (0 '#2166ac', 1 '#67a9cf', 2 '#d1e5f0', 3 '#f7f7f7', 4 '#fddbc7', 5 '#ef8a62', 6 '#b2182b')\n";

// Figures on a page use its background; separate figures have a white background.
enum class Background { kOfPage, kWhite };
constexpr int kPlotWidth = 520;  // small enough that the lettering is readable on a phone
constexpr int kKeyFont = 13;

std::string head(int width, int height, Background background = Background::kOfPage) {
  return "set encoding utf8\nset terminal svg size " + std::to_string(width) + ',' + std::to_string(height) +
         " dynamic enhanced font 'sans-serif,15' linewidth 1.2" +
         (background == Background::kWhite ? " background rgb 'white'" : "") + "\n";
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
  std::string text = name + " << END\n";
  for (const auto& [x, y] : points) text += text::shortest(x) + ' ' + text::shortest(y) + '\n';
  return text + "END\n";
}

// The legend above the plot: as many equally full columns as fit.
struct Key {
  std::size_t rows = 0;
  std::size_t columns = 1;
  std::size_t spare = 0;  // how many characters gnuplot overestimates the longest entry by
};

std::size_t characters(std::string_view text) {
  const auto begins = [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; };  // in UTF-8
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), begins));
}

// The room and the widths are those that gnuplot's SVG terminal assumes.
Key key_of(const std::vector<std::string>& titles) {
  constexpr double kRoom = kPlotWidth - 40, kCharacter = 0.7 * kKeyFont, kSample = 5.7 * kCharacter;
  std::size_t entries = 0, longest = 0;
  for (const std::string& title : titles) {
    if (title.empty()) continue;
    ++entries;
    longest = std::max(longest, characters(title));
  }
  if (entries == 0) return {};
  const std::size_t spare = longest / 8;
  const auto fitting = static_cast<std::size_t>(kRoom / (kCharacter * static_cast<double>(longest - spare) + kSample));
  const std::size_t most = std::clamp<std::size_t>(fitting, 1, entries);
  const std::size_t rows = (entries + most - 1) / most;
  return {rows, (entries + rows - 1) / rows, spare};
}

// The axes get the same room however large the legend is.
std::string plot_head(const Key& key, Background background = Background::kOfPage) {
  return head(kPlotWidth, 360 + 20 * static_cast<int>(key.rows), background);
}

std::string axis_commands(const Axes& axes, const Key& key) {
  std::string text = "set xlabel " + text::gnuplot_string(axes.x) + "\nset ylabel " + text::gnuplot_string(axes.y) +
                     "\nset grid lw 0.5 lc rgb '#8A8A8A' dt 3\nset minussign\nset bmargin 3.3\n"
                     "set key tmargin center horizontal samplen 2.4 font '," +
                     std::to_string(kKeyFont) + "' width -" + std::to_string(key.spare) + " maxcols " +
                     std::to_string(key.columns) + "\nset border 3 lw 0.8\nset tics nomirror\n";
  if (axes.log_x) text += "set logscale x\nset format x '10^{%T}'\n";
  if (axes.log_y) text += "set logscale y\nset format y '10^{%T}'\n";
  return text;
}

std::string extra_commands(const Axes& axes) {
  std::string text;
  for (const std::string& command : axes.extra) text += command + '\n';
  return text;
}

// The places of the marks that the x axis can show.
std::vector<double> drawn_marks(const Axes& axes) {
  std::vector<double> places;
  for (const Mark& mark : axes.marks) {
    if (std::isfinite(mark.x) && (mark.x > 0.0 || !axes.log_x)) places.push_back(mark.x);
  }
  return places;
}

// By what factor a logarithmic axis is longer than its values at each end. Without one, gnuplot lets it end at powers
// of ten.
constexpr double kXMargin = 1.5, kNoMargin = 1.0;

std::string x_range(const Axes& axes, const std::vector<Points>& drawn) {
  if (!axes.log_x) return {};
  std::vector<double> all = drawn_marks(axes);
  for (const Points& points : drawn) {
    for (const auto& point : points) all.push_back(point.first);
  }
  const auto [low, high] = std::minmax_element(all.begin(), all.end());
  return "set xrange [" + text::shortest(*low / kXMargin) + ':' + text::shortest(*high * kXMargin) + "]\n";
}

// gnuplot 6 also writes a number, 10^1 or 10^2, at minor tics of a logarithmic axis on which there are fewer than three
// powers of ten. There the tics are listed, in the way in which gnuplot 5 draws them.
std::string decimal_tics(const char* axis, double low, double high) {
  if (std::floor(std::log10(high)) - std::ceil(std::log10(low)) >= 2.0) return {};
  std::string tics;
  const int last = static_cast<int>(std::ceil(std::log10(high)));
  for (int power = static_cast<int>(std::floor(std::log10(low))); power <= last; ++power) {
    const std::string exponent = 'e' + std::to_string(power);
    tics += (tics.empty() ? "" : ", ") + std::string("'10^{") + (power < 0 ? "−" : "") +
            std::to_string(std::abs(power)) + "}' 1" + exponent;
    for (int digit = 2; digit < 10 && power < last; ++digit) tics += ", '' " + std::to_string(digit) + exponent + " 1";
  }
  return std::string("if (GPVAL_VERSION >= 6.0) set ") + axis + "tics (" + tics + ")\n";
}

// A logarithmic axis of a single value, or one without a power of ten on it, would have no number beside it: it is
// widened to powers of ten.
std::string readable_range(const char* axis, const std::vector<double>& values, double margin) {
  const auto [smallest, largest] = std::minmax_element(values.begin(), values.end());
  const double low = *smallest / margin, high = *largest * margin;
  const double below = std::floor(std::log10(low)), above = std::ceil(std::log10(high));
  std::string text;
  const bool widens = std::ceil(std::log10(low)) > std::floor(std::log10(high));
  if (widens) {
    text = std::string("set ") + axis + "range [1e" + std::to_string(static_cast<int>(below)) + ":1e" +
           std::to_string(static_cast<int>(above)) + "]\n";
  }
  const bool ends_at_powers = widens || margin == kNoMargin;
  return text + (ends_at_powers ? decimal_tics(axis, std::pow(10.0, below), std::pow(10.0, above))
                                : decimal_tics(axis, low, high));
}

std::string readable_ranges(const Axes& axes, const std::vector<Points>& drawn) {
  std::vector<double> xs = drawn_marks(axes), ys;
  for (const Points& points : drawn) {
    for (const auto& [x, y] : points) {
      xs.push_back(x);
      ys.push_back(y);
    }
  }
  return (axes.log_x ? readable_range("x", xs, kXMargin) : "") + (axes.log_y ? readable_range("y", ys, kNoMargin) : "");
}

std::string style_of(const Series& series) {
  if (series.style == kOverlay) return std::string(kOverlayStyle);
  if (series.style == 0) return "with lines lw 1.2 dt 2 lc rgb '#8A8A8A'";
  const std::string style(kLineStyles[static_cast<std::size_t>(series.style - 1) % kLineStyles.size()]);
  if (series.drawn == Drawn::kMarks) return "with points ps 0.5 " + style;
  if (series.drawn == Drawn::kLine) return "with lines lw 2.2 " + style.substr(0, style.find(" pt")) + " dt 1";
  return "with linespoints lw 1.8 ps 0.8 " + style;
}

std::string title_of(const Series& series) {
  return series.title.empty() ? " notitle" : " title " + text::gnuplot_string(series.title);
}

// Of a mark between lines and points; bars have marks of several styles.
constexpr const char* kMarkStyle = "lw 2.5 dt 1 lc rgb '#8A8A8A'";

std::string vertical_line(double x, const std::string& style) {
  const std::string at = text::shortest(x);
  return "set arrow from " + at + ", graph 0 to " + at + ", graph 1 nohead front " + style + '\n';
}

// The style of a mark over bars. Bars use the first colour.
std::string mark_style(std::size_t i) {
  constexpr std::array<std::string_view, 4> kColours = {"#D55E00", "#CC79A7", "#009E73", "#E69F00"};
  return "lw 2 dt " + std::to_string(1 + i % 5) + " lc rgb '" + std::string(kColours[i % kColours.size()]) + '\'';
}

double largest_value(const Map& map) {
  double largest = 0.0;
  for (const MapCell& cell : map.cells) largest = std::max(largest, cell.value);
  return largest;
}

// Only a few tick marks, so that their numbers do not overlap on a narrow bar.
std::string colour_range(double low, double middle, double high) {
  const auto mark = [](double value) {
    return std::string(value < 0.0 ? "'−" : "'") + text::rounded(std::abs(value), 2) + "' " + text::shortest(value);
  };
  return "set cbrange [" + text::shortest(low) + ':' + text::shortest(high) + "]\nset cbtics (" + mark(low) + ", " +
         mark(middle) + ", " + mark(high) + ") offset 0,2.1 nomirror scale 0\n";
}

// One swatch for each class: a palette in steps, from viridis.
std::string class_palette(std::size_t count) {
  constexpr std::array<std::string_view, 10> kColours = {"#440154", "#482878", "#3e4989", "#31688e", "#26828e",
                                                         "#1f9e89", "#35b779", "#6ece58", "#b5de2b", "#fde725"};
  std::string steps;
  for (std::size_t i = 0; i < count; ++i) {
    const std::string colour(kColours[i * (kColours.size() - 1) / std::max<std::size_t>(count - 1, 1)]);
    for (const std::size_t end : {i, i + 1}) {
      steps += (steps.empty() ? "" : ", ") + std::to_string(end) + " '" + colour + "'";
    }
  }
  return "set palette defined (" + steps + ")\n";
}

std::string colour_commands(const Map& map) {
  if (map.colours == MapColours::kDiverging) {
    return std::string(kDiverging) + colour_range(-map.largest, 0.0, map.largest);
  }
  if (map.colours == MapColours::kClasses) {
    std::string marks;
    for (std::size_t i = 0; i < map.classes.size(); ++i) {
      marks += (i > 0 ? ", " : "") + text::gnuplot_string(map.classes[i]) + ' ' + std::to_string(i);
    }
    return class_palette(map.classes.size()) +
           "set cbrange [-0.5:" + text::shortest(static_cast<double>(map.classes.size()) - 0.5) + "]\nset cbtics (" +
           marks + ") offset 0,2.1 nomirror scale 0\n";
  }
  const double largest = largest_value(map);
  return std::string(kViridis) + colour_range(0.0, 0.5 * largest, largest);
}

}  // namespace

std::string line_plot(const Axes& axes, const std::vector<Series>& series) {
  std::string data, plots;
  std::vector<std::string> titles;
  std::vector<Points> drawn;
  for (const Series& one : series) {
    Points points = drawable(one.points, axes);
    if (points.empty()) continue;
    const std::string name = "$series" + std::to_string(drawn.size());
    data += data_block(name, points);
    plots += (plots.empty() ? "plot " : ", \\\n     ") + name + " using 1:2 " + style_of(one) + title_of(one);
    titles.push_back(one.title);
    drawn.push_back(std::move(points));
  }
  if (plots.empty()) return {};
  std::string arrows;
  for (const double at : drawn_marks(axes)) arrows += vertical_line(at, kMarkStyle);
  for (const Mark& mark : axes.marks) {
    if (arrows.empty()) break;
    plots += std::string(", \\\n     keyentry with lines ") + kMarkStyle + " title " + text::gnuplot_string(mark.title);
    titles.push_back(mark.title);
  }
  const Key key = key_of(titles);
  return plot_head(key) + axis_commands(axes, key) + x_range(axes, drawn) + readable_ranges(axes, drawn) +
         extra_commands(axes) + arrows + data + plots + '\n';
}

std::string bar_plot(const Axes& axes, const std::vector<Bar>& bars, const std::vector<Mark>& marks) {
  const auto is_drawable = [&](double x) { return std::isfinite(x) && (x > 0.0 || !axes.log_x); };
  std::string data, arrows, keys;
  std::vector<std::string> titles;
  Points ends;
  for (const Bar& bar : bars) {
    if (!is_drawable(bar.low) || !is_drawable(bar.high)) continue;
    data += text::shortest(bar.low) + ' ' + text::shortest(bar.high) + ' ' + text::shortest(bar.height) + '\n';
    ends.insert(ends.end(), {{bar.low, 0.0}, {bar.high, 0.0}});
  }
  if (data.empty()) return {};
  for (std::size_t i = 0; i < marks.size(); ++i) {
    if (!is_drawable(marks[i].x)) continue;
    const std::string style = mark_style(i);
    ends.emplace_back(marks[i].x, 0.0);
    titles.push_back(marks[i].title);
    arrows += vertical_line(marks[i].x, style);
    keys += ", \\\n     keyentry with lines " + style + " title " + text::gnuplot_string(marks[i].title);
  }
  const Key key = key_of(titles);
  return plot_head(key, Background::kWhite) + axis_commands(axes, key) + x_range(axes, {ends}) +
         readable_ranges(axes, {ends}) + "set yrange [0:*]\n" + extra_commands(axes) + arrows + "$bars << END\n" +
         data + "END\nplot $bars using 1:3:1:2:(0):3 with boxxyerror lc rgb '#0072B2' fs solid 0.6 noborder notitle" +
         keys + '\n';
}

namespace {

// One line for each cell, by rows: its centre and its value, if it has one.
std::string cells_of(const Map& map) {
  std::vector<std::string> values(static_cast<std::size_t>(map.columns) * static_cast<std::size_t>(map.rows), "NaN");
  for (const MapCell& cell : map.cells) {
    values[static_cast<std::size_t>(cell.row - 1) * static_cast<std::size_t>(map.columns) +
           static_cast<std::size_t>(cell.column - 1)] = text::shortest(cell.value);
  }
  std::string lines;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto column = static_cast<double>(i % static_cast<std::size_t>(map.columns)) + 0.5;
    const auto row = static_cast<double>(i / static_cast<std::size_t>(map.columns)) + 0.5;
    lines += text::shortest(column * (map.width / map.columns)) + ' ' + text::shortest(row * (map.height / map.rows)) +
             ' ' + values[i] + '\n';
  }
  return lines;
}

}  // namespace

std::string map_plot(const Map& map) {
  std::string text = head(460, 460);
  const double ratio = map.height / map.width;
  text += "set size ratio " + text::shortest(std::isfinite(ratio) ? std::clamp(ratio, 0.4, 1.6) : 1.0) + '\n';
  text += "set xrange [0:" + text::shortest(map.width) + "]\nset yrange [0:" + text::shortest(map.height) + "]\n";
  text += "set xlabel 'u'\nset ylabel 'v' offset 1.5,0\nset tics nomirror out\n";
  text += colour_commands(map);
  text +=
      "set colorbox horizontal user origin graph 0, graph 1.06 size graph 1, graph 0.04\n"
      "set cblabel " +
      text::gnuplot_string(map.quantity) +
      " offset 0,4.9\n"
      "set lmargin at screen 0.18\nset rmargin at screen 0.94\n"
      "set tmargin at screen 0.83\nset bmargin at screen 0.17\n";
  text += "$cells << END\n";
  return text + cells_of(map) + "END\nplot $cells using 1:2:3 with image pixels notitle\n";
}

namespace {

constexpr const char* kNoGnuplot =
    "There are no figures because gnuplot was not found. Install it (Debian: gnuplot-nox) and run the command again. "
    "The tables are complete.";

}  // namespace

DrawnFigures draw_figures(std::vector<Figure> figures, const std::filesystem::path& scratch,
                          std::vector<std::string>& messages, const Hooks& hooks) {
  DrawnFigures drawn;
  std::size_t done = 0;
  for (Figure& figure : figures) {
    files::require_not_cancelled(hooks);
    const PlotResult plot = run_gnuplot(figure.script, scratch, hooks.cancelled);
    if (hooks.progress) hooks.progress({"figures", ++done, figures.size()});
    if (plot.outcome == PlotResult::Outcome::kNoProgram) {
      drawn.none = kNoGnuplot;
      messages.emplace_back(kNoGnuplot);
      return drawn;
    }
    if (plot.outcome == PlotResult::Outcome::kFailed) {
      messages.push_back("gnuplot could not draw '" + figure.title + "': " + plot.message);
      drawn.left_out.push_back({"figure: " + figure.title, "gnuplot could not draw it"});
      continue;
    }
    std::string svg = inline_svg(plot.svg, figure.id, figure.title);
    drawn.figures.push_back({std::move(figure), std::move(svg)});
  }
  return drawn;
}

}  // namespace exactff::page
