#include "matrix/rows.h"

#include <algorithm>
#include <charconv>
#include <optional>

#include "files/parallel.h"
#include "matrix/csv.h"
#include "text/refuse.h"

namespace exactff::matrix {
namespace {

constexpr std::string_view kNumber = "entry,";  // the first column of a journal

// Jobs take from microseconds to minutes. Small chunks share them out evenly; as many as this cost little.
constexpr std::uint64_t kChunks = 4096;
constexpr std::uint64_t kLargestChunk = 64;

Request require_valid(Request request) {
  jobs::require_shard(request.shard);
  const bool has_columns = !request.to.empty() || request.options.backs || request.options.open;
  if (request.scene == nullptr || request.from.empty() || !has_columns) {
    text::refuse(std::string("the matrix has no ") + (has_columns ? "rows" : "columns"), "there is nothing to compute",
                 "name patches by --from and --to");
  }
  return request;
}

struct NumberedLine {
  std::uint64_t entry = 0;
  std::string_view line;  // with its end
};

// Takes the first line off the text. Nothing if it has no number or no end.
std::optional<NumberedLine> take_line(std::string_view& text) {
  NumberedLine result;
  const std::size_t end = text.find('\n');
  if (end == std::string_view::npos) return std::nullopt;
  const auto number = std::from_chars(text.data(), text.data() + end, result.entry);
  if (number.ec != std::errc{} || *number.ptr != ',') return std::nullopt;
  const auto start = static_cast<std::size_t>(number.ptr - text.data()) + 1;
  result.line = text.substr(start, end + 1 - start);
  text.remove_prefix(end + 1);
  return result;
}

class EntryComputer : public jobs::Rows::Computer {
 public:
  explicit EntryComputer(const EntryJobs& entries) : entries_(entries) {}
  void append(std::uint64_t row, std::string& text) override {
    entries_.compute(row, [&](std::size_t entry, const ViewFactor& f) {
      text += std::to_string(entry) + ',';
      entries_.append_csv(text, entry, f);
    });
  }

 private:
  const EntryJobs& entries_;
};

}  // namespace

Rows::Rows(Request request)
    : request_(require_valid(std::move(request))),
      entries_(*request_.scene, request_.from, request_.to, request_.options) {
  const std::uint64_t count = entries_.count();
  const auto chunk = static_cast<std::uint32_t>(std::clamp<std::uint64_t>(count / kChunks, 1, kLargestChunk));
  const int threads = request_.options.threads > 0 ? request_.options.threads : files::usable_threads();
  plan_ = {kKind, count, chunk, request_.shard, threads};
}

std::string Rows::comments() const {
  return csv_comments(*request_.scene, request_.from, request_.to, request_.options.factors,
                      {request_.options.backs, request_.options.open, entries_.has_buried()});
}

std::string Rows::csv_head() const { return comments() + std::string(kColumns) + '\n'; }

std::string Rows::head() const {
  return comments() + rows_line(plan_) + shard_line(plan_) + std::string(kNumber) + std::string(kColumns) + '\n';
}

bool Rows::may_be_text_of(jobs::Range range, std::string_view text) const {
  for (std::uint64_t row = range.first; row < range.end(); ++row) {
    for (const std::size_t entry : entries_.entries_of(row)) {
      const std::optional<NumberedLine> line = take_line(text);
      if (!line || line->entry != entry) return false;
    }
  }
  return text.empty();
}

std::unique_ptr<Rows::Computer> Rows::computer() const { return std::make_unique<EntryComputer>(entries_); }

bool EntryLines::add(std::string_view text) {
  while (!text.empty()) {
    const std::optional<NumberedLine> line = take_line(text);
    if (!line) return false;
    lines_.emplace_back(line->entry, line->line);
  }
  return true;
}

std::string EntryLines::in_order() {
  std::ranges::sort(lines_);
  std::string text;
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    if (lines_[i].first != i) return {};
    text += lines_[i].second;
  }
  return text;
}

std::string head_without_jobs(const std::string& head) {
  const std::string pairs = "\n# " + std::string(kKind.rows) + ": ";
  const std::size_t from = head.find(pairs);
  const std::size_t to = from == std::string::npos ? from : head.find('\n', from + 1);
  const std::string columns = std::string(kNumber) + std::string(kColumns) + '\n';
  if (to == std::string::npos || head.substr(to + 1) != columns) return {};
  return head.substr(0, from + 1) + std::string(kColumns) + '\n';
}

}  // namespace exactff::matrix
