#include "jobs/compute.h"

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <utility>

#include "kernel/expect.h"
#include "text/phrases.h"

namespace exactff::jobs {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using files::WorkerPool;

// --- what remains to be computed ---

Schedule::Schedule(const Rows& rows, std::span<const Block> done)
    : plan_(rows.plan()), position_((plan_.shard.number - 1) * plan_.chunk) {
  for (const Block& block : done) done_.push_back(range_of(block));
  rows_ = plan_.shard_rows();
  for (const Range& range : done_) rows_ -= range.rows;
}

std::optional<Range> Schedule::next() {
  const std::lock_guard lock(mutex_);
  return advance();
}

std::optional<Range> Schedule::advance() {
  while (position_ < plan_.count) {
    const std::uint64_t chunk_end = std::min(plan_.count, (position_ / plan_.chunk + 1) * plan_.chunk);
    const bool more_done = next_done_ < done_.size();
    if (more_done && done_[next_done_].first == position_) {
      position_ = done_[next_done_++].end();
    } else {
      const std::uint64_t end = more_done ? std::min(chunk_end, done_[next_done_].first) : chunk_end;
      const Range range{position_, static_cast<std::uint32_t>(end - position_)};
      position_ = end;
      if (position_ == chunk_end) position_ += (plan_.shard.count - 1) * plan_.chunk;
      return range;
    }
    if (position_ == chunk_end) position_ += (plan_.shard.count - 1) * plan_.chunk;
  }
  return std::nullopt;
}

// --- a thread ---

namespace {

constexpr auto kLongestUndelivered = std::chrono::seconds(1);

// Rows that are finished and not yet delivered.
class Batch {
 public:
  Batch(std::uint64_t first, const DeliverRows& deliver) : deliver_(deliver) { finished_.range.first = first; }

  void add(std::string_view line) {
    finished_.lines += line;
    ++finished_.range.rows;
    if (Clock::now() - since_ >= kLongestUndelivered) deliver();
  }
  void add_slow(SlowRow slow) { finished_.slow.push_back(slow); }
  void deliver() {
    Finished whole{{finished_.range.end(), 0}, {}, {}};
    std::swap(whole, finished_);
    since_ = Clock::now();
    if (whole.range.rows > 0) deliver_(std::move(whole));
  }

 private:
  const DeliverRows& deliver_;
  Finished finished_;
  Clock::time_point since_ = Clock::now();
};

}  // namespace

void compute_rows(const Rows& rows, double slow_seconds, const TakeRange& take, const DeliverRows& deliver,
                  WorkerPool::Worker& worker) {
  std::string line;
  while (!worker.must_stop()) {
    const std::optional<Range> range = take();
    if (!range) return;
    Batch batch(range->first, deliver);
    const std::unique_ptr<Rows::Computer> computer = rows.computer();
    try {
      for (std::uint64_t row = range->first; row < range->end() && !worker.must_stop(); ++row) {
        const auto start = worker.begin(row);
        line.clear();
        computer->append(row, line);
        const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
        if (seconds >= slow_seconds) batch.add_slow({row, seconds});
        batch.add(line);
      }
    } catch (...) {
      batch.deliver();
      throw;
    }
    batch.deliver();
  }
}

// --- all of them ---

namespace {

constexpr auto kAlone = std::chrono::milliseconds(100);   // between checks of progress and signals
constexpr auto kWithTeam = std::chrono::milliseconds(1);  // and at messages
constexpr auto kSyncEvery = std::chrono::seconds(1);

class Computation {
 public:
  Computation(const Rows& rows, RowJournal& journal, Team* team, const RowHooks& hooks)
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
    WorkerPool pool(rows_.plan().threads, {{}, hooks_.cancelled}, [this](WorkerPool::Worker& worker) {
      compute_rows(rows_, hooks_.slow_seconds, take_, deliver_, worker);
    });
    try {
      attend(pool, summary);
    } catch (...) {
      pool.stop();
      while (!pool.wait_for(kAlone)) {
      }
      collect_the_rest();
      tell(summary);
      throw;
    }
    tell(summary);
  }

  // While threads work: handles progress, slow rows, other processes and the disk.
  void attend(WorkerPool& pool, Summary& summary) {
    auto synced = Clock::now();
    for (bool ended = false; !ended || !all_done() || (leader_ && !leader_->all_here());) {
      if (ended) std::this_thread::sleep_for(kWithTeam);  // other processes have not ended
      ended = pool.wait_for(leader_ ? kWithTeam : kAlone);
      if (ended) pool.rethrow();
      if (leader_) leader_->attend(take_, deliver_);
      tell(summary, pool.slow_step(files::kSlowStep));
      if (hooks_.cancelled && hooks_.cancelled()) throw Cancelled();
      if (Clock::now() - synced < kSyncEvery) continue;
      journal_.sync();
      synced = Clock::now();
    }
    journal_.sync();
  }

  // After the work was given up: still keeps what other processes have finished.
  void collect_the_rest() {
    if (leader_) leader_->cease(deliver_);
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

  void tell(Summary& summary, std::optional<std::uint64_t> slow_now = {}) {
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
    if (!hooks_.progress) return;
    const std::string name = slow_now ? rows_.name(*slow_now) : std::string();
    hooks_.progress({rows_.plan().kind.rows, done, rows_.shard_rows(), name});
  }

  const Rows& rows_;
  RowJournal& journal_;
  const RowHooks& hooks_;
  Schedule schedule_;
  const TakeRange take_ = [this] { return schedule_.next(); };
  const DeliverRows deliver_ = [this](Finished finished) { keep(std::move(finished)); };
  std::optional<Leader> leader_;
  std::mutex mutex_;
  std::uint64_t done_ = 0;
  std::vector<SlowRow> slow_;
};

}  // namespace

void compute_missing(const Rows& rows, RowJournal& journal, Team* team, const RowHooks& hooks, Summary& summary) {
  Computation(rows, journal, team, hooks).run(summary);
}

files::FailureAdvice advice_while_in_journal(const RowJournal& journal) {
  return {"all rows are finished and kept in " + journal.path().string() + "; the file needs the same space again",
          "free some space, then continue with --resume"};
}

// A chunk may have been computed in several blocks. The result must not depend on where it was divided.
void for_each_chunk(const Rows& rows, const RowJournal& journal, const RowHooks& hooks, const TakeChunk& take) {
  const std::uint32_t chunk = rows.plan().chunk;
  Pace pace("writing the file", rows.shard_rows(), hooks);
  const std::vector<Block> blocks = journal.blocks();
  [[maybe_unused]] std::uint64_t taken = 0;  // for the requirement
  for (std::size_t i = 0; i < blocks.size();) {
    Range range{range_of(blocks[i]).first, 0};
    std::string text;
    for (; i < blocks.size() && range_of(blocks[i]).first / chunk == range.first / chunk; ++i) {
      text += journal.read(blocks[i]);
      range.rows += range_of(blocks[i]).rows;
    }
    if (!take(range, text)) throw std::logic_error("a block of the journal is not what it was");
    pace.add(range.rows);
    taken += range.rows;
  }
  EXACTFF_EXPECT(taken == rows.shard_rows());
}

void write_rows(const Rows& rows, const RowJournal& journal, const fs::path& file, const RowHooks& hooks,
                const TakeChunk& see) {
  WholeFile whole(file, advice_while_in_journal(journal));
  const bool in_blocks = rows.plan().shard.count > 1;
  whole.append(rows.head());
  for_each_chunk(rows, journal, hooks, [&](Range range, const std::string& text) {
    whole.append(in_blocks ? block_text(range, text) : text);
    return see(range, text);
  });
  whole.commit();
}

bool is_complete(const fs::path& file, Existing existing) {
  return existing == Existing::kResume && files::is_there(file) && !files::is_there(journal_of(file));
}

std::uint64_t require_head(const File& file, const Rows& rows) {
  const std::string head = rows.head();
  require_same_head(file.path(), read_head(file).value_or(file.read(0, head.size())), head);
  return head.size();
}

void require_shard_file(const File& file, const Rows& rows, const std::function<void(const std::string& text)>& take) {
  std::uint64_t found = 0;
  for (const Block& block : find_blocks(file, require_head(file, rows), kRowsWord).list) {
    const Range range = range_of(block);
    const std::string text = read_bytes(file, block);
    if (!rows.may_be_one_block(range) || !rows.may_be_text_of(range, text)) continue;
    found += range.rows;
    take(text);
  }
  if (found != rows.shard_rows()) refuse_damaged(file.path(), rows, found);
}

void refuse_damaged(const fs::path& file, const Rows& rows, std::uint64_t rows_found) {
  throw InputError({.file = file.string(),
                    .what = "is damaged: " + std::to_string(rows_found) + " of " +
                            text::counted(rows.shard_rows(), rows.plan().kind.row) + " can be read",
                    .why = "a complete file has all of them",
                    .suggestion = "compute it again with --force"});
}

}  // namespace exactff::jobs
