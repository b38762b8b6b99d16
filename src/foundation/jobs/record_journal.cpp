// A file of records. A record is appended when a piece of work is finished:
//
//   exactff journal 1, version 0.1.0\n
//   NAME BYTES CRC32\n  and then BYTES bytes and a line end, again and again
//
// The CRC-32 covers name and bytes. Reading stops at the first record that is torn or damaged, and new records
// overwrite everything from there on: only the sound beginning of a journal is used. A journal of another version is
// not used, since its values may differ. A file that is not a journal is never touched.
#include <charconv>
#include <map>
#include <mutex>

#include "exactff/jobs.h"
#include "exactff/version.h"
#include "files/file.h"
#include "text/crc32.h"

namespace exactff::jobs {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kBeginning = "exactff journal ";
constexpr std::size_t kLongestHead = 512;

std::string first_line() { return std::string(kBeginning) + "1, version " + kVersion + '\n'; }

std::string record(std::string_view name, std::string_view bytes) {
  std::string text(name);
  text += ' ' + std::to_string(bytes.size()) + ' ' + text::crc32_digits(name, bytes) + '\n';
  text += bytes;
  return text += '\n';
}

struct RecordHead {
  std::string name;
  std::uint64_t bytes = 0;
  std::string checksum;
  std::uint64_t length = 0;  // of the head, including its line end
};

std::optional<RecordHead> head_at(std::string_view text) {
  const std::size_t end = text.find('\n');
  if (end == std::string_view::npos) return std::nullopt;
  const std::string_view line = text.substr(0, end);
  const std::size_t first = line.find(' ');
  const std::size_t second = first == std::string_view::npos ? first : line.find(' ', first + 1);
  if (second == std::string_view::npos) return std::nullopt;
  RecordHead head{std::string(line.substr(0, first)), 0, std::string(line.substr(second + 1)), end + 1};
  const char* last = line.data() + second;
  const auto parsed = std::from_chars(line.data() + first + 1, last, head.bytes);
  if (parsed.ec != std::errc{} || parsed.ptr != last) return std::nullopt;
  return head;
}

struct RecordPlace {
  std::uint64_t offset = 0;
  std::uint64_t bytes = 0;
};

const files::FailureAdvice kAdvice{"finished work is kept there, so that an interrupted run can continue",
                                   "free some space, or name a folder on another disk"};
const Problem kInUse{.what = "another process is working on it",
                     .why = "two processes would compute the same values and damage each other's journal",
                     .suggestion = "wait for the other process, or name another folder with -o"};

}  // namespace

struct Journal::Impl {
  explicit Impl(const fs::path& path) : made(path), file(files::open_locked(path, kAdvice, kInUse)) {}

  // If the first line is cut off, nothing follows it.
  void require_ours(Existing existing) const {
    const std::string ours = first_line(), theirs = file.read(0, ours.size());
    if (ours.starts_with(theirs)) return;
    if (!theirs.starts_with(kBeginning)) {
      throw InputError({.file = file.path().string(),
                        .what = "already exists, and exactff did not write it",
                        .why = "finished work must be kept in a file with this name",
                        .suggestion = "move it away, or name another folder with -o"});
    }
    if (existing == Existing::kReplace) return;
    throw InputError({.file = file.path().string(),
                      .what = "was written by another version of exactff",
                      .why = "its values may differ",
                      .suggestion = "continue with that version, or start again with --force"});
  }

  void read() {
    const std::string ours = first_line();
    if (file.read(0, ours.size()) != ours) return;
    end = ours.size();
    while (const auto next = record_at(end)) end = *next;
  }

  // The end of the sound record at this offset; nothing if the record is torn, damaged or missing.
  std::optional<std::uint64_t> record_at(std::uint64_t offset) {
    const auto head = head_at(file.read(offset, kLongestHead));
    const std::uint64_t start = offset + (head ? head->length : 0);
    if (!head || head->bytes > file.size() || start + head->bytes + 1 > file.size()) return std::nullopt;
    const std::string bytes = file.read(start, head->bytes + 1);
    if (bytes.back() != '\n') return std::nullopt;
    if (text::crc32_digits(head->name, std::string_view(bytes).substr(0, head->bytes)) != head->checksum)
      return std::nullopt;
    places[head->name] = {start, head->bytes};
    return start + head->bytes + 1;
  }

  void begin() {
    places.clear();
    file.truncate(0);
    file.write(0, first_line());
    end = first_line().size();
  }

  files::MadeFolders made;
  files::File file;
  mutable std::mutex mutex;
  std::map<std::string, RecordPlace> places;
  std::uint64_t end = 0;
};

Journal::Journal(const fs::path& path, Existing existing) : impl_(std::make_unique<Impl>(path)) {
  impl_->require_ours(existing);
  impl_->read();
  if (existing == Existing::kRefuse && !impl_->places.empty()) {
    throw InputError({.file = path.string(),
                      .what = "contains the finished work of an interrupted run",
                      .why = "it may be hours of work",
                      .suggestion = "continue with --resume, or start again with --force"});
  }
  try {
    if (existing != Existing::kResume || impl_->end == 0) impl_->begin();
  } catch (const InputError&) {
    remove();
    throw;
  }
}

Journal::~Journal() {
  if (impl_->places.empty()) remove();
}

std::optional<std::string> Journal::find(const std::string& name) const {
  const std::scoped_lock lock(impl_->mutex);
  const auto found = impl_->places.find(name);
  if (found == impl_->places.end()) return std::nullopt;
  return impl_->file.read(found->second.offset, found->second.bytes);
}

void Journal::add(const std::string& name, std::string_view bytes) {
  const std::string text = record(name, bytes);
  const std::scoped_lock lock(impl_->mutex);
  impl_->file.write(impl_->end, text);
  impl_->places[name] = {impl_->end + text.size() - bytes.size() - 1, bytes.size()};
  impl_->end += text.size();
}

std::size_t Journal::size() const {
  const std::scoped_lock lock(impl_->mutex);
  return impl_->places.size();
}

const fs::path& Journal::path() const { return impl_->file.path(); }

void Journal::remove() { impl_->file.remove(); }

fs::path journal_of_folder(const fs::path& folder) {
  fs::path journal = folder.lexically_normal();
  if (!journal.has_filename()) journal = journal.parent_path();
  return journal += ".part";
}

}  // namespace exactff::jobs
