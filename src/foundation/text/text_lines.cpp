#include "text/text_lines.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "text/encoding.h"
#include "text/escape.h"
#include "text/refuse.h"

namespace exactff::text {
namespace {

constexpr bool is_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

std::string_view without_comment(std::string_view text) {
  for (std::size_t at = text.find('#'); at != std::string_view::npos; at = text.find('#', at + 1)) {
    if (at == 0 || is_blank(text[at - 1])) return text.substr(0, at);
  }
  return text;
}

}  // namespace

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::string_view take_word(std::string_view& text) {
  std::size_t begin = 0;
  while (begin < text.size() && is_blank(text[begin])) ++begin;
  std::size_t end = begin;
  while (end < text.size() && !is_blank(text[end])) ++end;
  const std::string_view word = text.substr(begin, end - begin);
  text.remove_prefix(end);
  return word;
}

std::vector<std::string_view> words(std::string_view text) {
  std::vector<std::string_view> result;
  for (std::string_view word = take_word(text); !word.empty(); word = take_word(text)) result.push_back(word);
  return result;
}

std::string in_quotes(std::string_view text, std::size_t shown) {
  return "'" + text::printable(text::beginning(text, shown)) + (text.size() > shown ? "...'" : "'");
}

PlainLines::PlainLines(std::string_view text, std::size_t lines_before) : text_(text), number_(lines_before) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";  // of the byte order
  if (text_.starts_with(kMark)) text_.remove_prefix(kMark.size());
  next_feed_ = std::min(text_.find('\n'), text_.size());
  next_return_ = std::min(text_.find('\r'), text_.size());
}

bool PlainLines::next(TextLine& line) {
  if (at_ >= text_.size()) return false;
  if (next_feed_ < at_) next_feed_ = std::min(text_.find('\n', at_), text_.size());
  if (next_return_ < at_) next_return_ = std::min(text_.find('\r', at_), text_.size());
  const std::size_t end = std::min(next_feed_, next_return_);
  line = {++number_, text_.substr(at_, end - at_)};
  cut_off_ = end == text_.size() && !trimmed(line.text).empty();
  at_ = end + (next_feed_ == next_return_ + 1 ? 2 : 1);
  return true;
}

bool TextLines::take_physical(TextLine& line) {
  TextLine physical;
  if (!lines_.next(physical)) return false;
  const std::string_view data = without_comment(physical.text);
  // A backslash before a comment joins nothing. It is removed, since it would otherwise be the last character.
  const bool ends_before_comment = data.size() < physical.text.size() && trimmed(data).ends_with('\\');
  line = {physical.number, ends_before_comment ? data.substr(0, data.rfind('\\')) : trimmed(data)};
  return true;
}

bool TextLines::next(TextLine& line) {
  if (!take_physical(line)) return false;
  if (!line.text.ends_with('\\')) return true;
  joined_.clear();
  const std::size_t number = line.number;
  while (line.text.ends_with('\\')) {
    joined_.append(line.text.substr(0, line.text.size() - 1)).push_back(' ');
    if (!take_physical(line)) line.text = {};
  }
  joined_.append(line.text);
  line = {number, trimmed(joined_)};
  return true;
}

void ProblemList::add(Problem problem) {
  if (full()) return count_dropped();
  problems_.push_back(std::move(problem));
}

std::vector<Problem> ProblemList::take(const std::string& noun) {
  if (dropped_ > 0) {
    problems_.push_back(
        {problems_[0].file, 0, std::to_string(dropped_) + " more " + noun, "only the first ones are shown", ""});
  }
  return std::move(problems_);
}

void ProblemList::throw_if_any() {
  if (problems_.empty()) return;
  const auto by_line = [](const Problem& a, const Problem& b) { return a.file == b.file && a.line < b.line; };
  if (std::all_of(problems_.begin(), problems_.end(), [&](const Problem& p) { return p.file == problems_[0].file; })) {
    std::stable_sort(problems_.begin(), problems_.end(), by_line);
  }
  throw InputError(take("problems"));
}

// --- Text file ---

namespace {

[[noreturn]] void refuse_binary(const std::string& file, std::string_view block, const std::string& purpose) {
  const bool utf16 = block.starts_with("\xFF\xFE") || block.starts_with("\xFE\xFF");
  if (utf16) refuse(file, "is UTF-16 text", "only UTF-8 is read", "save it as UTF-8");
  refuse(file, "is not a text file", "it contains zero bytes", "give " + purpose);
}

[[noreturn]] void cannot_read(const std::string& file, const std::string& purpose) {
  const std::string reason = errno != 0 ? std::strerror(errno) : "reading failed";
  refuse(file, "cannot be read to its end", reason, "give " + purpose + " that can be read");
}

std::size_t read_block(std::istream& in, std::span<char> block, const std::string& file, const std::string& purpose) {
  if (!in) return 0;
  errno = 0;
  try {
    in.read(block.data(), static_cast<std::streamsize>(block.size()));
  } catch (const std::ios_base::failure&) {
    cannot_read(file, purpose);
  }
  if (in.bad()) cannot_read(file, purpose);
  return static_cast<std::size_t>(in.gcount());
}

}  // namespace

void require_text(std::string_view bytes, const std::string& file, const std::string& purpose) {
  if (bytes.find('\0') != std::string_view::npos) refuse_binary(file, bytes, purpose);
}

std::size_t read_text_block(std::istream& in, std::span<char> block, const std::string& file,
                            const std::string& purpose) {
  const std::size_t count = read_block(in, block, file, purpose);
  require_text({block.data(), count}, file, purpose);
  return count;
}

std::string read_text(std::istream& in, const std::string& file, const std::string& purpose) {
  std::string text;
  std::array<char, 1 << 16> block{};
  while (const std::size_t count = read_text_block(in, block, file, purpose)) text.append(block.data(), count);
  return text;
}

std::ifstream open_text_file(const std::filesystem::path& path, const std::string& purpose) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    refuse(path, "is a folder", "a file is needed", "name " + purpose + " in this folder");
  }
  errno = 0;
  std::ifstream in(path, std::ios::binary);
  if (!in) refuse(path, "cannot be opened", std::strerror(errno), "check the path");
  return in;
}

std::string read_file(const std::filesystem::path& path, const std::string& purpose) {
  std::error_code ignored;
  const bool device = std::filesystem::is_character_file(path, ignored);
  std::ifstream in = open_text_file(path, purpose);
  std::string bytes;
  std::array<char, 1 << 16> block{};
  const std::string file = path.string();
  while (const std::size_t count = (device ? read_text_block : read_block)(in, block, file, purpose))
    bytes.append(block.data(), count);
  return bytes;
}

std::string read_text_file(const std::filesystem::path& path, const std::string& purpose) {
  std::ifstream in = open_text_file(path, purpose);
  return read_text(in, path.string(), purpose);
}

}  // namespace exactff::text
