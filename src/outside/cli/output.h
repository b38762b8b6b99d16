// Small helpers of the commands: words for numbers and faces, tables, files that appear complete or not at all.
#pragma once

#include <algorithm>
#include <filesystem>
#include <iosfwd>
#include <ostream>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "exactff/receiver.h"
#include "exactff/scene.h"
#include "exactff/scene_files.h"
#include "text/escape.h"

namespace exactff::cli {

std::string percent(double share);
std::string pad(const std::string& text, std::size_t width);

// For a terminal.
template <class Named>
std::string shown_name(const Scene& scene, const Named& named) {
  return text::printable(scene.name_of(named));
}

// Writes a file beside `path` and renames it: the file appears complete or not at all. Throws InputError.
void write_whole_file(const std::filesystem::path& path, const std::string& text);

// The same for all of these files: if one cannot be written, none appears.
void write_scene_files(const SceneFiles& scene);

// Throws InputError if the file exists, unless it may be replaced. Pipes and devices may always be written to.
void require_free_file(const std::filesystem::path& path, bool force);

// Throws InputError if the printed text could not be written, for example because the disk is full.
void check_output(std::ostream& out);

// Writes "warning: ..." to stderr for the first 20 warnings, then the number of the others.
void print_warnings(std::span<const Problem> warnings);
// Warnings on receivers that were probably meant to lie on a face.
void print_near_misses(const Scene& scene, std::span<const Receiver> receivers);
// Warnings on faces that lie behind others, which hide everything from them. Of more than 4,096 faces, about that many
// are looked at.
void print_hidden_faces(const Scene& scene);

// Throws InputError unless a result can be written to `folder` (page/output_folder.h).
void check_output_folder(const std::filesystem::path& folder);

enum class Align { kLeft, kRight };

// A table to be read by people: columns as wide as their widest cell, numbers aligned right. Cells wider than a limit
// stick out instead of widening every row.
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
