// Several processes, on one machine or many, that make one truth file together: rank 0 leads. It alone opens the
// journal, deals out rows and takes what is finished; the others follow.
//
// What they say to each other, one message each:
//   follower to leader   hello    the head of the truth file as the follower sees it: they must be the same
//                        ask      so many pieces of work are wanted
//                        rows     finished: range, slow rows, lines
//                        trouble  why the follower cannot go on, and what is to blame
//                        ceased   no more rows will come
//                        bye      nothing more will come
//   leader to follower   work     ranges of rows; none at all where there are no more
//                        cease    finish the row in hand, send what is finished, say ceased
//                        dismiss  the end, with the exit code that all shall have; bye answers it
// A leader that throws still has to dismiss; only then may the processes end.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "exactff/truth.h"
#include "truth/workers.h"

namespace exactff::truth {

struct Message {
  int rank = 0;  // that it comes from
  std::string text;
};

// How messages travel. Those between two processes arrive in the order in which they were sent.
class Team {
 public:
  virtual ~Team() = default;
  [[nodiscard]] virtual int rank() const = 0;
  [[nodiscard]] virtual int size() const = 0;
  [[nodiscard]] virtual int ranks_on_this_machine() const = 0;
  [[nodiscard]] virtual std::string place() const = 0;         // the name of this process's machine
  virtual void send(int rank, std::string text) = 0;           // does not wait for the arrival
  [[nodiscard]] virtual std::optional<Message> receive() = 0;  // what has arrived, if anything has; does not wait
};

// The threads that a process should use if it is not told: the processes of a machine share its cores.
[[nodiscard]] int fair_threads(const Team& team);

// As write() without a team, which is what a null pointer stands for. Called by rank 0 alone; dismiss() must follow,
// whatever is thrown.
Summary write(Request request, const std::filesystem::path& file, Existing existing, const Hooks& hooks, Team* team);

// Ends the followers of this team with an exit code. Waits until each has said bye.
void dismiss(Team& team, int exit_code);

// What every other rank does: `request` makes the same request that the leader has (what it throws is told to the
// leader); hooks other than `cancelled` and slow_seconds are not called. Returns the exit code.
int follow(Team& team, const std::function<Request()>& request, const Hooks& hooks);

// The leader's side while rows are computed.
class Leader {
 public:
  Leader(Team& team, const Rows& rows);

  // Answers what has arrived. Throws what a follower has told: InputError where its input is to blame, study::Cancelled
  // where it was interrupted.
  void attend(const Workers::Take& take, const Workers::Deliver& deliver);
  // Every follower has been heard of, and sees the same files.
  [[nodiscard]] bool all_here() const { return here_ == team_.size() - 1; }
  // Has the followers stop, and takes what they have finished. Throws nothing of what they may still tell.
  void cease(const Workers::Deliver& deliver);

 private:
  void answer(const Message& message, const Workers::Take& take, const Workers::Deliver& deliver);
  void give_work(int rank, std::uint64_t pieces, const Workers::Take& take);

  Team& team_;
  const std::string head_;
  int here_ = 0;
};

}  // namespace exactff::truth
