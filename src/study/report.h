// A report on several studies, and on what is not about one scene.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "exactff/study.h"
#include "study/figures.h"
#include "study/tables.h"

namespace exactff::study {

// A CSV file as text, `#` lines first.
struct TextTable {
  std::string file;
  std::string holds;  // what it holds, in a line
  std::string csv;
};

// What was found apart from any one scene and its receivers.
struct Chapter {
  std::string name;                          // letters, digits and hyphens
  std::string title;                         // a heading
  std::vector<std::string> paragraphs = {};  // what was done and found, plain text that can be quoted
  std::vector<Figure> figures = {};
  std::vector<TextTable> values = {};  // the same bytes on every run
  std::vector<TextTable> times = {};
  std::vector<LeftOut> left_out = {};
};

struct SceneChapter {
  std::string name;   // letters, digits and hyphens: of files and figures; empty in a report on one scene
  std::string title;  // "Cornell box"
  Study study;
};

struct Report {
  std::string title;  // empty: that of its one scene
  std::vector<SceneChapter> scenes;
  std::vector<Chapter> chapters;
  std::string command_line;
  std::vector<LeftOut> left_out;  // scenes and chapters
};

// A chapter as bytes for a journal of this machine, and back; nothing where it is torn.
[[nodiscard]] std::string to_bytes(const Chapter& chapter);
[[nodiscard]] std::optional<Chapter> chapter_of(std::string_view bytes);

// As write(Study): the files of a scene begin with its name and an underscore.
std::vector<std::string> write(const Report& report, const std::filesystem::path& folder, const Hooks& hooks = {});

// What a scene's file is called.
[[nodiscard]] std::string file_name(const SceneChapter& scene, const Table& table);

}  // namespace exactff::study
