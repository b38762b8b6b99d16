// The lines and words of OBJ and MTL files, and a list that collects their problems.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "exactff/error.h"

namespace exactff::text {

// A line without comment and outer blanks; lines that end in a backslash are joined with the next by a blank.
struct TextLine {
  std::size_t number = 0;  // of its first physical line, from 1
  std::string_view text;   // valid until the next call
};

// Reads lines that end in LF, CRLF, CR or the end of the text. A comment starts with a '#' at the start of a word
// and ends with its line, backslash or not. A UTF-8 byte order mark at the start is skipped.
class TextLines {
 public:
  explicit TextLines(std::string_view text);
  bool next(TextLine& line);
  // After all lines are read: true if the last line is not blank and lacks its line end.
  bool is_cut_off() const { return cut_off_; }

 private:
  std::string_view take_physical();

  std::string_view rest_;
  std::size_t number_ = 0;  // of the last physical line taken
  bool cut_off_ = false;
  std::string joined_;
};

std::string_view trimmed(std::string_view text);
// Removes and returns the first word; empty if there is none.
std::string_view take_word(std::string_view& text);
std::vector<std::string_view> words(std::string_view text);

// At most the first `shown` bytes in quotes, unprintable ones replaced.
std::string in_quotes(std::string_view text, std::size_t shown = 40);

inline constexpr std::size_t kShownName = 200;  // bytes of a name that a user may want to copy

// Every problem of a file in file order; beyond a cap they are only counted, so that memory stays bounded.
class ProblemList {
 public:
  static constexpr std::size_t kKept = 1000;

  void add(Problem problem);
  bool empty() const { return problems_.empty(); }
  bool full() const { return problems_.size() == kKept; }
  void count_dropped() { ++dropped_; }  // as add() does once the list is full
  // Throws an InputError if there are any.
  void throw_if_any();
  // Returns all of them; the last one gives the number dropped, called `noun`.
  std::vector<Problem> take(const std::string& noun);

 private:
  std::vector<Problem> problems_;
  std::size_t dropped_ = 0;
};

}  // namespace exactff::text
