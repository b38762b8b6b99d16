// Several processes, on one machine or many, that compute the rows of one file together. Rank 0 is the leader: only the
// leader opens the journal, distributes rows and collects finished rows. The other processes are followers.
//
// The messages between them:
//   follower to leader   hello    the head of the file as the follower sees it: all heads must be the same
//                        ask      requests a number of pieces of work
//                        rows     finished rows: range, slow rows, lines
//                        trouble  why the follower cannot continue, and the kind of cause
//                        ceased   no more rows will come
//                        bye      nothing more will come
//   leader to follower   work     ranges of rows; none at all if no more are left
//                        cease    finish the row in hand, send what is finished, send ceased
//                        dismiss  the end, with the exit code for all processes; the follower answers bye
// A leader that throws must still dismiss the followers; only then may the processes end.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "jobs/rows.h"

namespace exactff::jobs {

struct Message {
  int rank = 0;  // of the sender
  std::string text;
};

// Transports messages. Messages between two processes arrive in the order in which they were sent.
class Team {
 public:
  virtual ~Team() = default;
  [[nodiscard]] virtual int rank() const = 0;
  [[nodiscard]] virtual int size() const = 0;
  [[nodiscard]] virtual int ranks_on_this_machine() const = 0;
  [[nodiscard]] virtual std::string place() const = 0;         // the name of this process's machine
  virtual void send(int rank, std::string text) = 0;           // does not wait for the arrival
  [[nodiscard]] virtual std::optional<Message> receive() = 0;  // the next message, if any has arrived; does not wait
};

// The default number of threads of a process: the processes of a machine share its cores.
[[nodiscard]] int fair_threads(const Team& team);

// --- their work ---

struct SlowRow {
  std::uint64_t row = 0;
  double seconds = 0.0;
};

// Finished rows, as lines.
struct Finished {
  Range range;
  std::string lines;
  std::vector<SlowRow> slow;
};

using TakeRange = std::function<std::optional<Range>()>;  // may wait; nothing if no more are left
using DeliverRows = std::function<void(Finished)>;        // from any thread

// The leader's communication while rows are computed.
class Leader {
 public:
  Leader(Team& team, const Rows& rows);

  // Answers the messages that have arrived. Throws the failure that a follower has reported: InputError if its input is
  // the cause, Cancelled if it was interrupted.
  void attend(const TakeRange& take, const DeliverRows& deliver);
  // Whether every follower has said hello and sees the same files.
  [[nodiscard]] bool all_here() const { return here_ == team_.size() - 1; }
  // Makes the followers stop, and collects what they have finished. Does not throw the failures that they may still
  // report.
  void cease(const DeliverRows& deliver);

 private:
  void answer(const Message& message, const TakeRange& take, const DeliverRows& deliver);
  void give_work(int rank, std::uint64_t pieces, const TakeRange& take);

  Team& team_;
  const std::string head_;
  int here_ = 0;
};

// Runs a follower, that is, any other rank. `make_rows` must make the same rows as the leader's; what it throws is sent
// to the leader. Only the hooks `cancelled` and slow_seconds are used. Returns the exit code.
int follow(Team& team, const std::function<std::unique_ptr<Rows>()>& make_rows, const RowHooks& hooks);

// Ends the followers of this team with an exit code. Waits until each has sent bye.
void dismiss(Team& team, int exit_code);

}  // namespace exactff::jobs
