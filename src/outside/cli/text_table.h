// A table to be read by people: columns as wide as their widest cell, numbers aligned right. Cells wider than a limit
// stick out instead of widening every row.
#pragma once

#include <algorithm>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "text/escape.h"

namespace exactff::cli {

enum class Align { kLeft, kRight };

class TextTable {
 public:
  void add_column(std::string title, Align align = Align::kLeft) {
    titles_.push_back(std::move(title));
    aligns_.push_back(align);
  }
  // One cell per column.
  void add_row(std::vector<std::string> cells) {
    for (std::string& cell : cells) cell = text::printable(cell);
    rows_.push_back(std::move(cells));
  }

  void print(std::ostream& out) const {
    std::vector<std::size_t> widths(titles_.size());
    widen(widths, titles_);
    for (const auto& row : rows_) widen(widths, row);
    print_row(out, widths, titles_);
    for (const auto& row : rows_) print_row(out, widths, row);
  }

 private:
  static constexpr std::size_t kWidest = 80;

  // Counts the bytes that begin a UTF-8 character.
  static std::size_t width(const std::string& text) {
    return static_cast<std::size_t>(std::count_if(
        text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
  }

  static void widen(std::vector<std::size_t>& widths, const std::vector<std::string>& cells) {
    for (std::size_t i = 0; i < widths.size(); ++i) widths[i] = std::max(widths[i], std::min(width(cells[i]), kWidest));
  }

  void print_row(std::ostream& out, const std::vector<std::size_t>& widths,
                 const std::vector<std::string>& cells) const {
    std::string line;
    for (std::size_t i = 0; i < widths.size(); ++i) {
      const std::size_t taken = width(cells[i]);
      const std::string blanks(widths[i] > taken ? widths[i] - taken : 0, ' ');
      line += aligns_[i] == Align::kLeft ? cells[i] + blanks : blanks + cells[i];
      line += "  ";
    }
    line.erase(line.find_last_not_of(' ') + 1);
    out << line << '\n';
  }

  std::vector<std::string> titles_;
  std::vector<Align> aligns_;
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace exactff::cli
