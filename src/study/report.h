// A report on several studies, and on experiments that do not concern one scene.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "exactff/study.h"
#include "study/figures.h"
#include "study/tables.h"

namespace exactff::study {

// A CSV file as text. The comment lines (#) come first.
struct TextTable {
  std::string file;
  std::string holds;  // description in one line
  std::string csv;
};

// Results that do not concern one scene and its receivers.
struct Chapter {
  std::string name;                          // letters, digits and hyphens
  std::string title;                         // a heading
  std::vector<std::string> paragraphs = {};  // what was done and found; plain text that can be quoted
  std::vector<Figure> figures = {};
  std::vector<TextTable> values = {};  // the same bytes on every run
  std::vector<TextTable> times = {};
  std::vector<LeftOut> left_out = {};
};

struct SceneChapter {
  std::string name;   // letters, digits and hyphens: used for files and figures; empty in a report on one scene
  std::string title;  // "Cornell box"
  Study study;
};

struct Report {
  std::string title;  // empty: the title of the only scene
  std::vector<SceneChapter> scenes;
  std::vector<Chapter> chapters;
  std::string command_line;
  std::vector<LeftOut> left_out;  // scenes and chapters
};

// Converts a chapter to bytes for a journal of this machine, and back. The way back returns nothing if the bytes are
// torn.
[[nodiscard]] std::string to_bytes(const Chapter& chapter);
[[nodiscard]] std::optional<Chapter> chapter_of(std::string_view bytes);

// Like write(Study), but the files of a scene begin with its name and an underscore.
std::vector<std::string> write(const Report& report, const std::filesystem::path& folder, const Hooks& hooks = {});

// The file name of a scene's table.
[[nodiscard]] std::string file_name(const SceneChapter& scene, const Table& table);

}  // namespace exactff::study
