// Files of text: read as a whole or refused with the reason, their lines and words, and a list of their problems.
#pragma once

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <istream>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "exactff/error.h"

namespace exactff::text {

struct TextLine {
  std::size_t number = 0;  // from 1
  std::string_view text;   // valid until the next call
};

// Reads physical lines, which end in LF, CRLF, CR or the end of the text. Removes only the line ends, and a UTF-8 byte
// order mark at the start.
class PlainLines {
 public:
  // `lines_before` lines of the file precede the text.
  explicit PlainLines(std::string_view text, std::size_t lines_before = 0);
  bool next(TextLine& line);
  // True if the last line read is not blank and lacks its line end.
  bool is_cut_off() const { return cut_off_; }
  std::size_t bytes_left() const { return text_.size() - std::min(at_, text_.size()); }

 private:
  std::string_view text_;
  std::size_t at_ = 0;
  std::size_t next_feed_;  // positions of the next LF and CR, at_ or later: each is searched for once
  std::size_t next_return_;
  std::size_t number_;
  bool cut_off_ = false;
};

// Reads the lines of OBJ and MTL files without comments and outer blanks. A line that ends in a backslash is joined
// with the next by a blank; its number is that of the first. A comment starts with a '#' at the start of a word and
// ends with its physical line, backslash or not.
class TextLines {
 public:
  explicit TextLines(std::string_view text) : lines_(text) {}
  bool next(TextLine& line);
  // After all lines are read: true if the last line is not blank and lacks its line end.
  bool is_cut_off() const { return lines_.is_cut_off(); }

 private:
  bool take_physical(TextLine& line);

  PlainLines lines_;
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

// --- Text file ---

// Input files, read as a whole or refused with the reason.

// Throws InputError if the file does not exist, is a directory, cannot be read to its end, or contains NUL bytes
// (binary data, UTF-16, a device that never ends). `purpose` completes "give ...": "a Wavefront OBJ file".
[[nodiscard]] std::string read_text_file(const std::filesystem::path& path, const std::string& purpose);

// The same from an open stream, called `file` in messages.
[[nodiscard]] std::string read_text(std::istream& in, const std::string& file, const std::string& purpose);

// The same for a file that may be binary. A device is read only if it gives text: it might never end.
[[nodiscard]] std::string read_file(const std::filesystem::path& path, const std::string& purpose);
// Throws InputError if the bytes are no text, as read_text_file does.
void require_text(std::string_view bytes, const std::string& file, const std::string& purpose);

// read_text_file in two steps, for files that need not be held as a whole. A block is full unless the file ends in it;
// returns 0 at the end.
[[nodiscard]] std::ifstream open_text_file(const std::filesystem::path& path, const std::string& purpose);
[[nodiscard]] std::size_t read_text_block(std::istream& in, std::span<char> block, const std::string& file,
                                          const std::string& purpose);

}  // namespace exactff::text
