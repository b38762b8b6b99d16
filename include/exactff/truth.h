// Truth files: certified form factors of many receivers, one row per receiver and source, that other programs are held
// against.
//
// A truth file is a CSV: comment lines "# key: value" with all that its bytes depend on, one line of column names,
// then the rows, receiver by receiver and for each the sources in order. Its bytes depend on the request alone: not on
// threads, machines, shards, interruptions or resumptions. While it is made, what is finished is in the journal
// FILE.part beside it, whatever happens to the program; FILE itself appears when it is complete.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "exactff/exact.h"
#include "exactff/receiver.h"
#include "exactff/scene.h"
#include "exactff/study.h"

namespace exactff::truth {

// Rows are dealt out by chunks of so many, counted from the first row; a shard is made of whole chunks.
inline constexpr std::uint32_t kChunkRows = 64;

// Chunk k, counted from 0, belongs to shard `number` (from 1) of `count` where k mod count = number - 1.
struct Shard {
  std::uint64_t number = 1;
  std::uint64_t count = 1;
};

// What is asked for. Refers to the scene.
struct Request {
  const Scene* scene = nullptr;
  std::string scene_name;           // for the header
  std::vector<Receiver> receivers;  // an empty id is replaced by the receiver's number, from 1
  std::string receivers_name;       // "floor, grid 32x32", or the name of a file
  std::vector<Selection> sources;   // empty: every patch that emits
  // A column more: F with no occluder at all, correctly rounded ("0" is a proved zero, "0.0" an underflow).
  bool unoccluded = false;
  // A column more: visible over whole unclipped area, correctly rounded.
  bool visible_fraction = false;
  Engine engine = Engine::kEdges;  // no byte depends on it
  Shard shard;                     // other than 1/1: the file holds this shard's rows, for merge()
  int threads = 0;                 // 0: as many as this process may use
};

// What to do where there is a file or a journal already: both may hold hours of work.
enum class Existing {
  kRefuse,   // InputError
  kResume,   // go on with the journal; a complete file of the same request is left as it is
  kReplace,  // begin anew; the journal is lost at once, the file when the new one is complete
};

// All are called from the thread that called write() or merge(), but `cancelled`, which is asked from any thread.
struct Hooks {
  std::function<void(const study::Progress&)> progress = {};  // in rows
  std::function<bool()> cancelled = {};                       // asked between rows
  std::function<void(const std::string&)> note = {};          // what is worth telling, such as a damaged journal
  std::function<void(const std::string& row, double seconds)> slow_row = {};  // "receiver '7', source 'light'"
  double slow_seconds = 1.0;  // a row that takes at least this long is slow
};

struct Summary {
  std::uint64_t rows = 0;
  std::array<std::uint64_t, 4> rows_by_status{};  // by Status
  std::uint64_t resumed = 0;                      // rows that were there already
  std::uint64_t slow = 0;                         // rows that were told to the hook
  double seconds = 0.0;                           // wall time of computing the others

  [[nodiscard]] std::uint64_t with(Status status) const { return rows_by_status[static_cast<std::size_t>(status)]; }
};

// Where the journal of `file` is: beside it, with ".part" appended.
[[nodiscard]] std::filesystem::path journal_of(const std::filesystem::path& file);

// Computes the rows and writes the file. Throws InputError for what is wrong with the request, the file or the journal
// (made for another request, in use by another process) and where nothing can be written; study::Cancelled where the
// hooks say so. Whatever is thrown, and even if the process is killed, the rows in the journal stay valid: at most a
// second of work and the row in hand of each thread are lost.
Summary write(Request request, const std::filesystem::path& file, Existing existing = Existing::kRefuse,
              const Hooks& hooks = {});

// Puts all shards of one request together: the same bytes as one write() without shards. The order of the shards does
// not matter. Throws one InputError with all that is wrong: a shard that is missing, doubled, damaged, unfinished or of
// another request. The file appears whole or not at all.
Summary merge(const std::vector<std::filesystem::path>& shards, const std::filesystem::path& file,
              Existing existing = Existing::kRefuse, const Hooks& hooks = {});

}  // namespace exactff::truth
