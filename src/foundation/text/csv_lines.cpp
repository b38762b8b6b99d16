#include "text/csv_lines.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "exactff/error.h"
#include "text/encoding.h"
#include "text/text_lines.h"

namespace exactff::text {

namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

// Appends to `field` the text between the quotes that begin at line[at]; false if they are not closed.
bool take_quoted(std::string_view line, std::size_t& at, std::string& field) {
  for (++at; at < line.size(); ++at) {
    if (line[at] != '"') {
      field += line[at];
    } else if (at + 1 < line.size() && line[at + 1] == '"') {
      field += line[at++];
    } else {
      ++at;
      return true;
    }
  }
  return false;
}

}  // namespace

CsvLines::CsvLines(const std::filesystem::path& path, std::string purpose)
    : file_(path.string()), purpose_(std::move(purpose)), opened_(open_text_file(path, purpose_)), in_(opened_) {
  pass_byte_order_mark();
}

CsvLines::CsvLines(std::istream& in, std::string file, std::string purpose)
    : file_(std::move(file)), purpose_(std::move(purpose)), in_(in) {
  pass_byte_order_mark();
}

void CsvLines::pass_byte_order_mark() {
  if (fill() && std::string_view(block_.data(), end_).starts_with(kByteOrderMark)) at_ = kByteOrderMark.size();
}

bool CsvLines::fill() {
  at_ = 0;
  end_ = read_text_block(in_, block_, file_, purpose_);
  return end_ > 0;
}

// Requires that the position is at a line end. Skips it; CR LF is one line end.
void CsvLines::pass_line_end() {
  const char ended_by = block_[at_++];
  if (ended_by == '\r' && (at_ < end_ || fill()) && block_[at_] == '\n') ++at_;
}

bool CsvLines::next(std::string_view& line) {
  line_.clear();
  if (at_ == end_ && !fill()) return false;
  ++number_;
  do {
    const std::string_view rest(block_.data() + at_, end_ - at_);
    const std::size_t length = std::min(rest.find_first_of("\r\n"), rest.size());
    line_.append(rest.substr(0, length));
    at_ += length;
    if (at_ < end_) {
      pass_line_end();
      break;
    }
  } while (fill());
  line = line_;
  return true;
}

bool is_csv_comment(std::string_view line) {
  const std::string_view content = trimmed(line);
  return content.empty() || content.front() == '#';
}

bool split_csv_line(std::string_view line, std::vector<std::string>& fields, char separator) {
  std::size_t count = 0;
  for (std::size_t at = 0;; ++at) {
    if (count == fields.size()) fields.emplace_back();
    std::string& field = fields[count++];
    field.clear();
    while (at < line.size() && (line[at] == ' ' || line[at] == '\t')) ++at;
    const bool quoted = at < line.size() && line[at] == '"';
    if (quoted && !take_quoted(line, at, field)) return false;
    const std::size_t end = std::min(line.find(separator, at), line.size());
    const std::string_view rest = trimmed(line.substr(at, end - at));
    if (quoted && !rest.empty()) return false;
    if (!quoted) field.assign(rest);
    at = end;
    if (at == line.size()) break;
  }
  fields.resize(count);
  if (!is_utf8(line)) std::ranges::transform(fields, fields.begin(), in_utf8);
  return true;
}

// --- Dialects ---

namespace {

bool has_outside_quotes(std::string_view line, char wanted) {
  bool quoted = false;
  return std::ranges::any_of(line, [&](char c) {
    if (c == '"') quoted = !quoted;
    return c == wanted && !quoted;
  });
}

bool holds_numbers(std::string_view line) {
  CsvDialect semicolons("a;b");
  std::vector<std::string> fields;
  return semicolons.split(line, fields) && std::ranges::all_of(fields, [&](const std::string& field) {
           const NumberFault fault = semicolons.number(field).fault;
           return fault != NumberFault::kNotANumber && fault != NumberFault::kHexadecimal;
         });
}

}  // namespace

CsvDialect::CsvDialect(std::string_view line) {
  if (!has_outside_quotes(line, ';')) return;
  if (!has_outside_quotes(line, ',') || holds_numbers(line)) separator_ = ';';
}

ParsedNumber CsvDialect::number(std::string_view text) {
  ParsedNumber number = parse_number(text);
  const bool has_comma = number.fault == NumberFault::kComma;
  if (!has_semicolons() || (!has_comma && text.find('.') == std::string_view::npos)) return number;
  const char sign = has_comma ? ',' : '.';
  if (decimal_sign_ == 0) decimal_sign_ = sign;
  if (decimal_sign_ != sign) return {0.0, has_comma ? NumberFault::kComma : NumberFault::kPoint};
  if (!has_comma) return number;
  std::string with_point(text);
  std::ranges::replace(with_point, ',', '.');
  return parse_number(with_point);
}

}  // namespace exactff::text
