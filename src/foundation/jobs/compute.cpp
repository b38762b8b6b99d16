#include "jobs/compute.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <stdexcept>
#include <thread>
#include <utility>

#include "files/file.h"
#include "kernel/expect.h"
#include "text/phrases.h"
#include "text/refuse.h"

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

// A file in which nothing of the journal is lost, whatever happens to it.
files::FailureAdvice advice_while_in_journal(const RowJournal& journal) {
  return {"all rows are finished and kept in " + journal.path().string() + "; the file needs the same space again",
          "free some space, then continue with --resume"};
}

using TakeChunk = std::function<bool(Range range, const std::string& text)>;

// Calls take(range, text) for every chunk, in order. Requires every row of the shard to be in the journal. A chunk may
// have been computed in several blocks; the result must not depend on where it was divided.
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

// The rows after their head: one after another, or the chunks of a shard as blocks.
class TableFile {
 public:
  TableFile(const fs::path& path, const std::string& head, bool numbered, const See& see,
            const files::FailureAdvice& advice = {})
      : file_(path, advice), numbered_(numbered), see_(see) {
    file_.append(head);
  }

  [[nodiscard]] bool add(const std::string& text) {
    if (see_) see_(text);
    if (numbered_) return lines_.add(text);
    file_.append(text);
    return true;
  }
  void add_block(Range range, const std::string& text) {
    if (see_) see_(text);
    file_.append(block_text(range, text));
  }
  // Returns false if numbered lines are missing or occur twice.
  [[nodiscard]] bool commit() {
    if (const std::string lines = lines_.take(); numbered_) {
      if (lines.empty()) return false;
      file_.append(lines);
    }
    file_.commit();
    return true;
  }

 private:
  WholeFile file_;
  bool numbered_;
  const See& see_;
  LinesInOrder lines_;
};

void write_file(const Rows& rows, const RowJournal& journal, const fs::path& path, const RowHooks& hooks,
                const See& see) {
  const bool in_blocks = rows.plan().shard.count > 1;
  TableFile file(path, rows.head(), rows.are_numbered() && !in_blocks, see, advice_while_in_journal(journal));
  for_each_chunk(rows, journal, hooks, [&](Range range, const std::string& text) {
    if (!in_blocks) return rows.may_be_text_of(range, text) && file.add(text);
    file.add_block(range, text);
    return rows.may_be_text_of(range, text);
  });
  if (!file.commit()) throw std::logic_error("lines of the table are missing in the journal");
}

// --- Files that are complete ---

// Whether `existing` continues a run, and this file of it is complete: files appear only when they are complete.
bool is_complete(const fs::path& file, Existing existing) {
  return existing == Existing::kResume && files::is_there(file) && !files::is_there(journal_of(file));
}

[[noreturn]] void refuse_damaged(const fs::path& file, const Rows& rows, std::uint64_t found, std::uint64_t all) {
  text::refuse(file,
               "is damaged: " + std::to_string(found) + " of " +
                   text::counted(all, rows.plan().kind.row, rows.plan().kind.rows) + " can be read",
               "a complete file has all of them", "compute it again with --force");
}

void read_shard(const File& file, const Rows& rows, std::uint64_t head_bytes, const See& see) {
  std::uint64_t found = 0;
  for (const Block& block : find_blocks(file, head_bytes, kRowsWord).list) {
    const Range range = range_of(block);
    const std::string text = read_bytes(file, block);
    if (!rows.may_be_one_block(range) || !rows.may_be_text_of(range, text)) continue;
    found += range.rows;
    if (see) see(text);
  }
  if (found != rows.shard_rows()) refuse_damaged(file.path(), rows, found, rows.shard_rows());
}

void read_lines_of(const File& file, const Rows& rows, std::uint64_t offset, const See& see) {
  constexpr std::size_t kPieceBytes = 1 << 20;
  std::uint64_t found = 0;
  char last = '\n';
  for (std::string text = file.read(offset, kPieceBytes); !text.empty(); text = file.read(offset, kPieceBytes)) {
    found += static_cast<std::uint64_t>(std::ranges::count(text, '\n'));
    last = text.back();
    offset += text.size();
    if (see) see(text);
  }
  if (last != '\n' || found != rows.line_count()) refuse_damaged(file.path(), rows, found, rows.line_count());
}

void read_complete(const fs::path& path, const Rows& rows, const See& see) {
  const File file(path, File::Mode::kRead);
  const std::string head = rows.head();
  require_same_head(file.path(), read_head(file).value_or(file.read(0, head.size())), head);
  if (rows.plan().shard.count > 1) {
    read_shard(file, rows, head.size(), see);
  } else {
    read_lines_of(file, rows, head.size(), see);
  }
}

// --- Shards ---

// Every shard holds its chunks in order, so reading all shards in parallel gives the rows in order.

using text::refuse;

struct ShardFile {
  File file;
  ShardHead head;
  std::vector<Block> blocks;
};

void read_chunks(ShardFile& shard, std::uint64_t head_bytes) {
  const Plan& plan = shard.head.plan;
  Blocks found = find_blocks(shard.file, head_bytes, kRowsWord);
  bool whole = found.damaged == 0 && found.end == shard.file.size() && found.list.size() == plan.shard_chunks();
  for (std::size_t i = 0; whole && i < found.list.size(); ++i)
    whole = range_of(found.list[i]) == plan.chunk_of_shard(i);
  if (!whole) {
    refuse(shard.file.path(),
           "is damaged: " + std::to_string(found.list.size()) + " of its " +
               text::counted(plan.shard_chunks(), "chunk") + " of " + plan.kind.rows + " are intact",
           "every " + plan.kind.row + " is needed", "delete it and compute this shard again");
  }
  shard.blocks = std::move(found.list);
}

ShardFile read_shard_file(const fs::path& path) {
  File file(path, File::Mode::kRead);
  const std::string text = read_head(file).value_or("");
  std::optional<ShardHead> head = parse_shard_head(text);
  if (!head) {
    refuse(path, "is not a shard of a table", "shards are written with --shard 1/4 and so on, by this version",
           "name only those files");
  }
  const std::string& command = head->plan.kind.command;
  if (head->unfinished) {
    refuse(path, "is the journal of an unfinished run", "rows are missing",
           "complete it with the same exactff " + command + " command and --resume");
  }
  if (head->plan.shard.count < 2) refuse(path, "is no shard", "it has no part of the rows", "name the shards");
  ShardFile shard{std::move(file), std::move(*head), {}};
  read_chunks(shard, text.size());
  return shard;
}

// By shard number.
using ShardFiles = std::map<std::uint64_t, ShardFile>;

void add(ShardFiles& shards, ShardFile shard) {
  const Plan plan = shard.head.plan;
  if (!shards.empty()) {
    const ShardFile& first = shards.begin()->second;
    const Plan& other = first.head.plan;
    if (plan.shard.count != other.shard.count || plan.chunk != other.chunk) {
      refuse(shard.file.path(), "is one of " + text::counted(plan.shard.count, "shard"),
             first.file.path().string() + " is one of " + std::to_string(other.shard.count),
             "name shards of the same request");
    }
    require_same_head(shard.file.path(), shard.head.table, first.head.table, first.file.path().string() + " has",
                      "name shards of the same request");
  }
  const auto [place, is_new] = shards.try_emplace(plan.shard.number, std::move(shard));
  if (is_new) return;
  refuse(shard.file.path(),
         "is shard " + std::to_string(place->first) + ", and so is " + place->second.file.path().string(),
         "its " + plan.kind.rows + " would occur twice", "give each shard once");
}

ShardFiles read_all(const std::vector<fs::path>& paths, Pace& pace) {
  std::vector<Problem> problems;
  ShardFiles shards;
  for (const fs::path& path : paths) {
    pace.add(1);
    try {
      add(shards, read_shard_file(path));
    } catch (const InputError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  }
  if (!problems.empty()) throw InputError(std::move(problems));
  return shards;
}

void require_all(const ShardFiles& shards) {
  if (shards.empty()) refuse("no shard is named", "there is nothing to merge", "name the files of the shards");
  const Plan& plan = shards.begin()->second.head.plan;
  if (shards.size() == plan.shard.count) return;
  constexpr std::size_t kMostNamed = 20;
  std::vector<std::string> missing;
  for (std::uint64_t number = 1; number <= plan.shard.count && missing.size() <= kMostNamed; ++number) {
    if (!shards.contains(number)) missing.push_back(std::to_string(number));
  }
  if (missing.size() > kMostNamed) missing.back() = "more";
  refuse("of " + text::counted(plan.shard.count, "shard") + " these are missing: " + text::enumerate(missing),
         "every " + plan.kind.row + " is needed", "add these files");
}

// Calls take(text) for every chunk, in order; it returns false if the text cannot be that of rows: the file changed in
// the meantime.
template <class Take>
void take_chunks(const ShardFiles& shards, const RowHooks& hooks, const Take& take) {
  const Plan& plan = shards.begin()->second.head.plan;
  Pace pace("writing the file", plan.count, hooks);
  for (std::uint64_t chunk = 0; chunk < plan.chunks(); ++chunk) {
    const ShardFile& shard = shards.at(chunk % plan.shard.count + 1);
    const Block& block = shard.blocks[chunk / plan.shard.count];
    if (!take(read_bytes(shard.file, block))) {
      refuse(shard.file.path(), "changed while it was being read", "every " + plan.kind.row + " is needed",
             "try again");
    }
    pace.add(range_of(block).rows);
  }
}

}  // namespace

Summary write(const Rows& rows, const fs::path& file, Existing existing, const RowHooks& hooks, Team* team,
              const See& see) {
  require_free(file, existing);
  Summary summary;
  summary.rows = rows.shard_rows();
  if (is_complete(file, existing)) {
    read_complete(file, rows, see);
    summary.resumed = summary.rows;
    return summary;
  }
  RowJournal journal(file, rows, existing, hooks);
  Computation(rows, journal, team, hooks).run(summary);
  write_file(rows, journal, file, hooks, see);
  journal.remove();
  return summary;
}

Summary merge(const std::vector<fs::path>& paths, const fs::path& file, Existing existing, const RowHooks& hooks,
              const See& see) {
  files::require_not_read(file, paths);
  require_free(file, existing == Existing::kReplace ? existing : Existing::kRefuse);
  Pace reading("reading shards", paths.size(), hooks);
  const ShardFiles shards = read_all(paths, reading);
  require_all(shards);
  const ShardHead& first = shards.begin()->second.head;
  TableFile table(file, first.table, first.numbered, see);
  take_chunks(shards, hooks, [&](const std::string& text) { return table.add(text); });
  if (!table.commit()) {
    refuse(paths.front(), "and the other shards do not hold each line of the table once", "every line is needed",
           "compute them again");
  }
  Summary summary;
  summary.rows = first.plan.count;
  return summary;
}

}  // namespace exactff::jobs
