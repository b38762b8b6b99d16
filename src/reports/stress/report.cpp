// The report of a stress test: its tables, figures and page.
#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>

#include "files/file.h"
#include "files/parallel.h"
#include "page/gnuplot.h"
#include "page/output_folder.h"
#include "page/page_text.h"
#include "stress/stress.h"
#include "table/rows.h"
#include "text/escape.h"
#include "text/phrases.h"

namespace exactff::stress {
namespace {

using page::Axes;
using page::heading;
using page::HtmlTable;
using page::paragraph;
using page::Points;
using page::Series;
using table::keys;
using table::numbers;
using table::Rows;
using table::Table;
using table::texts;
using text::counted;
using text::counted_of;
using text::html;
using enum HtmlTable::CellKind;

// --- tables ---

constexpr int kPrintedDigits = 30;
constexpr std::optional<double> kNone;

table::Columns stiffness() { return keys("stiffness", table::Type::kNumber); }

table::Head head_of(const Report& report, std::string_view what) {
  table::Head head;
  head.set("about", std::string(what));
  if (!report.unfinished.empty()) head.set("unfinished", report.unfinished);
  return head;
}

void set_tampieri(table::Head& head) {
  head.set("tampieri", "eps_B " + text::shortest(kToleranceShare) + " of the unoccluded form factor, " +
                           std::to_string(kRays) + " jittered rays, seed 1");
}

Table value_table(const Report& report) {
  table::Head head = head_of(report, "every family, stiffness and method");
  head.set("error",
           std::string("|value - truth| / truth; where the truth is 0, |value| over the unoccluded form factor; "
                       "0 below truth_is_good_to; no value where the method refuses the scene"));
  head.set("truth_is_good_to", kTruthIsGoodTo);
  set_tampieri(head);
  table::Columns answers;
  for (const Method method : kMethods) {
    const auto strength = method == Method::kExact ? table::Strength::kCertified : table::Strength::kEstimated;
    const std::string name(short_name_of(method));
    answers.push_back({name + "_value", table::Type::kNumber, "", strength});
    answers.push_back({name + "_error", table::Type::kNumber, "", table::Strength::kEstimated});
  }
  Rows rows("stress values", std::move(head),
            {keys("family"), stiffness(), texts("truth,evidence"), table::flags("agrees"),
             texts("status", table::Strength::kProved), table::counts("precision_bits,occluders,edges"), answers,
             texts("refused_by")});
  for (const FamilyResult& family : report.families) {
    for (const Row& r : family.rows) {
      rows << family.family.name << r.stiffness << r.truth.decimals(kPrintedDigits).value_or(r.truth.midpoint())
           << to_string(family.family.evidence) << r.agrees << exactff::to_string(r.status) << r.precision_bits
           << r.occluders << r.edges;
      std::string refused_by;
      for (const Method method : kMethods) {
        const Answer& answer = r.of(method);
        if (answer.refused) {
          refused_by += (refused_by.empty() ? "" : " ") + std::string(short_name_of(method));
          rows << kNone << kNone;
        } else {
          rows << answer.value << answer.error;
        }
      }
      rows << refused_by;
    }
  }
  return rows.take();
}

Table summary_table(const Report& report) {
  table::Head head =
      head_of(report,
              "the largest stiffness up to which each method's error stays below each threshold; 0: not even once; "
              "stiffnesses are tried in steps (see values.csv); each number is the last one tried");
  set_tampieri(head);
  Rows rows("stress summary", std::move(head),
            {keys("family,method"), keys("threshold", table::Type::kNumber),
             numbers("usable_up_to,largest_tried", table::Strength::kEstimated)});
  for (const FamilyResult& family : report.families) {
    for (const Method method : kMethods) {
      for (const double threshold : kThresholds) {
        rows << family.family.name << short_name_of(method) << threshold << usable_up_to(family, method, threshold)
             << family.rows.back().stiffness;
      }
    }
  }
  return rows.take();
}

Table timing_table(const Report& report) {
  std::string names;
  for (const Method method : kMethods) names += std::string(short_name_of(method)) + "_seconds,";
  Rows rows("stress timings", head_of(report, "median seconds of one call, preprocessing apart"),
            {keys("family"), stiffness(), numbers(names, table::Strength::kEstimated, "s")});
  for (const FamilyResult& family : report.families) {
    for (const Row& r : family.rows) {
      rows << family.family.name << r.stiffness;
      for (const Method method : kMethods) rows << r.of(method).seconds;
    }
  }
  return rows.take();
}

// --- headlines ---

struct Tally {
  std::size_t independent = 0;  // compared with a closed form or a symmetry
  std::size_t agreeing = 0;     // of these
  std::size_t certified = 0;    // compared with the exact method's own enclosure
  int most_bits = 0;
  double smallest = std::numeric_limits<double>::infinity();  // smallest positive form factor with an independent truth
};

Tally tally(const Report& report) {
  Tally t;
  for (const FamilyResult& family : report.families) {
    const bool independent = family.family.evidence != Evidence::kCertified;
    for (const Row& row : family.rows) {
      ++(independent ? t.independent : t.certified);
      t.most_bits = std::max(t.most_bits, row.precision_bits);
      if (!independent) continue;
      t.agreeing += row.agrees ? 1U : 0U;
      const double value = row.of(Method::kExact).value;
      if (value > 0.0) t.smallest = std::min(t.smallest, value);
    }
  }
  return t;
}

std::string exact_sentence(const Report& report) {
  const Tally t = tally(report);
  std::string text;
  if (t.independent > 0) {
    text = "The exact value agrees with an independent closed form or symmetry, rounded to a double, in " +
           counted_of(t.agreeing, t.independent, "scene");
    if (std::isfinite(t.smallest)) text += ", down to a form factor of " + text::rounded(t.smallest, 2);
    text += t.certified > 0 ? "; " : ". ";
  }
  if (t.certified > 0) {
    text += (text.empty() ? "In " : "in ") + counted(t.certified, "scene") +
            " no independent value exists; there it is compared with its own enclosure at higher precision. ";
  }
  if (t.most_bits > 0) text += "The proof needed at most " + std::to_string(t.most_bits) + " bits.";
  return text;
}

bool to_the_end(const FamilyResult& family, Method method, double threshold) {
  return usable_up_to(family, method, threshold) == family.rows.back().stiffness;
}

std::size_t families_kept(const Report& report, Method method, double threshold) {
  return static_cast<std::size_t>(
      std::count_if(report.families.begin(), report.families.end(),
                    [&](const FamilyResult& family) { return to_the_end(family, method, threshold); }));
}

std::size_t refusals(const Report& report, Method method) {
  std::size_t count = 0;
  for (const FamilyResult& family : report.families) {
    count += static_cast<std::size_t>(
        std::count_if(family.rows.begin(), family.rows.end(), [&](const Row& row) { return row.of(method).refused; }));
  }
  return count;
}

std::string thresholds_kept(const Report& report, Method method) {
  return " keeps its error below 10⁻³ to the end in " + std::to_string(families_kept(report, method, kThresholds[0])) +
         " of " + counted(report.families.size(), "family", "families") + ", below 10⁻⁶ in " +
         std::to_string(families_kept(report, method, kThresholds[1])) + " and below 10⁻¹² in " +
         std::to_string(families_kept(report, method, kThresholds[2]));
}

std::string tolerance_kept(const Report& report, Method method) {
  const auto kept = std::count_if(report.families.begin(), report.families.end(), [&](const FamilyResult& family) {
    return kept_up_to(family, method) == family.rows.back().stiffness;
  });
  return " keeps the tolerance that it was given (" + text::rounded(kToleranceShare) +
         " of the unoccluded form factor) to the end in " + std::to_string(kept) + " of " +
         counted(report.families.size(), "family", "families");
}

std::string method_sentence(const Report& report, Method method) {
  std::string text = std::string(name_of(method)) +
                     (has_tolerance(method) ? tolerance_kept(report, method) : thresholds_kept(report, method));
  if (const std::size_t refused = refusals(report, method); refused > 0) {
    text += "; it refuses " + counted(refused, "scene") + " because single precision would merge corners";
  }
  return text + '.';
}

// --- figures ---

// Errors outside this range are drawn at its ends.
constexpr double kSmallestDrawn = 1e-18;
constexpr double kLargestDrawn = 1e3;

// Indexed by Method.
struct LineLook {
  const char* label;
  int style;
};
constexpr std::array<LineLook, kMethodCount> kLooks = {
    {{"exact", 1}, {"acos", 2}, {"atan2", 3}, {"a×(b−a)", page::kOverlay}, {"Tampieri", 5}, {"as printed", 6}}};

// Up to 10^16 a decade is one unit of the axis, beyond it 1/18 of a unit, so that both ends are readable.
constexpr double kBend = 16.0;
constexpr double kBeyond = 18.0;

double position(double stiffness) {
  const double decade = std::log10(stiffness);
  return decade <= kBend ? decade : kBend + (decade - kBend) / kBeyond;
}

std::string tic_commands(double largest) {
  std::string marks;
  const auto mark = [&](int decade) {
    const std::string label = decade == 0 ? "1" : decade == 1 ? "10" : "10^{" + std::to_string(decade) + "}";
    marks += (marks.empty() ? "'" : ", '") + label + "' " +
             text::shortest(position(std::stod("1e" + std::to_string(decade))));
  };
  const int last = static_cast<int>(std::log10(largest));
  const int step = last < 6 ? 1 : 4;
  for (int decade = 0; decade <= std::min(last, static_cast<int>(kBend)); decade += step) mark(decade);
  for (int decade = 100; decade <= last; decade += 100) mark(decade);
  return "set xtics (" + marks + ')';
}

Points points(const FamilyResult& result, const std::function<double(const Row&)>& y) {
  Points list;
  for (const Row& row : result.rows) list.emplace_back(position(row.stiffness), y(row));
  return list;
}

Series series_of(const FamilyResult& result, Method method, const std::function<double(const Answer&)>& y) {
  const LineLook& look = kLooks[static_cast<std::size_t>(method)];
  return {look.label, points(result, [&](const Row& row) { return y(row.of(method)); }), look.style};
}

// An answer that is refused or not a number is not drawn.
double drawn_error(const Answer& answer) {
  return std::isfinite(answer.error) ? std::clamp(answer.error, kSmallestDrawn, kLargestDrawn) : -1.0;
}

double microseconds(const Answer& answer) { return 1e6 * answer.seconds; }

Axes axes(const FamilyResult& result, const char* y) {
  const double largest = result.rows.back().stiffness;
  Axes a{.x = "stiffness: " + std::string(result.family.stiffness), .y = y, .log_x = false};
  a.extra.push_back(tic_commands(largest));
  a.extra.push_back("set xrange [-0.3:" + text::shortest(position(largest) + 0.3) + ']');
  return a;
}

page::Figure error_figure(const FamilyResult& result) {
  Axes a = axes(result, "relative error");
  a.extra.emplace_back("set yrange [3e-19:3e3]");
  a.extra.emplace_back("set ytics 1e-18,1e3");
  a.extra.emplace_back("unset mytics");
  std::vector<Series> series;
  for (Method method : kMethods) series.push_back(series_of(result, method, drawn_error));
  return {std::string(result.family.name) + ".error", "Error", "", line_plot(a, series)};
}

page::Figure precision_figure(const FamilyResult& result) {
  Axes a = axes(result, "bits of the certified sum");
  a.log_y = false;
  a.extra.emplace_back("set yrange [0:*]");
  a.extra.emplace_back("unset key");
  const Points bits = points(result, [](const Row& row) { return static_cast<double>(row.precision_bits); });
  return {std::string(result.family.name) + ".bits", "Precision that the proof needed", "",
          line_plot(a, {{"", bits, 1}})};
}

page::Figure time_figure(const FamilyResult& result) {
  const Axes a = axes(result, "time per value, µs");
  std::vector<Series> series;
  for (Method method : {Method::kExact, Method::kAtan2Difference, Method::kAdaptive, Method::kAdaptiveLiteral}) {
    series.push_back(series_of(result, method, microseconds));
  }
  return {std::string(result.family.name) + ".time", "Time", "", line_plot(a, series)};
}

// Where the precision that the proof needed never changes, a sentence says so instead of a figure.
bool precision_changes(const FamilyResult& result) {
  return std::ranges::adjacent_find(result.rows, std::not_equal_to<>{}, &Row::precision_bits) != result.rows.end();
}

// --- the page ---

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
        "Each family opens to its figures; values.csv has every value. Stiffness grows in steps, above 10<sup>16</sup> "
        "in steps of "
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
    if (const int bits = result.rows.front().precision_bits; bits > 0 && !precision_changes(result)) {
      content += paragraph("The proof needed " + std::to_string(bits) + " bits in every scene.");
    }
    content += "</div>\n";
    const bool agrees = std::ranges::all_of(result.rows, &Row::agrees);
    text_ += page::fold(html(family.title) + (agrees ? "" : ": <b>disagrees with the truth</b>"), content);
  }

  [[nodiscard]] std::string figures(const FamilyInfo& family) const {
    std::string group;
    for (const auto& [figure, svg] : drawn_.figures) {
      if (!figure.id.starts_with(std::string(family.name) + '.')) continue;
      group += "<figure id=\"" + figure.id + "\">\n<h3>" + html(figure.title) + "</h3>\n" + svg + "\n</figure>\n";
    }
    return group.empty() ? group : "<div class=\"figures maps\">\n" + group + "</div>\n";
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

// --- files ---

void write_tables(const Report& report, const std::filesystem::path& folder) {
  for (const StressTable& table : tables()) {
    table::write(table.make(report), folder / table.file);
  }
}

void write_page(const Report& report, const page::DrawnFigures& drawn, const std::filesystem::path& folder) {
  files::write_file(folder / page::kReportFile, [&](std::ostream& out) { out << report_page(report, drawn); });
}

}  // namespace

const std::array<StressTable, 3>& tables() {
  static const std::array<StressTable, 3> list = {
      {{"summary.csv", "the stiffness up to which each method stays below each error", summary_table},
       {"values.csv", "every value and error, the truth to 30 digits, the bits needed", value_table},
       {"timings.csv", "times of single calls", timing_table}}};
  return list;
}

std::vector<std::string> headlines(const Report& report) {
  std::vector<std::string> sentences = {exact_sentence(report)};
  for (Method method : kMethods) {
    if (method != Method::kExact) sentences.push_back(method_sentence(report, method));
  }
  return sentences;
}

std::vector<page::Figure> figures(const FamilyResult& result) {
  if (!precision_changes(result)) return {error_figure(result), time_figure(result)};
  return {error_figure(result), precision_figure(result), time_figure(result)};
}

std::string report_page(const Report& report, const page::DrawnFigures& drawn) {
  return PageWriter(report, drawn).write();
}

std::filesystem::path part_of(const std::filesystem::path& folder) {
  const std::filesystem::path named = folder.has_filename() ? folder : folder.parent_path();  // DIR/ is DIR
  return named.string() + ".part";
}

void write_part(const Report& report, const std::filesystem::path& folder) {
  page::StagedFolder staged(part_of(folder));
  page::DrawnFigures drawn;
  drawn.none = "There are no figures, because the run was interrupted.";
  write_tables(report, staged.path());
  write_page(report, drawn, staged.path());
  staged.commit();
}

std::vector<std::string> write(const Report& report, const std::filesystem::path& folder, const Hooks& hooks) {
  page::StagedFolder staged(folder);
  std::vector<std::string> messages;
  files::require_not_cancelled(hooks);
  write_tables(report, staged.path());
  std::vector<page::Figure> wanted;
  for (const FamilyResult& family : report.families) {
    std::vector<page::Figure> some = figures(family);
    std::move(some.begin(), some.end(), std::back_inserter(wanted));
  }
  const page::DrawnFigures drawn = page::draw_figures(std::move(wanted), staged.path(), messages, hooks);
  write_page(report, drawn, staged.path());
  files::require_not_cancelled(hooks);
  staged.commit();
  page::remove_result(part_of(folder));
  return messages;
}

}  // namespace exactff::stress
