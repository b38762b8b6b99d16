// A report on several studies, and on experiments that do not concern one scene: its tables, figures, pictures and
// page.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "exactff/methods.h"
#include "exactff/study.h"
#include "exactff/table.h"
#include "page/chapter.h"

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
  std::vector<page::Chapter> chapters;
  std::string command_line;
  std::string identity;           // a line of the page that says what was asked for ; may be empty
  std::vector<LeftOut> left_out;  // scenes and chapters
};

// As study::write_report, but the files of a scene begin with its name and an underscore.
std::vector<std::string> write(const StudyReport& report, const std::filesystem::path& folder, const Hooks& hooks = {});

// --- tables ---
//
// The tables of a study. Their heads state the scene, the seeds and everything else that the values depend on.

struct StudyTable {
  std::string_view file;   // that of times ends in "timings.csv"; others have the same bytes on every run
  std::string_view holds;  // for the report's list of files
  table::Table (*make)(const Study& study);
  bool (*has_rows)(const Study& study);  // a table without rows is left out
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

// --- the page ---

// What belongs to each scene and each chapter of a report, in their order.
struct Page {
  page::DrawnFigures drawn;
  std::vector<LeftOut> left_out;  // from the study or chapter, and from its figures
  std::optional<Strip> strip = {};
};

struct Pages {
  std::vector<Page> scenes;
  std::vector<Page> chapters;
};

// The report as one HTML page that loads nothing and has no scripts.
[[nodiscard]] std::string report_page(const StudyReport& report, const Pages& pages);

// All figures that are wanted, as HTML; empty if there are none.
using WantsFigure = std::function<bool(const page::Figure& figure)>;
[[nodiscard]] std::string figure_group(const page::DrawnFigures& drawn, const WantsFigure& wants, bool maps = false);
[[nodiscard]] std::string left_out_list(const std::vector<LeftOut>& items);

}  // namespace exactff::report
