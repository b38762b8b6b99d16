// A truth file as a stream: no journal, no shard. Threads finish pieces of chunks in any order; the calling thread
// writes them in order.
#include <chrono>
#include <map>
#include <mutex>
#include <optional>
#include <ostream>

#include "exactff/truth.h"
#include "jobs/compute.h"
#include "kernel/float_environment.h"
#include "text/refuse.h"
#include "truth/rows.h"

namespace exactff::truth {
namespace {

constexpr auto kBetweenWrites = std::chrono::milliseconds(20);

class Stream {
 public:
  Stream(const Rows& rows, std::ostream& out, const jobs::RowHooks& hooks)
      : rows_(rows), out_(out), hooks_(hooks), schedule_(rows, {}) {}

  void run(Summary& summary) {
    put(rows_.head());
    files::WorkerPool pool(rows_.plan().threads, {{}, hooks_.cancelled}, [this](files::WorkerPool::Worker& worker) {
      jobs::compute_rows(
          rows_, hooks_.slow_seconds, [this] { return schedule_.next(); },
          [this](jobs::Finished finished) { keep(std::move(finished)); }, worker);
    });
    for (bool ended = false; !ended;) {
      ended = pool.wait_for(kBetweenWrites);
      write_what_is_next(summary, pool.slow_step(files::kSlowStep));
    }
    pool.rethrow();
    summary.rows_by_status = tally_.by_status();
  }

 private:
  void keep(jobs::Finished finished) {
    const std::lock_guard lock(mutex_);
    done_ += finished.range.rows;
    waiting_.emplace(finished.range.first, std::move(finished));
  }

  void write_what_is_next(Summary& summary, std::optional<std::uint64_t> slow_row) {
    std::map<std::uint64_t, jobs::Finished> ready;
    std::uint64_t done = 0;
    {
      const std::lock_guard lock(mutex_);
      while (!waiting_.empty() && waiting_.begin()->first == next_) {
        next_ = waiting_.begin()->second.range.end();
        ready.insert(waiting_.extract(waiting_.begin()));
      }
      done = done_;
    }
    for (const auto& [first, finished] : ready) {
      put(finished.lines);
      tally_.add(finished.lines);
      tell_slow(finished, summary);
    }
    out_.flush();
    require_written();
    if (!hooks_.progress) return;
    const std::string slow = slow_row ? rows_.name(*slow_row) : std::string();
    hooks_.progress({"rows", done, rows_.count(), slow});
  }

  void tell_slow(const jobs::Finished& finished, Summary& summary) {
    summary.slow += finished.slow.size();
    for (const jobs::SlowRow& slow : finished.slow) {
      if (hooks_.slow_row) hooks_.slow_row(rows_.name(slow.row), slow.seconds);
    }
  }

  void put(const std::string& text) {
    out_.write(text.data(), static_cast<std::streamsize>(text.size()));
    require_written();
  }

  void require_written() {
    if (out_) return;
    text::refuse("the rows could not be written", "the output is incomplete",
                 "free some disk space, or send the output elsewhere");
  }

  const Rows& rows_;
  std::ostream& out_;
  const jobs::RowHooks& hooks_;
  jobs::Schedule schedule_;
  std::mutex mutex_;
  std::map<std::uint64_t, jobs::Finished> waiting_;  // by first row
  std::uint64_t next_ = 0;
  std::uint64_t done_ = 0;
  Tally tally_;
};

}  // namespace

Summary write(Request request, std::ostream& out, const jobs::RowHooks& hooks) {
  const kernel::StandardArithmetic arithmetic;
  const Rows rows(std::move(request));
  if (rows.request().shard.count > 1) {
    text::refuse("a shard cannot be written to a stream", "shards are files that exactff merge reads",
                 "name a file, or compute all rows");
  }
  Summary summary;
  summary.rows = rows.count();
  const auto start = std::chrono::steady_clock::now();
  Stream(rows, out, hooks).run(summary);
  summary.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return summary;
}

}  // namespace exactff::truth
