// The report as one HTML page.
#include <algorithm>
#include <array>
#include <cmath>

#include "page/page_text.h"
#include "report/report.h"
#include "study/settings.h"
#include "text/escape.h"
#include "text/phrases.h"

namespace exactff::report {
namespace {

using page::HtmlTable;
using enum HtmlTable::CellKind;

std::string anchor_of(const SceneChapter& scene) { return scene.name.empty() ? "scene" : "scene-" + scene.name; }

std::string figure_text(const page::DrawnFigure& drawn) {
  return "<figure id=\"" + drawn.figure.id + "\">\n<h3>" + page::prose(text::html(drawn.figure.title)) + "</h3>\n" +
         drawn.svg + "\n<figcaption>" + page::prose(drawn.figure.caption) + "</figcaption>\n</figure>\n";
}

// All figures that are wanted; empty if there are none.
template <class Wants>
std::string figure_group(const page::DrawnFigures& drawn, const Wants& wants, bool maps = false) {
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

// Figures of the adaptive algorithm's sweeps.
constexpr std::array<std::string_view, 5> kSweepFigures = {"eps-b", "violations", "silent", "time", "rays"};

std::string signed_number(double value) { return value < 0.0 ? "−" + text::rounded(-value) : text::rounded(value); }

// The chapter of a scene: verdict, pictures, what each method needs; then the rest, folded.
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
    if (!page_.left_out.empty()) text_ += page::fold("What was left out, and why", left_out_list(page_.left_out));
    text_ += "</section>\n";
    return std::move(text_);
  }

 private:
  [[nodiscard]] const Study& study() const { return scene_.study; }
  [[nodiscard]] bool is_swept() const { return !study().settings.empty(); }

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
        const SlopeWords words = slope ? slope_words(*slope, ladder, sight) : SlopeWords{"–", {}};
        table.cell(words.fitted, kText);
        table.cell(words.theory, kText);
      }
    }
    if (methods.slopes.empty() || methods.cells.size() < 2) return {};
    return "<h3 class=\"part\">Exponents of error against work</h3>\n" +
           page::paragraph(
               "Error = c · work<sup>p</sup>, fitted over the settings of a method, where the source is "
               "partly hidden and where all of it is visible, with 95 % confidence intervals over the "
               "seeds of stochastic methods.") +
           table.text() + '\n';
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

  const SceneChapter& scene_;
  const Page& page_;
  std::string text_;
};

// --- the whole page ---

class PageWriter {
 public:
  PageWriter(const StudyReport& report, const std::vector<Page>& pages) : report_(report), pages_(pages) {}

  std::string write() {
    head();
    question();
    contents();
    if (has_overview()) overview();
    for (std::size_t i = 0; i < report_.scenes.size(); ++i) {
      text_ += ScenePart(report_.scenes[i], pages_[i]).write();
    }
    definitions();
    reproduction();
    if (!report_.identity.empty()) text_ += report_.identity + '\n';
    text_ += page::page_end();
    return std::move(text_);
  }

 private:
  [[nodiscard]] bool alone() const { return report_.scenes.size() == 1; }

  [[nodiscard]] std::string title() const {
    if (!report_.title.empty()) return text::html(report_.title);
    return "Exact and approximate form factors: " + text::html(report_.scenes.front().title);
  }

  void head() {
    text_ = page::page_head(title());
    text_ += "<h1>" + title() + "</h1>\n";
    if (alone()) return;
    text_ += "<p class=\"subtitle\">" + text::counted(report_.scenes.size(), "scene") + ".</p>\n";
  }

  void question() {
    text_ += page::paragraph(
        "How much light does a point receive from a polygonal source when other faces hide a part of it? This page "
        "compares approximate methods with the exact values: how large is the true error, and how long does each "
        "method take?");
  }

  void contents() {
    if (alone()) return;
    text_ += "<nav class=\"contents\" aria-label=\"Contents\"><ul>\n";
    const auto link = [&](const std::string& to, const std::string& words) {
      text_ += "<li><a href=\"#" + to + "\">" + words + "</a></li>\n";
    };
    if (has_overview()) link("overview", "Which method for which error");
    for (const SceneChapter& scene : report_.scenes) link(anchor_of(scene), text::html(scene.title));
    link("words", "Terms and sources");
    link("reproduction", "How to reproduce this page");
    text_ += "</ul></nav>\n";
  }

  [[nodiscard]] bool has_overview() const {
    return !alone() && std::ranges::any_of(report_.scenes, [](const SceneChapter& scene) {
      return exact_cell(scene.study) != nullptr;
    });
  }

  // One row per scene: the cheapest method for every wanted error, the exact method included.
  void overview() {
    text_ += "<section id=\"overview\">\n" + page::heading("Which method for which error");
    text_ += page::paragraph(
        "For each scene and error: the fastest method and setting that is accurate to this error, and its time per "
        "receiver. The error is the RMS error over the chosen receivers and seeds, divided by the radiosity of the "
        "brightest receiver.");
    HtmlTable table(HtmlTable::Shape::kWide);
    table.column("scene", kText);
    for (const double wanted : kWantedErrors) table.column(power_of_ten(wanted), kText);
    for (const SceneChapter& scene : report_.scenes) {
      const MethodCell* exact = exact_cell(scene.study);
      if (exact == nullptr) continue;
      table.row();
      table.cell(text::html(scene.title), kText);
      for (const double wanted : kWantedErrors) {
        const MethodCell* best = cheapest(scene.study, wanted);
        if (best == nullptr || best->seconds > exact->seconds) best = exact;
        const std::string name = text::html(cell_name(scene.study, *best));
        table.cell(
            page::prose(best == exact ? "<strong>" + name + "</strong>" : name) + ", " + text::duration(best->seconds),
            kText);
      }
    }
    text_ += table.text() + "\n</section>\n";
  }

  void define(const std::string& term, const std::string& meaning) {
    text_ += "<dt>" + page::prose(term) + "</dt><dd>" + page::prose(meaning) + "</dd>\n";
  }

  void definitions() {
    text_ +=
        "<section id=\"words\">\n" + page::heading("Terms and sources") +
        "<details>\n<summary>What the words of this page mean, and where the methods were published</summary>\n<dl>\n";
    define("Form factor F",
           "The share of the diffuse light leaving the receiving point that reaches the source directly: the integral "
           "of cos θ_r cos θ_s / (π r²) over the visible part of the source, where r is the distance and θ_r and θ_s "
           "are the angles to the normals at the receiver and on the source. It is a pure number between 0 and 1.");
    define("Exact",
           "The visible part is found in rational arithmetic without any tolerance. The integral over its boundary, "
           "Eq. (4) below, is enclosed in balls: intervals, given by midpoint and radius, that are proved to contain "
           "F. The value is certified: it is proved to be the true F, rounded once to the nearest double.");
    define("Radiosity",
           "ρ_r B_s F, summed over the sources: the receiver’s reflectance times the source’s radiosity times the form "
           "factor. Errors are given for the colour channel with the largest error.");
    define("ε_B, ε_A",
           "The tolerances of Tampieri’s algorithm. It stops splitting a part of the source when the part can "
           "contribute at most ε_B (a radiosity), or when its area is at most ε_A.");
    define("Leaf",
           "A part of the source that the algorithm does not split further. Shadow rays estimate its visible fraction, "
           "unless a shaft test decides it. The shaft is the convex hull of the receiver and the part; only faces that "
           "reach into it can be occluders, which hide a part of the source.");
    define("Silent error",
           "All rays of a leaf agreed, so the algorithm assumed that it is fully visible or fully hidden, but it is "
           "not. Differences below 10⁻⁹ of the leaf do not count.");
    define("RMS, mean, p99, worst",
           "Statistics of the errors over the receivers: the root mean square; the mean, with its sign; the magnitude "
           "that at least 99 % of the receivers do not exceed (nearest rank); the largest magnitude.");
    define("Mended and literal",
           "Two variants of Tampieri’s algorithm. The literal variant follows the published listing: it returns 0 for "
           "a receiver at a right angle to the source, does not clip the source at the horizon (the receiver’s plane), "
           "and works in single precision. The mended variant corrects these three faults.");
    define("Adaptive, exact V",
           "The same algorithm with the exact visible fraction of a leaf instead of rays. The remaining error comes "
           "from the assumption that visibility is constant over a leaf.");
    define("Hemicube, Nettle, Wallace, area sampling",
           "Hemicube: the scene is drawn on the pixels of half a cube around the receiver. Nettle: for each of m × m "
           "sub-patches, the form factor from centre to centre times a visible share found by rays. Wallace: for each "
           "of m × m sub-patches, one ray and the form factor of a disc. Area sampling: rays to random, stratified or "
           "low-discrepancy points of the source, uniform in its area or in the solid angle that the receiver sees.");
    define("Sources",
           "F. Tampieri, “Accurate Form-Factor Computation”, in D. Kirk (ed.), <em>Graphics Gems III</em>, Academic "
           "Press, 1992, pp. 329–333 and 577–581. Its Eq. (4), the contour integral: F = −1/(2π) Σ<sub>i</sub> "
           "(arccos(R<sub>i</sub> · R<sub>j</sub>) / |R<sub>i</sub> × R<sub>j</sub>|) (R<sub>i</sub> × "
           "R<sub>j</sub> · N<sub>r</sub>), j = i + 1 modulo n. R<sub>i</sub> is the unit vector from the receiver to "
           "vertex i of the n vertices of the visible region, in counter-clockwise order as seen from the receiver "
           "(holes: clockwise); N<sub>r</sub> is the unit normal at the receiver. For this order the printed equation "
           "lacks the minus sign.<br>"
           "T. Karkanis, “Accurate Point-To-Patch Form Factors”, course project CSC2522, University of Toronto, about "
           "1999.<br>"
           "P. Nettle, “Radiosity In English – Form Factor Calculation”, flipcode, 3 June 1999.<br>"
           "J. R. Wallace, K. A. Elmquist and E. A. Haines, “A Ray Tracing Algorithm for Progressive Radiosity”, "
           "<em>Computer Graphics</em> 23(3) (SIGGRAPH ’89), pp. 315–324.<br>"
           "E. A. Haines and J. R. Wallace, “Shaft Culling for Efficient Ray-Cast Radiosity”, Eurographics Workshop on "
           "Rendering, 1991; in <em>Photorealistic Rendering in Computer Graphics</em>, Springer, 1994, pp. "
           "122–138.<br>"
           "M. F. Cohen and D. P. Greenberg, “The Hemi-Cube: A Radiosity Solution for Complex Environments”, "
           "<em>Computer Graphics</em> 19(3) (SIGGRAPH ’85), pp. 31–40.");
    text_ += "</dl>\n</details>\n</section>\n";
  }

  void reproduction() {
    text_ += "<section id=\"reproduction\">\n" + page::heading("How to reproduce this page");
    if (!report_.command_line.empty()) text_ += "<pre>" + text::html(report_.command_line) + "</pre>\n";
    page::Facts facts = {{"program", page::program_fact()}};
    for (const SceneChapter& scene : report_.scenes) facts.emplace_back("scene", scene_fact(scene));
    facts.emplace_back("processor", page::processor_fact());
    facts.emplace_back("made", page::today());
    text_ += page::facts_table(facts);
    text_ += page::paragraph(
        "All values are the same in every run and for any number of threads. Times are not. They are those of one "
        "thread at "
        "work, measured after all values had been computed. At each receiver in turn, the exact method and a "
        "setting were called, in several rounds. A time is the median ratio of the two, times the median time of the "
        "exact method there, and the mean of this over the receivers.");
    text_ += page::fold("Files in this folder", files());
    text_ += "</section>\n";
  }

  [[nodiscard]] static std::string scene_fact(const SceneChapter& scene) {
    const Study& study = scene.study;
    const std::string flipped = flipped_names(study), transparent = transparent_names(study);
    return text::html(study.request.scene_name) + ", hash " + study.request.scene->hash() +
           (flipped.empty() ? "" : "; flipped: " + text::html(flipped)) +
           (transparent.empty() ? "" : "; transparent: " + text::html(transparent)) + "; " +
           (study.settings.empty() ? "the methods that were named"
            : study.full_product   ? "every combination of the settings of the ray-sampled algorithm"
                                   : "ε_B × rays, and sweeps of the other parameters through the base setting") +
           "; set up once per scene: exact method " + text::duration(study.exact_setup_seconds) + ", ray structure " +
           (study.ray_setup_seconds > 0.0 ? text::duration(study.ray_setup_seconds)
                                          : std::string("not built (no candidate list was long enough to need it)"));
  }

  [[nodiscard]] std::string files() const {
    std::string list = "<ul>\n";
    const auto item = [&](const std::string& file, const std::string& holds) {
      list += "<li><code>" + text::html(file) + "</code>: " + text::html(holds) + "</li>\n";
    };
    for (const StudyTable& table : tables()) {
      const bool anywhere = std::any_of(report_.scenes.begin(), report_.scenes.end(),
                                        [&](const SceneChapter& scene) { return table.has_rows(scene.study); });
      if (!anywhere) continue;
      item(report_.scenes.size() == 1 ? file_name(report_.scenes.front(), table) : "SCENE_" + std::string(table.file),
           std::string(table.holds));
    }
    list += "</ul>\n";
    if (report_.scenes.size() < 2) return list;
    std::vector<std::string> names;
    for (const SceneChapter& scene : report_.scenes) {
      names.push_back("<code>" + text::html(scene.name) + "</code> (" + text::html(scene.title) + ')');
    }
    return list + "<p>SCENE stands for " + text::enumerate(names) + ".</p>\n";
  }

  const StudyReport& report_;
  const std::vector<Page>& pages_;
  std::string text_;
};

}  // namespace

std::string report_page(const StudyReport& report, const std::vector<Page>& pages) {
  return PageWriter(report, pages).write();
}

}  // namespace exactff::report
