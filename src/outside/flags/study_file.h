// The small file that describes a study of several scenes.
//
//   # a comment
//   title Form factors of rooms
//   scene cornell_box.obj --on floor --grid 32x32 --title "Cornell box"
//   scene @karkanis:n=200 --on ... --unless-abridged
//   experiment karkanis-times
//   experiment meshing --unless-abridged
//
// A scene line has the words and flags that `exactff compare` takes for one scene (flags/comparison.h). Files are
// looked up in the folder of the study.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "report/plan.h"

namespace exactff::flags {

[[nodiscard]] bool is_study_file(const std::string& path);  // by its extension, .study

// Reads a .study file (data/README.md) and loads its scenes. Throws one InputError with the line of every problem.
[[nodiscard]] report::Plan read_study_file(const std::filesystem::path& file, const report::Effort& effort = {});

// --- its syntax ---

struct StudyLine {
  std::size_t number = 0;
  std::vector<std::string> words;  // without the keyword
};

struct StudyFile {
  std::string title;
  std::vector<StudyLine> scenes;
  std::vector<StudyLine> experiments;
};

// Throws InputError with everything that is wrong in the syntax of the file. Flags are checked later, by the code that
// parses them.
[[nodiscard]] StudyFile parse_study_file(const std::filesystem::path& path);

// The words of a line. Blanks separate words; "..." or '...' encloses text with blanks. Throws InputError if a quote is
// not closed.
[[nodiscard]] std::vector<std::string> split_words(std::string_view line, const std::string& file, std::size_t number);

}  // namespace exactff::flags
