// Truth files written by several processes, which are threads here.
#include <atomic>
#include <chrono>
#include <exception>
#include <thread>

#include "jobs/team.h"
#include "support/test.h"
#include "support/thread_team.h"
#include "truth/rows.h"
#include "unit/products/truth_support.h"

namespace exactff::truth {
namespace {

namespace fs = std::filesystem;
using namespace jobs;
using validation::Mailbox;
using validation::ThreadTeam;

class TruthTeam : public Truth {
 protected:
  using Requests = std::function<Request(int rank)>;

  // Runs every rank in a thread. The exit code of a leader that throws is 2, and all ranks must return the leader's
  // code. Returns what the leader threw.
  std::exception_ptr run(int size, const Requests& request, const RowHooks& leaders = {},
                         const RowHooks& followers = {}) {
    std::vector<Mailbox> mail(static_cast<std::size_t>(size));
    std::vector<int> codes(mail.size(), -1);
    std::exception_ptr thrown;
    {
      std::vector<std::jthread> ranks;
      for (int rank = 1; rank < size; ++rank) {
        ranks.emplace_back([&, rank] {
          ThreadTeam team(mail, rank);
          codes[static_cast<std::size_t>(rank)] = follow(
              team, [&, rank] { return request(rank); }, followers);
        });
      }
      ThreadTeam team(mail, 0);
      try {
        write(request(0), file_, Existing::kResume, leaders, &team);
        codes[0] = 0;
      } catch (...) {
        thrown = std::current_exception();
        codes[0] = 2;
      }
      dismiss(team, codes[0]);
    }
    EXPECT_EQ(std::set<int>(codes.begin(), codes.end()).size(), 1U);
    return thrown;
  }

  template <class Error>
  static std::string message_of(std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const Error& error) {
      return error.what();
    } catch (...) {
      return "another error";
    }
    return "no error";
  }
};

TEST_F(TruthTeam, ManyProcessesWriteTheBytesOfOne) {
  write(request(40), file_);
  const std::string whole = text_of(file_);
  for (const int size : {1, 2, 4}) {
    fs::remove(file_);
    EXPECT_EQ(run(size, [this](int) { return request(40); }), nullptr);
    EXPECT_EQ(text_of(file_), whole);
  }
  expect_only({"truth.csv"});
}

// Interrupted before this number of rows, by whichever thread asked.
RowHooks interrupted_after(std::atomic<int>& rows) {
  RowHooks hooks;
  hooks.cancelled = [&rows] { return rows-- <= 0; };
  return hooks;
}

// A leader that is so slow that the others do the work.
RowHooks slow() {
  RowHooks hooks;
  hooks.cancelled = [] {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return false;
  };
  return hooks;
}

TEST_F(TruthTeam, AnInterruptedTeamKeepsWhatItFinished) {
  write(request(40), file_);
  const std::string whole = text_of(file_);
  fs::remove(file_);
  std::atomic<int> followers_rows = 600 * kQuestions, leaders_rows = 300 * kQuestions;
  const auto asked = [this](int) { return request(40); };
  EXPECT_EQ(message_of<Cancelled>(run(4, asked, slow(), interrupted_after(followers_rows))), "cancelled");
  expect_only({"truth.csv.part"});
  EXPECT_GE(rows_in_journal(request(40)), 420U);
  EXPECT_EQ(message_of<Cancelled>(run(4, asked, interrupted_after(leaders_rows), slow())), "cancelled");
  expect_only({"truth.csv.part"});
  const Summary summary = write(request(40), file_, Existing::kResume);
  EXPECT_GT(summary.resumed, 600U);
  EXPECT_EQ(text_of(file_), whole);
}

TEST_F(TruthTeam, AProcessThatSeesOtherFilesIsNamed) {
  const auto thrown = run(3, [this](int rank) {
    Request asked = request(40);
    if (rank == 2) asked.receivers[0].point.x += 0.25;
    return asked;
  });
  const std::string told = message_of<InputError>(thrown);
  EXPECT_HOLDS(told, "on rank 2 (here): the program, the scene or the receivers differ from those of rank 0");
}

}  // namespace
}  // namespace exactff::truth
