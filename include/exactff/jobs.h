// What long computations tell their caller, and how the caller ends them; and jobs, which are kept while they are done.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace exactff {

// --- Progress ---

// The progress of the work. Hooks are called with it from the thread that called the function.
struct Progress {
  std::string_view stage;
  std::size_t done = 0;
  std::size_t total = 0;
  // What takes long just now, in the words of messages: "from 'floor' to 'light'". Of all that is being computed, the
  // step that began first, if it has taken a second; empty if there is none, or where steps have no names.
  std::string_view slow = {};
};

// `cancelled` is called from any thread, every few milliseconds, also within a single pair of receiver and source. It
// must be quick. Reading a scene, the polygon Booleans and the building of Embree's trees do not call it, and can take
// seconds.
struct Hooks {
  std::function<void(const Progress&)> progress;
  std::function<bool()> cancelled;
};

// Thrown if Hooks::cancelled returned true.
class Cancelled : public std::runtime_error {
 public:
  Cancelled() : std::runtime_error("cancelled") {}
};

// During its lifetime, functions without a parameter for hooks use these hooks when this thread calls them:
// exact_form_factor and every method ask `cancelled`, and so do the functions that make receivers, which also report
// progress. They throw Cancelled where the answer is true; what they were writing to is then unspecified, but may be
// used again. Objects nest, and the innermost counts. Keeps a reference.
class HooksOfThread {
 public:
  explicit HooksOfThread(const Hooks& hooks);
  explicit HooksOfThread(Hooks&&) = delete;
  ~HooksOfThread();
  HooksOfThread(const HooksOfThread&) = delete;
  HooksOfThread& operator=(const HooksOfThread&) = delete;

 private:
  const Hooks* before_;
};

// A part of a result that was left out, and why: for example because the scene has nothing for it.
struct LeftOut {
  std::string what;
  std::string why;
};

}  // namespace exactff

// --- Jobs ---

// Work of many independent rows that is kept while it is done: of truth files (truth.h) and of matrices (matrix.h).
//
// Finished rows go at once to the journal FILE.part beside the file, even if the program is killed later. FILE itself
// appears when all rows are done. Its bytes depend on the request alone: not on threads, processes, shards,
// interruptions or resumptions.
namespace exactff::jobs {

// A part of the rows. Rows are counted in chunks from the first one; chunk k, counted from 0, belongs to shard `number`
// (from 1) of `count` if k mod count = number - 1.
struct Shard {
  std::uint64_t number = 1;
  std::uint64_t count = 1;
};

// What to do if there is already a file or a journal. Both may hold hours of work.
enum class Existing {
  kRefuse,   // InputError
  kResume,   // continue with the journal; a complete file of the same request is left as it is
  kReplace,  // start again; the old journal is lost at once, the old file when the new one is complete
};

// What Hooks tell and ask, and what rows add. All are called from the thread that called the function,
// except `cancelled`, which is called from any thread.
struct RowHooks {
  std::function<void(const Progress&)> progress = {};  // in rows
  std::function<bool()> cancelled = {};                // called often, as Hooks::cancelled
  std::function<void(const std::string&)> note = {};   // notes for the user, such as a damaged journal
  std::function<void(const std::string& row, double seconds)> slow_row = {};  // "receiver '7', source 'light'"
  double slow_seconds = 1.0;  // a row that takes at least this long is slow
};

struct Summary {
  std::uint64_t rows = 0;
  std::uint64_t resumed = 0;  // rows that were already finished
  std::uint64_t slow = 0;     // rows reported to RowHooks::slow_row
  double seconds = 0.0;       // wall time of computing the other rows
};

// The path of the journal of `file`: beside it, with ".part" appended.
[[nodiscard]] std::filesystem::path journal_of(const std::filesystem::path& file);

// Throws InputError if no such file can be made at `file`: if it is a folder or a device, or if it exists already and
// `existing` says to refuse.
void require_free(const std::filesystem::path& file, Existing existing);

// Sees the text of rows, which may begin and end anywhere.
using See = std::function<void(std::string_view text)>;

// Merges all shards of one request, of a truth file or of a matrix, into the bytes that the same request without shards
// gives. The order of the shards does not matter. Throws one InputError that lists all problems: shards that are
// missing, duplicate, damaged, unfinished or of another request. The file appears complete or not at all. `see` gets
// all rows.
Summary merge(const std::vector<std::filesystem::path>& shards, const std::filesystem::path& file,
              Existing existing = Existing::kRefuse, const RowHooks& hooks = {}, const See& see = {});

// Finished work, stored in a file beside the result so that an interrupted run can be resumed. Each piece of work has a
// name. Damaged pieces in the file count as not done. All functions may be called from any thread.
class Journal {
 public:
  // Throws InputError if the file cannot be written, if another process uses it, or if it holds finished work and
  // `existing` is kRefuse.
  Journal(const std::filesystem::path& file, Existing existing);
  ~Journal();  // removes a journal without content
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  [[nodiscard]] std::optional<std::string> find(const std::string& name) const;
  void add(const std::string& name, std::string_view bytes);
  [[nodiscard]] std::size_t size() const;  // number of pieces of work
  [[nodiscard]] const std::filesystem::path& path() const;
  void remove();  // call when all work is done

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// The path of the journal for a folder of results: beside the folder.
[[nodiscard]] std::filesystem::path journal_of_folder(const std::filesystem::path& folder);

}  // namespace exactff::jobs
