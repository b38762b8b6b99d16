// The figures of a study.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "kernel/statistics.h"
#include "page/gnuplot.h"
#include "report/report.h"
#include "study/settings.h"
#include "study/statistics.h"
#include "text/escape.h"
#include "text/phrases.h"

namespace exactff::report {
namespace {

constexpr const char* kEpsB = "tolerance ε_B (radiosity)";
constexpr const char* kError = "error (radiosity)";

// The value of a parameter of the sweeps.
using ValueOf = double (*)(const AdaptiveOptions&);
double eps_b_of(const AdaptiveOptions& s) { return s.eps_b; }
double rays_of(const AdaptiveOptions& s) { return s.rays; }

// The kinds of error that a figure shows.
struct ErrorKind {
  const char* title;
  double ErrorStatistics::*value;
};
constexpr std::array<ErrorKind, 3> kKinds = {
    {{"worst", &ErrorStatistics::worst}, {"p99", &ErrorStatistics::p99}, {"RMS", &ErrorStatistics::rms}}};

constexpr std::size_t kMostLines = 8;  // more cannot be told apart in one figure
// Pure rounding errors are below the axis.
constexpr const char* kFloor = "set yrange [1e-9<*:]";
constexpr const char* kRelative = "RMS error / brightest receiver";

// If there are many methods, figures show each once; its variants are in the tables.
bool is_variant(const Ladder& ladder) {
  if (ladder.only_of_sweeps) return true;
  const methods::Choice& choice = ladder.rungs.front();
  if (choice.method->name == "adaptive" && choice.settings.whole("rays") > 16) return true;
  const auto has = [&](const char* setting, const char* word) {
    return choice.settings.has(setting) && choice.settings.word(setting) == word;
  };
  return has("variant", "literal") || (choice.method->name == "adaptive" && has("pattern", "centre"));
}

class FigureMaker {
 public:
  FigureMaker(const Study& study, std::vector<LeftOut>& left_out)
      : study_(study), left_out_(left_out), brightest_(study::largest_radiosity(study)) {
    choose_ladders();
  }

  std::vector<page::Figure> make() {
    if (!study_.settings.empty()) add_sweep_figures();
    add_method_figures();
    add_maps();
    return std::move(figures_);
  }

 private:
  [[nodiscard]] const AdaptiveOptions& base() const { return study_.settings[study_.base]; }

  void add_sweep_figures() {
    add_error_against_eps_b();
    add_violations();
    add_silent_errors();
    add_error_against_time();
    add_error_against_rays();
  }

  [[nodiscard]] page::Points points(const std::vector<std::size_t>& line, ValueOf x, double ErrorStatistics::*y) const {
    page::Points result;
    for (std::size_t k : line) {
      result.emplace_back(x(study_.settings[k]), study_.summaries[k].radiosity.*y);
    }
    return result;
  }

  [[nodiscard]] std::vector<page::Series> error_series(const std::vector<std::size_t>& line, ValueOf x) const {
    std::vector<page::Series> series;
    int style = 0;
    for (const ErrorKind& kind : kKinds) series.push_back({kind.title, points(line, x, kind.value), ++style});
    return series;
  }

  void leave_out(std::string what, std::string why) { left_out_.push_back({std::move(what), std::move(why)}); }
  void leave_figure_out(const std::string& title, std::string why) { leave_out("figure: " + title, std::move(why)); }

  // An empty script means that the figure has no point.
  void add(page::Figure figure, std::string why_empty = "every error is 0, which a logarithmic axis cannot show") {
    if (figure.script.empty()) {
      leave_figure_out(figure.title, std::move(why_empty));
    } else {
      figures_.push_back(std::move(figure));
    }
  }

  // The settings that differ from `from` in this parameter only. If there are fewer than two: nothing, and the reason
  // is recorded.
  std::optional<std::vector<std::size_t>> sweep(std::size_t from, std::string_view parameter,
                                                const std::string& title) {
    std::vector<std::size_t> line = study::line_through(study_.settings, from, parameter);
    if (line.size() >= 2) return line;
    const bool told = std::any_of(study_.left_out.begin(), study_.left_out.end(), [&](const LeftOut& item) {
      return parameter == "eps_B" ? item.what == "sweep of eps_B" : item.what != "sweep of eps_B";
    });
    leave_figure_out(title, told ? "its sweep was left out" : "the sweep has a single value");
    return std::nullopt;
  }

  void add_error_against_eps_b() {
    const std::string title = "Achieved error against the tolerance ε_B";
    const auto line = sweep(study_.base, "eps_B", title);
    if (!line) return;
    std::vector<page::Series> series = error_series(*line, eps_b_of);
    AdaptiveOptions literal = base();
    literal.variant = base().variant == Variant::kMended ? Variant::kLiteral : Variant::kMended;
    if (const auto other = study::find_setting(study_.settings, literal)) {
      const auto other_line = study::line_through(study_.settings, *other, "eps_B");
      series.push_back({"RMS, " + std::string(to_string(literal.variant)),
                        points(other_line, eps_b_of, &ErrorStatistics::rms), page::kOverlay});
    }
    page::Points diagonal;
    for (std::size_t k : *line) diagonal.emplace_back(study_.settings[k].eps_b, study_.settings[k].eps_b);
    series.push_back({"error = ε_B", diagonal, 0});
    add({"eps-b", title,
         "The error that was reached against the tolerance that was set, with " + std::to_string(base().rays) + ' ' +
             std::string(to_string(base().pattern)) +
             " rays per undecided leaf. Above the dashed line the tolerance is broken. ε_B bounds the error of each "
             "leaf of the recursion, not of their sum, and a leaf whose rays all agree is not split at all.",
         page::line_plot({kEpsB, kError, true, true, {}}, series)});
  }

  // One series per number of rays: the settings along eps_B, all other parameters as in the base.
  template <class PointOf>
  [[nodiscard]] std::vector<page::Series> series_by_rays(const PointOf& point_of) const {
    std::vector<page::Series> series;
    int style = 0;
    for (std::size_t k : study::line_through(study_.settings, study_.base, "rays")) {
      page::Series one{text::counted(static_cast<std::uint64_t>(study_.settings[k].rays), "ray"), {}, ++style};
      for (std::size_t j : study::line_through(study_.settings, k, "eps_B")) one.points.push_back(point_of(j));
      series.push_back(std::move(one));
    }
    return series;
  }

  void add_violations() {
    const std::string title = "How often the tolerance is broken";
    if (!sweep(study_.base, "eps_B", title)) return;
    const auto count = static_cast<double>(study_.exact.size());
    const auto series = series_by_rays([&](std::size_t k) {
      return std::pair(study_.settings[k].eps_b, 100.0 * static_cast<double>(study_.summaries[k].violations) / count);
    });
    add({"violations", title,
         "Share of the " + text::counted(study_.exact.size(), "receiver") +
             " whose radiosity is off by more than ε_B, one line per number of rays.",
         page::line_plot({kEpsB, "receivers with |error| > ε_B, %", true, false, {"set yrange [0:*<100]"}}, series)});
  }

  void add_silent_errors() {
    const std::string title = "Silent errors against the tolerance ε_B";
    const auto line = sweep(study_.base, "eps_B", title);
    if (!line) return;
    page::Series all{"RMS error of F", {}, 1}, silent{"RMS error from silent leaves", {}, 2},
        worst{"worst error from silent leaves", {}, 4};
    for (const std::size_t k : *line) {
      const Summary& s = study_.summaries[k];
      const double eps_b = study_.settings[k].eps_b;
      all.points.emplace_back(eps_b, s.form_factor.rms);
      silent.points.emplace_back(eps_b, s.silent.rms);
      worst.points.emplace_back(eps_b, s.silent.worst);
    }
    if (std::all_of(silent.points.begin(), silent.points.end(), [](const auto& p) { return p.second == 0.0; })) {
      leave_figure_out(title, "no leaf had a silent error");
      return;
    }
    const Summary& b = study_.summaries[study_.base];
    add({"silent", title,
         "A leaf has a silent error if all its rays agreed, but the leaf was partly visible or the opposite of what "
         "the rays showed. The figure shows the error that these leaves cause in the form factor. At the base "
         "setting " +
             text::counted_of(b.silent_receivers, study_.judged.size(), "receiver") + " had such leaves.",
         page::line_plot({kEpsB, "error of the form factor", true, true, {}}, {all, silent, worst})});
  }

  void add_error_against_time() {
    if (!(brightest_ > 0.0))
      return leave_figure_out("Tampieri’s algorithm: error against run time", "every error is 0");
    const std::vector<page::Series> series = series_by_rays([&](std::size_t k) {
      const MethodCell* cell = cell_of_setting(study_, k);
      return std::pair(1e6 * study_.times[k].mean, cell != nullptr ? relative_error(study_, *cell) : 0.0);
    });
    page::Axes axes{"time per receiver, µs", "RMS error / brightest receiver", true, true, {}, {}};
    axes.marks = {{"exact: error 0", 1e6 * exact_seconds(study_)}};
    add({"time", "Tampieri’s algorithm: error against run time",
         "Each line is one number of rays with varying ε_B, at the " +
             text::counted(study_.methods.receivers.size(), "receiver") +
             " at which all methods are compared. The vertical line is the exact method.",
         page::line_plot(axes, series)});
  }

  void add_error_against_rays() {
    const std::string title = "Error against the number of rays";
    const auto line = sweep(study_.base, "rays", title);
    if (!line) return;
    add({"rays", title,
         "At ε_B = " + text::rounded(base().eps_b) + ", " + std::string(to_string(base().pattern)) +
             " rays per undecided leaf. " + slope_sentence(*line),
         page::line_plot({"rays per undecided leaf", kError, true, true, {}}, error_series(*line, rays_of))});
  }

  [[nodiscard]] std::string slope_sentence(const std::vector<std::size_t>& line) const {
    const auto slope = kernel::fitted_slope(points(line, rays_of, &ErrorStatistics::rms));
    if (!slope) return {};
    return std::string("The RMS error falls as the number of rays to the power ") + (*slope < 0.0 ? "−" : "") +
           text::rounded(std::abs(*slope), 2) +
           " (least squares); random sampling of a fixed set of leaves would give −0.5.";
  }

  // --- every method ---

  void add_method_figures() {
    if (methods().cells.empty() || !(brightest_ > 0.0)) return;
    add_methods_against_time();
    add_convergence(Sight::kPartly, "convergence-partly", "Convergence where the source is partly hidden");
    add_convergence(Sight::kVisible, "convergence-visible", "Convergence where the whole source is visible");
    if (!methods().fields.empty()) add_by_fraction();
    add_profile();
  }

  [[nodiscard]] const MethodStudy& methods() const { return study_.methods; }

  // The recommended one and those that are the best for their time come first, then each method once.
  void choose_ladders() {
    const std::vector<const MethodCell*> front = pareto_front(study_);
    const MethodCell* best = recommended(study_);
    const auto rank = [&](std::size_t l) {
      if (best != nullptr && best->ladder == l) return 0;
      if (std::ranges::find(front, l, &MethodCell::ladder) != front.end()) return 1;
      return is_variant(methods().ladders[l]) ? 3 : 2;
    };
    for (std::size_t l = 0; l < methods().ladders.size(); ++l) {
      if (methods().ladders[l].rungs.front().method->name != "exact") drawn_ladders_.push_back(l);
    }
    std::ranges::stable_sort(drawn_ladders_, {}, rank);
    if (drawn_ladders_.size() > kMostLines) {
      std::erase_if(drawn_ladders_, [&](std::size_t l) { return rank(l) == 3; });
      drawn_ladders_.resize(std::min(drawn_ladders_.size(), kMostLines));
    }
    std::ranges::sort(drawn_ladders_);
  }

  void add_methods_against_time() {
    std::vector<page::Series> series;
    int style = 0;
    for (const std::size_t l : drawn_ladders_) {
      page::Series one{methods().ladders[l].name, {}, ++style};
      for (const MethodCell& cell : methods().cells) {
        if (cell.ladder == l) one.points.emplace_back(1e6 * cell.seconds, relative_error(study_, cell));
      }
      if (methods().ladders[l].along.empty()) one.drawn = page::Drawn::kMarks;
      series.push_back(std::move(one));
    }
    const MethodCell* best = recommended(study_);
    if (best != nullptr) {
      series.push_back({"recommended", {{1e6 * best->seconds, relative_error(study_, *best)}}, page::kOverlay});
    }
    page::Series front{"best for its time", {}, 0};
    for (const MethodCell* cell : pareto_front(study_)) {
      front.points.emplace_back(1e6 * cell->seconds, relative_error(study_, *cell));
    }
    const auto drawn = std::ranges::count_if(front.points, [](const auto& point) { return point.second > 0.0; });
    series.push_back(std::move(front));
    page::Axes axes{"time per receiver, µs", kRelative, true, true, {kFloor}, {}};
    if (const MethodCell* exact = exact_cell(study_)) axes.marks = {{"exact: error 0", 1e6 * exact->seconds}};
    const std::string caption =
        "Each line is a method with increasing effort, at " + text::counted(methods().receivers.size(), "receiver") +
        "; the vertical line is the exact method." +
        (best != nullptr
             ? " The open mark is " + text::html(cell_name(study_, *best)) + ", which the verdict recommends."
             : "") +
        (drawn > 1 ? " The dashed line joins the settings that no other setting beats in both time and error." : "");
    add({"methods-time", "Error against run time", caption, page::line_plot(axes, series)},
        "no method has an error that a logarithmic axis can show");
  }

  void add_convergence(Sight sight, const char* id, const char* title) {
    std::vector<page::Series> series;
    int style = 0;
    for (const std::size_t l : drawn_ladders_) {
      const auto& slope = sight == Sight::kPartly ? methods().slopes[l].partly : methods().slopes[l].visible;
      ++style;
      if (!slope) continue;
      page::Series one{methods().ladders[l].name, {}, style};
      for (const MethodCell& cell : methods().cells) {
        if (cell.ladder != l) continue;
        const ErrorStatistics& e = sight == Sight::kPartly ? cell.error_partly : cell.error_visible;
        one.points.emplace_back(cell.work, e.rms / brightest_);
      }
      series.push_back(std::move(one));
    }
    add({id, title,
         "Error against the number of samples per receiver (hemicube: pixels; adaptive: leaves plus rays, or leaves "
         "plus exact visible fractions). The table has the fitted exponents.",
         page::line_plot({"samples, pixels, or leaves and rays", kRelative, true, true, {kFloor}, {}}, series)},
        sight == Sight::kPartly ? "no receiver sees the source partly hidden, or fewer than three settings were run"
                                : "no receiver sees the whole source, or fewer than three settings were run");
  }

  // RMS over the receivers of each bin. Bins with fewer than three receivers are left out.
  void add_by_fraction() {
    if (study_.request.scene->faces().size() > study::kMostFacesForFractions) {
      leave_figure_out("Error by how much of the source is visible",
                       "exact visible fractions take too long in a scene with so many faces");
      return;
    }
    const auto bin_of = [&](std::size_t i) -> std::optional<double> {
      const double v = study_.exact[i].visible_fraction;
      if (study_.exact[i].sight == Sight::kNothing) return std::nullopt;
      if (study_.exact[i].sight == Sight::kHidden) return 0.0;
      if (study_.exact[i].sight == Sight::kVisible) return 100.0;
      return std::clamp(10.0 * std::floor(10.0 * v) + 5.0, 5.0, 95.0);
    };
    constexpr std::size_t kFewest = 3;
    std::vector<page::Series> series;
    for (const MethodField& field : methods().fields) {
      const auto place = std::ranges::find(drawn_ladders_, field.ladder);
      if (place == drawn_ladders_.end()) continue;
      std::map<double, std::vector<double>> bins;
      for (std::size_t i = 0; i < field.radiosity_errors.size(); ++i) {
        if (const std::optional<double> bin = bin_of(i)) bins[*bin].push_back(field.radiosity_errors[i]);
      }
      page::Series one{methods().ladders[field.ladder].name, {}, static_cast<int>(place - drawn_ladders_.begin()) + 1};
      for (const auto& [bin, errors] : bins) {
        if (errors.size() >= kFewest) one.points.emplace_back(bin, study::error_statistics(errors).rms / brightest_);
      }
      series.push_back(std::move(one));
    }
    add({"by-fraction", "Error by how much of the source is visible",
         "Receivers are grouped into bins by the exact visible share of the source’s area: nothing, tenths, all. Bins "
         "with fewer than three receivers are left out. Each method at its middle setting (see the table), with one "
         "seed.",
         page::line_plot(
             {"visible share of the source, %", kRelative, false, true, {"set xrange [-3:103]", kFloor}, {}}, series)},
        "every error is 0, or no bin has three receivers");
  }

  void add_profile() {
    if (!study_.profile) return;
    const Profile& profile = *study_.profile;
    std::vector<page::Series> series;
    int style = 1;
    for (const Profile::Curve& curve : profile.others) {
      page::Series one{curve.name, {}, ++style};
      for (std::size_t i = 0; i < profile.position.size(); i += 2) {
        one.points.emplace_back(profile.position[i], curve.radiosity[i]);
      }
      one.drawn = page::Drawn::kMarks;
      series.push_back(std::move(one));
    }
    page::Series exact{"exact", {}, 1};
    for (std::size_t i = 0; i < profile.position.size(); ++i) {
      exact.points.emplace_back(profile.position[i], profile.exact[i]);
    }
    exact.drawn = page::Drawn::kLine;
    series.push_back(std::move(exact));
    page::Axes axes{"position along " + profile.where + " (scene’s unit)", "radiosity", false, false, {}, {}};
    for (const double kink : profile.kinks) {
      const std::string at = text::shortest(kink);
      axes.extra.push_back("set arrow from " + at + ", graph 0 to " + at +
                           ", graph 1 nohead back lw 1 dt 3 lc rgb '#8A8A8A'");
    }
    add({"profile", "A profile through the penumbra",
         "The exact curve, and single evaluations of other methods at their middle setting. Dotted vertical lines: "
         "where the source begins to be hidden or begins to be visible (" +
             text::counted(profile.kinks.size(), "place") + "). The curve has its kinks there.",
         page::line_plot(axes, series)},
        "the profile has no value");
  }

  // --- maps ---

  // The receivers on the lattice with the most of them.
  struct Grid {
    std::shared_ptr<const Lattice> lattice;
    std::vector<std::pair<std::size_t, GridCell>> cells;
    std::size_t other_lattices = 0;
  };

  [[nodiscard]] std::optional<Grid> find_grid() const {
    std::vector<Grid> grids;
    for (std::size_t i = 0; i < study_.request.receivers.size(); ++i) {
      const auto& cell = study_.request.receivers[i].cell;
      if (!cell) return std::nullopt;
      auto grid = std::ranges::find(grids, cell->lattice, &Grid::lattice);
      if (grid == grids.end()) grid = grids.insert(grids.end(), Grid{cell->lattice, {}, 0});
      grid->cells.emplace_back(i, *cell);
    }
    const auto largest = std::ranges::max_element(grids, {}, [](const Grid& grid) { return grid.cells.size(); });
    if (largest == grids.end() || largest->lattice->size.u < 2 || largest->lattice->size.v < 2) return std::nullopt;
    largest->other_lattices = grids.size() - 1;
    return *largest;
  }

  template <class ValueOf>
  [[nodiscard]] page::Map map_of(const Grid& grid, std::string quantity, page::MapColours colours,
                                 const ValueOf& value_of) const {
    const Lattice& lattice = *grid.lattice;
    page::Map map{std::move(quantity), lattice.size.u, lattice.size.v, lattice.width, lattice.height, colours, 0.0, {}};
    for (const auto& [i, cell] : grid.cells) map.cells.push_back({cell.column, cell.row, value_of(i)});
    return map;
  }

  void add_maps() {
    const auto grid = find_grid();
    if (!grid) {
      leave_out("false-colour maps", "the receivers are not a grid on a face");
      return;
    }
    if (grid->other_lattices > 0) {
      leave_out(
          "maps of " + text::counted(grid->other_lattices, "other face"),
          "the maps show " + name_of(*study_.request.scene, grid->lattice->region) + ", which has the most receivers");
    }
    add_exact_map(*grid);
    if (const auto shown = shown_method(study_)) {
      add_approximate_map(*grid, *shown);
      add_error_map(*grid, *shown);
    }
    add_sight_map(*grid);
    if (!study_.settings.empty()) add_silent_map(*grid);
  }

  static std::vector<double> magnitudes_of(const page::Map& map) {
    std::vector<double> magnitudes;
    for (const page::MapCell& cell : map.cells) magnitudes.push_back(std::abs(cell.value));
    return magnitudes;
  }
  static bool is_dark(const page::Map& map) {
    return std::ranges::none_of(map.cells, [](const page::MapCell& cell) { return cell.value > 0.0; });
  }

  void add_exact_map(const Grid& grid) {
    const page::Map map = map_of(grid, "radiosity", page::MapColours::kSequential,
                                 [&](std::size_t i) { return study_.exact[i].radiosity.largest(); });
    if (is_dark(map)) {
      leave_out("map of the exact radiosity", "it is 0 everywhere");
      return;
    }
    add({"map-exact", "Exact radiosity",
         "On " + text::html(name_of(*study_.request.scene, grid.lattice->region)) +
             ", largest colour channel; u runs along the first edge. Lengths are in the scene’s unit.",
         page::map_plot(map), true});
  }

  void add_approximate_map(const Grid& grid, const Shown& shown) {
    // The exact radiosity plus the error of the channel with the largest error: grey scenes have only one channel.
    const page::Map map = map_of(grid, "radiosity", page::MapColours::kSequential, [&](std::size_t i) {
      return std::max(0.0, study_.exact[i].radiosity.largest() + shown.errors[i]);
    });
    if (is_dark(map)) return;
    const std::string of = study_.settings.empty() ? "" : ": the result of the ray-sampled algorithm";
    add({"map-approximate", "Radiosity by " + shown.title, text::html(shown.name) + of + ", one seed.",
         page::map_plot(map), true});
  }

  void add_sight_map(const Grid& grid) {
    const auto class_of = [&](std::size_t i) { return static_cast<double>(study_.exact[i].sight); };
    page::Map map = map_of(grid, "the source is", page::MapColours::kClasses, class_of);
    map.classes = {"behind", "hidden", "partly", "visible"};
    add({"map-sight", "Visibility of the source",
         "Classified exactly. From dark to light: the receiver is behind the source or faces away; the source is "
         "hidden (umbra), partly hidden (penumbra), fully visible.",
         page::map_plot(map), true});
  }

  void add_silent_map(const Grid& grid) {
    const auto& samples = study_.samples[study_.base];
    if (study_.judged.size() < study_.exact.size()) {
      leave_out("map of silent errors", "silent errors were computed at some receivers only");
      return;
    }
    page::Map map = map_of(grid, "error of the form factor", page::MapColours::kDiverging,
                           [&](std::size_t i) { return samples[i].silent_error; });
    map.largest = std::ranges::max(magnitudes_of(map));
    if (!(map.largest > 0.0)) {
      leave_out("map of silent errors", "no leaf of the base setting had a silent error");
      return;
    }
    add({"map-silent", "Silent errors",
         "The error that silent leaves (all rays agreed, and were wrong) cause in the form factor at the base setting. "
         "Red: too large.",
         page::map_plot(map), true});
  }

  void add_error_map(const Grid& grid, const Shown& shown) {
    page::Map map = map_of(grid, "approximate − exact (radiosity)", page::MapColours::kDiverging,
                           [&](std::size_t i) { return shown.errors[i]; });
    const std::vector<double> magnitudes = magnitudes_of(map);
    map.largest = kernel::nearest_rank(magnitudes, 0.99);
    if (map.largest == 0.0) map.largest = std::ranges::max(magnitudes);
    if (!(map.largest > 0.0)) {
      leave_out("map of the signed error", shown.title + " has no error anywhere");
      return;
    }
    add({"map-error", "Signed error of " + shown.title,
         text::html(shown.name) + ". Red: too bright; blue: too dark. Errors beyond ±" + text::rounded(map.largest) +
             " (the 99th percentile) have the colour of that value.",
         page::map_plot(map), true});
  }

  const Study& study_;
  std::vector<LeftOut>& left_out_;
  std::vector<page::Figure> figures_;
  double brightest_;                        // radiosity of the brightest receiver
  std::vector<std::size_t> drawn_ladders_;  // in the figures of every method
};

}  // namespace

std::vector<page::Figure> figures(const Study& study, std::vector<LeftOut>& left_out) {
  return FigureMaker(study, left_out).make();
}

}  // namespace exactff::report
