#include "jobs/team.h"

#include <algorithm>
#include <condition_variable>
#include <cstring>
#include <deque>
#include <mutex>
#include <new>
#include <stdexcept>
#include <thread>
#include <type_traits>
#include <utility>

#include "files/parallel.h"
#include "jobs/compute.h"

namespace exactff::jobs {
namespace {

using Clock = std::chrono::steady_clock;
using files::WorkerPool;

enum class Word : char { kHello, kAsk, kRows, kTrouble, kCeased, kBye, kWork, kCease, kDismiss };

constexpr auto kPause = std::chrono::milliseconds(1);        // between checks for messages
constexpr auto kWhileIdle = std::chrono::milliseconds(100);  // between checks whether to end
constexpr double kWorkAhead = 0.02;                          // seconds that the rows waiting at a follower should last
constexpr std::uint64_t kMostPieces = 64;                    // the limit of waiting pieces for each thread

// A message is a word followed by its data.
class Writer {
 public:
  explicit Writer(Word word) : text_(1, static_cast<char>(word)) {}
  template <class Plain>
  requires std::is_trivially_copyable_v<Plain> Writer& operator<<(const Plain& value) {
    text_.append(reinterpret_cast<const char*>(&value), sizeof value);
    return *this;
  }
  Writer& operator<<(const std::string& text) {
    *this << std::uint64_t{text.size()};
    text_ += text;
    return *this;
  }
  [[nodiscard]] std::string text() && { return std::move(text_); }

 private:
  std::string text_;
};

class Reader {
 public:
  explicit Reader(const std::string& text) : text_(text) {}
  [[nodiscard]] Word word() const { return static_cast<Word>(text_.at(0)); }
  template <class Plain>
  Plain read() {
    Plain value{};
    std::memcpy(&value, take(sizeof value), sizeof value);
    return value;
  }
  std::string read_text() {
    const auto size = static_cast<std::size_t>(read<std::uint64_t>());
    return {take(size), size};
  }
  [[nodiscard]] bool at_end() const { return at_ == text_.size(); }

 private:
  const char* take(std::size_t count) {
    if (count > text_.size() - at_) throw std::logic_error("a message between processes is cut off");
    at_ += count;
    return text_.data() + at_ - count;
  }
  const std::string& text_;
  std::size_t at_ = 1;
};

std::string to_text(const Finished& finished) {
  Writer message(Word::kRows);
  message << finished.range.first << finished.range.rows << std::uint64_t{finished.slow.size()};
  for (const SlowRow& slow : finished.slow) message << slow.row << slow.seconds;
  message << finished.lines;
  return std::move(message).text();
}

Finished to_finished(Reader message) {
  Finished finished;
  finished.range.first = message.read<std::uint64_t>();
  finished.range.rows = message.read<std::uint32_t>();
  for (auto count = message.read<std::uint64_t>(); count > 0; --count) {
    const auto row = message.read<std::uint64_t>();
    finished.slow.push_back({row, message.read<double>()});
  }
  finished.lines = message.read_text();
  return finished;
}

enum class Blame : char { kInput, kSignal, kMemory, kProgram };

std::string trouble(Blame blame, const std::string& place, const std::string& what) {
  return std::move(Writer(Word::kTrouble) << blame << place << what).text();
}

[[noreturn]] void rethrow(int rank, Reader message) {
  const auto blame = message.read<Blame>();
  const std::string place = message.read_text(), what = message.read_text();
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
      const std::string place = reader.read_text();
      if (reader.read_text() != head_) {
        rethrow(message.rank, Reader(trouble(Blame::kInput, place,
                                             "the program, the scene or the receivers differ from those of rank 0 (" +
                                                 team_.place() + "); every process needs the same files")));
      }
      ++here_;
      return;
    }
    case Word::kAsk:
      return give_work(message.rank, reader.read<std::uint64_t>(), take);
    case Word::kRows:
      return deliver(to_finished(reader));
    case Word::kTrouble:
      rethrow(message.rank, reader);
    default:
      throw std::logic_error("a follower said what only a leader says");
  }
}

void Leader::give_work(int rank, std::uint64_t pieces, const TakeRange& take) {
  Writer work(Word::kWork);
  for (; pieces > 0; --pieces) {
    const std::optional<Range> range = take();
    if (!range) break;
    work << range->first << range->rows;
  }
  team_.send(rank, std::move(work).text());
}

void Leader::cease(const DeliverRows& deliver) {
  for (int rank = 1; rank < team_.size(); ++rank) team_.send(rank, std::move(Writer(Word::kCease)).text());
  for (int left = team_.size() - 1; left > 0;) {
    const std::optional<Message> message = team_.receive();
    if (!message) {
      std::this_thread::sleep_for(kPause);
      continue;
    }
    const Reader reader(message->text);
    if (reader.word() == Word::kCeased) --left;
    if (reader.word() == Word::kRows) deliver(to_finished(reader));
  }
}

void dismiss(Team& team, int exit_code) {
  for (int rank = 1; rank < team.size(); ++rank) {
    team.send(rank, std::move(Writer(Word::kDismiss) << exit_code).text());
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
      say(Writer(Word::kHello) << team_.place() << rows->head());
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
  void say(Writer& message) { team_.send(0, std::move(message).text()); }

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
        asked_ = false;
        no_more_ = reader.at_end();
        while (!reader.at_end()) {
          const auto first = reader.read<std::uint64_t>();
          desk.put({first, reader.read<std::uint32_t>()});
        }
      } else {
        obey(reader);
      }
    }
  }

  void obey(Reader reader) {
    told_to_stop_ = true;
    if (reader.word() == Word::kCease) must_say_ceased_ = true;
    if (reader.word() == Word::kDismiss) exit_code_ = reader.read<int>();
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
    say(Writer(Word::kAsk) << std::uint64_t{ahead - waiting});
  }

  int wait_for_dismissal() {
    for (bool said = false; !exit_code_;) {
      if (must_say_ceased_ && !said) {
        said = true;
        team_.send(0, std::move(Writer(Word::kCeased)).text());
      }
      const std::optional<Message> message = team_.receive();
      if (!message) {
        std::this_thread::sleep_for(kPause);
      } else if (const Reader reader(message->text); reader.word() != Word::kWork) {
        obey(reader);
      }
    }
    team_.send(0, std::move(Writer(Word::kBye)).text());
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
