#include <nlohmann/json.hpp>

#include "support/test.h"

namespace exactff {
namespace {

// A floor, a lamp above it, a bent quadrilateral, a face without area and a bow tie.
const std::string kBentRoom =
    "mtllib room.mtl\n"
    "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\n"
    "v 1 1 3\nv 1 2 3\nv 2 2 3\nv 2 1 3.5\nv 2 1 3\n"
    "usemtl grey\ng floor\nf 1 2 3 4\n"
    "usemtl bright\ng lamp\nf 5 6 7 9\n"
    "usemtl grey\ng bent\nf 5 6 7 8\nf 1 2 2\n";
const std::string kBowTie = "g bow\nf 1 2 4 3\n";
const std::string kTwoMaterials = "newmtl grey\nKd .5\nnewmtl bright\nKe 17 12 4\n";

struct Room {
  TemporaryDirectory directory;
  std::string path;

  explicit Room(const std::string& more = "") {
    (void)directory.write("room.mtl", kTwoMaterials);
    path = directory.write("room.obj", kBentRoom + more).string();
  }
  ProgramRun info(const Words& flags = {}) const { return run_exactff(joined({"info", path}, flags)); }
};

TEST(InfoCommand, ListsPatchesEmittersAndDoubtfulFaces) {
  const Room room;
  const ProgramRun run = room.info();
  EXPECT_EQ(run.exit_code, 0);
  const char* const lines[] = {
      "patch  faces     area  front                       material  Kd   Ke       emits\n",
      "floor      1       16  (0, 0, 1)                   grey      0.5  0        no\n",
      "lamp       1        1  (0, 0, -1)                  bright    1    17 12 4  yes\n",
      "3 patches, 4 faces in 4 convex pieces, 9 vertices, area ",
      "emitters: lamp\n",
      "bent:1 (off by ",
      "zero area, ignored: bent:2\n",
      "unusable, left out: none\n",
      "open edges: 8 (an odd number of faces uses them)\n",
      " --on floor --source lamp --grid 16x16 -o DIR",
  };
  for (const char* line : lines) EXPECT_HOLDS(run.output, line) << line << "\nin\n" << run.output;
}

TEST(InfoCommand, JsonRoundTrips) {
  const Room room;
  const nlohmann::json json = nlohmann::json::parse(room.info({"--json"}).output);
  EXPECT_EQ(json["patches"].size(), 3U);
  EXPECT_EQ(json["patches"][1]["name"], "lamp");
  EXPECT_EQ(json["patches"][1]["materials"][0]["Ke"], (std::vector<double>{17, 12, 4}));
  EXPECT_EQ(json["patches"][1]["front"], (std::vector<double>{0, 0, -1}));
  EXPECT_EQ(json["not_planar"][0]["name"], "bent:1");
  EXPECT_EQ(json["ignored"][0], "bent:2");
  EXPECT_EQ(json["hash"].get<std::string>().size(), 16U);
  EXPECT_EQ(json["warnings"].size(), 2U);
}

TEST(InfoCommand, BadFacesStopItUnlessTheyAreSkipped) {
  const Room room(kBowTie);
  const ProgramRun stopped = room.info();
  EXPECT_EQ(stopped.exit_code, 2);
  EXPECT_EQ(stopped.output, "");
  const ProgramRun skipped = room.info({"--skip-bad-faces"});
  EXPECT_EQ(skipped.exit_code, 0);
  EXPECT_HOLDS(skipped.output, "unusable, left out: bow:1\n");
}

// --- What commands say where a scene or a receiver is probably not what was meant ---

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
  [[nodiscard]] static ProgramRun run(const Words& arguments) { return run_exactff(arguments); }
};

TEST_F(Advice, OnFrontsIsGivenByEveryCommandAndObeyedIsSilent) {
  const std::string flips = "floor,ceiling,south,east,north,west";
  const std::string truth = (directory.path() / "truth.csv").string(), image = (directory.path() / "a.png").string();
  for (const Words& command :
       std::vector<Words>{{"matrix", room, "--accuracy", "1e-2"},
                          {"radiosity", room, "--accuracy", "1e-2"},
                          {"truth", room, "--on", "lamp", "--centres", "--source", "floor", "-o", truth, "--force"},
                          {"render", room, "--size", "8x8", "-o", image, "--force"},
                          {"point", room, "--at", "1.5", "1.5", "2", "--normal", "0", "0", "-1", "--source", "floor"},
                          {"view", room, "--at", "1.5", "1.5", "2", "--normal", "0", "0", "-1"}}) {
    const ProgramRun told = run(command);
    EXPECT_HOLDS(told.error, "looks out of it: 'floor', 'ceiling'") << command.front() << '\n' << told.error;
    EXPECT_HOLDS(told.error, "--flip " + flips) << command.front();
    Words obeyed = command;
    obeyed.insert(obeyed.end(), {"--flip", flips});
    EXPECT_FALSE(holds(run(obeyed).error, "out of it")) << command.front();
  }
  EXPECT_HOLDS(run({"matrix", empty_room}).error, "--flip all");
  EXPECT_EQ(run({"matrix", empty_room, "--flip", "all"}).error, "");
}

// Half a metre below the floor. A lamp is seen from the floor; from the ground outside of a room, nothing would be.
TEST_F(Advice, OnReceiversThatSeeOnlyBacksIsTheirPlaceOnTheFace) {
  const Words flips{"--flip", "floor,ceiling,south,east,north,west"};
  const auto below = [&](Words command, const char* z) {
    command.insert(command.end(), {"--at", "1", "1.5", z, "--normal", "0", "0", "1"});
    command.insert(command.end(), flips.begin(), flips.end());
    return run(command).error;
  };
  const std::string point = below({"point", room, "--source", "lamp"}, "-.5"), view = below({"view", room}, "-.5");
  EXPECT_HOLDS(point,
               "x lies 0.5 behind 'floor' and sees nothing but backs. On it, with --at 1 1.5 0 --on floor, "
               "the form factor of 'lamp' is ");
  EXPECT_HOLDS(view, "--on floor, it sees 6 patches instead of 0");
  EXPECT_HOLDS(
      below({"point", room, "--source", "lamp"}, "-1e-7"),
      "x lies 1e-07 behind 'floor', which then hides everything beyond it. With --on floor the form factor of");
  EXPECT_FALSE(holds(below({"view", room}, ".5"), "sees nothing but backs"));
  EXPECT_FALSE(holds(below({"view", room}, "5"), "sees nothing but backs")) << "above the ceiling";
}

}  // namespace
}  // namespace exactff
