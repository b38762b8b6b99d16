#include "jobs/journal.h"

#include <algorithm>
#include <system_error>

#include "exactff/error.h"
#include "text/encoding.h"
#include "text/escape.h"
#include "text/phrases.h"

namespace exactff::jobs {

namespace fs = std::filesystem;

fs::path journal_of(const fs::path& file) {
  fs::path journal = file;
  return journal += ".part";
}

namespace {

// The head of the file with one additional comment line.
std::string journal_head(const Rows& rows) {
  const std::string head = rows.head();
  const std::size_t columns = head.rfind('\n', head.size() - 2) + 1;
  const RowKind& kind = rows.plan().kind;
  return head.substr(0, columns) + "# unfinished: " + std::string(kind.rows) +
         " in the order in which they were done; exactff " + std::string(kind.command) + " with --resume goes on\n" +
         head.substr(columns);
}

std::string_view line_at(std::string_view text, std::size_t at) {
  return text.substr(at, std::min(text.find('\n', at), text.size()) - at);
}

std::string shorten(std::string_view line) {
  constexpr std::size_t kMost = 200;
  return text::printable(text::beginning(line, kMost)) + (line.size() > kMost ? "..." : "");
}

File open_journal(const fs::path& path, const RowHooks& hooks) {
  File file = files::open_locked(
      path, {"the rows are kept in this file", "name a file in a folder that exists, is writable and has free space"},
      {.what = "another process is working on it",
       .why = "two processes would compute the same rows and damage each other's file",
       .suggestion = "wait for the other process, or name another file with -o"});
  if (file.lock() == File::Lock::kUnsupported && hooks.note) {
    hooks.note(path.string() + ": this file system cannot lock files; make sure that no other process uses the file");
  }
  return file;
}

}  // namespace

void require_free(const fs::path& file, Existing existing) {
  std::error_code ignored;
  const bool folder = fs::is_directory(file, ignored), device = fs::is_other(file, ignored);
  if (folder || device || !file.has_filename()) {
    throw InputError({.file = file.string(),
                      .what = folder   ? "is a folder"
                              : device ? "is a device"
                                       : "is not the name of a file",
                      .why = "finished rows are kept in a file, so that an interrupted run can continue",
                      .suggestion = "name a file, for example -o truth.csv"});
  }
  if (existing == Existing::kRefuse && fs::exists(file, ignored)) {
    throw InputError({.file = file.string(),
                      .what = "already exists",
                      .why = "it may hold hours of work",
                      .suggestion = "name another file, or replace it with --force"});
  }
}

namespace {

// Cells of a grid were once named by column and row, "12,7".
std::string about_old_ids(std::string_view line) {
  const bool of_grid = line.starts_with("# receivers: ") && line.find(", grid") != std::string_view::npos;
  return of_grid ? ". If only the hash differs, the file may be of an older version, which named the cell r7c12 of a "
                   "grid '12,7'; such a file cannot be continued or merged"
                 : "";
}

}  // namespace

void require_same_head(const fs::path& file, std::string_view head, std::string_view other, const std::string& whose,
                       const std::string& suggestion) {
  const std::string_view common =
      head.substr(0, static_cast<std::size_t>(
                         std::mismatch(head.begin(), head.end(), other.begin(), other.end()).first - head.begin()));
  if (common.size() == head.size() && head.size() == other.size()) return;
  const std::size_t line = common.rfind('\n') + 1;  // npos + 1 is 0
  throw InputError({.file = file.string(),
                    .line = static_cast<std::size_t>(std::count(common.begin(), common.end(), '\n')) + 1,
                    .what = "belongs to a different request: it says '" + shorten(line_at(head, line)) + "', and " +
                            whose + " '" + shorten(line_at(other, line)) + "'",
                    .why = "rows of different requests must not be mixed" + about_old_ids(line_at(head, line)),
                    .suggestion = suggestion});
}

RowJournal::RowJournal(const fs::path& file, const Rows& rows, Existing existing, const RowHooks& hooks)
    : file_(open_journal(journal_of(file), hooks)) {
  take_over(rows, existing, hooks);
  file_.set_failure_advice({"it contains the rows finished so far", "free some space, then continue with --resume"});
}

RowJournal::~RowJournal() {
  if (blocks_.empty() && end_ > 0) remove();
}

void RowJournal::take_over(const Rows& rows, Existing existing, const RowHooks& hooks) {
  const std::string head = journal_head(rows);
  const std::optional<std::string> found = read_head(file_);
  // A journal that is cut off within its head holds no rows.
  const bool nothing = !found && head.starts_with(file_.read(0, head.size()));
  if (existing == Existing::kReplace || nothing) return begin(head);
  require_same_head(file_.path(), found.value_or(file_.read(0, 4096)), head);
  Blocks there = find_blocks(file_, head.size());
  if (there.list.empty()) return begin(head);
  if (existing == Existing::kRefuse) {
    throw InputError({.file = file_.path().string(),
                      .what = "contains the finished rows of an interrupted run",
                      .why = "they would be lost",
                      .suggestion = "continue with --resume, or start again with --force"});
  }
  const std::uint64_t lost = there.damaged + file_.size() - there.end;
  if (lost > 0) {
    if (hooks.note) {
      hooks.note(file_.path().string() + ": " + text::counted(lost, "byte") +
                 " are incomplete or damaged; their rows are computed again");
    }
    file_.truncate(there.end);
  }
  end_ = synced_ = there.end;
  keep_usable(std::move(there.list), rows, hooks);
}

void RowJournal::begin(const std::string& head) {
  file_.truncate(0);
  try {
    file_.write(0, head);
  } catch (const InputError&) {  // no room: nothing is left behind
    remove();
    throw;
  }
  end_ = head.size();
}

// Keeps the rows of this request, each once. Nothing else is ever appended, but the file may have been tampered with.
void RowJournal::keep_usable(std::vector<Block> found, const Rows& rows, const RowHooks& hooks) {
  std::stable_sort(found.begin(), found.end(),
                   [](const Block& a, const Block& b) { return a.range.first < b.range.first; });
  const std::size_t count = found.size();
  std::uint64_t next = 0;
  for (const Block& block : found) {
    const Range& range = block.range;
    if (range.first < next || range.rows == 0 || !rows.may_be_one_block(range)) continue;
    if (!rows.may_be_text_of(range, read(block))) continue;
    blocks_.push_back(block);
    next = range.end();
  }
  if (blocks_.size() < count && hooks.note) {
    hooks.note(file_.path().string() + ": " + text::counted(count - blocks_.size(), "block") +
               " cannot be used here; their rows are computed again");
  }
}

void RowJournal::append(Range range, std::string_view lines) {
  const std::string text = block_text(range, lines);
  const std::lock_guard lock(mutex_);
  try {
    file_.write(end_, text);
  } catch (...) {
    try {
      file_.truncate(end_);
    } catch (...) {  // a torn block is recognised anyway
    }
    throw;
  }
  blocks_.push_back({range, end_ + text.size() - lines.size(), lines.size()});
  end_ += text.size();
}

void RowJournal::sync() {
  std::uint64_t end = 0;
  {
    const std::lock_guard lock(mutex_);
    end = end_;
  }
  if (end == synced_) return;
  file_.sync();
  if (synced_ == 0) files::sync_folder_of(file_.path());  // makes the directory entry of the file durable
  synced_ = end;
}

std::vector<Block> RowJournal::blocks() const {
  std::vector<Block> sorted = blocks_;
  std::sort(sorted.begin(), sorted.end(), [](const Block& a, const Block& b) { return a.range.first < b.range.first; });
  return sorted;
}

void Pace::add(std::uint64_t rows) {
  if (hooks_.cancelled && hooks_.cancelled()) throw Cancelled();
  done_ += rows;
  if (hooks_.progress) hooks_.progress({stage_, done_, total_});
}

}  // namespace exactff::jobs
