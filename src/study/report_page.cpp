#include "study/report_page.h"

#include <algorithm>

#include "study/page_text.h"
#include "study/tables.h"
#include "study/text.h"

namespace exactff::study {
namespace {

class PageWriter {
 public:
  PageWriter(const Study& study, const Page& page) : study_(study), page_(page) {}

  std::string write() {
    head();
    question_and_answer();
    tiles();
    figures();
    table();
    left_out();
    definitions();
    reproduction();
    text_ += page_end();
    return std::move(text_);
  }

 private:
  [[nodiscard]] std::string title() const {
    return "Exact and sampled form factors: " + html(study_.request.scene_name);
  }
  [[nodiscard]] bool partly() const { return study_.receivers_by_sight[static_cast<std::size_t>(Sight::kPartly)] > 0; }

  void head() {
    text_ = page_head(title());
    text_ += "<h1>" + title() + "</h1>\n<p class=\"subtitle\">" + counted(study_.exact.size(), "receiver") + " (" +
             html(study_.request.receivers_name) + "), source " + html(source_names(study_)) + ", " +
             counted(study_.settings.size(), "setting") + " of the ray-sampled algorithm.</p>\n";
  }

  void question_and_answer() {
    text_ += paragraph(
        "<strong>The question.</strong> How much light a point receives from a polygonal source depends on the part of "
        "the source that it sees. Tampieri’s adaptive algorithm (1992) finds that part by shadow rays, dividing "
        "the source until a tolerance ε_B is met. This page holds its results against the exact ones: how large is the "
        "true error, how often is the tolerance broken, and what does each answer cost?");
    text_ += "<p><strong>The answer.</strong></p>\n<ul class=\"answer\">\n";
    for (const std::string& sentence : headlines(study_)) text_ += "<li>" + prose(html(sentence)) + "</li>\n";
    text_ += "</ul>\n";
  }

  void tile(const std::string& number, const std::string& words) {
    text_ += "<div class=\"tile\"><b>" + number + "</b><span>" + prose(words) + "</span></div>\n";
  }

  void tiles() {
    const Summary& base = study_.summaries[study_.base];
    const double exact = partly() ? study_.exact_time.median_partly : study_.exact_time.median;
    const TimeSummary& base_time = study_.times[study_.base];
    const std::string where = partly() ? ", source partly hidden" : "";
    text_ += "<div class=\"tiles\">\n";
    tile(duration(exact), "exact, per receiver" + where + " (median)");
    tile(duration(partly() ? base_time.median_partly : base_time.median),
         "sampled at the base setting, per receiver" + where + " (median)");
    tile(share(base.violations, study_.exact.size()), "of receivers off by more than ε_B at the base setting");
    tile(rounded(base.radiosity.rms),
         "RMS error there (radiosity); the tolerance is " + rounded(study_.settings[study_.base].eps_b));
    text_ += "</div>\n";
  }

  void figures() {
    text_ += heading("Figures");
    if (!page_.drawn.none.empty()) text_ += paragraph(html(page_.drawn.none));
    figure_group(false);
    figure_group(true);
  }

  void figure_group(bool maps) {
    std::string group;
    for (const DrawnFigure& drawn : page_.drawn.figures) {
      if (drawn.figure.map != maps || drawn.svg.empty()) continue;
      group += "<figure id=\"" + drawn.figure.id + "\">\n<h3>" + prose(html(drawn.figure.title)) + "</h3>\n" +
               drawn.svg + "\n<figcaption>" + prose(drawn.figure.caption) + "</figcaption>\n</figure>\n";
    }
    if (group.empty()) return;
    if (maps) text_ += heading("Over the grid of receivers");
    text_ += std::string("<div class=\"figures") + (maps ? " maps" : "") + "\">\n" + group + "</div>\n";
  }

  void cell(const std::string& text, bool words = false) {
    text_ += std::string("<td") + (words ? " class=\"text\"" : "") + ">" + text + "</td>";
  }

  void table() {
    text_ += heading("Every setting");
    text_ += paragraph(
        "Errors are in radiosity, approximate minus exact, over all receivers. The marked row is the base setting, "
        "through which the sweeps run. “Off” is the share of receivers whose error exceeds ε_B; “silent” counts leaves "
        "whose rays all agreed and were wrong in part. Times are per receiver" +
        std::string(partly() ? ", the last column over the receivers that see the source partly hidden." : "."));
    text_ += "<div class=\"wide\"><table>\n<thead><tr>";
    for (const char* name : {"#", "ε_B", "rays"}) column(name);
    column("pattern", true);
    for (const char* name : {"ε_A", "seed"}) column(name);
    column("variant", true);
    for (const char* name : {"RMS", "mean", "p99", "worst", "off", "leaves", "rays traced", "silent", "median time"}) {
      column(name);
    }
    if (partly()) column("median, partly hidden");
    text_ += "</tr></thead>\n<tbody>\n";
    exact_row();
    for (std::size_t k = 0; k < study_.settings.size(); ++k) setting_row(k);
    text_ += "</tbody></table></div>\n";
  }

  void column(const std::string& name, bool words = false) {
    text_ += std::string("<th") + (words ? " class=\"text\"" : "") + ">" + prose(name) + "</th>";
  }

  void exact_row() {
    text_ +=
        "<tr class=\"exact\"><td></td><td class=\"text\" "
        "colspan=\"6\">exact</td><td>0</td><td>0</td><td>0</td><td>0</td>"
        "<td>0 %</td><td></td><td></td><td></td>";
    times(study_.exact_time);
    text_ += "</tr>\n";
  }

  void times(const TimeSummary& t) {
    cell(duration(t.median));
    if (partly()) cell(duration(t.median_partly));
  }

  void setting_row(std::size_t k) {
    const AdaptiveOptions& s = study_.settings[k];
    const Summary& summary = study_.summaries[k];
    text_ += k == study_.base ? "<tr class=\"base\">" : "<tr>";
    cell(std::to_string(k + 1));
    cell(rounded(s.eps_b));
    cell(std::to_string(s.rays));
    cell(std::string(name_of(s.pattern)), true);
    cell(rounded(s.eps_a));
    cell(std::to_string(s.seed));
    cell(std::string(name_of(s.variant)), true);
    for (double value :
         {summary.radiosity.rms, summary.radiosity.mean, summary.radiosity.p99, summary.radiosity.worst}) {
      cell(signed_number(value));
    }
    cell(share(summary.violations, study_.exact.size()));
    cell(std::to_string(summary.leaves));
    cell(std::to_string(summary.rays));
    cell(std::to_string(summary.silent_leaves));
    times(study_.times[k]);
    text_ += "</tr>\n";
  }

  static std::string signed_number(double value) { return value < 0.0 ? "−" + rounded(-value) : rounded(value); }

  void left_out() {
    if (page_.left_out.empty()) return;
    text_ += heading("Left out, and why") + "<ul>\n";
    for (const LeftOut& item : page_.left_out) {
      text_ += "<li>" + prose(html(item.what) + ": " + html(item.why)) + ".</li>\n";
    }
    text_ += "</ul>\n";
  }

  void define(const std::string& term, const std::string& meaning) {
    text_ += "<dt>" + prose(term) + "</dt><dd>" + prose(meaning) + "</dd>\n";
  }

  void definitions() {
    text_ += heading("What the words mean") + "<dl>\n";
    define("Form factor F",
           "The integral of cos θ_r cos θ_s / (π r²) over the part of the source that is visible from the "
           "receiving point: a pure number between 0 and 1.");
    define("Exact",
           "The visible part is found in rational arithmetic without any tolerance, its boundary is integrated with "
           "proved "
           "bounds, and the value is the true F rounded once to the nearest double.");
    define("Radiosity",
           "ρ_r B_s F: the receiver’s reflectance times the source’s radiosity times the form factor, summed over the "
           "sources; errors are those of the colour channel where they are largest.");
    define("ε_B, ε_A",
           "The sampled algorithm stops dividing a part of the source when the part could contribute no more than ε_B "
           "(a radiosity), or when its area is at most ε_A.");
    define(
        "Leaf",
        "A part of the source that is not divided further. Its visible fraction is what its shadow rays say, unless a "
        "shaft test decides it for certain.");
    define("Silent error",
           "A leaf whose rays all agreed, so that it was taken as seen whole or hidden whole, although it is partly "
           "visible. Parts below a thousand-millionth of the leaf do not count.");
    define("RMS, mean, p99, worst",
           "Over the receivers: root of the mean square; the mean with its sign; the magnitude that at least "
           "99 % of the receivers do not exceed (nearest rank); the largest magnitude.");
    define("Mended and literal",
           "The literal variant follows the published listing, which drops receivers at a right angle to the "
           "source, has no horizon clip and works in single precision. The mended one does not.");
    text_ += "</dl>\n";
  }

  void reproduction() {
    text_ += heading("How to reproduce this page");
    if (!study_.request.command_line.empty()) text_ += "<pre>" + html(study_.request.command_line) + "</pre>\n";
    text_ += facts_table(
        {{"program", program_fact()},
         {"scene", html(study_.request.scene_name) + ", hash " + study_.request.scene->hash()},
         {"settings", study_.full_product ? "every combination of the lists"
                                          : "ε_B × rays, and sweeps of the other parameters through the base setting"},
         {"processor", processor_fact()},
         {"threads", std::to_string(study_.request.threads)},
         {"set up once", "exact method " + duration(study_.exact_setup_seconds) + ", ray structure " +
                             (study_.ray_setup_seconds > 0.0
                                  ? duration(study_.ray_setup_seconds)
                                  : std::string("not built (no candidate list was long enough to need it)")) +
                             "; not part of the times per receiver"},
         {"made", today()}});
    text_ += paragraph(
        "Every value is the same on every run and for any number of threads; times are not. A time is the wall time of "
        "one call on one thread, made after a first call with the same arguments. " +
        threads_sentence());
    text_ += "<p>Beside this page lie:</p>\n<ul>\n";
    for (const Table& table : tables()) {
      text_ += "<li><code>" + std::string(table.file) + "</code>: " + html(table.holds) + "</li>\n";
    }
    text_ += "</ul>\n";
  }

  [[nodiscard]] std::string threads_sentence() const {
    if (study_.request.threads == 1) return "Nothing else of this program ran at the same time.";
    return "Other threads of this program ran at the same time and disturb each other’s times somewhat; "
           "<code>--threads 1</code> "
           "avoids that.";
  }

  const Study& study_;
  const Page& page_;
  std::string text_;
};

}  // namespace

std::string report_page(const Study& study, const Page& page) { return PageWriter(study, page).write(); }

}  // namespace exactff::study
