// From a request to its truth file.
//
// 1. Check the request, and that no other work would be destroyed: the file and its journal.
// 2. Read from the journal which rows are done. Distribute the others by chunks to any idle worker: threads of this
//    process, and other processes if there is a team.
// 3. Append finished rows to the journal at once, in any order. Make it durable every second.
// 4. When every row is in the journal, write the file in order under a temporary name and rename it. Then remove the
//    journal.
#include <algorithm>
#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <thread>

#include "exactff/truth.h"
#include "kernel/float_environment.h"
#include "text/phrases.h"
#include "truth/journal.h"
#include "truth/leader.h"
#include "truth/rows.h"
#include "truth/workers.h"

namespace exactff::truth {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr auto kAlone = std::chrono::milliseconds(100);   // between checks of progress and signals
constexpr auto kWithTeam = std::chrono::milliseconds(1);  // and at messages
constexpr auto kSyncEvery = std::chrono::seconds(1);

// Computes the rows that are not in the journal and appends them to it.
class Computation {
 public:
  Computation(const Rows& rows, RowJournal& journal, Team* team, const Hooks& hooks)
      : rows_(rows), journal_(journal), hooks_(hooks), schedule_(rows, journal.blocks()) {
    if (team != nullptr && team->size() > 1) leader_.emplace(*team, rows);
  }

  void run(Summary& summary) {
    const auto start = Clock::now();
    summary.resumed = rows_.shard_rows() - schedule_.rows();
    done_ = summary.resumed;
    tell(summary);
    if (schedule_.rows() > 0) compute(summary);
    summary.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  }

 private:
  void compute(Summary& summary) {
    Workers workers(
        rows_, rows_.request().threads, hooks_, [this] { return schedule_.next(); },
        [this](Finished finished) { keep(std::move(finished)); });
    try {
      attend(workers, summary);
    } catch (...) {
      workers.stop();
      while (!workers.wait_for(kAlone)) {
      }
      collect_the_rest();
      tell(summary);
      throw;
    }
    tell(summary);
  }

  // While threads work: handles progress, slow rows, other processes and the disk.
  void attend(Workers& workers, Summary& summary) {
    auto synced = Clock::now();
    for (bool ended = false; !ended || !all_done() || (leader_ && !leader_->all_here());) {
      if (ended) std::this_thread::sleep_for(kWithTeam);  // other processes have not ended
      ended = workers.wait_for(leader_ ? kWithTeam : kAlone);
      if (ended) workers.rethrow();
      if (leader_) leader_->attend([this] { return schedule_.next(); }, [this](Finished f) { keep(std::move(f)); });
      tell(summary);
      if (hooks_.cancelled && hooks_.cancelled()) throw Cancelled();
      if (Clock::now() - synced < kSyncEvery) continue;
      journal_.sync();
      synced = Clock::now();
    }
    journal_.sync();
  }

  // After the work was given up: still keeps what other processes have finished.
  void collect_the_rest() {
    if (leader_) leader_->cease([this](Finished f) { keep(std::move(f)); });
    journal_.sync();
  }

  // From any thread.
  void keep(Finished finished) {
    journal_.append(finished.range, finished.lines);
    const std::lock_guard lock(mutex_);
    done_ += finished.range.rows;
    slow_.insert(slow_.end(), finished.slow.begin(), finished.slow.end());
  }

  [[nodiscard]] bool all_done() {
    const std::lock_guard lock(mutex_);
    return done_ == rows_.shard_rows();
  }

  void tell(Summary& summary) {
    std::vector<SlowRow> slow;
    std::uint64_t done = 0;
    {
      const std::lock_guard lock(mutex_);
      slow.swap(slow_);
      done = done_;
    }
    summary.slow += slow.size();
    for (const SlowRow& row : slow) {
      if (hooks_.slow_row) hooks_.slow_row(rows_.name(row.row), row.seconds);
    }
    if (hooks_.progress) hooks_.progress({"rows", done, rows_.shard_rows()});
  }

  const Rows& rows_;
  RowJournal& journal_;
  const Hooks& hooks_;
  Schedule schedule_;
  std::optional<Leader> leader_;
  std::mutex mutex_;
  std::uint64_t done_ = 0;
  std::vector<SlowRow> slow_;
};

// Puts the finished blocks in order and writes the truth file, or the shard, then removes the journal. Requires every
// row to be in the journal.
void assemble(const Rows& rows, RowJournal& journal, const fs::path& file, const Hooks& hooks, Summary& summary) {
  WholeFile whole(
      file, {"all rows are finished and kept in " + journal.path().string() + "; the file needs the same space again",
             "free some space, then continue with --resume"});
  const bool in_blocks = rows.request().shard.count > 1;
  Pace pace("writing the file", rows.shard_rows(), hooks);
  Tally tally;
  whole.append(rows.head());
  const std::vector<Block> blocks = journal.blocks();
  // A chunk may have been computed in several blocks. The result must not depend on where it was divided.
  for (std::size_t i = 0; i < blocks.size();) {
    Range range{blocks[i].range.first, 0};
    std::string lines;
    for (; i < blocks.size() && blocks[i].range.first / kChunkRows == range.first / kChunkRows; ++i) {
      lines += journal.read(blocks[i]);
      range.rows += blocks[i].range.rows;
    }
    if (!tally.add_rows(lines, range.rows)) throw std::logic_error("a block of the journal is not what it was");
    whole.append(in_blocks ? block_text(range, lines) : lines);
    pace.add(range.rows);
  }
  whole.commit();
  journal.remove();
  summary.rows_by_status = tally.by_status();
}

bool is_there(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(path, ignored);
}

void add_shard(const File& file, std::uint64_t head_bytes, Tally& tally) {
  for (const Block& block : find_blocks(file, head_bytes).list) tally.add(read_lines(file, block));
}

void add_rows(const File& file, std::uint64_t offset, Tally& tally) {
  constexpr std::size_t kPieceBytes = 1 << 20;
  for (std::string text = file.read(offset, kPieceBytes); !text.empty(); text = file.read(offset, kPieceBytes)) {
    tally.add(text);
    offset += text.size();
  }
}

// A file without a journal is complete, since files appear only when complete.
Summary account_of(const fs::path& path, const Rows& rows) {
  const File file(path, File::Mode::kRead);
  const std::string head = rows.head();
  require_same_head(path, read_head(file).value_or(file.read(0, head.size())), head);
  Tally tally;
  (rows.request().shard.count > 1 ? add_shard : add_rows)(file, head.size(), tally);
  if (!tally.whole() || tally.rows() != rows.shard_rows()) {
    throw InputError({.file = path.string(),
                      .what = "is damaged: " + std::to_string(tally.rows()) + " of " +
                              text::counted(rows.shard_rows(), "row") + " can be read",
                      .why = "a complete file has all rows",
                      .suggestion = "compute it again with --force"});
  }
  Summary summary;
  summary.rows = summary.resumed = tally.rows();
  summary.rows_by_status = tally.by_status();
  return summary;
}

}  // namespace

Summary write(Request request, const fs::path& file, Existing existing, const Hooks& hooks, Team* team) {
  const kernel::StandardArithmetic arithmetic;
  const Rows rows(std::move(request));
  require_free(file, existing);
  if (existing == Existing::kResume && is_there(file) && !is_there(journal_of(file))) return account_of(file, rows);
  Summary summary;
  summary.rows = rows.shard_rows();
  RowJournal journal(file, rows, existing, hooks);
  Computation(rows, journal, team, hooks).run(summary);
  assemble(rows, journal, file, hooks, summary);
  return summary;
}

Summary write(Request request, const fs::path& file, Existing existing, const Hooks& hooks) {
  return write(std::move(request), file, existing, hooks, nullptr);
}

}  // namespace exactff::truth
