// Pieces of HTML that all reports use.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
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

// A part that readers open if they want it: closed on a screen, open in print. `title` and `content` are HTML; empty if
// there is no content. An id in the content is found by links even while the part is closed.
[[nodiscard]] std::string fold(const std::string& title, const std::string& content);

// The source of an <img>: a PNG file inside the page.
[[nodiscard]] std::string png_source(std::string_view png);

// Pairs of a name and its description (HTML).
using Facts = std::vector<std::pair<std::string, std::string>>;
[[nodiscard]] std::string facts_table(const Facts& facts);

// A table, written from left to right and from top to bottom: first its columns, then row after row. All texts are
// HTML; headings have no tags.
class HtmlTable {
 public:
  enum class CellKind { kNumber, kText };
  // kNarrow: fits on a phone. kWide: a phone shows each row as a card, each number behind the heading of its column.
  enum class Shape { kNarrow, kWide };

  explicit HtmlTable(Shape shape = Shape::kNarrow);
  void column(const std::string& heading, CellKind kind = CellKind::kNumber);
  void columns(std::initializer_list<const char*> headings) {
    for (const char* heading : headings) column(heading);
  }
  void row(const std::string& name = {});  // begins the next one
  void cell(const std::string& content, CellKind kind = CellKind::kNumber, int span = 1);
  void cells(std::initializer_list<std::string> contents) {
    for (const std::string& content : contents) cell(content);
  }
  [[nodiscard]] std::string text() const;  // without a line end after it

 private:
  Shape shape_;
  std::string text_;
  bool in_head_ = true;
  std::vector<std::string> headings_;
  std::size_t column_ = 0;  // of the next cell
};

// Facts about this program and this machine.
[[nodiscard]] std::string program_fact();    // version, compiler, kind of build
[[nodiscard]] std::string processor_fact();  // its name, hardware threads
[[nodiscard]] std::string today();           // date and time, UTC

}  // namespace exactff::page
