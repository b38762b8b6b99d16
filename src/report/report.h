// A report on several studies, and on experiments that do not concern one scene.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "page/chapter.h"
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

// Like write(Study), but the files of a scene begin with its name and an underscore.
std::vector<std::string> write(const StudyReport& report, const std::filesystem::path& folder, const Hooks& hooks = {});

// The file name of a scene's table.
[[nodiscard]] std::string file_name(const SceneChapter& scene, const StudyTable& table);

}  // namespace exactff::report
