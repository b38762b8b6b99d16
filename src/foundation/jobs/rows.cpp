#include "jobs/rows.h"

#include <algorithm>
#include <charconv>

#include "exactff/version.h"
#include "table/csv.h"
#include "text/encoding.h"
#include "text/escape.h"
#include "text/phrases.h"
#include "text/refuse.h"

namespace exactff::jobs {

std::uint64_t Plan::shard_rows() const {
  const std::uint64_t rows = shard_chunks() * chunk;
  const bool has_last = count > 0 && (chunks() - 1) % shard.count == shard.number - 1;
  return has_last ? rows - (chunks() * chunk - count) : rows;  // the last chunk may be shorter
}

Range Plan::chunk_of_shard(std::uint64_t index) const {
  const std::uint64_t first = (index * shard.count + shard.number - 1) * chunk;
  return {first, static_cast<std::uint32_t>(std::min<std::uint64_t>(chunk, count - first))};
}

void require_shard(const Shard& shard) {
  if (shard.number >= 1 && shard.number <= shard.count) return;
  text::refuse("there is no shard " + std::to_string(shard.number) + " of " + std::to_string(shard.count),
               "shards are numbered from 1", "write --shard 1/4 for the first of four");
}

bool Rows::may_be_one_block(Range range) const {
  const std::uint64_t chunk = range.first / plan_.chunk;
  return range.rows > 0 && range.end() <= plan_.count && (range.end() - 1) / plan_.chunk == chunk &&
         chunk % plan_.shard.count == plan_.shard.number - 1;
}

// --- Lines ---

std::optional<NumberedLine> take_line(std::string_view& text) {
  NumberedLine result;
  const std::size_t end = text.find('\n');
  if (end == std::string_view::npos) return std::nullopt;
  const auto number = std::from_chars(text.data(), text.data() + end, result.number);
  if (number.ec != std::errc{} || *number.ptr != ',') return std::nullopt;
  const auto start = static_cast<std::size_t>(number.ptr - text.data()) + 1;
  result.line = text.substr(start, end + 1 - start);
  text.remove_prefix(end + 1);
  return result;
}

bool Rows::may_be_text_of(Range range, std::string_view text) const {
  for (std::uint64_t row = range.first; row < range.end(); ++row) {
    if (numbered_) {
      for (const std::uint64_t number : lines_of(row)) {
        const std::optional<NumberedLine> line = take_line(text);
        if (!line || line->number != number) return false;
      }
    } else {
      const std::size_t end = text.find('\n');
      if (end == std::string_view::npos || end == 0) return false;
      text.remove_prefix(end + 1);
    }
  }
  return text.empty();
}

bool LinesInOrder::add(std::string_view text) {
  while (!text.empty()) {
    const std::optional<NumberedLine> line = take_line(text);
    if (!line) return false;
    lines_.emplace_back(line->number, line->line);
  }
  return true;
}

std::string LinesInOrder::take() {
  std::ranges::sort(lines_);
  std::string text;
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    if (lines_[i].first != i) return {};
    text += lines_[i].second;
  }
  return text;
}

// --- Heads ---

namespace {

constexpr std::string_view kRowCount = "rows", kShard = "shard", kShards = "shards", kChunk = "rows_in_chunk",
                           kUnfinished = "unfinished";
constexpr std::uint64_t kMostChunk = 1 << 16;

table::Column number_column() {
  return {.name = "line", .type = table::Type::kCount, .strength = table::Strength::kGiven, .key = true};
}

}  // namespace

std::string Rows::head(HeadOf of) const {
  if (of == HeadOf::kTable) return table::csv_head(plan_.kind.command, about_, columns_);
  table::Head head = about_;
  head.set(kRowCount, plan_.count);
  head.set(kShard, plan_.shard.number);
  head.set(kShards, plan_.shard.count);
  head.set(kChunk, std::uint64_t{plan_.chunk});
  if (of == HeadOf::kJournal) head.set(kUnfinished, true);
  std::vector<table::Column> columns = columns_;
  if (numbered_) columns.insert(columns.begin(), number_column());
  return table::csv_head(plan_.kind.command, head, columns);
}

std::optional<ShardHead> parse_shard_head(std::string_view lines) {
  std::optional<table::ParsedHead> parsed = table::parse_csv_head(lines);
  if (!parsed) return std::nullopt;
  const auto count = parsed->head.count(kRowCount), number = parsed->head.count(kShard),
             shards = parsed->head.count(kShards), chunk = parsed->head.count(kChunk);
  if (!count || !number || !shards || *number < 1 || *number > *shards || !chunk || *chunk < 1 || *chunk > kMostChunk) {
    return std::nullopt;
  }
  ShardHead head{.plan = {{parsed->kind}, *count, static_cast<std::uint32_t>(*chunk), {*number, *shards}}, .table = {}};
  head.unfinished = parsed->head.flag(kUnfinished);
  for (const std::string_view name : {kRowCount, kShard, kShards, kChunk, kUnfinished}) parsed->head.remove(name);
  head.numbered = parsed->columns.front() == number_column();
  if (head.numbered) parsed->columns.erase(parsed->columns.begin());
  head.table = table::csv_head(parsed->kind, parsed->head, parsed->columns);
  return head;
}

namespace {

std::string words_of(const table::HeadValue* value) {
  if (value == nullptr) return "none";
  constexpr std::size_t kMost = 200;
  const std::string words = table::words_of(*value);
  return text::printable(text::beginning(words, kMost)) + (words.size() > kMost ? "..." : "");
}

// The first value of either head that the other one does not have: "accuracy 0.001", "accuracy 0.01".
std::pair<std::string, std::string> first_difference(const table::ParsedHead& a, const table::ParsedHead& b) {
  for (const table::Head* const head : {&a.head, &b.head}) {
    for (const auto& [name, value] : head->values()) {
      const table::HeadValue *one = a.head.find(name), *other = b.head.find(name);
      if (one != nullptr && other != nullptr && *one == *other) continue;
      std::string label = name;
      text::replace_all(label, "_", " ");
      return {label + ' ' + words_of(one), label + ' ' + words_of(other)};
    }
  }
  if (a.kind != b.kind) return {"kind " + a.kind, "kind " + b.kind};
  const auto differ = std::ranges::mismatch(a.columns, b.columns);
  const auto column = [](auto at, const std::vector<table::Column>& columns) {
    return at == columns.end() ? std::string("fewer columns") : "column " + at->name;
  };
  if (a.columns != b.columns) return {column(differ.in1, a.columns), column(differ.in2, b.columns)};
  return {"another version of exactff", "version " + std::string(kVersion)};
}

}  // namespace

void require_same_head(const std::filesystem::path& file, std::string_view head, std::string_view other,
                       const std::string& whose, const std::string& suggestion) {
  if (head == other) return;
  const auto theirs = table::parse_csv_head(head), ours = table::parse_csv_head(other);
  const auto differ = theirs && ours ? first_difference(*theirs, *ours)
                                     : std::pair<std::string, std::string>("no head of this version", "one");
  text::refuse(file, 1,
               "belongs to a different request: it has " + differ.first + ", and " + whose + ' ' + differ.second,
               "rows of different requests must not be mixed", suggestion);
}

}  // namespace exactff::jobs
