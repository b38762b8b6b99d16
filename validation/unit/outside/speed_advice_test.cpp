// What exactff matrix says while it takes long.
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <string>
#include <thread>

#include "cli/view_factor_words.h"
#include "exactff/models.h"
#include "support/program.h"

namespace exactff::cli {
namespace {

using validation::RunningProgram;

TEST(SpeedAdvice, DependsOnWhatWasAsked) {
  const Scene scene = models::make_scene("closed-room");
  matrix::Request request{&scene, {scene.select("floor"), scene.select("lamp")}, {scene.select("floor")}, {}, {}};
  EXPECT_EQ(words_on_speed(request),
            "Faster: --accuracy 0.001 instead of 1e-06; a smaller --budget than 100000, for wider entries; fewer rows "
            "than 2 by --from");
  request.options.factors.certify = true;
  request.options.factors.both_directions = true;
  request.options.factors.accuracy = 0.01;
  request.options.backs = true;
  request.from.pop_back();
  EXPECT_EQ(words_on_speed(request),
            "Faster: no --certify, so that errors are estimated; no --both-directions; a smaller --budget than 100000, "
            "for wider entries; no --backs");
  request.options.factors = {.accuracy = 1e-10, .certify = true};
  EXPECT_EQ(words_on_speed(request).find("certify"), std::string::npos);
  request.options.factors.certify = false;
  EXPECT_TRUE(words_on_speed(request).starts_with("Faster: --certify, ")) << words_on_speed(request);
}

// Once, on stderr, only while it takes long, and with the name of the pair.
TEST(SpeedAdvice, IsGivenOnceAfterSomeSeconds) {
  const validation::TemporaryDirectory directory;
  const RunningProgram slow(EXACTFF_PROGRAM,
                            {"matrix", EXACTFF_DATA_DIR "/scenes/blinds_room.obj", "--from", "floor", "--to", "window",
                             "--threads", "2", "-o", directory.path() / "m.csv"},
                            directory.path() / "slow");
  const auto start = std::chrono::steady_clock::now();
  const auto elapsed = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); };
  while (slow.error().empty() && !slow.has_ended() && elapsed() < 60) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  EXPECT_GT(elapsed(), 3.0);
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  slow.send(SIGINT);
  EXPECT_EQ(slow.wait(), 128 + SIGINT);
  const std::string said = slow.error();
  EXPECT_TRUE(
      said.starts_with("note: this takes more than 5 s. It is slow from 'floor' to 'window'. Faster: --accuracy "))
      << said;
  EXPECT_EQ(said.find("note: "), said.rfind("note: ")) << said;
  const RunningProgram quick(EXACTFF_PROGRAM, {"matrix", "@closed-room", "--from", "lamp", "--to", "ceiling"},
                             directory.path() / "quick");
  EXPECT_EQ(quick.wait(), 0);
  EXPECT_EQ(quick.error(), "");
}

}  // namespace
}  // namespace exactff::cli
