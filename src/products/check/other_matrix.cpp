#include "check/other_matrix.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <string_view>

#include "files/numpy.h"
#include "text/csv_dialect.h"
#include "text/phrases.h"
#include "text/refuse.h"
#include "text/text_file.h"
#include "text/text_lines.h"

namespace exactff::check {
namespace {

// Separated by commas or semicolons, or by blanks in a line without them. Returns false if a quotation mark is not
// closed.
bool split(const text::CsvDialect& dialect, std::string_view line, std::vector<std::string>& fields) {
  if (dialect.has_semicolons() || line.find_first_of(",\"") != std::string_view::npos) {
    return dialect.split(line, fields);
  }
  fields.clear();
  for (const std::string_view word : text::words(line)) fields.emplace_back(word);
  return true;
}

bool is_number(text::NumberFault fault) {
  return fault == text::NumberFault::kNone || fault == text::NumberFault::kNotFinite ||
         fault == text::NumberFault::kTooLarge;
}

// Numbers that are not finite are failures of the candidate, not of its file.
class Numbers {
 public:
  explicit Numbers(std::string file) : file_(std::move(file)) {}

  // `line`: the first one.
  void recognise(std::string_view line) { dialect_ = text::CsvDialect(line); }
  [[nodiscard]] const text::CsvDialect& dialect() const { return dialect_; }

  double take(std::string_view text, std::size_t line) {
    const text::ParsedNumber number = dialect_.number(text);
    if (number.fault == text::NumberFault::kNone) return number.value;
    if (is_number(number.fault)) return text::not_finite_value(text, number.fault);
    complain(line, text.empty() ? "a field is empty" : describe(number.fault, text), "an entry of a matrix is a number",
             text.empty() ? "write nan if there is no result" : advice(number.fault));
    return 0.0;
  }
  void complain(std::size_t line, std::string what, std::string why, std::string suggestion) {
    problems_.add({file_, line, std::move(what), std::move(why), std::move(suggestion)});
  }
  void throw_if_any() { problems_.throw_if_any(); }

 private:
  std::string file_;
  text::CsvDialect dialect_;
  text::ProblemList problems_;
};

// Calls take(fields, line) for every line that is neither blank nor a comment.
template <class Take>
void for_each_line(const std::filesystem::path& file, Numbers& numbers, const Take& take) {
  text::CsvLines lines(file, "a matrix");
  std::vector<std::string> fields;
  bool is_first = true;
  for (std::string_view line; lines.next(line);) {
    if (text::is_csv_comment(line)) continue;
    if (is_first) numbers.recognise(line);
    is_first = false;
    if (!split(numbers.dialect(), line, fields)) {
      numbers.complain(lines.number(), "a quotation mark is not closed in its line, or text follows it",
                       "the fields cannot be separated", "write a quotation mark inside quotes twice");
      continue;
    }
    take(fields, lines.number());
  }
}

std::string first_bytes(const std::filesystem::path& file) {
  std::string bytes(8, '\0');
  std::ifstream in(file, std::ios::binary);
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(in.gcount(), 0)));
  return bytes;
}

bool is_whole(std::string_view word, std::size_t& number) {
  const auto end = std::from_chars(word.data(), word.data() + word.size(), number);
  return end.ec == std::errc{} && end.ptr == word.data() + word.size();
}

// "View3D 3.5 0 0 1 6": program, version, format, two flags and the number of surfaces.
struct View3dHead {
  std::size_t format = 0, surfaces = 0;
};
std::optional<View3dHead> view3d_head(std::string_view line) {
  const std::vector<std::string_view> words = text::words(line);
  if (words.size() != 6 || is_number(text::parse_number(words.front()).fault)) return std::nullopt;
  View3dHead head;
  std::size_t flag = 0;
  const bool whole = is_whole(words[2], head.format) && is_whole(words[3], flag) && is_whole(words[4], flag) &&
                     is_whole(words[5], head.surfaces);
  return whole ? std::optional(head) : std::nullopt;
}

}  // namespace

OtherKind kind_of(const std::filesystem::path& file, const CandidateColumns& columns) {
  std::error_code ignored;
  if (std::filesystem::is_other(file, ignored)) {
    text::refuse(file, "is no regular file", "a matrix is recognised by its content, and then read",
                 "write it to a file first");
  }
  const std::string bytes = first_bytes(file);
  if (files::is_npy(bytes)) return OtherKind::kNpy;
  if (bytes.starts_with("PK")) {
    text::refuse(file, "is a zip archive, as .npz files are", "an archive may hold several arrays",
                 "give the CSV file of the same matrix, or one .npy array");
  }
  text::CsvLines lines(file, "a matrix");
  std::string_view line;
  do {
    if (!lines.next(line)) text::refuse(file, "has no entries", "there is nothing to check", "give a matrix");
  } while (text::is_csv_comment(line));
  if (view3d_head(line)) return OtherKind::kView3d;
  std::vector<std::string> fields;
  text::CsvDialect dialect(line);
  (void)split(dialect, line, fields);
  if (std::ranges::all_of(fields, [&](const std::string& field) { return is_number(dialect.number(field).fault); }))
    return OtherKind::kNumbers;
  const auto has = [&](const std::string& given, const char* usual) {
    return std::ranges::find(fields, given.empty() ? usual : given) != fields.end();
  };
  return has(columns.receiver, "from") && has(columns.source, "to") ? OtherKind::kList : OtherKind::kNamed;
}

NumberGrid read_numbers(const std::filesystem::path& file) {
  NumberGrid grid{file.string(), "a table of numbers", 0, 0, {}, {}, {}, 0};
  Numbers numbers(grid.file);
  for_each_line(file, numbers, [&](const std::vector<std::string>& fields, std::size_t line) {
    if (grid.rows++ == 0) grid.columns = fields.size();
    if (fields.size() != grid.columns) {
      numbers.complain(
          line, text::counted(fields.size(), "number") + " where the first row has " + std::to_string(grid.columns),
          "a row of a matrix has a number for each column", "write one row in each line");
      return;
    }
    for (const std::string& field : fields) {
      grid.values.push_back(numbers.take(field, line));
      grid.lines.push_back(static_cast<std::uint32_t>(line));
    }
  });
  numbers.throw_if_any();
  return grid;
}

Candidate read_named(const std::filesystem::path& file) {
  Candidate candidate;
  candidate.file = file.string();
  candidate.has_sources = true;
  Numbers numbers(candidate.file);
  bool has_head = false;
  std::vector<std::string> head;
  for_each_line(file, numbers, [&](const std::vector<std::string>& fields, std::size_t line) {
    if (!has_head) {
      has_head = true;
      head = fields;
      return;
    }
    if (candidate.rows.empty() && candidate.sources.empty()) {  // with a corner above the names, or without
      const bool corner = head.size() == fields.size() && !head.empty();
      candidate.sources.assign(head.begin() + (corner ? 1 : 0), head.end());
    }
    if (fields.size() != candidate.sources.size() + 1) {
      numbers.complain(line,
                       std::to_string(fields.size()) + " fields where there are a name and " +
                           text::counted(candidate.sources.size(), "column"),
                       "values would be assigned to the wrong columns",
                       "begin the file with the names of the columns, and each line with the name of its row");
      return;
    }
    for (std::size_t j = 0; j < candidate.sources.size(); ++j) {
      CandidateRow& row = candidate.rows.emplace_back();
      row.receiver = fields.front();
      row.source = static_cast<std::uint32_t>(j);
      row.line = static_cast<std::uint32_t>(line);
      row.value = numbers.take(fields[j + 1], line);
    }
  });
  numbers.throw_if_any();
  return candidate;
}

namespace {

// The words of a text one after another, with their lines.
class Words {
 public:
  explicit Words(std::string_view text) : lines_(text) {}
  std::string_view next() {
    for (;;) {
      if (const std::string_view word = text::take_word(rest_); !word.empty()) return word;
      text::TextLine line;
      if (!lines_.next(line)) return {};
      rest_ = line.text;
      number_ = line.number;
    }
  }
  [[nodiscard]] std::uint32_t line() const { return static_cast<std::uint32_t>(number_); }

 private:
  text::PlainLines lines_;
  std::string_view rest_;
  std::size_t number_ = 0;
};

}  // namespace

// After the head: areas, rows, and emittances, which may be missing. Lines may be broken anywhere.
NumberGrid read_view3d_output(const std::filesystem::path& file) {
  NumberGrid grid{file.string(), "View3D's output", 0, 0, {}, {}, {}, 0};
  const std::string text = text::read_text_file(file, "View3D's output as text");
  const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
  const View3dHead head = view3d_head(std::string_view(text).substr(0, end)).value_or(View3dHead{});
  if (head.format != 0) {
    text::refuse(file, "is output of View3D in the format " + std::to_string(head.format), "only text is read",
                 "write it with out=0");
  }
  grid.rows = grid.columns = head.surfaces;
  const std::size_t n = head.surfaces;
  // Every number takes two bytes at least; this bounds the memory, too.
  if (n == 0 || n > text.size() || n * (n + 1) > text.size()) {
    text::refuse(file, "is cut off: it states " + text::counted(n, "surface"),
                 "it holds an area for each surface and a factor for each pair", "write it again");
  }
  Numbers numbers(grid.file);
  Words words(std::string_view(text).substr(end));
  std::vector<double> all;
  for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
    const std::uint32_t line = words.line();
    if (all.empty()) grid.line_of_areas = line;
    all.push_back(numbers.take(word, line));
    if (all.size() > n && all.size() <= n + n * n) grid.lines.push_back(line);
  }
  numbers.throw_if_any();
  const std::size_t needed = n + n * n;
  if (all.size() != needed && all.size() != needed + n) {
    text::refuse(file, "has " + text::counted(all.size(), "number") + " after its first line",
                 std::to_string(n) + " surfaces have " + std::to_string(n) + " areas, " + std::to_string(n * n) +
                     " factors and " + std::to_string(n) + " emittances",
                 "write it again");
  }
  const auto at = [&](std::size_t i) { return all.begin() + static_cast<std::ptrdiff_t>(i); };
  grid.areas.assign(all.begin(), at(n));
  grid.values.assign(at(n), at(needed));
  return grid;
}

NumberGrid read_npy_grid(const std::filesystem::path& file) {
  files::NpyArray array = files::read_npy(file);
  if (array.shape.size() != 2) {
    text::refuse(file, "has " + text::counted(array.shape.size(), "axis", "axes"), "a matrix has rows and columns",
                 "save an array of shape (rows, columns)");
  }
  return {file.string(), "a NumPy array", array.shape[0], array.shape[1], std::move(array.values), {}, {}, 0};
}

}  // namespace exactff::check
