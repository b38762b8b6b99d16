// Every way in which a check can end, observed from a process that continues.
#include "fuzz/apart.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <stdexcept>

namespace exactff::validation {
namespace {

TEST(RunApart, SaysWhenAllIsWell) {
  const Outcome outcome = run_apart([] { return std::string(); }, 10);
  EXPECT_EQ(outcome.ending, Ending::kFine);
  EXPECT_EQ(outcome.problem, "");
}

TEST(RunApart, HandsBackTheWholeProblem) {
  const std::string problem(100000, 'x');
  const Outcome outcome = run_apart([&] { return problem; }, 10);
  EXPECT_EQ(outcome.ending, Ending::kProblem);
  EXPECT_EQ(outcome.problem, problem);
}

TEST(RunApart, SurvivesACrash) {
  EXPECT_EQ(run_apart([]() -> std::string { std::abort(); }, 10).ending, Ending::kCrash);
  EXPECT_EQ(run_apart([]() -> std::string { std::_Exit(1); }, 10).ending, Ending::kCrash);  // as a sanitizer does
  EXPECT_EQ(run_apart([]() -> std::string { throw std::runtime_error("unseen"); }, 10).ending, Ending::kCrash);
}

TEST(RunApart, EndsAHang) {
  std::atomic<bool> done = false;
  const auto for_ever = [&]() -> std::string {
    while (!done) {
    }
    return {};
  };
  EXPECT_EQ(run_apart(for_ever, 1).ending, Ending::kHang);
}

}  // namespace
}  // namespace exactff::validation
