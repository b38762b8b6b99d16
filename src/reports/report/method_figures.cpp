#include <algorithm>
#include <cmath>
#include <map>

#include "page/gnuplot.h"
#include "report/figures.h"
#include "report/verdicts.h"
#include "study/statistics.h"
#include "text/escape.h"
#include "text/phrases.h"

namespace exactff::report {
namespace {

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

class MethodFigures {
 public:
  MethodFigures(const Study& study, std::vector<page::Figure>& figures, std::vector<LeftOut>& left_out)
      : study_(study), figures_(figures), left_out_(left_out), brightest_(study::largest_radiosity(study)) {
    choose_ladders();
  }

  void add_all() {
    if (methods().cells.empty() || !(brightest_ > 0.0)) return;
    add_error_against_time();
    add_convergence(Sight::kPartly, "convergence-partly", "Convergence where the source is partly hidden");
    add_convergence(Sight::kVisible, "convergence-visible", "Convergence where the whole source is visible");
    if (!methods().fields.empty()) add_by_fraction();
    if (!methods().fields.empty()) add_by_distance();
    add_profile();
  }

 private:
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
      if (methods().ladders[l].rungs.front().method->name != "exact") shown_.push_back(l);
    }
    std::ranges::stable_sort(shown_, {}, rank);
    if (shown_.size() > kMostLines) {
      std::erase_if(shown_, [&](std::size_t l) { return rank(l) == 3; });
      shown_.resize(std::min(shown_.size(), kMostLines));
    }
    std::ranges::sort(shown_);
  }

  void leave_out(const std::string& title, std::string why) {
    left_out_.push_back({"figure: " + title, std::move(why)});
  }

  void add(page::Figure figure, const std::string& why_empty) {
    if (figure.script.empty()) {
      leave_out(figure.title, why_empty);
    } else {
      figures_.push_back(std::move(figure));
    }
  }

  void add_error_against_time() {
    std::vector<page::Series> series;
    int style = 0;
    for (const std::size_t l : shown_) {
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
    for (const std::size_t l : shown_) {
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

  // Every method's errors at all receivers: the fields, and the adaptive algorithm's base setting.
  struct Field {
    std::string name;
    std::vector<double> errors;
    int style = 1;
  };

  [[nodiscard]] std::vector<Field> fields() const {
    std::vector<Field> list;
    for (const MethodField& field : methods().fields) {
      const auto place = std::find(shown_.begin(), shown_.end(), field.ladder);
      if (place == shown_.end()) continue;
      list.push_back(
          {methods().ladders[field.ladder].name, field.radiosity_errors, static_cast<int>(place - shown_.begin()) + 1});
    }
    return list;
  }

  // RMS over the receivers of each bin, against the position of the bin on the axis. Bins with fewer than three
  // receivers are left out.
  template <class BinOf>
  [[nodiscard]] std::vector<page::Series> series_by_bin(const BinOf& bin_of) const {
    constexpr std::size_t kFewest = 3;
    std::vector<page::Series> series;
    for (const Field& field : fields()) {
      std::map<double, std::vector<double>> bins;
      for (std::size_t i = 0; i < field.errors.size(); ++i) {
        if (const std::optional<double> bin = bin_of(i)) bins[*bin].push_back(field.errors[i]);
      }
      page::Series one{field.name, {}, field.style};
      for (const auto& [bin, errors] : bins) {
        if (errors.size() >= kFewest) one.points.emplace_back(bin, study::error_statistics(errors).rms / brightest_);
      }
      series.push_back(std::move(one));
    }
    return series;
  }

  void add_by_fraction() {
    if (study_.request.scene->faces().size() > study::kMostFacesForFractions) {
      leave_out("Error by how much of the source is visible",
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
    add({"by-fraction", "Error by how much of the source is visible",
         "Receivers are grouped into bins by the exact visible share of the source’s area: nothing, tenths, all. Bins "
         "with fewer than three receivers are left out. Each method at its middle setting (see the table), with one "
         "seed.",
         page::line_plot(
             {"visible share of the source, %", kRelative, false, true, {"set xrange [-3:103]", kFloor}, {}},
             series_by_bin(bin_of))},
        "every error is 0, or no bin has three receivers");
  }

  void add_by_distance() {
    const std::string title = "Error by distance to the nearest shadow edge";
    if (study_.edge_distance.empty()) return;  // already in the list of what is left out
    const double unit = 0.5 * study_.edge_resolution;
    const auto bin_of = [&](std::size_t i) -> std::optional<double> {
      if (study_.exact[i].sight == Sight::kNothing) return std::nullopt;
      const double d = std::max(study_.edge_distance[i], unit);
      return unit * std::exp2(std::floor(std::log2(d / unit)) + 0.5);
    };
    add({"by-distance", title,
         "A shadow edge is where the source begins to be hidden or begins to be visible. The edges are found by exact "
         "classification of a finer grid, so distances below " +
             text::rounded(unit, 2) +
             " cannot be distinguished. Bins are powers of two. The settings are those of the previous figure.",
         page::line_plot({"distance to the nearest shadow edge (scene’s unit)", kRelative, true, true, {kFloor}, {}},
                         series_by_bin(bin_of))},
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

  const Study& study_;
  std::vector<page::Figure>& figures_;
  std::vector<LeftOut>& left_out_;
  double brightest_;
  std::vector<std::size_t> shown_;  // indices of ladders
};

}  // namespace

void add_method_figures(const Study& study, std::vector<page::Figure>& figures, std::vector<LeftOut>& left_out) {
  MethodFigures(study, figures, left_out).add_all();
}

}  // namespace exactff::report
