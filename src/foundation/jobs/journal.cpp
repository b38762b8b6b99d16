#include "jobs/journal.h"

#include <algorithm>
#include <memory>
#include <system_error>
#include <utility>

#include "exactff/error.h"
#include "exactff/version.h"
#include "files/file.h"
#include "text/hashes.h"
#include "text/number_text.h"
#include "text/phrases.h"
#include "text/refuse.h"

namespace exactff::jobs {

namespace fs = std::filesystem;

// --- Blocks ---

namespace {

constexpr std::string_view kBeforeCrc = " bytes, crc ";
constexpr std::size_t kLongestLine = 512;
constexpr std::size_t kReadBytes = 1 << 20;

std::string opening_of(std::string_view word) { return "# " + std::string(word) + ' '; }

// The block whose comment line is at `offset`; nothing if the block is damaged. The name may hold any text, so the line
// is read from its end.
std::optional<Block> block_at(const File& file, std::uint64_t offset, std::string_view opening) {
  const std::string text = file.read(offset, kLongestLine);
  const std::size_t end = text.find('\n');
  const std::string_view line = std::string_view(text).substr(0, end);
  const std::size_t crc = line.rfind(kBeforeCrc), comma = line.rfind(", ", crc == 0 ? 0 : crc - 1);
  if (end == std::string::npos || crc == std::string_view::npos || comma == std::string_view::npos) return std::nullopt;
  if (!line.starts_with(opening) || comma < opening.size()) return std::nullopt;
  Block block{std::string(line.substr(opening.size(), comma - opening.size())), offset + end + 1};
  const auto bytes = text::whole_number<std::uint64_t>(line.substr(comma + 2, crc - comma - 2));
  if (!bytes || *bytes > file.size() - block.offset) return std::nullopt;
  block.bytes = *bytes;
  const std::size_t digits = crc + kBeforeCrc.size();
  if (line.substr(digits) != text::crc32_digits(line.substr(0, digits), read_bytes(file, block))) return std::nullopt;
  return block;
}

// Where the next comment line of a block may begin, after `offset`. Does not require a line break before it: that may
// be damaged, too.
std::optional<std::uint64_t> next_opening(const File& file, std::uint64_t offset, std::string_view opening) {
  for (++offset;;) {
    const std::string bytes = file.read(offset, kReadBytes);
    if (const std::size_t found = bytes.find(opening); found != std::string::npos) return offset + found;
    if (bytes.size() < kReadBytes) return std::nullopt;
    offset += bytes.size() - opening.size();  // the text may lie across two reads
  }
}

}  // namespace

std::optional<std::string> read_head(const File& file) {
  std::string text;
  for (std::size_t line = 0;;) {
    const std::string more = file.read(text.size(), kReadBytes);
    text += more;
    for (std::size_t end = text.find('\n', line); end != std::string::npos; end = text.find('\n', line)) {
      if (text[line] != '#') return text.substr(0, end + 1);
      line = end + 1;
    }
    if (more.empty()) return std::nullopt;
  }
}

std::string block_text(std::string_view word, std::string_view name, std::string_view bytes) {
  std::string text = opening_of(word);
  text.append(name).append(", ").append(std::to_string(bytes.size())).append(kBeforeCrc);
  text += text::crc32_digits(text, bytes) + '\n';
  text += bytes;
  return text;
}

Blocks find_blocks(const File& file, std::uint64_t head_bytes, std::string_view word) {
  const std::string opening = opening_of(word);
  Blocks blocks;
  blocks.end = head_bytes;
  std::optional<std::uint64_t> offset = head_bytes;
  while (offset && *offset < file.size()) {
    if (std::optional<Block> block = block_at(file, *offset, opening)) {
      blocks.damaged += *offset - blocks.end;
      blocks.end = block->offset + block->bytes;
      offset = blocks.end;
      blocks.list.push_back(std::move(*block));
    } else {
      offset = next_opening(file, *offset, opening);
    }
  }
  return blocks;
}

std::string read_bytes(const File& file, const Block& block) {
  return file.read(block.offset, static_cast<std::size_t>(block.bytes));
}

std::string name_of(Range range) { return std::to_string(range.first) + '+' + std::to_string(range.rows); }

Range range_of(const Block& block) {
  const std::string_view name = block.name;
  const std::size_t plus = name.find('+');
  if (plus == std::string_view::npos) return {};
  const auto first = text::whole_number<std::uint64_t>(name.substr(0, plus));
  const auto rows = text::whole_number<std::uint32_t>(name.substr(plus + 1));
  return first && rows ? Range{*first, *rows} : Range{};
}

std::string block_text(Range range, std::string_view lines) { return block_text(kRowsWord, name_of(range), lines); }

// --- Names of journals ---

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
    text::refuse(file,
                 folder   ? "is a folder"
                 : device ? "is a device"
                          : "is not the name of a file",
                 "finished rows are kept in a file, so that an interrupted run can continue",
                 "name a file, for example -o truth.csv");
  }
  if (existing == Existing::kRefuse && fs::exists(file, ignored)) {
    text::refuse(file, "already exists", "it may hold hours of work", "name another file, or replace it with --force");
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
    text::refuse(path(), "contains the finished work of an interrupted run", "it may be hours of work",
                 "continue with --resume, or start again with --force");
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
    text::refuse(path(), "already exists, and exactff did not write it",
                 "finished work must be kept in a file with this name", "move it away, or give another name with -o");
  }
  if (existing == Existing::kReplace || beginning == form_.head) return;
  if (!first.starts_with('#') || first.find(kVersion) == std::string_view::npos) {
    text::refuse(path(), "was written by another version of exactff", "its values may differ",
                 "continue with that version, or start again with --force");
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
