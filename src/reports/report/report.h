// A report on several studies: its tables, figures, pictures and page.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "exactff/methods.h"
#include "exactff/study.h"
#include "exactff/table.h"
#include "page/gnuplot.h"

namespace exactff::report {

// Reports read studies, and use their names without the namespace.
using study::ErrorStatistics;
using study::ExactRow;
using study::ExactTerm;
using study::Ladder;
using study::MethodCell;
using study::MethodField;
using study::MethodStudy;
using study::Profile;
using study::SampleRow;
using study::Sight;
using study::Slope;
using study::Study;
using study::Summary;
using study::Sweeps;
using study::TimeSummary;

struct SceneChapter {
  std::string name;   // letters, digits and hyphens: used for files and figures; empty in a report on one scene
  std::string title;  // "Cornell box"
  Study study;
};

struct StudyReport {
  std::string title;  // empty: the title of the only scene
  std::vector<SceneChapter> scenes;
  std::string command_line;
  std::string identity;  // a line of the page that says what was asked for; may be empty
};

// As study::write_report, but the files of a scene begin with its name and an underscore.
std::vector<std::string> write(const StudyReport& report, const std::filesystem::path& folder, const Hooks& hooks = {});

// --- tables ---
//
// The tables of a study. Their heads state the scene, the seeds and everything else that the values depend on.

struct StudyTable {
  std::string_view file;   // that of times ends in "timings.csv"; others have the same bytes on every run
  std::string_view holds;  // for the report's list of files
  table::Table (*fill)(const Study& study, table::Head head);
  bool (*has_rows)(const Study& study);  // a table without rows is left out

  [[nodiscard]] table::Table make(const Study& study) const;
};

// In the order of the report's list.
[[nodiscard]] const std::vector<StudyTable>& tables();

// The file name of a scene's table.
[[nodiscard]] std::string file_name(const SceneChapter& scene, const StudyTable& table);

// "light" or "lamp + window".
[[nodiscard]] std::string source_names(const Study& study);
// What --flip and --transparent have changed; often empty.
[[nodiscard]] std::string flipped_names(const Study& study);
[[nodiscard]] std::string transparent_names(const Study& study);

// Writes the exact values, and the value and the error of each setting that was run at every receiver, for ParaView
// (vtk::write): the settings of the adaptive algorithm, and of each method that of MethodField.
void write_vtk(const Study& study, const std::filesystem::path& file, const Hooks& hooks = {});

// --- figures and pictures ---

// The figures as gnuplot scripts that contain their data. Returns only those that the study has data for. The
// missing ones are added to `left_out`.
[[nodiscard]] std::vector<page::Figure> figures(const Study& study, std::vector<LeftOut>& left_out);

// The pictures at the head of a scene's chapter, side by side, as PNG files: the scene under its direct light, exact
// and by a method, and the method's errors. No byte depends on a clock or the number of threads.
struct Strip {
  std::string exact, method, error;
  std::string method_name;
  bool is_base = false;  // the base setting of the sweeps
  std::string camera;    // as flags of exactff compare
  std::string outlined;  // the patches of the receivers; empty if they are not in the picture
  double scale = 0.0;    // the error of full colour, relative to the brightest pixel
  double rms = 0.0;      // relative to the brightest pixel
  double wrong = 0.0;    // share of the pixels that are wrong by over 10 %
};

// What the maps and the strip of a study show: the base setting of the sweeps, else the middle setting of the first
// method that is not exact. Nothing if the study has neither.
struct Shown {
  std::string title, name;
  methods::Choice choice;
  std::vector<double> errors;  // in radiosity, by receiver
};
[[nodiscard]] std::optional<Shown> shown_method(const Study& study);

// Renders the scene for about a second at most, by fixed prices of counted work: dear scenes get smaller pictures, and
// too dear ones none. Nothing is returned, and the reason added to `left_out`, if there is no picture. Call it after
// all times have been measured. Throws Cancelled.
[[nodiscard]] std::optional<Strip> strip_of(const Study& study, std::vector<LeftOut>& left_out, const Hooks& hooks);

// A picture of one receiver's view of one source, as a self-contained SVG document: each plane of the source as seen
// from x, the projected occluders, the exact visible region. With `sampled`, it shows the leaves in its leaf_list.
// Leaves that are not in the list, and planes that x does not face, are left out, with a note.
[[nodiscard]] std::string visibility_svg(const Scene& scene, const Receiver& receiver, const ExactSource& source,
                                         const FormFactor& result, const AdaptiveResult* sampled = nullptr);

// --- the page ---

// What belongs to a scene of a report.
struct Page {
  page::DrawnFigures drawn;
  std::vector<LeftOut> left_out;  // from the study, and from its figures
  std::optional<Strip> strip = {};
};

// The report as one HTML page that loads nothing and has no scripts. `pages`: of the scenes, in their order.
[[nodiscard]] std::string report_page(const StudyReport& report, const std::vector<Page>& pages);

// --- Verdicts ---

// Conclusions from the runs of the methods: which is cheapest for a wanted error, and what theory predicts for the
// slopes.
//
// All conclusions are drawn from the same runs, MethodStudy::cells, by the same two numbers: the RMS error over the
// chosen receivers and seeds, divided by the radiosity of the brightest receiver, and the time per receiver for all
// sources, averaged over the chosen receivers.

inline constexpr std::array kWantedErrors = {1e-2, 1e-3, 1e-4, 1e-5, 1e-6};

[[nodiscard]] double relative_error(const Study& study, const MethodCell& cell);
[[nodiscard]] bool is_exact(const Study& study, const MethodCell& cell);
// Null if the exact method is not among the ladders.
[[nodiscard]] const MethodCell* exact_cell(const Study& study);
// That of a setting of the sweeps; null if it was not run at the chosen receivers.
[[nodiscard]] const MethodCell* cell_of_setting(const Study& study, std::size_t setting);

// False for the control, which is given the exact visibilities and so is not a method that anybody could use instead.
[[nodiscard]] bool is_rival(const Study& study, const MethodCell& cell);

// The fastest cell among those with an error of at most `wanted`: of one ladder, or of all rivals of the exact method.
[[nodiscard]] const MethodCell* cheapest(const Study& study, double wanted, std::optional<std::size_t> ladder = {});

// The cell of the ladder with the smallest error; null if none was run.
[[nodiscard]] const MethodCell* most_accurate(const Study& study, std::size_t ladder);

// The cells that no other cell beats in both time and accuracy, by increasing time. Without the control.
[[nodiscard]] std::vector<const MethodCell*> pareto_front(const Study& study);

// "area sampling, stratified, samples 64".
[[nodiscard]] std::string cell_name(const Study& study, const MethodCell& cell);
// "1e-4" in typeset form: "10⁻⁴".
[[nodiscard]] std::string power_of_ten(double value);

// The time of an exact value that a chapter states.
[[nodiscard]] double exact_seconds(const Study& study);

// The rival that a verdict recommends where its error will do: the most accurate of those that are at least as fast as
// the exact method. Null if there is none.
[[nodiscard]] const MethodCell* recommended(const Study& study);

// The main result in a few sentences.
[[nodiscard]] std::vector<std::string> headlines(const Study& study);

// One sentence that says when to use the exact method and when another one.
[[nodiscard]] std::string verdict(const Study& study);

// What the runs of Tampieri's algorithm over its settings show, in sentences; empty without such runs.
[[nodiscard]] std::vector<std::string> sweep_findings(const Study& study);

// Sentences that can be quoted: what other methods need for a similar accuracy, and the verdict; empty without others.
[[nodiscard]] std::vector<std::string> method_sentences(const Study& study);

// Says that the machine's speed drifted while times were measured; empty if it did not.
[[nodiscard]] std::string drift_warning(const Study& study);

// For each method, and each variant of the sweeps: how many values are not finite, and how many lie outside [0, 1] by
// more than rounding. One sentence for each that has any. Values are sums over the sources.
[[nodiscard]] std::vector<std::string> range_sentences(const Study& study);

// Receivers that were probably meant to lie on a face (near_misses), in sentences.
[[nodiscard]] std::vector<std::string> receiver_warnings(const Study& study);

// A fitted slope: "−0.75 (−0.8 to −0.7)"; and the slope that theory expects, if it expects one: "−3/4 with one shadow
// edge across the source".
struct SlopeWords {
  std::string fitted, theory;
};
[[nodiscard]] SlopeWords slope_words(const Slope& slope, const Ladder& ladder, Sight sight);

}  // namespace exactff::report
