#include "text/text_lines.h"

#include "text/characters.h"
#include "text/escape.h"

namespace exactff::text {

namespace {

constexpr std::string_view kBlanks = " \t\v\f\r\n";

std::string_view without_comment(std::string_view text) {
  for (std::size_t at = text.find('#'); at != std::string_view::npos; at = text.find('#', at + 1)) {
    if (at == 0 || kBlanks.find(text[at - 1]) != std::string_view::npos) return text.substr(0, at);
  }
  return text;
}

}  // namespace

std::string_view trimmed(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
  return text.substr(0, text.find_last_not_of(kBlanks) + 1);
}

std::string_view take_word(std::string_view& text) {
  text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
  const std::string_view word = text.substr(0, text.find_first_of(kBlanks));
  text.remove_prefix(word.size());
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

TextLines::TextLines(std::string_view text) : rest_(text) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";  // of the byte order
  if (rest_.starts_with(kMark)) rest_.remove_prefix(kMark.size());
}

std::string_view TextLines::take_physical() {
  const std::size_t end = std::min(rest_.find_first_of("\r\n"), rest_.size());
  const std::string_view line = rest_.substr(0, end);
  rest_.remove_prefix(end);
  cut_off_ = rest_.empty() && !trimmed(line).empty();
  rest_.remove_prefix(rest_.starts_with("\r\n") ? 2 : std::min<std::size_t>(rest_.size(), 1));
  ++number_;
  const std::string_view data = without_comment(line);
  // A backslash before a comment joins nothing. It is removed, since it would otherwise be the last character.
  return data.size() < line.size() && trimmed(data).ends_with('\\') ? data.substr(0, data.rfind('\\')) : trimmed(data);
}

bool TextLines::next(TextLine& line) {
  if (rest_.empty()) return false;
  line.text = take_physical();
  line.number = number_;
  if (!line.text.ends_with('\\')) return true;
  joined_.clear();
  while (line.text.ends_with('\\')) {
    joined_.append(line.text.substr(0, line.text.size() - 1)).push_back(' ');
    line.text = rest_.empty() ? std::string_view{} : take_physical();
  }
  joined_.append(line.text);
  line.text = trimmed(joined_);
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

}  // namespace exactff::text
