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

#include <optional>
#include <string>

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

// Ends the followers of this team with an exit code. Waits until each has sent bye.
void dismiss(Team& team, int exit_code);

}  // namespace exactff::jobs
