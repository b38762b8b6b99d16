#include <algorithm>
#include <cmath>

#include "exactff/report.h"
#include "page/page_text.h"
#include "report/identity.h"
#include "report/report.h"
#include "report/tables.h"
#include "report/verdicts.h"
#include "text/escape.h"
#include "text/phrases.h"

namespace exactff::report {
namespace {

using page::HtmlTable;
using enum HtmlTable::Kind;

std::string figure_group(const page::DrawnFigures& drawn, bool maps) {
  std::string group;
  for (const page::DrawnFigure& one : drawn.figures) {
    if (one.figure.map != maps || one.svg.empty()) continue;
    group += "<figure id=\"" + one.figure.id + "\">\n<h3>" + page::prose(text::html(one.figure.title)) + "</h3>\n" +
             one.svg + "\n<figcaption>" + page::prose(one.figure.caption) + "</figcaption>\n</figure>\n";
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

class ScenePart {
 public:
  ScenePart(const SceneChapter& scene, const Page& page, bool alone) : scene_(scene), page_(page), alone_(alone) {}

  std::string write() {
    text_ = "<section class=\"scene\" id=\"" + anchor(scene_) + "\">\n<h2>" + text::html(scene_.title) + "</h2>\n";
    text_ +=
        "<p class=\"subtitle\">" + text::counted(study().exact.size(), "receiver") + " (" +
        text::html(study().request.receivers_name) + "), source " + text::html(source_names(study())) + ", " +
        text::counted(study().request.scene->faces().size(), "face") +
        (is_swept() ? ", " + text::counted(study().settings.size(), "setting") + " of the ray-sampled algorithm" : "") +
        (study().methods.cells.empty() ? std::string()
                                       : ", " + text::counted(study().methods.ladders.size(), "method") + " compared") +
        ".</p>\n";
    for (const std::string& sentence : receiver_warnings(study())) {
      text_ += page::paragraph("Warning: " + text::html(sentence) + ".");
    }
    answer();
    tiles();
    figures();
    needs();
    for (const std::string& sentence : range_sentences(study())) text_ += page::paragraph(text::html(sentence));
    methods_table();
    if (is_swept()) settings_table();
    left_out();
    text_ += "</section>\n";
    return std::move(text_);
  }

  static std::string anchor(const SceneChapter& scene) { return scene.name.empty() ? "scene" : "scene-" + scene.name; }

 private:
  [[nodiscard]] const Study& study() const { return scene_.study; }
  [[nodiscard]] bool is_swept() const { return !study().settings.empty(); }
  [[nodiscard]] bool partly() const { return study().receivers_by_sight[static_cast<std::size_t>(Sight::kPartly)] > 0; }

  void subheading(const std::string& words) { text_ += "<h3 class=\"part\">" + words + "</h3>\n"; }

  void answer() {
    if (alone_) {
      for (const std::string& sentence : method_sentences(study())) {
        text_ += "<p class=\"quote\">" + page::prose(text::html(sentence)) + "</p>\n";
      }
    }
    text_ += "<ul class=\"answer\">\n";
    for (const std::string& sentence : headlines(study()))
      text_ += "<li>" + page::prose(text::html(sentence)) + "</li>\n";
    text_ += "</ul>\n";
  }

  void tile(const std::string& number, const std::string& words) {
    text_ += "<div class=\"tile\"><b>" + number + "</b><span>" + page::prose(words) + "</span></div>\n";
  }

  void tiles() {
    text_ += "<div class=\"tiles\">\n";
    is_swept() ? sweep_tiles() : method_tiles();
    text_ += "</div>\n";
  }

  // The most accurate setting of each method that was named.
  void method_tiles() {
    if (const MethodCell* exact = exact_cell(study())) tile(text::duration(exact->seconds), "exact, per receiver");
    for (std::size_t l = 0; l < study().methods.ladders.size(); ++l) {
      const MethodCell* best = most_accurate(study(), l);
      if (best == nullptr || is_exact(study(), *best)) continue;
      const std::string name = text::html(cell_name(study(), *best));
      const std::string error = text::rounded(100.0 * relative_error(study(), *best), 2) + " %";
      tile(text::duration(best->seconds), name + ", per receiver");
      tile(error, "RMS error of " + name + ", of the brightest receiver");
    }
  }

  void sweep_tiles() {
    const Summary& base = study().summaries[study().base];
    const double exact = partly() ? study().exact_time.median_partly : study().exact_time.median;
    const TimeSummary& base_time = study().times[study().base];
    const std::string where = partly() ? ", source partly hidden" : "";
    tile(text::duration(exact), "exact, per receiver" + where + " (median)");
    tile(text::duration(partly() ? base_time.median_partly : base_time.median),
         "sampled at the base setting, per receiver" + where + " (median)");
    tile(text::share(base.violations, study().exact.size()),
         "of receivers with an error above ε_B at the base setting");
    tile(text::rounded(base.radiosity.rms),
         "RMS error there (radiosity); the tolerance is " + text::rounded(study().settings[study().base].eps_b));
  }

  void figures() {
    if (!page_.drawn.none.empty()) text_ += page::paragraph(text::html(page_.drawn.none));
    text_ += figure_group(page_.drawn, false);
    const std::string maps = figure_group(page_.drawn, true);
    if (!maps.empty()) subheading("Maps over the grid of receivers");
    text_ += maps;
  }

  // One row per method: its least time for every wanted error, as a multiple of the exact method's time.
  void needs() {
    const MethodCell* exact = exact_cell(study());
    if (exact == nullptr || study().methods.cells.size() < 2) return;
    subheading("Time that each method needs");
    text_ += page::paragraph(
        "Time that each method needs to be accurate to a given error, as a multiple of the time of the exact method (" +
        text::duration(exact->seconds) +
        " per receiver). The error is the RMS error over the chosen receivers and seeds, divided by the radiosity of "
        "the brightest receiver. A dash means that no setting that was run reached this error.");
    HtmlTable table;
    table.column("method", kText);
    for (const double wanted : kWantedErrors) table.column(power_of_ten(wanted));
    table.column("best error");
    for (std::size_t l = 0; l < study().methods.ladders.size(); ++l) needs_row(table, l, exact->seconds);
    text_ += table.text() + '\n';
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

  void methods_table() {
    if (study().methods.cells.empty()) return;
    HtmlTable table;
    table.column("method", kText);
    table.columns(
        {"work", "seeds", "RMS", "partly hidden", "visible", "mean", "p99", "worst", "time per receiver", "exact ×"});
    const MethodCell* exact = exact_cell(study());
    for (const MethodCell& c : study().methods.cells) {
      table.row(is_exact(study(), c) ? "exact" : "");
      table.cell(text::html(cell_name(study(), c)), kText);
      table.cells({text::rounded(c.work), c.seeds.front() == 0 ? "–" : std::to_string(c.seeds.size()),
                   signed_number(c.error.rms), signed_number(c.error_partly.rms), signed_number(c.error_visible.rms),
                   signed_number(c.error.mean), signed_number(c.error.p99), signed_number(c.error.worst),
                   text::duration(c.seconds), exact != nullptr ? text::rounded(c.seconds / exact->seconds, 2) : "–"});
    }
    text_ += std::string("<details") + (is_swept() ? "" : " open") + "><summary>Every method and setting</summary>\n" +
             table.text() + "</details>\n";
  }

  void settings_table() {
    text_ += std::string("<details") + (alone_ && study().methods.cells.empty() ? " open" : "") +
             "><summary>Every setting of the ray-sampled algorithm</summary>\n";
    text_ += page::paragraph(
        "Errors are in radiosity, approximate minus exact, over all receivers. The marked row is the base setting; "
        "each sweep varies one parameter of it. “Off” is the share of receivers whose error exceeds ε_B. “Silent” "
        "counts the leaves with a silent error: all their rays agreed, and were wrong for a part of the leaf. Times "
        "are per receiver" +
        std::string(partly() ? "; the last column covers only receivers that see the source partly hidden." : "."));
    HtmlTable table;
    table.columns({"#", "ε_B", "rays"});
    table.column("pattern", kText);
    table.columns({"ε_A", "seed"});
    table.column("variant", kText);
    table.columns({"RMS", "mean", "p99", "worst", "off", "leaves", "rays traced", "silent", "median time"});
    if (partly()) table.column("median, partly hidden");
    exact_row(table);
    for (std::size_t k = 0; k < study().settings.size(); ++k) setting_row(table, k);
    text_ += table.text() + "</details>\n";
  }

  void exact_row(HtmlTable& table) const {
    table.row("exact");
    table.cell("");
    table.cell("exact", kText, 6);
    table.cells({"0", "0", "0", "0", "0 %", "", "", ""});
    times(table, study().exact_time);
  }

  void times(HtmlTable& table, const TimeSummary& t) const {
    table.cell(text::duration(t.median));
    if (partly()) table.cell(text::duration(t.median_partly));
  }

  void setting_row(HtmlTable& table, std::size_t k) const {
    const AdaptiveOptions& s = study().settings[k];
    const Summary& summary = study().summaries[k];
    table.row(k == study().base ? "base" : "");
    table.cells({std::to_string(k + 1), text::rounded(s.eps_b), std::to_string(s.rays)});
    table.cell(std::string(name_of(s.pattern)), kText);
    table.cells({text::rounded(s.eps_a), std::to_string(s.seed)});
    table.cell(std::string(name_of(s.variant)), kText);
    const ErrorStatistics& e = summary.radiosity;
    table.cells({signed_number(e.rms), signed_number(e.mean), signed_number(e.p99), signed_number(e.worst),
                 text::share(summary.violations, study().exact.size()), std::to_string(summary.leaves),
                 std::to_string(summary.rays), std::to_string(summary.silent_leaves)});
    times(table, study().times[k]);
  }

  static std::string signed_number(double value) {
    return value < 0.0 ? "−" + text::rounded(-value) : text::rounded(value);
  }

  void left_out() {
    if (page_.left_out.empty()) return;
    subheading("What was left out, and why");
    text_ += left_out_list(page_.left_out);
  }

  const SceneChapter& scene_;
  const Page& page_;
  const bool alone_;
  std::string text_;
};

class PageWriter {
 public:
  PageWriter(const StudyReport& report, const Pages& pages) : report_(report), pages_(pages) {}

  std::string write() {
    head();
    question();
    contents();
    if (has_overview()) overview();
    for (std::size_t i = 0; i < report_.scenes.size(); ++i) {
      text_ += ScenePart(report_.scenes[i], pages_.scenes[i], alone()).write();
    }
    for (std::size_t i = 0; i < report_.chapters.size(); ++i) chapter(report_.chapters[i], pages_.chapters[i]);
    left_out();
    definitions();
    reproduction();
    if (!report_.identity.empty()) text_ += identity_line(report_.identity) + '\n';
    text_ += page::page_end();
    return std::move(text_);
  }

 private:
  [[nodiscard]] bool alone() const { return report_.scenes.size() == 1 && report_.chapters.empty(); }

  [[nodiscard]] std::string title() const {
    if (!report_.title.empty()) return text::html(report_.title);
    return "Exact and approximate form factors: " + text::html(report_.scenes.front().title);
  }

  void head() {
    text_ = page::page_head(title());
    text_ += "<h1>" + title() + "</h1>\n";
    if (alone()) return;
    text_ += "<p class=\"subtitle\">" + text::counted(report_.scenes.size(), "scene");
    if (!report_.chapters.empty()) text_ += " and " + text::counted(report_.chapters.size(), "experiment");
    text_ += ".</p>\n";
  }

  void question() {
    text_ += page::paragraph(
        "<strong>The question.</strong> The light that a point receives from a polygonal source depends on the part of "
        "the source that is visible from the point. Most programs approximate this part. Tampieri’s adaptive algorithm "
        "(1992) uses shadow rays and splits the source until a tolerance ε_B is met; the hemicube uses pixels; other "
        "methods use sample points. This page compares them with the exact values. How large is the true error? How "
        "often is the tolerance broken? How long does each method take?");
  }

  void contents() {
    text_ += "<nav class=\"contents\" aria-label=\"Contents\"><ul>\n";
    const auto link = [&](const std::string& to, const std::string& words) {
      text_ += "<li><a href=\"#" + to + "\">" + words + "</a></li>\n";
    };
    if (has_overview()) link("overview", "Which method for which error");
    for (const SceneChapter& scene : report_.scenes) link(ScenePart::anchor(scene), text::html(scene.title));
    for (const page::Chapter& chapter : report_.chapters) link("chapter-" + chapter.name, text::html(chapter.title));
    if (!report_.left_out.empty()) link("left-out", "What this report leaves out, and why");
    link("words", "Terms and sources");
    link("reproduction", "How to reproduce this page");
    text_ += "</ul></nav>\n";
  }

  [[nodiscard]] bool has_overview() const {
    return !alone() && std::ranges::any_of(report_.scenes, [](const SceneChapter& scene) {
      return exact_cell(scene.study) != nullptr;
    });
  }

  void overview() {
    text_ += "<section id=\"overview\">\n" + page::heading("Which method for which error");
    recommendations();
    for (const SceneChapter& scene : report_.scenes) {
      const std::vector<std::string> sentences = method_sentences(scene.study);
      if (sentences.empty()) continue;
      text_ += "<p class=\"quote\"><strong>" + text::html(scene.title) + ".</strong> ";
      for (const std::string& sentence : sentences) text_ += page::prose(text::html(sentence)) + ' ';
      text_ += "</p>\n";
    }
    text_ += "</section>\n";
  }

  void left_out() {
    if (report_.left_out.empty()) return;
    text_ += "<section id=\"left-out\">\n" + page::heading("What this report leaves out, and why") +
             left_out_list(report_.left_out) + "</section>\n";
  }

  // One row per scene: the cheapest method for every wanted error, the exact method included.
  void recommendations() {
    text_ += page::paragraph(
        "For each scene and error: the fastest method and setting that is accurate to this error, and its time per "
        "receiver. The error is the RMS error over the chosen receivers and seeds, divided by the radiosity of the "
        "brightest receiver.");
    HtmlTable table("recommend");
    table.column("scene");
    for (const double wanted : kWantedErrors) table.column(power_of_ten(wanted));
    for (const SceneChapter& scene : report_.scenes) {
      const MethodCell* exact = exact_cell(scene.study);
      if (exact == nullptr) continue;
      table.row();
      table.cell(text::html(scene.title));
      for (const double wanted : kWantedErrors) {
        const MethodCell* best = cheapest(scene.study, wanted);
        if (best == nullptr || best->seconds > exact->seconds) best = exact;
        const std::string name = text::html(cell_name(scene.study, *best));
        table.cell((best == exact ? "<strong>" + name + "</strong>" : name) + ", " + text::duration(best->seconds));
      }
    }
    text_ += table.text() + '\n';
  }

  void chapter(const page::Chapter& chapter, const Page& page) {
    text_ +=
        "<section class=\"scene\" id=\"chapter-" + chapter.name + "\">\n<h2>" + text::html(chapter.title) + "</h2>\n";
    for (const std::string& words : chapter.paragraphs) text_ += page::paragraph(text::html(words));
    if (!page.drawn.none.empty()) text_ += page::paragraph(text::html(page.drawn.none));
    text_ += figure_group(page.drawn, false) + figure_group(page.drawn, true);
    if (!page.left_out.empty())
      text_ += "<h3 class=\"part\">What was left out, and why</h3>\n" + left_out_list(page.left_out);
    text_ += "</section>\n";
  }

  void define(const std::string& term, const std::string& meaning) {
    text_ += "<dt>" + page::prose(term) + "</dt><dd>" + page::prose(meaning) + "</dd>\n";
  }

  void definitions() {
    text_ += "<section id=\"words\">\n" + page::heading("Terms and sources") + "<dl>\n";
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
           "low-discrepancy points of the source.");
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
    text_ += "</dl>\n</section>\n";
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
        "All values are the same in every run and for any number of threads. Times are not. They were measured on one "
        "thread, after all values had been computed. Each time is the median of three calls, after a first call with "
        "the same arguments.");
    files();
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

  void files() {
    text_ +=
        "<p>Files in this folder:</p>\n"
        "<ul>\n";
    const auto item = [&](const std::string& file, const std::string& holds) {
      text_ += "<li><code>" + text::html(file) + "</code>: " + text::html(holds) + "</li>\n";
    };
    for (const StudyTable& table : tables()) {
      const bool anywhere = std::any_of(report_.scenes.begin(), report_.scenes.end(),
                                        [&](const SceneChapter& scene) { return table.has_rows(scene.study); });
      if (!anywhere) continue;
      item(report_.scenes.size() == 1 ? file_name(report_.scenes.front(), table) : "SCENE_" + std::string(table.file),
           std::string(table.holds));
    }
    for (const page::Chapter& chapter : report_.chapters) {
      for (const auto* list : {&chapter.values, &chapter.times}) {
        for (const page::CsvFile& table : *list) item(table.file, table.holds);
      }
    }
    text_ += "</ul>\n";
    if (report_.scenes.size() < 2) return;
    std::vector<std::string> names;
    for (const SceneChapter& scene : report_.scenes) {
      names.push_back("<code>" + text::html(scene.name) + "</code> (" + text::html(scene.title) + ')');
    }
    text_ += "<p>SCENE stands for " + text::enumerate(names) + ".</p>\n";
  }

  const StudyReport& report_;
  const Pages& pages_;
  std::string text_;
};

}  // namespace

std::string report_page(const StudyReport& report, const Pages& pages) { return PageWriter(report, pages).write(); }

}  // namespace exactff::report
