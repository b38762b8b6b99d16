#include "jobs/journal.h"

#include <algorithm>
#include <memory>
#include <system_error>
#include <utility>

#include "exactff/error.h"
#include "exactff/version.h"
#include "files/file.h"
#include "text/phrases.h"

namespace exactff::jobs {

namespace fs = std::filesystem;

fs::path journal_of(const fs::path& file) {
  fs::path journal = file;
  return journal += ".part";
}

namespace {

std::string_view line_at(std::string_view text, std::size_t at) {
  return text.substr(at, std::min(text.find('\n', at), text.size()) - at);
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

// --- the file ---

namespace {

const files::FailureAdvice kAdvice{"finished work is kept in this file, so that an interrupted run can continue",
                                   "name a file in a folder that exists, is writable and has free space"};
const files::FailureAdvice kAdviceWithWork{"it contains what is finished so far",
                                           "free some space, then continue with --resume"};
const Problem kInUse{.what = "another process is working on it",
                     .why = "two processes would compute the same values and damage each other's file",
                     .suggestion = "wait for the other process, or give another name with -o"};

}  // namespace

JournalFile::JournalFile(const fs::path& path, JournalForm form, Existing existing,
                         const std::function<void(const std::string&)>& note)
    : form_(std::move(form)), file_(files::open_locked(path, kAdvice, kInUse)) {
  if (note && file_.lock() == File::Lock::kUnsupported) {
    note(path.string() + ": this file system cannot lock files; make sure that no other process uses the file");
  }
  take_over(existing, note);
  file_.set_failure_advice(kAdviceWithWork);
}

JournalFile::~JournalFile() {
  if (blocks_.empty()) remove();
}

void JournalFile::take_over(Existing existing, const std::function<void(const std::string&)>& note) {
  const std::string beginning = file_.read(0, form_.head.size());
  // A journal that is cut off within its head holds nothing.
  if (beginning != form_.head && form_.head.starts_with(beginning)) return begin();
  require_same(beginning, existing);
  if (existing == Existing::kReplace) return begin();
  Blocks there = find_blocks(file_, form_.head.size(), form_.word);
  if (there.list.empty()) return begin();
  if (existing == Existing::kRefuse) {
    throw InputError({.file = path().string(),
                      .what = "contains the finished work of an interrupted run",
                      .why = "it may be hours of work",
                      .suggestion = "continue with --resume, or start again with --force"});
  }
  const std::uint64_t lost = there.damaged + file_.size() - there.end;
  if (lost > 0) {
    if (note) {
      note(path().string() + ": " + text::counted(lost, "byte") +
           " are incomplete or damaged; what they held is computed again");
    }
    file_.truncate(there.end);
  }
  end_ = synced_ = there.end;
  for (Block& block : there.list) blocks_.insert_or_assign(block.name, block);
}

// The first line names the program and its version.
void JournalFile::require_same(std::string_view beginning, Existing existing) const {
  const std::string_view first = line_at(beginning, 0);
  if (first.find("exactff") == std::string_view::npos) {
    throw InputError({.file = path().string(),
                      .what = "already exists, and exactff did not write it",
                      .why = "finished work must be kept in a file with this name",
                      .suggestion = "move it away, or give another name with -o"});
  }
  if (existing == Existing::kReplace || beginning == form_.head) return;
  if (!first.starts_with('#') || first.find(kVersion) == std::string_view::npos) {
    throw InputError({.file = path().string(),
                      .what = "was written by another version of exactff",
                      .why = "its values may differ",
                      .suggestion = "continue with that version, or start again with --force"});
  }
  require_same_head(path(), read_head(file_).value_or(file_.read(0, 4096)), form_.head);
}

void JournalFile::begin() {
  file_.truncate(0);
  try {
    file_.write(0, form_.head);
  } catch (const InputError&) {  // no room: nothing is left behind
    remove();
    throw;
  }
  end_ = form_.head.size();
}

void JournalFile::add(const std::string& name, std::string_view bytes) {
  const std::string text = block_text(form_.word, name, bytes);
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
  blocks_.insert_or_assign(name, Block{name, end_ + text.size() - bytes.size(), bytes.size()});
  end_ += text.size();
}

std::optional<std::string> JournalFile::find(const std::string& name) const {
  const std::lock_guard lock(mutex_);
  const auto found = blocks_.find(name);
  if (found == blocks_.end()) return std::nullopt;
  return read(found->second);
}

void JournalFile::forget(const std::string& name) {
  const std::lock_guard lock(mutex_);
  blocks_.erase(name);
}

void JournalFile::sync() {
  std::uint64_t end = 0;
  {
    const std::lock_guard lock(mutex_);
    end = end_;
  }
  if (end == synced_) return;
  file_.sync();
  if (synced_ == 0) files::sync_folder_of(path());  // makes the directory entry of the file durable
  synced_ = end;
}

std::size_t JournalFile::size() const {
  const std::lock_guard lock(mutex_);
  return blocks_.size();
}

std::vector<Block> JournalFile::blocks() const {
  const std::lock_guard lock(mutex_);
  std::vector<Block> all;
  for (const auto& [name, block] : blocks_) all.push_back(block);
  return all;
}

// --- of rows ---

RowJournal::RowJournal(const fs::path& file, const Rows& rows, Existing existing, const RowHooks& hooks)
    : file_(journal_of(file), {rows.head(HeadOf::kJournal), std::string(kRowsWord)}, existing, hooks.note) {
  // Nothing but rows of this request, each once, is ever appended, but the file may have been tampered with.
  std::size_t unusable = 0;
  std::uint64_t next = 0;
  for (const Block& block : blocks()) {
    const Range range = range_of(block);
    if (range.first >= next && rows.may_be_one_block(range) && rows.may_be_text_of(range, read(block))) {
      next = range.end();
    } else {
      file_.forget(block.name);
      ++unusable;
    }
  }
  if (unusable > 0 && hooks.note) {
    hooks.note(path().string() + ": " + text::counted(unusable, "block") +
               " cannot be used here; their rows are computed again");
  }
}

std::vector<Block> RowJournal::blocks() const {
  std::vector<Block> sorted = file_.blocks();
  std::ranges::sort(sorted, {}, [](const Block& block) { return range_of(block).first; });
  return sorted;
}

// --- of other work ---

struct Journal::Impl {
  explicit Impl(const fs::path& path, Existing existing)
      : made(path),
        file(path,
             {std::string("# exactff ") + kVersion + " journal: finished work of a run that continues with --resume\n",
              "work"},
             existing, {}) {}

  files::MadeFolders made;
  JournalFile file;
};

Journal::Journal(const fs::path& path, Existing existing) : impl_(std::make_unique<Impl>(path, existing)) {}
Journal::~Journal() = default;

std::optional<std::string> Journal::find(const std::string& name) const { return impl_->file.find(name); }
void Journal::add(const std::string& name, std::string_view bytes) { impl_->file.add(name, bytes); }
std::size_t Journal::size() const { return impl_->file.size(); }
const fs::path& Journal::path() const { return impl_->file.path(); }
void Journal::remove() { impl_->file.remove(); }

fs::path journal_of_folder(const fs::path& folder) {
  fs::path journal = folder.lexically_normal();
  if (!journal.has_filename()) journal = journal.parent_path();
  return journal += ".part";
}

// --- progress ---

void Pace::add(std::uint64_t rows) {
  if (hooks_.cancelled && hooks_.cancelled()) throw Cancelled();
  done_ += rows;
  if (hooks_.progress) hooks_.progress({stage_, done_, total_});
}

}  // namespace exactff::jobs
