// The leader of a team of processes.
#pragma once

#include <cstdint>
#include <string>

#include "exactff/team.h"
#include "truth/workers.h"

namespace exactff::truth {

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

}  // namespace exactff::truth
