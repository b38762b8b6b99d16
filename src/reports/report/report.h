// A report on several studies, and on experiments that do not concern one scene.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "page/chapter.h"
#include "report/strip.h"
#include "report/studies.h"
#include "report/tables.h"

namespace exactff::report {

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
  std::string identity;           // of the plan (identity.h); empty if there is none
  std::vector<LeftOut> left_out;  // scenes and chapters
};

// As study::write_report, but the files of a scene begin with its name and an underscore.
std::vector<std::string> write(const StudyReport& report, const std::filesystem::path& folder, const Hooks& hooks = {});

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

// The file name of a scene's table.
[[nodiscard]] std::string file_name(const SceneChapter& scene, const StudyTable& table);

}  // namespace exactff::report
