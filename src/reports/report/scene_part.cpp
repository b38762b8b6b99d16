#include "report/scene_part.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "page/page_text.h"
#include "report/tables.h"
#include "report/verdicts.h"
#include "study/ladders.h"
#include "study/settings.h"
#include "text/escape.h"
#include "text/phrases.h"

namespace exactff::report {
namespace {

using page::HtmlTable;
using enum HtmlTable::CellKind;

// Figures of the adaptive algorithm's sweeps.
constexpr std::array<std::string_view, 5> kSweepFigures = {"eps-b", "violations", "silent", "time", "rays"};

std::string signed_number(double value) { return value < 0.0 ? "−" + text::rounded(-value) : text::rounded(value); }

class ScenePart {
 public:
  ScenePart(const SceneChapter& scene, const Page& page) : scene_(scene), page_(page) {}

  std::string write() {
    text_ = "<section class=\"scene\" id=\"" + anchor_of(scene_) + "\">\n<h2>" + text::html(scene_.title) + "</h2>\n";
    text_ += "<p class=\"verdict\">" + page::prose(text::html(verdict(study()))) + "</p>\n";
    opening();
    strip();
    needs_beside_figure();
    text_ += page::fold("Where the errors are, and how they fall with the work", errors_part());
    text_ += page::fold("Tampieri’s algorithm: tolerance and error", sweep_part());
    text_ += page::fold("Maps over the grid of receivers",
                        figure_group(
                            page_.drawn, [](const page::Figure& figure) { return figure.map; }, true));
    text_ += page::fold("Every method and setting", methods_table() + ranges());
    text_ += page::fold("Every setting of Tampieri’s algorithm", settings_table());
    if (!page_.left_out.empty()) text_ += page::fold("What was left out, and why", left_out_list(page_.left_out));
    text_ += "</section>\n";
    return std::move(text_);
  }

 private:
  [[nodiscard]] const Study& study() const { return scene_.study; }
  [[nodiscard]] bool is_swept() const { return !study().settings.empty(); }
  [[nodiscard]] bool partly() const { return study().receivers_by_sight[static_cast<std::size_t>(Sight::kPartly)] > 0; }

  void opening() {
    text_ += "<p class=\"subtitle\">" + text::counted(study().exact.size(), "receiver") + " (" +
             text::html(study().request.receivers_name) + "), source " + text::html(source_names(study())) + ", " +
             text::counted(study().request.scene->faces().size(), "face") + ". " + certified() + "</p>\n";
    for (const std::string& sentence : receiver_warnings(study())) {
      text_ += page::paragraph("Warning: " + text::html(sentence) + ".");
    }
    if (const std::string drift = drift_warning(study()); !drift.empty()) {
      text_ += page::paragraph("Warning: " + text::html(drift));
    }
    if (!page_.drawn.none.empty()) text_ += page::paragraph(text::html(page_.drawn.none));
  }

  [[nodiscard]] std::string certified() const {
    const auto count = static_cast<std::size_t>(std::ranges::count_if(study().exact, &ExactRow::certified));
    return "The exact value is certified to the last bit at " +
           text::counted_of(count, study().exact.size(), "receiver") + ".";
  }

  void strip() {
    if (!page_.strip) return;
    const Strip& strip = *page_.strip;
    const auto percent = [](double share) { return text::rounded(100.0 * share, 2) + " %"; };
    const auto panel = [&](const std::string& png, const std::string& name, const std::string& words) {
      text_ += "<div><img src=\"" + page::png_source(png) + "\" alt=\"" + name + "\">\n<p><strong>" +
               page::prose(name) + ".</strong> " + page::prose(words) + "</p></div>\n";
    };
    text_ += "<figure id=\"" + anchor_of(scene_) + "-strip\">\n<div class=\"strip\">\n";
    panel(strip.exact, "Exact", "The direct light; every pixel is correct in every digit.");
    panel(strip.method, strip.is_base ? "Tampieri’s algorithm" : text::html(strip.method_name),
          strip.is_base ? "The middle of its settings: " + text::html(strip.method_name) + "." : "");
    panel(strip.error, "Its error",
          "Red: too bright; blue: too dark; full colour from " + percent(strip.scale) +
              " of the brightest pixel on. RMS " + percent(strip.rms) + "; " + percent(strip.wrong) +
              " of the pixels are wrong by over 10 %.");
    text_ += "</div>\n<figcaption>" +
             (strip.outlined.empty() ? "The receivers’ patch is not in the picture."
                                     : "Green outline: the receivers’ patch, " + text::html(strip.outlined) + ".") +
             " Black outline: regions that are mostly wrong by over 10 %. Camera: <code>" + text::html(strip.camera) +
             "</code>.</figcaption>\n</figure>\n";
  }

  // The figure of error against time that stands beside the table.
  [[nodiscard]] const char* leading_figure() const { return study().methods.cells.empty() ? "time" : "methods-time"; }

  [[nodiscard]] bool is_named(const page::Figure& figure, std::string_view name) const {
    return figure.id == (scene_.name.empty() ? std::string(name) : scene_.name + '-' + std::string(name));
  }

  [[nodiscard]] bool is_of_sweep(const page::Figure& figure) const {
    return std::ranges::any_of(kSweepFigures, [&](std::string_view name) { return is_named(figure, name); });
  }

  void needs_beside_figure() {
    std::string figure;
    for (const page::DrawnFigure& one : page_.drawn.figures) {
      if (is_named(one.figure, leading_figure())) figure = figure_text(one);
    }
    const std::string table = study().methods.cells.size() < 2 ? eps_b_table() : needs();
    if (table.empty() && figure.empty()) return;
    text_ += "<div class=\"pair\">\n<div>\n" + table + "</div>\n" + figure + "</div>\n";
  }

  // One row per method: its least time for every wanted error, as a multiple of the exact method's time.
  [[nodiscard]] std::string needs() const {
    const MethodCell* exact = exact_cell(study());
    if (exact == nullptr) return {};
    HtmlTable table;
    table.column("method", kText);
    for (const double wanted : kWantedErrors) table.column(power_of_ten(wanted));
    table.column("best error");
    for (std::size_t l = 0; l < study().methods.ladders.size(); ++l) needs_row(table, l, exact->seconds);
    return "<h3>What each method needs</h3>\n" +
           page::paragraph("Time to be accurate to a given error, as a multiple of the exact method’s time (" +
                           text::duration(exact->seconds) + " per receiver, mean over " +
                           text::counted(study().methods.receivers.size(), "receiver") +
                           "). Errors are RMS over receivers and seeds, relative to the brightest receiver. A dash: "
                           "no setting that was run is that accurate. “Every method and setting” below has the spread "
                           "of the times.") +
           table.text() + '\n';
  }

  void needs_row(HtmlTable& table, std::size_t l, double exact_seconds) const {
    const Ladder& ladder = study().methods.ladders[l];
    table.row(ladder.rungs.front().method->name == "exact" ? "exact" : "");
    table.cell(text::html(ladder.name), kText);
    for (const double wanted : kWantedErrors) {
      const MethodCell* found = cheapest(study(), wanted, l);
      table.cell(found != nullptr ? text::rounded(found->seconds / exact_seconds, 2) : "–");
    }
    const MethodCell* best = most_accurate(study(), l);
    const double error = best != nullptr ? relative_error(study(), *best) : INFINITY;
    table.cell(std::isfinite(error) ? text::rounded(error, 2) : "–");
  }

  [[nodiscard]] std::string errors_part() const {
    const auto wants = [&](const page::Figure& figure) {
      return !figure.map && !is_of_sweep(figure) && !is_named(figure, leading_figure());
    };
    return figure_group(page_.drawn, wants) + slopes_table();
  }

  // How the error of each method falls with the work, and the setting that stands for it in the figures.
  [[nodiscard]] std::string slopes_table() const {
    const MethodStudy& methods = study().methods;
    HtmlTable table(HtmlTable::Shape::kWide);
    table.column("method", kText);
    for (const char* heading : {"middle setting", "partly hidden: fitted", "theory", "visible: fitted", "theory"}) {
      table.column(heading, kText);
    }
    std::set<std::string> reasons;
    for (std::size_t l = 0; l < methods.ladders.size() && l < methods.slopes.size(); ++l) {
      const Ladder& ladder = methods.ladders[l];
      if (ladder.rungs.front().method->name == "exact") continue;
      const auto field = std::ranges::find(methods.fields, l, &MethodField::ladder);
      table.row();
      table.cell(text::html(ladder.name), kText);
      table.cell(field == methods.fields.end()
                     ? "–"
                     : text::html(ladder.along) + ' ' + text::html(study::rung_text(ladder, field->rung)),
                 kText);
      for (const Sight sight : {Sight::kPartly, Sight::kVisible}) {
        const auto& slope = sight == Sight::kPartly ? methods.slopes[l].partly : methods.slopes[l].visible;
        const SlopeWords words = slope ? slope_words(*slope, ladder, sight) : SlopeWords{"–", {}, {}};
        table.cell(words.fitted, kText);
        table.cell(words.theory, kText);
        if (!words.reason.empty()) reasons.insert("The exponent of " + ladder.name + " is " + words.reason + ".");
      }
    }
    if (methods.slopes.empty() || methods.cells.size() < 2) return {};
    std::string notes;
    for (const std::string& reason : reasons) notes += page::paragraph(text::html(reason));
    return "<h3 class=\"part\">Exponents of error against work</h3>\n" +
           page::paragraph(
               "Error = c · work<sup>p</sup>, fitted over the settings of a method, where the source is "
               "partly hidden and where all of it is visible, with 95 % confidence intervals over the "
               "seeds of stochastic methods.") +
           table.text() + '\n' + notes;
  }

  [[nodiscard]] std::string sweep_part() const {
    if (!is_swept()) return {};
    std::string findings;
    for (const std::string& sentence : sweep_findings(study())) {
      findings += "<li>" + page::prose(text::html(sentence)) + "</li>\n";
    }
    const bool table_leads = study().methods.cells.size() < 2;
    const auto wants = [&](const page::Figure& figure) {
      return is_of_sweep(figure) && !is_named(figure, leading_figure());
    };
    return (table_leads ? std::string() : eps_b_table()) + "<ul class=\"answer\">\n" + findings + "</ul>\n" +
           figure_group(page_.drawn, wants);
  }

  // One row per tolerance, the other parameters as in the base setting.
  [[nodiscard]] std::string eps_b_table() const {
    if (!is_swept()) return {};
    std::vector<std::size_t> line = study::line_through(study().settings, study().base, "eps_B");
    std::ranges::sort(line, std::greater<>{}, [&](std::size_t k) { return study().settings[k].eps_b; });
    HtmlTable table;
    table.columns({"ε_B", "RMS error", "worst", "above ε_B", "leaves", "time"});
    const auto count = static_cast<double>(study().exact.size());
    for (const std::size_t k : line) {
      const Summary& summary = study().summaries[k];
      table.row(k == study().base ? "base" : "");
      table.cells({text::rounded(study().settings[k].eps_b), text::rounded(summary.radiosity.rms),
                   text::rounded(summary.radiosity.worst), text::share(summary.violations, study().exact.size()),
                   text::rounded(static_cast<double>(summary.leaves) / count),
                   page::prose(text::duration(study().times[k].mean))});
    }
    return "<h3>What the tolerance achieves</h3>\n" +
           page::paragraph("Per receiver, with " + text::html(rays_words()) +
                           ". Errors in radiosity. “Above ε_B”: receivers whose error exceeds the tolerance. The time "
                           "is that at the receivers at which all methods are compared; the exact method takes " +
                           text::duration(exact_seconds(study())) + " there.") +
           table.text() + '\n';
  }

  [[nodiscard]] std::string rays_words() const {
    const AdaptiveOptions& base = study().settings[study().base];
    return base.pattern == SamplePattern::kCentre
               ? "one ray to the centre of each undecided leaf"
               : std::to_string(base.rays) + ' ' + std::string(to_string(base.pattern)) + " rays per undecided leaf";
  }

  [[nodiscard]] std::string methods_table() const {
    if (study().methods.cells.empty()) return {};
    HtmlTable table(HtmlTable::Shape::kWide);
    table.column("method", kText);
    table.columns({"work", "seeds", "RMS", "partly hidden", "visible", "mean", "p99", "worst", "time per receiver",
                   "exact ×", "quartiles"});
    const double exact = exact_seconds(study());
    for (const MethodCell& c : study().methods.cells) {
      table.row(is_exact(study(), c) ? "exact" : "");
      table.cell(page::prose(text::html(cell_name(study(), c))), kText);
      table.cells({text::rounded(c.work), c.seeds.front() == 0 ? "–" : std::to_string(c.seeds.size()),
                   signed_number(c.error.rms), signed_number(c.error_partly.rms), signed_number(c.error_visible.rms),
                   signed_number(c.error.mean), signed_number(c.error.p99), signed_number(c.error.worst),
                   text::duration(c.seconds), text::rounded(c.seconds / exact, 2), quartiles(c)});
    }
    return page::paragraph("Errors are in radiosity, approximate minus exact, at " +
                           text::counted(study().methods.receivers.size(), "receiver") +
                           ". “Exact ×”: the time as a multiple of the exact method’s, which was measured in turn with "
                           "it, in several rounds; the quartiles are over the rounds.") +
           table.text() + '\n';
  }

  [[nodiscard]] std::string quartiles(const MethodCell& cell) const {
    if (is_exact(study(), cell) || std::isnan(cell.ratio_low)) return "–";
    return text::rounded(cell.ratio_low, 2) + "–" + text::rounded(cell.ratio_high, 2);
  }

  // Values that no form factor can have.
  [[nodiscard]] std::string ranges() const {
    std::string text;
    for (const std::string& sentence : range_sentences(study())) text += page::paragraph(text::html(sentence));
    return text;
  }

  [[nodiscard]] std::string settings_table() const {
    if (!is_swept()) return {};
    HtmlTable table(HtmlTable::Shape::kWide);
    table.columns({"#", "ε_B", "rays"});
    table.column("pattern", kText);
    table.columns({"ε_A", "seed"});
    table.column("variant", kText);
    table.columns({"RMS", "mean", "p99", "worst", "off", "leaves", "rays traced", "silent", "time per receiver"});
    if (partly()) table.column("partly hidden");
    exact_row(table);
    for (std::size_t k = 0; k < study().settings.size(); ++k) setting_row(table, k);
    return page::paragraph(
               "Errors are in radiosity, approximate minus exact, over all receivers. The marked row is the base "
               "setting; each sweep varies one parameter of it. “Off” is the share of receivers whose error exceeds "
               "ε_B. “Silent” counts the leaves with a silent error: all their rays agreed, and were wrong for a part "
               "of the leaf. Times are those at the receivers at which all methods are compared" +
               std::string(partly() ? "; the last column covers only those that see the source partly hidden." : ".")) +
           table.text() + '\n';
  }

  void exact_row(HtmlTable& table) const {
    table.row("exact");
    table.cell("");
    table.cell("exact", kText, 6);
    table.cells({"0", "0", "0", "0", "0 %", "", "", ""});
    times(table, study().exact_time);
  }

  void times(HtmlTable& table, const TimeSummary& t) const {
    table.cell(text::duration(t.mean));
    if (partly()) table.cell(text::duration(t.mean_partly));
  }

  void setting_row(HtmlTable& table, std::size_t k) const {
    const AdaptiveOptions& s = study().settings[k];
    const Summary& summary = study().summaries[k];
    table.row(k == study().base ? "base" : "");
    table.cells({std::to_string(k + 1), text::rounded(s.eps_b), std::to_string(s.rays)});
    table.cell(std::string(to_string(s.pattern)), kText);
    table.cells({text::rounded(s.eps_a), std::to_string(s.seed)});
    table.cell(std::string(to_string(s.variant)), kText);
    const ErrorStatistics& e = summary.radiosity;
    table.cells({signed_number(e.rms), signed_number(e.mean), signed_number(e.p99), signed_number(e.worst),
                 text::share(summary.violations, study().exact.size()), std::to_string(summary.leaves),
                 std::to_string(summary.rays), std::to_string(summary.silent_leaves)});
    times(table, study().times[k]);
  }

  const SceneChapter& scene_;
  const Page& page_;
  std::string text_;
};

}  // namespace

std::string figure_text(const page::DrawnFigure& drawn) {
  return "<figure id=\"" + drawn.figure.id + "\">\n<h3>" + page::prose(text::html(drawn.figure.title)) + "</h3>\n" +
         drawn.svg + "\n<figcaption>" + page::prose(drawn.figure.caption) + "</figcaption>\n</figure>\n";
}

std::string figure_group(const page::DrawnFigures& drawn, const WantsFigure& wants, bool maps) {
  std::string group;
  for (const page::DrawnFigure& one : drawn.figures) {
    if (!one.svg.empty() && wants(one.figure)) group += figure_text(one);
  }
  if (group.empty()) return {};
  return std::string("<div class=\"figures") + (maps ? " maps" : "") + "\">\n" + group + "</div>\n";
}

std::string left_out_list(const std::vector<LeftOut>& items) {
  std::string text = "<ul>\n";
  for (const LeftOut& item : items)
    text += "<li>" + page::prose(text::html(item.what) + ": " + text::html(item.why)) + ".</li>\n";
  return text + "</ul>\n";
}

std::string anchor_of(const SceneChapter& scene) { return scene.name.empty() ? "scene" : "scene-" + scene.name; }

std::string scene_part(const SceneChapter& scene, const Page& page) { return ScenePart(scene, page).write(); }

}  // namespace exactff::report
