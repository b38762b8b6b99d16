// Several processes, on one machine or many, that compute one truth file together. Rank 0 is the leader: only the
// leader opens the journal, distributes rows and collects finished rows. The other processes are followers.
//
// The messages between them:
//   follower to leader   hello    the head of the truth file as the follower sees it: all heads must be the same
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

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "exactff/truth.h"

namespace exactff::truth {

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

// The same as write() without a team, which a null pointer stands for. Called by rank 0 only. dismiss() must follow,
// whatever is thrown.
Summary write(Request request, const std::filesystem::path& file, Existing existing, const Hooks& hooks, Team* team);

// Ends the followers of this team with an exit code. Waits until each has sent bye.
void dismiss(Team& team, int exit_code);

// Runs a follower, that is, any other rank. `request` must make the same request as the leader's; what it throws is
// sent to the leader. Only the hooks `cancelled` and slow_seconds are used. Returns the exit code.
int follow(Team& team, const std::function<Request()>& request, const Hooks& hooks);

}  // namespace exactff::truth
