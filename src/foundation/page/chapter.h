// A chapter of a report: sentences, figures and tables.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "exactff/jobs.h"

namespace exactff::page {

// --- Figure ---

// A figure of a report: a gnuplot script that contains its data.

struct Figure {
  std::string id;  // unique in the page
  std::string title;
  std::string caption;  // HTML
  std::string script;   // plots one SVG to standard output
  bool map = false;     // a false-colour map over the grid
};

struct DrawnFigure {
  Figure figure;
  std::string svg;
};

struct DrawnFigures {
  std::vector<DrawnFigure> figures;
  std::vector<LeftOut> left_out;  // figures that gnuplot could not draw
  std::string none;               // why there are no figures; empty if there are
};

// Runs gnuplot, with its files in `scratch`. Adds notes for the user to `messages`.
[[nodiscard]] DrawnFigures draw_figures(std::vector<Figure> figures, const std::filesystem::path& scratch,
                                        std::vector<std::string>& messages, const Hooks& hooks);

// --- Chapter ---

// A CSV file as text. The comment lines (#) come first.
struct CsvFile {
  std::string file;
  std::string holds;  // description in one line
  std::string csv;
};

// Numbers that a sentence could not hold. The first column is text. All texts are plain.
struct NumberTable {
  std::string title;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
};

// Results that do not concern one scene and its receivers.
struct Chapter {
  std::string name;                          // letters, digits and hyphens
  std::string title;                         // a heading
  std::vector<std::string> paragraphs = {};  // what was done and found; plain text that can be quoted
  std::vector<NumberTable> tables = {};      // behind the paragraphs
  std::vector<Figure> figures = {};
  std::vector<CsvFile> values = {};  // the same bytes on every run
  std::vector<CsvFile> times = {};
  std::vector<LeftOut> left_out = {};
};

// Converts a chapter to bytes for a journal of this machine, and back. The way back returns nothing if the bytes are
// torn.
[[nodiscard]] std::string to_bytes(Chapter chapter);
[[nodiscard]] std::optional<Chapter> chapter_of(std::string_view bytes);

}  // namespace exactff::page
