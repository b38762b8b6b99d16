// The processes of a team: their leader and a follower.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "jobs/team.h"
#include "jobs/workers.h"

namespace exactff::jobs {

// The leader's communication while rows are computed.
class Leader {
 public:
  Leader(Team& team, const Rows& rows);

  // Answers the messages that have arrived. Throws the failure that a follower has reported: InputError if its input is
  // the cause, Cancelled if it was interrupted.
  void attend(const Workers::Take& take, const Workers::Deliver& deliver);
  // Whether every follower has said hello and sees the same files.
  [[nodiscard]] bool all_here() const { return here_ == team_.size() - 1; }
  // Makes the followers stop, and collects what they have finished. Does not throw the failures that they may still
  // report.
  void cease(const Workers::Deliver& deliver);

 private:
  void answer(const Message& message, const Workers::Take& take, const Workers::Deliver& deliver);
  void give_work(int rank, std::uint64_t pieces, const Workers::Take& take);

  Team& team_;
  const std::string head_;
  int here_ = 0;
};

// Runs a follower, that is, any other rank. `make_rows` must make the same rows as the leader's; what it throws is sent
// to the leader. Only the hooks `cancelled` and slow_seconds are used. Returns the exit code.
int follow(Team& team, const std::function<std::unique_ptr<Rows>()>& make_rows, const RowHooks& hooks);

}  // namespace exactff::jobs
