#include <algorithm>

#include "page/page_text.h"
#include "stress/report.h"
#include "text/escape.h"
#include "text/phrases.h"

namespace exactff::stress {

namespace {

using page::heading;
using page::HtmlTable;
using page::paragraph;
using text::counted;
using text::html;
using enum HtmlTable::CellKind;

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
        "<strong>The question.</strong> The form factor from a point to a polygon is the share of the diffuse light "
        "leaving the point that reaches the polygon directly; occluders between them hide a part of it. It is easy to "
        "compute unless something is very near, very far, very thin or almost aligned. Each family below is a scene "
        "with one number, its stiffness, that makes it more and more extreme. Up to which stiffness is each method "
        "usable?");
    if (!report_.unfinished.empty()) {
      text_ += paragraph("<strong>Incomplete.</strong> The run was interrupted. Not finished: " +
                         html(text::enumerate(report_.unfinished)) + ".");
    }
    text_ += "<p><strong>The answer.</strong></p>\n<ul class=\"answer\">\n";
    for (const std::string& sentence : headlines(report_)) text_ += "<li>" + page::prose(html(sentence)) + "</li>\n";
    text_ += "</ul>\n";
    if (!drawn_.none.empty()) text_ += paragraph(html(drawn_.none));
  }

  void summary() {
    text_ += heading("Up to which stiffness each method is usable");
    text_ += paragraph(
        "The exact method and Eq. (4) in double: three numbers, the stiffness up to which the relative error stays "
        "below 10⁻³, 10⁻⁶ and 10⁻¹², starting at the least extreme scene. Tampieri’s algorithm: the stiffness up to "
        "which its error stays within the tolerance that it was given, " +
        text::rounded(kToleranceShare) +
        " of the unoccluded form factor; near the tolerance this depends on where its random rays hit. “all”: to the "
        "end of the family; “–”: not even at the start; “refused”: the method then refuses the scene.");
    HtmlTable table(HtmlTable::Shape::kWide);
    table.column("family", kText);
    table.column("ends at");
    for (Method method : kMethods) table.column(html(name_of(method)), kText);
    for (const FamilyResult& family : report_.families) {
      table.row();
      table.cell("<a href=\"#" + html(family.family.name) + "\">" + html(family.family.title) + "</a>", kText);
      table.cell(stiffness_text(family.rows.back().stiffness));
      for (Method method : kMethods) {
        const std::string reaches = reaches_text(family, method);
        table.cell(reaches == "all" ? "<b>all</b>" : reaches, kText);
      }
    }
    text_ += table.text() + '\n';
  }

  void how_to_read() {
    text_ += heading("The families");
    text_ += paragraph(
        "Each family opens to its figures and values. Stiffness grows in steps, above 10<sup>16</sup> in steps of "
        "twenty decades; families end before F leaves the range of normal doubles. Eq. (4) in double gets the exact "
        "visible region, so difficulties in finding the region do not affect it.");
    text_ += paragraph(
        "Stiffness grows from left to right; above 10<sup>16</sup> the axis is compressed by a factor of eighteen. "
        "Errors below 10<sup>−18</sup> and above 10<sup>3</sup> are drawn at these values. A line ends where its "
        "method returns no number or refuses the scene. “Bits” is the precision of the last evaluation of the contour "
        "integral, or 0 if none was needed; there is no figure if it never changes. Times are medians of single calls. "
        "The time of Eq. (4) in double does not include finding the visible region.");
  }

  void section(const FamilyResult& result) {
    const FamilyInfo& family = result.family;
    std::string content = "<div id=\"" + html(family.name) + "\">\n";
    content += paragraph(html(family.about) + " <em>Stiffness: " + html(family.stiffness) +
                         ". Truth: " + html(to_string(family.evidence)) + ".</em>");
    content += figures(family);
    if (const int bits = constant_bits(result); bits > 0) {
      content += paragraph("The proof needed " + std::to_string(bits) + " bits in every scene.");
    }
    content += page::fold("Every value", values_table(result) + '\n') + "</div>\n";
    const bool agrees = std::ranges::all_of(result.rows, &Row::agrees);
    text_ += page::fold(html(family.title) + (agrees ? "" : ": <b>disagrees with the truth</b>"), content);
  }

  static int constant_bits(const FamilyResult& result) {
    const int bits = result.rows.front().precision_bits;
    const bool same =
        std::all_of(result.rows.begin(), result.rows.end(), [&](const Row& row) { return row.precision_bits == bits; });
    return same ? bits : 0;
  }

  [[nodiscard]] std::string figures(const FamilyInfo& family) const {
    std::string group;
    for (const auto& [figure, svg] : drawn_.figures) {
      if (!figure.id.starts_with(std::string(family.name) + '.')) continue;
      group += "<figure id=\"" + figure.id + "\">\n<h3>" + html(figure.title) + "</h3>\n" + svg + "\n</figure>\n";
    }
    return group.empty() ? group : "<div class=\"figures maps\">\n" + group + "</div>\n";
  }

  static std::string values_table(const FamilyResult& result) {
    HtmlTable table(HtmlTable::Shape::kWide);
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
    text_ += heading("Definitions") + "<details>\n<summary>Errors, methods and sources</summary>\n<dl>\n";
    define("Relative error",
           "|value − F| / F; if F is 0, |value| / unoccluded form factor. F comes from closed forms for rectangles, "
           "from a symmetry, or, where neither exists, from the exact method’s own enclosure. The closed forms are "
           "evaluated in balls (intervals that are proved to contain the result), with the exact values of the "
           "coordinates and a precision that grows until 36 digits are certain.");
    define("Exact",
           "The exact form factor, proved to be correctly rounded. Its only error is this one rounding, at most "
           "1.1·10⁻¹⁶ relative for normal numbers.");
    define("Eq. (4) in double",
           "F = −1/(2π) Σ<sub>i</sub> (arccos(R<sub>i</sub> · R<sub>j</sub>) / |R<sub>i</sub> × R<sub>j</sub>|) "
           "(R<sub>i</sub> × R<sub>j</sub> · N<sub>r</sub>), j = i + 1 modulo n: Tampieri’s contour formula over the "
           "exact visible region, whose n corners are rounded to doubles. R<sub>i</sub> is the unit vector from the "
           "receiver to corner i, N<sub>r</sub> the receiver’s unit normal. Source: F. Tampieri, “Accurate Form-Factor "
           "Computation”, in D. Kirk (ed.), <em>Graphics Gems III</em>, Academic Press, 1992, pp. 329–333 and 577–581; "
           "the printed equation lacks the minus sign. There are three ways to compute the angle between two corners a "
           "and b: acos of unit vectors; atan2(|a × b|, a · b); and the same with a × b computed as a × (b − a). A "
           "real program would also have to find the visible region.");
    define("Tampieri’s algorithm",
           "The ray-sampled adaptive algorithm of the same source, with jittered shadow rays, in two variants. As "
           "printed: it does not clip at the horizon, works in single precision, and returns 0 for perpendicular "
           "pairs. Mended: these faults are corrected. Shadow rays are traced in single precision, so both variants "
           "refuse scenes whose corners single precision would merge.");
    text_ += "</dl>\n</details>\n";
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
        "Exact values are the same on every machine. All other values are the same on one machine for any number of "
        "threads. Times vary; --threads 1 gives the most reliable ones.");
    text_ += "<p>Files in this folder:</p>\n<ul>\n";
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
