// Signals while the program reads, computes and writes, and what killed and interrupted runs leave to the next one.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "support/folder.h"
#include "support/program.h"
#include "unit/outside/hostile_program.h"
#include "unit/outside/sanitized.h"

namespace exactff {
namespace {

namespace fs = std::filesystem;
using validation::names_in;

// While gnuplot draws, the hidden folder exists: this is the worst moment for an interruption.
TEST_F(HostileProgram, SignalsWhileItWritesLeaveTheJournalAlone) {
  const fs::path started = directory_.path() / "started", folder = place_ / "result";
  const auto gnuplot = with_gnuplot("touch '" + started.string() + "'; exec sleep 100");
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    for (const int times : {1, 2}) {
      fs::remove(started);
      const Running run = start(comparison(folder), gnuplot);
      while (!fs::exists(started) && !run.has_ended()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
      EXPECT_GT(names_in(place_).size(), 1U);
      for (int i = 0; i < times; ++i) run.send(signal);
      EXPECT_EQ(run.wait(), 128 + signal);
      EXPECT_TRUE(run.error().ends_with("\nexactff: interrupted; finished work is kept in " + folder.string() +
                                        ".part; to continue, run the same command with --resume\n"))
          << run.error();
      expect_only_a_journal(folder);
    }
  }
}

// One piece of work may take hours, such as a method with a billion rays.
TEST_F(HostileProgram, ASignalInAPieceOfWorkEndsItInHalfASecond) {
  const fs::path folder = place_ / "result";
  std::vector<std::string> arguments = comparison(folder);
  std::erase(arguments, "--no-methods");
  arguments.insert(arguments.end(), {"--sweep", "--method", "nettle:splits=4096,rays=65536", "--method-budget", "1e9"});
  const Running run = start(arguments);
  constexpr std::uintmax_t kFirstPiece = 200;  // bytes of the journal: its first line is shorter
  while (validation::size_of(folder.string() + ".part") < kFirstPiece && !run.has_ended()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  std::this_thread::sleep_for(std::chrono::seconds(1));
  ASSERT_FALSE(run.has_ended()) << run.error();
  const auto sent = std::chrono::steady_clock::now();
  run.send(SIGINT);
  EXPECT_EQ(run.wait(), 128 + SIGINT);
  EXPECT_LT(std::chrono::steady_clock::now() - sent,
            std::chrono::seconds(kSanitized ? 10 : 2));  // the machine may be busy
  EXPECT_TRUE(run.error().ends_with("\nexactff: interrupted; finished work is kept in " + folder.string() +
                                    ".part; to continue, run the same command with --resume\n"))
      << run.error();
  EXPECT_FALSE(fs::exists(folder));
}

}  // namespace
}  // namespace exactff
