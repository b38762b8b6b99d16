#include <algorithm>
#include <cctype>
#include <functional>
#include <set>

#include "page/page_text.h"
#include "report/identity.h"
#include "report/plan.h"
#include "report/report.h"
#include "report/scene_part.h"
#include "report/tables.h"
#include "report/verdicts.h"
#include "text/escape.h"
#include "text/phrases.h"

namespace exactff::report {
namespace {

using page::HtmlTable;
using enum HtmlTable::CellKind;

class PageWriter {
 public:
  PageWriter(const StudyReport& report, const Pages& pages) : report_(report), pages_(pages) {}

  std::string write() {
    head();
    question();
    contents();
    if (has_overview()) overview();
    for (std::size_t i = 0; i < report_.scenes.size(); ++i) {
      text_ += scene_part(report_.scenes[i], pages_.scenes[i]);
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
    text_ += table.text() + '\n';
  }

  void chapter(const page::Chapter& chapter, const Page& page) {
    text_ +=
        "<section class=\"scene\" id=\"chapter-" + chapter.name + "\">\n<h2>" + text::html(chapter.title) + "</h2>\n";
    experiment_part(chapter, page);
    text_ += "</section>\n";
  }

  // A sentence, a figure or two, then the findings and further figures, folded.
  void experiment_part(const page::Chapter& chapter, const Page& page) {
    if (!chapter.paragraphs.empty()) {
      const std::string opening = opening_sentence(chapter.paragraphs.front());
      text_ += "<p class=\"verdict\">" + page::prose(text::html(opening)) + "</p>\n";
    }
    if (!page.drawn.none.empty()) text_ += page::paragraph(text::html(page.drawn.none));
    constexpr std::size_t kShown = 2;
    std::set<std::string> shown;
    for (const page::DrawnFigure& one : page.drawn.figures) {
      if (shown.size() < kShown && !one.figure.map) shown.insert(one.figure.id);
    }
    const auto is_shown = [&](const page::Figure& figure) { return shown.contains(figure.id); };
    text_ += figure_group(page.drawn, is_shown);
    std::string findings;
    for (const std::string& words : chapter.paragraphs) findings += page::paragraph(text::html(words));
    for (const page::NumberTable& table : chapter.tables) findings += number_table(table);
    text_ += page::fold("What was done and found", findings);
    text_ += page::fold("Further figures", figure_group(page.drawn, std::not_fn(is_shown)));
    if (!page.left_out.empty()) text_ += page::fold("What was left out, and why", left_out_list(page.left_out));
  }

  static std::string number_table(const page::NumberTable& numbers) {
    using Table = page::HtmlTable;
    Table table(numbers.columns.size() > 3 ? Table::Shape::kWide : Table::Shape::kNarrow);
    const auto kind = [](std::size_t column) {
      return column == 0 ? Table::CellKind::kText : Table::CellKind::kNumber;
    };
    for (std::size_t i = 0; i < numbers.columns.size(); ++i) table.column(text::html(numbers.columns[i]), kind(i));
    for (const std::vector<std::string>& row : numbers.rows) {
      table.row();
      for (std::size_t i = 0; i < row.size(); ++i) table.cell(page::prose(text::html(row[i])), kind(i));
    }
    return page::paragraph("<strong>" + page::prose(text::html(numbers.title)) + "</strong>") + table.text() + '\n';
  }

  // The first sentence that is no list of numbers. A full stop ends a sentence if a capital follows.
  static std::string opening_sentence(const std::string& text) {
    std::size_t begin = 0;
    for (std::size_t at = text.find(". "); at != std::string::npos; at = text.find(". ", at + 1)) {
      if (at + 2 >= text.size() || std::isupper(static_cast<unsigned char>(text[at + 2])) == 0) continue;
      const std::string sentence = text.substr(begin, at + 1 - begin);
      if (sentence.find(';') == std::string::npos) return sentence;
      begin = at + 2;
    }
    return text.substr(begin);
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
    for (const page::Chapter& chapter : report_.chapters) {
      for (const auto* files : {&chapter.values, &chapter.times}) {
        for (const page::CsvFile& table : *files) item(table.file, table.holds);
      }
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
  const Pages& pages_;
  std::string text_;
};

}  // namespace

std::string report_page(const StudyReport& report, const Pages& pages) { return PageWriter(report, pages).write(); }

}  // namespace exactff::report
