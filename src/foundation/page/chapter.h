// A chapter of a report: sentences, figures and tables.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "exactff/progress.h"
#include "page/figure.h"

namespace exactff::page {

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
