#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "support/holds.h"
#include "support/program.h"

namespace exactff {
namespace {

using validation::holds;
using validation::ProgramRun;
using validation::run_program;
using validation::TemporaryDirectory;

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
  ProgramRun info(std::vector<std::string> flags = {}) const {
    flags.insert(flags.begin(), {"info", path});
    return run_program(EXACTFF_PROGRAM, flags);
  }
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
  for (const char* line : lines) EXPECT_TRUE(holds(run.output, line)) << line << "\nin\n" << run.output;
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
  EXPECT_TRUE(holds(skipped.output, "unusable, left out: bow:1\n")) << skipped.output;
}

}  // namespace
}  // namespace exactff
