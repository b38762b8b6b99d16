// Pieces of HTML that all reports use.
#pragma once

#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

namespace exactff::page {

// The page up to its first words, and what follows its last words. `title` is HTML.
[[nodiscard]] std::string page_head(const std::string& title);
[[nodiscard]] std::string page_end();

// Typesets running text: symbols get their subscripts, and units stay on the line of their numbers.
[[nodiscard]] std::string prose(std::string text);
[[nodiscard]] std::string paragraph(const std::string& html);
[[nodiscard]] std::string heading(const std::string& html);

// Pairs of a name and its description (HTML).
using Facts = std::vector<std::pair<std::string, std::string>>;
[[nodiscard]] std::string facts_table(const Facts& facts);

// A table, written from left to right and from top to bottom: first its columns, then row after row. All texts are
// HTML.
class HtmlTable {
 public:
  enum class Kind { kNumber, kText };

  explicit HtmlTable(const std::string& name = {});
  void column(const std::string& heading, Kind kind = Kind::kNumber);
  void columns(std::initializer_list<const char*> headings) {
    for (const char* heading : headings) column(heading);
  }
  void row(const std::string& name = {});  // begins the next one
  void cell(const std::string& content, Kind kind = Kind::kNumber, int span = 1);
  void cells(std::initializer_list<std::string> contents) {
    for (const std::string& content : contents) cell(content);
  }
  [[nodiscard]] std::string text() const;  // without a line end after it

 private:
  std::string text_;
  bool in_head_ = true;
};

// Facts about this program and this machine.
[[nodiscard]] std::string program_fact();    // version, compiler, kind of build
[[nodiscard]] std::string processor_fact();  // its name, hardware threads
[[nodiscard]] std::string today();           // date and time, UTC

}  // namespace exactff::page
