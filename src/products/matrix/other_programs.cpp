// Matrices of view factors as other programs write them: a small function for each form, which gives a table. A matrix
// with names has the text columns receiver and source. Of one without, the order is all there is: it has the counts row
// and column, from 0, and perhaps the areas of its rows.
#include "matrix/other_programs.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string_view>

#include "files/numpy.h"
#include "text/csv_lines.h"
#include "text/names.h"
#include "text/phrases.h"
#include "text/refuse.h"
#include "text/text_lines.h"

namespace exactff::matrix {
namespace {

namespace fs = std::filesystem;
using table::Cell;
using table::Table;
using table::Type;

constexpr std::string_view kEnergyPlusObject = "zoneproperty:userviewfactors:bysurfacename";

bool is_number(text::NumberFault fault) {
  return fault == text::NumberFault::kNone || fault == text::NumberFault::kNotFinite ||
         fault == text::NumberFault::kTooLarge;
}

// The fields of a file, and its problems. Numbers that are not finite are failures of the candidate, not of its file.
class Fields {
 public:
  explicit Fields(const fs::path& file) : file_(file.string()) {}

  // `line`: the first one.
  void recognise(std::string_view line) { dialect_ = text::CsvDialect(line); }
  // Separated by commas or semicolons, or by blanks in a line without them. Returns false if a quotation mark is not
  // closed.
  bool split(std::string_view line, std::vector<std::string>& fields) const {
    if (dialect_.has_semicolons() || line.find_first_of(",\"") != std::string_view::npos) {
      return dialect_.split(line, fields);
    }
    fields.clear();
    for (const std::string_view word : text::words(line)) fields.emplace_back(word);
    return true;
  }
  bool all_are_numbers(const std::vector<std::string>& fields) {
    return std::ranges::all_of(fields, [&](const std::string& one) { return is_number(dialect_.number(one).fault); });
  }
  double number(std::string_view text, std::size_t line) {
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
void for_each_line(const fs::path& file, Fields& all, const Take& take) {
  text::CsvLines lines(file, "a matrix");
  std::vector<std::string> fields;
  bool is_first = true;
  for (std::string_view line; lines.next(line);) {
    if (text::is_csv_comment(line)) continue;
    if (is_first) all.recognise(line);
    is_first = false;
    if (all.split(line, fields)) {
      take(fields, lines.number());
    } else {
      all.complain(lines.number(), "a quotation mark is not closed in its line, or text follows it",
                   "the fields cannot be separated", "write a quotation mark inside quotes twice");
    }
  }
}

// --- Tables ---

Table with_names() { return {"matrix", {}, {{"receiver", Type::kText}, {"source", Type::kText}, {"value"}}}; }
void add(Table& table, std::string_view receiver, std::string_view source, double value, std::size_t line) {
  table.append(std::array<Cell, 3>{receiver, source, value}, line);
}

// `holds`: "View3D's output", for messages.
struct Grid {
  std::string holds;
  std::size_t rows = 0, columns = 0;
  std::vector<double> values = {};      // row by row; may be infinite or NaN
  std::vector<std::size_t> lines = {};  // of each value; empty if the file has no lines
  std::vector<double> areas = {};       // of the rows; empty if the file has none
  std::size_t line_of_areas = 0;
};

// Areas of six digits are off by 5e-6 of themselves at most.
void require_same_areas(const fs::path& file, const Grid& grid, const Order& order) {
  constexpr double kSixDigits = 1e-5;
  text::ProblemList problems;
  for (std::size_t i = 0; i < grid.areas.size() && !order.areas.empty(); ++i) {
    const double ours = order.areas[i];
    if (std::abs(grid.areas[i] - ours) <= kSixDigits * ours) continue;
    problems.add({file.string(), grid.line_of_areas,
                  "surface " + std::to_string(i + 1) + " has the area " + text::shortest(grid.areas[i]) + ", and " +
                      text::in_quotes(order.rows[i]) + " has " + text::short_number(ours, 6),
                  "the matrices are of other patches, in another order or in another unit",
                  "compute the truth for the same scene, and name its patches by --from and --to in this order"});
  }
  problems.throw_if_any();
}

// With the names of the other matrix, in its order.
Table named_like(const Order& order, const fs::path& file, const Grid& grid) {
  if (grid.rows != order.rows.size() || grid.columns != order.columns.size()) {
    const auto size = [](std::size_t rows, std::size_t columns) {
      return std::to_string(rows) + " x " + std::to_string(columns);
    };
    text::refuse(file,
                 "is " + grid.holds + " of " + size(grid.rows, grid.columns) + ", and the truth is " +
                     size(order.rows.size(), order.columns.size()),
                 "without names, entries are compared in their order",
                 "compute the truth for the same patches in the same order, or write a CSV with " + order.keys[0] +
                     ',' + order.keys[1] + ",value");
  }
  require_same_areas(file, grid, order);
  Table table = with_names();
  for (std::size_t k = 0; k < grid.values.size(); ++k) {
    add(table, order.rows[k / grid.columns], order.columns[k % grid.columns], grid.values[k],
        grid.lines.empty() ? 0 : grid.lines[k]);
  }
  return table;
}

// --- Forms ---

Grid read_numbers(const fs::path& file) {
  Grid grid{.holds = "a table of numbers"};
  Fields all(file);
  for_each_line(file, all, [&](const std::vector<std::string>& fields, std::size_t line) {
    if (grid.rows++ == 0) grid.columns = fields.size();
    if (fields.size() != grid.columns) {
      all.complain(line,
                   text::counted(fields.size(), "number") + " where the first row has " + std::to_string(grid.columns),
                   "a row of a matrix has a number for each column", "write one row in each line");
      return;
    }
    for (const std::string& field : fields) {
      grid.values.push_back(all.number(field, line));
      grid.lines.push_back(line);
    }
  });
  all.throw_if_any();
  return grid;
}

Grid read_npy_grid(const fs::path& file) {
  files::NpyArray array = files::read_npy(file);
  if (array.shape.size() != 2) {
    text::refuse(file, "has " + text::counted(array.shape.size(), "axis", "axes"), "a matrix has rows and columns",
                 "save an array of shape (rows, columns)");
  }
  return {
      .holds = "a NumPy array", .rows = array.shape[0], .columns = array.shape[1], .values = std::move(array.values)};
}

// The names of columns in the first line, with a corner before them or without, and in each further line a name and its
// numbers.
Table read_with_names(const fs::path& file) {
  Table table = with_names();
  Fields all(file);
  std::optional<std::vector<std::string>> head;
  bool has_corner = true, is_second = true;
  for_each_line(file, all, [&](const std::vector<std::string>& fields, std::size_t line) {
    if (!head) {
      head = fields;
      return;
    }
    if (is_second) has_corner = head->size() == fields.size();
    is_second = false;
    const std::size_t first = has_corner ? 1 : 0, columns = head->size() - first;
    if (fields.size() != columns + 1) {
      all.complain(
          line,
          std::to_string(fields.size()) + " fields where there are a name and " + text::counted(columns, "column"),
          "values would be assigned to the wrong columns",
          "begin the file with the names of the columns, and each line with the name of its row");
      return;
    }
    for (std::size_t j = 0; j < columns; ++j) {
      add(table, fields.front(), (*head)[first + j], all.number(fields[j + 1], line), line);
    }
  });
  all.throw_if_any();
  return table;
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

// After the head: areas, rows, and emittances, which may be missing. Lines may be broken anywhere.
Grid read_view3d(const fs::path& file) {
  const std::string text = text::read_text_file(file, "View3D's output as text");
  const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
  const View3dHead head = view3d_head(std::string_view(text).substr(0, end)).value_or(View3dHead{});
  if (head.format != 0) {
    text::refuse(file, "is output of View3D in the format " + std::to_string(head.format), "only text is read",
                 "write it with out=0");
  }
  const std::size_t n = head.surfaces;
  // Every number takes two bytes at least; this bounds the memory, too.
  if (n == 0 || n > text.size() || n * (n + 1) > text.size()) {
    text::refuse(file, "is cut off: it states " + text::counted(n, "surface"),
                 "it holds an area for each surface and a factor for each pair", "write it again");
  }
  Grid grid{.holds = "View3D's output", .rows = n, .columns = n};
  Fields all(file);
  std::size_t count = 0;
  text::PlainLines lines(std::string_view(text).substr(end), 0);
  for (text::TextLine line; lines.next(line);) {
    for (const std::string_view word : text::words(line.text)) {
      const double number = all.number(word, line.number);
      if (count == 0) grid.line_of_areas = line.number;
      if (count < n) grid.areas.push_back(number);
      if (count++ < n || count > n + n * n) continue;
      grid.values.push_back(number);
      grid.lines.push_back(line.number);
    }
  }
  all.throw_if_any();
  const std::size_t needed = n + n * n;
  if (count == needed || count == needed + n) return grid;
  text::refuse(file, "has " + text::counted(count, "number") + " after its first line",
               std::to_string(n) + " surfaces have " + std::to_string(n) + " areas, " + std::to_string(n * n) +
                   " factors and " + std::to_string(n) + " emittances",
               "write it again");
}

// Input of EnergyPlus: OBJECT, ZONE, then FROM, TO, FACTOR for each pair, up to a semicolon; comments begin with an
// exclamation mark. Other objects are skipped.
Table read_energyplus(const fs::path& file) {
  const std::string text = text::read_text_file(file, "an input file of EnergyPlus");
  Table table = with_names();
  Fields all(file);
  std::vector<std::string> fields(1);
  text::PlainLines lines(text);
  for (text::TextLine line; lines.next(line);) {
    for (const char c : line.text.substr(0, line.text.find('!'))) {
      if (c != ',' && c != ';') {
        fields.back() += c;
        continue;
      }
      fields.back() = text::trimmed(fields.back());
      const bool ours = text::in_lower_case(fields.front()) == kEnergyPlusObject;
      if (ours && fields.size() > 2 && fields.size() % 3 == 2) {
        add(table, fields[2], fields[3], all.number(fields[4], line.number), line.number);
        fields.resize(2);
      } else if (ours && c == ';' && fields.size() > 2) {
        all.complain(line.number, "the object ends within a pair", "a pair has two names and a factor", "complete it");
      }
      if (c == ';') fields.clear();
      fields.emplace_back();
    }
  }
  all.throw_if_any();
  return table;
}

// A file of OpenFOAM: after the head, a list of lists "N(a b c)", or "N{a}" for N equal numbers.
std::vector<std::vector<double>> read_foam_lists(const fs::path& file) {
  std::string text = text::read_text_file(file, "a list of lists of OpenFOAM, in ASCII");
  const std::size_t head = text.find('}');  // of FoamFile { ... }
  const std::size_t begin = text.find('(', std::min(head, text.size()));
  Fields all(file);
  const auto refuse = [&]() {
    text::refuse(file, "is no list of lists of numbers in ASCII", "a row of a matrix is a list",
                 "use writeFormat ascii");
  };
  if (begin == std::string::npos) refuse();
  std::vector<std::vector<double>> lists;
  std::string_view rest = std::string_view(text).substr(begin + 1);
  for (;;) {
    const std::size_t open = rest.find_first_of("({)");
    if (open == std::string_view::npos) refuse();
    if (rest[open] == ')') return lists;
    const std::size_t close = rest.find(rest[open] == '(' ? ')' : '}', open);
    std::size_t count = 0;
    if (close == std::string_view::npos || !is_whole(text::trimmed(rest.substr(0, open)), count) || count > text.size())
      refuse();
    std::vector<double>& list = lists.emplace_back();
    for (const std::string_view word : text::words(rest.substr(open + 1, close - open - 1))) {
      list.push_back(all.number(word, 0));
    }
    if (rest[open] == '{' && list.size() == 1) list.assign(count, list.front());
    all.throw_if_any();
    if (list.size() != count) refuse();
    rest.remove_prefix(close + 1);
  }
}

// viewFactorsGen writes the factors of each face to those that it sees, and their numbers beside them.
Grid read_openfoam(const fs::path& file) {
  const std::vector<std::vector<double>> factors = read_foam_lists(file),
                                         faces = read_foam_lists(file.parent_path() / "globalFaceFaces");
  const std::size_t n = factors.size();
  Grid grid{.holds = "OpenFOAM's matrix", .rows = n, .columns = n, .values = std::vector<double>(n * n, 0.0)};
  const auto is_face = [&](double face) { return face >= 0.0 && face < static_cast<double>(n); };
  for (std::size_t i = 0; i < n; ++i) {
    if (faces.size() != n || faces[i].size() != factors[i].size() || !std::ranges::all_of(faces[i], is_face)) {
      text::refuse(file, "does not fit globalFaceFaces beside it", "that file says which faces the factors belong to",
                   "give both files of one run");
    }
    for (std::size_t j = 0; j < faces[i].size(); ++j) {
      grid.values[i * n + static_cast<std::size_t>(faces[i][j])] = factors[i][j];
    }
  }
  return grid;
}

// CalculiX writes records of Fortran: its version; the diagonal; then, column by column, what is below it and, row by
// row, what is above; and one that is not needed.
Grid read_calculix(const fs::path& file) {
  const std::string bytes = text::read_file(file, "view factors of CalculiX");
  std::vector<std::vector<double>> records;
  for (std::size_t at = 0; at < bytes.size();) {
    std::uint32_t length = 0;
    if (at + 8 <= bytes.size()) std::memcpy(&length, bytes.data() + at, 4);
    if (at + 8 + length > bytes.size() || bytes.compare(at, 4, bytes, at + 4 + length, 4) != 0) {
      text::refuse(file, "is cut off, or no file of CalculiX", "a record of Fortran has its length at both ends",
                   "write it again, by *VIEWFACTOR, WRITE");
    }
    std::vector<double>& record = records.emplace_back(length / sizeof(double));
    if (!record.empty()) std::memcpy(record.data(), bytes.data() + at + 4, record.size() * sizeof(double));
    at += 8 + length;
  }
  const std::size_t n = records.size() == 4 ? records[1].size() : 0;
  if (n == 0 || records[2].size() != n * (n - 1)) {
    text::refuse(file, "has not the records of a matrix of view factors", "its faces and factors do not fit",
                 "write it again, by *VIEWFACTOR, WRITE");
  }
  Grid grid{.holds = "CalculiX' matrix", .rows = n, .columns = n, .values = std::vector<double>(n * n)};
  auto next = records[2].begin();
  for (std::size_t i = 0; i < n; ++i) grid.values[i * n + i] = records[1][i];
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t i = j + 1; i < n; ++i) grid.values[i * n + j] = *next++;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n; ++j) grid.values[i * n + j] = *next++;
  return grid;
}

std::string first_bytes(const fs::path& file, std::size_t count) {
  std::string bytes(count, '\0');
  std::ifstream in(file, std::ios::binary);
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(in.gcount(), 0)));
  return bytes;
}

}  // namespace

std::optional<Table> read_other(const fs::path& file, const Order& order) {
  std::error_code ignored;
  if (fs::is_other(file, ignored)) {
    text::refuse(file, "is no regular file", "a matrix is recognised by its content, and then read",
                 "write it to a file first");
  }
  if (!table::kind_of(file).empty()) return std::nullopt;
  const auto in_order = [&](const Grid& grid) { return named_like(order, file, grid); };
  const std::string start = first_bytes(file, 1 << 16);
  if (file.extension() == ".vwf") return in_order(read_calculix(file));
  if (files::is_npy(start)) return in_order(read_npy_grid(file));
  if (start.starts_with("PK")) {
    text::refuse(file, "is a zip archive, as .npz files are", "an archive may hold several arrays",
                 "give a file that exactff wrote, or one .npy array");
  }
  if (text::in_lower_case(start).find(kEnergyPlusObject) != std::string::npos) return read_energyplus(file);
  if (start.find("FoamFile") != std::string::npos) return in_order(read_openfoam(file));
  text::CsvLines lines(file, "a matrix");
  std::string_view line;
  do {
    if (!lines.next(line)) text::refuse(file, "has no entries", "there is nothing to check", "give a matrix");
  } while (text::is_csv_comment(line));
  if (view3d_head(line)) return in_order(read_view3d(file));
  Fields all(file);
  std::vector<std::string> fields;
  all.recognise(line);
  (void)all.split(line, fields);
  if (all.all_are_numbers(fields)) return in_order(read_numbers(file));
  const auto has = [&](const std::string& key) { return std::ranges::find(fields, key) != fields.end(); };
  if (std::ranges::all_of(order.keys, has)) return std::nullopt;
  return read_with_names(file);
}

}  // namespace exactff::matrix
