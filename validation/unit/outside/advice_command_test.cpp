// What commands say where a scene or a receiver is probably not what was meant.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/holds.h"
#include "support/program.h"

namespace exactff {
namespace {

using validation::holds;
using validation::TemporaryDirectory;

// A cube without a lamp, whose fronts all look outward, and the same with a lamp in it.
const std::string kVertices =
    "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 0 0 4\nv 4 0 4\nv 4 4 4\nv 0 4 4\nv 1 1 3\nv 1 2 3\nv 2 2 3\nv 2 1 3\n";
const std::string kOutward =
    "g floor\nf 4 3 2 1\ng ceiling\nf 5 6 7 8\ng south\nf 1 2 6 5\ng east\nf 2 3 7 6\ng north\nf 3 4 8 7\n"
    "g west\nf 4 1 5 8\n";
const std::string kLamp = "usemtl bright\ng lamp\nf 9 10 11 12\n";

struct Advice : testing::Test {
  TemporaryDirectory directory;
  std::string empty_room = directory.write("empty.obj", kVertices + kOutward).string();
  std::string room;

  Advice() {
    (void)directory.write("m.mtl", "newmtl bright\nKe 1 1 1\n");
    room = directory.write("room.obj", "mtllib m.mtl\n" + kVertices + kOutward + kLamp).string();
  }
  [[nodiscard]] static validation::ProgramRun run(const std::vector<std::string>& arguments) {
    return validation::run_exactff(arguments);
  }
};

TEST_F(Advice, OnFrontsIsGivenByEveryCommandAndObeyedIsSilent) {
  const std::string flips = "floor,ceiling,south,east,north,west";
  const std::string truth = (directory.path() / "truth.csv").string(), image = (directory.path() / "a.png").string();
  for (const std::vector<std::string>& command : std::vector<std::vector<std::string>>{
           {"matrix", room, "--accuracy", "1e-2"},
           {"radiosity", room, "--accuracy", "1e-2"},
           {"truth", room, "--on", "lamp", "--centres", "--source", "floor", "-o", truth, "--force"},
           {"render", room, "--size", "8x8", "-o", image, "--force"},
           {"point", room, "--at", "1.5", "1.5", "2", "--normal", "0", "0", "-1", "--source", "floor"},
           {"view", room, "--at", "1.5", "1.5", "2", "--normal", "0", "0", "-1"}}) {
    const validation::ProgramRun told = run(command);
    EXPECT_TRUE(holds(told.error, "looks out of it: 'floor', 'ceiling'")) << command.front() << '\n' << told.error;
    EXPECT_TRUE(holds(told.error, "--flip " + flips)) << command.front();
    std::vector<std::string> obeyed = command;
    obeyed.insert(obeyed.end(), {"--flip", flips});
    EXPECT_FALSE(holds(run(obeyed).error, "out of it")) << command.front();
  }
  EXPECT_TRUE(holds(run({"matrix", empty_room}).error, "--flip all"));
  EXPECT_EQ(run({"matrix", empty_room, "--flip", "all"}).error, "");
}

TEST_F(Advice, OnOtherNamesOfTheSkyIsSky) {
  for (const char* name : {"space", "Void", "(open)"}) {
    const validation::ProgramRun refused = run({"matrix", room, "--to", name});
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_TRUE(holds(refused.error, "is called sky here")) << refused.error;
  }
  EXPECT_EQ(run({"matrix", directory.write("s.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\ng space\nf 1 2 3\n").string(), "--to",
                 "space"})
                .exit_code,
            0);
}

// Half a metre below the floor. A lamp is seen from the floor; from the ground outside of a room, nothing would be.
TEST_F(Advice, OnReceiversThatSeeOnlyBacksIsTheirPlaceOnTheFace) {
  const std::vector<std::string> flips{"--flip", "floor,ceiling,south,east,north,west"};
  const auto below = [&](std::vector<std::string> command, const char* z) {
    command.insert(command.end(), {"--at", "1", "1.5", z, "--normal", "0", "0", "1"});
    command.insert(command.end(), flips.begin(), flips.end());
    return run(command).error;
  };
  const std::string point = below({"point", room, "--source", "lamp"}, "-.5"), view = below({"view", room}, "-.5");
  EXPECT_TRUE(holds(point,
                    "x lies 0.5 behind 'floor' and sees nothing but backs. On it, with --at 1 1.5 0 --on floor, "
                    "the form factor of 'lamp' is "))
      << point;
  EXPECT_TRUE(holds(view, "--on floor, it sees 6 patches instead of 0")) << view;
  EXPECT_FALSE(holds(below({"view", room}, ".5"), "sees nothing but backs"));
  EXPECT_FALSE(holds(below({"view", room}, "5"), "sees nothing but backs")) << "above the ceiling";
}

}  // namespace
}  // namespace exactff
