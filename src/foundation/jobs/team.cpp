#include "jobs/team.h"

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <new>
#include <stdexcept>
#include <thread>
#include <utility>

#include "files/parallel.h"
#include "jobs/compute.h"
#include "jobs/kept_work.h"

namespace exactff::jobs {
namespace {

using Clock = std::chrono::steady_clock;
using files::WorkerPool;

enum class Word { kHello, kAsk, kRows, kTrouble, kCeased, kBye, kWork, kCease, kDismiss };
constexpr std::uint64_t kWords = 9;

constexpr auto kPause = std::chrono::milliseconds(1);        // between checks for messages
constexpr auto kWhileIdle = std::chrono::milliseconds(100);  // between checks whether to end
constexpr double kWorkAhead = 0.02;                          // seconds that the rows waiting at a follower should last
constexpr std::uint64_t kMostPieces = 64;                    // the limit of waiting pieces for each thread

// A message is its word and then its data, written as results in journals are (kept_work.h).
template <class... Field>
std::string message_of(Word word, Field... fields) {
  WordWriter words;
  words.choice(word, kWords);
  words(fields...);
  return words.bytes();
}

class Reader {
 public:
  explicit Reader(std::string_view text) : words_(text) { words_.choice(word_, kWords); }
  [[nodiscard]] Word word() const { return word_; }
  template <class... Field>
  void operator()(Field&... fields) {
    words_(fields...);
    require_sound();
  }
  void read(Finished& finished);

 private:
  void require_sound() const {
    if (words_.torn()) throw std::logic_error("a message between processes is cut off");
  }
  WordReader words_;
  Word word_{};
};

template <class Words>
void fields(Words& words, Finished& finished) {
  std::uint64_t rows = finished.range.rows;
  words(finished.range.first, rows, finished.lines);
  finished.range.rows = static_cast<std::uint32_t>(rows);
  words.list(finished.slow, [&](SlowRow& slow) { words(slow.row, slow.seconds); });
}

void Reader::read(Finished& finished) {
  fields(words_, finished);
  require_sound();
}

std::string to_text(Finished finished) {
  WordWriter words;
  Word word = Word::kRows;
  words.choice(word, kWords);
  fields(words, finished);
  return words.bytes();
}

Finished to_finished(Reader& message) {
  Finished finished;
  message.read(finished);
  return finished;
}

enum class Blame : std::uint64_t { kInput, kSignal, kMemory, kProgram };

std::string trouble(Blame blame, const std::string& place, const std::string& what) {
  return message_of(Word::kTrouble, static_cast<std::uint64_t>(blame), place, what);
}

[[noreturn]] void rethrow(int rank, Reader message) {
  std::uint64_t kind = 0;
  std::string place, what;
  message(kind, place, what);
  const auto blame = static_cast<Blame>(kind);
  if (blame == Blame::kSignal) throw Cancelled();
  if (blame == Blame::kMemory) throw std::bad_alloc();
  const std::string where = "on rank " + std::to_string(rank) + " (" + place + "): ";
  if (blame == Blame::kInput) throw InputError(Problem{{}, 0, where + what, {}, {}});
  throw std::runtime_error(where + what);
}

}  // namespace

int fair_threads(const Team& team) {
  const int cores = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  return std::clamp(cores / team.ranks_on_this_machine(), 1, files::usable_threads());
}

// --- the leader ---------------------------------------------------------------------------------------------------

Leader::Leader(Team& team, const Rows& rows) : team_(team), head_(rows.head()) {}

void Leader::attend(const TakeRange& take, const DeliverRows& deliver) {
  while (const std::optional<Message> message = team_.receive()) answer(*message, take, deliver);
}

void Leader::answer(const Message& message, const TakeRange& take, const DeliverRows& deliver) {
  Reader reader(message.text);
  switch (reader.word()) {
    case Word::kHello: {
      std::string place, head;
      reader(place, head);
      if (head != head_) {
        rethrow(message.rank, Reader(trouble(Blame::kInput, place,
                                             "the program, the scene or the receivers differ from those of rank 0 (" +
                                                 team_.place() + "); every process needs the same files")));
      }
      ++here_;
      return;
    }
    case Word::kAsk: {
      std::uint64_t pieces = 0;
      reader(pieces);
      return give_work(message.rank, pieces, take);
    }
    case Word::kRows:
      return deliver(to_finished(reader));
    case Word::kTrouble:
      rethrow(message.rank, reader);
    default:
      throw std::logic_error("a follower said what only a leader says");
  }
}

void Leader::give_work(int rank, std::uint64_t pieces, const TakeRange& take) {
  std::vector<std::uint64_t> ranges;
  for (; pieces > 0; --pieces) {
    const std::optional<Range> range = take();
    if (!range) break;
    ranges.insert(ranges.end(), {range->first, range->rows});
  }
  team_.send(rank, message_of(Word::kWork, ranges));
}

void Leader::cease(const DeliverRows& deliver) {
  for (int rank = 1; rank < team_.size(); ++rank) team_.send(rank, message_of(Word::kCease));
  for (int left = team_.size() - 1; left > 0;) {
    const std::optional<Message> message = team_.receive();
    if (!message) {
      std::this_thread::sleep_for(kPause);
      continue;
    }
    Reader reader(message->text);
    if (reader.word() == Word::kCeased) --left;
    if (reader.word() == Word::kRows) deliver(to_finished(reader));
  }
}

void dismiss(Team& team, int exit_code) {
  for (int rank = 1; rank < team.size(); ++rank) {
    team.send(rank, message_of(Word::kDismiss, static_cast<std::uint64_t>(exit_code)));
  }
  for (int left = team.size() - 1; left > 0;) {
    const std::optional<Message> message = team.receive();
    if (!message) {
      std::this_thread::sleep_for(kPause);
    } else if (Reader(message->text).word() == Word::kBye) {
      --left;
    }
  }
}

// --- a follower ---------------------------------------------------------------------------------------------------

namespace {

// The queue of a follower's threads: ranges come in, finished rows go out.
class Desk {
 public:
  void put(Range range) {
    const std::lock_guard lock(mutex_);
    waiting_.push_back(range);
    changed_.notify_all();
  }
  void close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    waiting_.clear();
    changed_.notify_all();
  }
  // Waits for a range; nothing after close(), or if the pool has stopped, perhaps since not all threads could start.
  std::optional<Range> take(const WorkerPool::Worker& worker) {
    std::unique_lock lock(mutex_);
    const auto may_go_on = [&] { return closed_ || !waiting_.empty() || worker.stopped(); };
    while (!changed_.wait_for(lock, kWhileIdle, may_go_on)) {
    }
    if (waiting_.empty()) return std::nullopt;
    const Range range = waiting_.front();
    waiting_.pop_front();
    ++taken_;
    out_changed_.notify_all();
    return range;
  }
  void deliver(Finished finished) {
    const std::lock_guard lock(mutex_);
    finished_.push_back(std::move(finished));
    out_changed_.notify_all();
  }
  // Waits a moment until something was finished or taken.
  std::vector<Finished> collect() {
    std::unique_lock lock(mutex_);
    if (finished_.empty()) out_changed_.wait_for(lock, kPause);
    return std::exchange(finished_, {});
  }
  [[nodiscard]] std::uint64_t waiting() {
    const std::lock_guard lock(mutex_);
    return waiting_.size();
  }
  [[nodiscard]] std::uint64_t taken() {
    const std::lock_guard lock(mutex_);
    return taken_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_, out_changed_;
  std::deque<Range> waiting_;
  std::vector<Finished> finished_;
  std::uint64_t taken_ = 0;
  bool closed_ = false;
};

class Follower {
 public:
  Follower(Team& team, const RowHooks& hooks) : team_(team), hooks_(hooks) {}

  int run(const std::function<std::unique_ptr<Rows>()>& make_rows) {
    try {
      const std::unique_ptr<Rows> rows = make_rows();
      team_.send(0, message_of(Word::kHello, team_.place(), rows->head()));
      work(*rows);
    } catch (const InputError& error) {
      team_.send(0, trouble(Blame::kInput, team_.place(), error.what()));
    } catch (const Cancelled&) {
      team_.send(0, trouble(Blame::kSignal, team_.place(), "interrupted"));
    } catch (const std::bad_alloc&) {
      team_.send(0, trouble(Blame::kMemory, team_.place(), "out of memory"));
    } catch (const std::exception& error) {
      team_.send(0, trouble(Blame::kProgram, team_.place(), error.what()));
    }
    return wait_for_dismissal();
  }

 private:
  void work(const Rows& rows) {
    threads_ = static_cast<std::uint64_t>(rows.plan().threads);
    Desk desk;
    WorkerPool pool(rows.plan().threads, {{}, hooks_.cancelled}, [&](WorkerPool::Worker& worker) {
      compute_rows(
          rows, hooks_.slow_seconds, [&] { return desk.take(worker); },
          [&](Finished finished) { desk.deliver(std::move(finished)); }, worker);
    });
    const auto send_finished = [&] {
      for (const Finished& finished : desk.collect()) team_.send(0, to_text(finished));
    };
    while (!told_to_stop_ && !pool.stopped()) {
      listen(desk);
      ask(desk);
      send_finished();
    }
    pool.stop();
    desk.close();
    while (!pool.wait_for(kPause)) send_finished();
    send_finished();
    pool.rethrow();
  }

  void listen(Desk& desk) {
    while (const std::optional<Message> message = team_.receive()) {
      Reader reader(message->text);
      if (reader.word() == Word::kWork) {
        std::vector<std::uint64_t> ranges;
        reader(ranges);
        asked_ = false;
        no_more_ = ranges.empty();
        for (std::size_t i = 0; i + 1 < ranges.size(); i += 2) {
          desk.put({ranges[i], static_cast<std::uint32_t>(ranges[i + 1])});
        }
      } else {
        obey(reader);
      }
    }
  }

  void obey(Reader reader) {
    told_to_stop_ = true;
    if (reader.word() == Word::kCease) must_say_ceased_ = true;
    if (reader.word() != Word::kDismiss) return;
    std::uint64_t code = 0;
    reader(code);
    exit_code_ = static_cast<int>(code);
  }

  // Asks for enough pieces to keep the threads busy until the next answer, and for no more: the cost of rows differs by
  // a factor of a thousand, and no other process can do what waits here.
  void ask(Desk& desk) {
    if (asked_ || no_more_) return;
    const double seconds = std::chrono::duration<double>(Clock::now() - started_).count();
    const double pace = static_cast<double>(desk.taken()) / std::max(seconds, 1e-6);  // pieces per second
    const auto ahead = static_cast<std::uint64_t>(
        std::clamp(pace * kWorkAhead, static_cast<double>(threads_), static_cast<double>(threads_ * kMostPieces)));
    const std::uint64_t waiting = desk.waiting();
    if (waiting > ahead / 2) return;
    asked_ = true;
    team_.send(0, message_of(Word::kAsk, std::uint64_t{ahead - waiting}));
  }

  int wait_for_dismissal() {
    for (bool said = false; !exit_code_;) {
      if (must_say_ceased_ && !said) {
        said = true;
        team_.send(0, message_of(Word::kCeased));
      }
      const std::optional<Message> message = team_.receive();
      if (!message) {
        std::this_thread::sleep_for(kPause);
      } else if (const Reader reader(message->text); reader.word() != Word::kWork) {
        obey(reader);
      }
    }
    team_.send(0, message_of(Word::kBye));
    return *exit_code_;
  }

  Team& team_;
  const RowHooks& hooks_;
  const Clock::time_point started_ = Clock::now();
  std::uint64_t threads_ = 1;
  bool asked_ = false;
  bool no_more_ = false;
  bool told_to_stop_ = false;
  bool must_say_ceased_ = false;
  std::optional<int> exit_code_;
};

}  // namespace

int follow(Team& team, const std::function<std::unique_ptr<Rows>()>& make_rows, const RowHooks& hooks) {
  return Follower(team, hooks).run(make_rows);
}

}  // namespace exactff::jobs
