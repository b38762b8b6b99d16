#include "stress/report_page.h"

#include <algorithm>

#include "exactff/stress.h"
#include "page/page_text.h"
#include "stress/tables.h"
#include "text/escape.h"
#include "text/phrases.h"

namespace exactff::stress {

namespace {

using page::heading;
using page::HtmlTable;
using page::paragraph;
using text::counted;
using text::html;
using enum HtmlTable::Kind;

constexpr const char* kTitle = "Where each method stops being usable";

class PageWriter {
 public:
  PageWriter(const Report& report, const page::DrawnFigures& drawn) : report_(report), drawn_(drawn) {}

  std::string write() {
    text_ = page::page_head(kTitle);
    opening();
    summary();
    how_to_read();
    for (const FamilyResult& family : report_.families) section(family);
    definitions();
    reproduction();
    text_ += page::page_end();
    return std::move(text_);
  }

 private:
  void opening() {
    std::size_t scenes = 0;
    for (const FamilyResult& family : report_.families) scenes += family.rows.size();
    text_ += std::string("<h1>") + kTitle + "</h1>\n<p class=\"subtitle\">" +
             counted(report_.families.size(), "family", "families") + " of stiff scenes, " + counted(scenes, "scene") +
             ", " + std::to_string(kMethodCount) + " methods.</p>\n";
    text_ += paragraph(
        "<strong>The question.</strong> A form factor from a point to a polygon, with occluders in between, is easy to "
        "compute as long as nothing is very near, very far, very thin or very nearly aligned. Each family below is a "
        "scene that one number, its stiffness, drives from benign to extreme. How far does each method follow?");
    text_ += "<p><strong>The answer.</strong></p>\n<ul class=\"answer\">\n";
    for (const std::string& sentence : headlines(report_)) text_ += "<li>" + page::prose(html(sentence)) + "</li>\n";
    text_ += "</ul>\n";
    if (!drawn_.none.empty()) text_ += paragraph(html(drawn_.none));
  }

  void summary() {
    text_ += heading("The largest stiffness with an error below 10⁻³, 10⁻⁶ and 10⁻¹²");
    text_ += paragraph(
        "From the benign end on, without a gap: three numbers a cell, one a threshold. “all”: to the end of the "
        "family; "
        "“–”: not even at its benign end; “refused”: there the method refuses the scene. Stiffnesses are tried in "
        "steps, "
        "beyond 10<sup>16</sup> in every twentieth decade; a cell names the last one that was good.");
    text_ += paragraph(
        "Eq. (4) in double is handed the exact visible region: where finding it is the difficulty, it has none. "
        "Tampieri’s algorithm was asked for an absolute error of " +
        text::rounded(kToleranceShare) +
        " of the unoccluded form factor, not for 10⁻⁶ or 10⁻¹², nor for an error relative to F; around 10⁻³ its cells "
        "depend on where its rays happen to fall. Families end before F leaves the range of normal doubles.");
    HtmlTable table;
    table.column("family", kText);
    table.column("ends at");
    for (Method method : kMethods) table.column(html(name_of(method)));
    for (const FamilyResult& family : report_.families) {
      table.row();
      table.cell("<a href=\"#" + html(family.family.name) + "\">" + html(family.family.title) + "</a>", kText);
      table.cell(stiffness_text(family.rows.back().stiffness));
      for (Method method : kMethods) {
        const std::string reaches = reaches_text(family, method);
        table.cell(reaches == "all" ? "<b>all</b>" : reaches);
      }
    }
    text_ += table.text() + '\n';
  }

  void how_to_read() {
    text_ += heading("How to read the figures");
    text_ += paragraph(
        "From left to right a scene grows stiffer; beyond 10<sup>16</sup> the axis is compressed eighteen-fold. Errors "
        "below 10<sup>−18</sup> and above 10<sup>3</sup> are drawn at these values. A line ends where its method "
        "returns no number or refuses the scene. Bits are those at which the contour integral was last "
        "evaluated, 0 where none "
        "was needed; where they never change there is no figure of them. Times are medians of single calls; Eq. (4) in "
        "double is handed the visible region, and finding it is not in its time.");
  }

  void section(const FamilyResult& result) {
    const FamilyInfo& family = result.family;
    text_ += "<h2 id=\"" + html(family.name) + "\">" + html(family.title) + "</h2>\n";
    text_ += paragraph(html(family.about) + " <em>Stiffness: " + html(family.stiffness) +
                       ". Truth: " + html(to_string(family.evidence)) + ".</em>");
    figures(family);
    if (const int bits = constant_bits(result); bits > 0) {
      text_ += paragraph("The proof needed " + std::to_string(bits) + " bits throughout.");
    }
    text_ += "<details><summary>Every value</summary>\n" + values_table(result) + "\n</details>\n";
  }

  static int constant_bits(const FamilyResult& result) {
    const int bits = result.rows.front().precision_bits;
    const bool same =
        std::all_of(result.rows.begin(), result.rows.end(), [&](const Row& row) { return row.precision_bits == bits; });
    return same ? bits : 0;
  }

  void figures(const FamilyInfo& family) {
    std::string group;
    for (const auto& [figure, svg] : drawn_.figures) {
      if (!figure.id.starts_with(std::string(family.name) + '.')) continue;
      group += "<figure id=\"" + figure.id + "\">\n<h3>" + html(figure.title) + "</h3>\n" + svg + "\n</figure>\n";
    }
    if (!group.empty()) text_ += "<div class=\"figures maps\">\n" + group + "</div>\n";
  }

  static std::string values_table(const FamilyResult& result) {
    HtmlTable table;
    table.columns({"stiffness", "form factor", "status", "exact, bits", "edges", "exact, time"});
    for (Method method : kMethods) table.column("error, " + html(short_name_of(method)));
    for (const Row& row : result.rows) {
      const Answer& exact = row.of(Method::kExact);
      table.row();
      table.cells({stiffness_text(row.stiffness), text::shortest(exact.value),
                   row.agrees ? html(exactff::to_string(row.status)) : "<b>disagrees with the truth</b>",
                   std::to_string(row.precision_bits), std::to_string(row.edges),
                   page::prose(text::duration(exact.seconds))});
      for (Method method : kMethods) table.cell(error_text(row.of(method)));
    }
    return table.text();
  }

  void define(const char* term, const char* meaning) {
    text_ += std::string("<dt>") + term + "</dt><dd>" + page::prose(meaning) + "</dd>\n";
  }

  void definitions() {
    text_ += heading("Definitions") + "<dl>\n";
    define(
        "Relative error",
        "|value − F| / F; where F is 0, |value| over the unoccluded form factor. F comes from the catalogue’s closed "
        "forms for rectangles, evaluated in balls at a precision that grows until they are good to 36 digits, with "
        "coordinates taken as the exact rationals that they are; or from a symmetry; or, where neither exists, from "
        "the exact method’s own enclosure.");
    define(
        "Exact",
        "The correctly rounded form factor. Its error is that of one rounding, at most 1.1·10⁻¹⁶ of a normal number.");
    define(
        "Eq. (4) in double",
        "Tampieri’s contour formula over the exact visible region, whose corners were rounded to doubles. Three "
        "ways to the angle between two corners a and b: by acos of unit vectors; by atan2(|a × b|, a · b); and with a "
        "× b formed as a × (b − a). The visible region is given to them; a program must find it, too.");
    define(
        "Tampieri’s algorithm",
        "The ray-sampled adaptive algorithm, by jittered shadow rays; mended, and as printed: no horizon clip, single "
        "precision, nothing for perpendicular pairs. It refuses scenes whose corners single precision, in which its "
        "shadow rays are "
        "traced, would merge.");
    text_ += "</dl>\n";
  }

  void reproduction() {
    text_ += heading("How to reproduce this page");
    if (!report_.request.command_line.empty()) text_ += "<pre>" + html(report_.request.command_line) + "</pre>\n";
    text_ += page::facts_table(
        {{"program", page::program_fact()},
         {"Tampieri’s algorithm", "ε_B " + text::rounded(kToleranceShare) + " of the unoccluded form factor, " +
                                      counted(kRays, "jittered ray") + " per undecided leaf, seed 1"},
         {"processor", page::processor_fact()},
         {"threads", std::to_string(report_.request.threads)},
         {"made", page::today()}});
    text_ += paragraph(
        "Exact values are the same everywhere, all other values on the same machine and for any number of threads; "
        "times are not, and are least disturbed with --threads 1.");
    text_ += "<p>Beside this page lie:</p>\n<ul>\n";
    for (const StressTable& table : tables()) {
      text_ += "<li><code>" + std::string(table.file) + "</code>: " + html(table.holds) + "</li>\n";
    }
    text_ += "</ul>\n";
  }

  const Report& report_;
  const page::DrawnFigures& drawn_;
  std::string text_;
};

}  // namespace

std::string report_page(const Report& report, const page::DrawnFigures& drawn) {
  return PageWriter(report, drawn).write();
}

}  // namespace exactff::stress
