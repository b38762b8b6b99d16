// The flags that choose receivers and sources, as a user gives them.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "support/program.h"

namespace exactff {
namespace {

namespace fs = std::filesystem;
using validation::RunningProgram;
using validation::TemporaryDirectory;
using validation::text_of;

using Words = std::vector<std::string>;

// A floor, a box lid of two faces, a lamp, a patch whose name has a comma, and one without area.
const std::string kRoom =
    "mtllib room.mtl\nusemtl grey\n"
    "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\n"
    "v 1 1 1\nv 2 1 1\nv 2 2 1\nv 1 2 1\n"
    "v 0 0 3\nv 1 0 3\nv 1 1 3\nv 0 1 3\n"
    "g floor\nf 1 2 3 4\ng lid\nf 5 6 7\nf 5 7 8\ng a,b\nf 1 2 3\ng line\nf 1 2 1\n"
    "usemtl bright\ng lamp\nf 12 11 10 9\n";
const std::string kMaterials = "newmtl grey\nKd .5\nnewmtl bright\nKe 17 12 4\n";

class ReceiverFlags : public testing::Test {
 protected:
  ReceiverFlags() { (void)directory_.write("room.mtl", kMaterials); }

  struct Truth {
    int exit_code = -1;
    std::string error;
    std::string text;

    [[nodiscard]] std::string comment(const std::string& key) const {
      const std::size_t at = text.find("# " + key + ": ");
      return at == std::string::npos ? ""
                                     : text.substr(at, std::min(text.find('\n', at), text.find(", hash", at)) - at);
    }
    // The first field of each row, as it stands.
    [[nodiscard]] Words ids() const {
      Words ids;
      std::istringstream lines(text);
      bool below_header = false;
      for (std::string line; std::getline(lines, line);) {
        if (below_header) ids.push_back(line.substr(0, line.find(',', line.starts_with('"') ? line.find('"', 1) : 0)));
        if (line.starts_with("receiver,")) below_header = true;
      }
      return ids;
    }
  };

  [[nodiscard]] Truth truth(Words flags, const std::string& source = "lamp", const std::string& room = {}) const {
    const std::string scene = room.empty() ? room_ : room;
    const fs::path file = directory_.path() / "truth.csv";
    flags.insert(flags.begin(), {"truth", scene, "--force", "--threads", "1", "-o", file.string()});
    if (!source.empty()) flags.insert(flags.end(), {"--source", source});
    const RunningProgram run(EXACTFF_PROGRAM, flags, directory_.path() / "stderr");
    Truth result;
    result.exit_code = run.wait();
    result.error = run.error();
    result.text = text_of(file);
    fs::remove(file);
    return result;
  }

  // What is told of wrong flags, after the program's name.
  [[nodiscard]] std::string refusal(const Words& flags, const std::string& source = "lamp") const {
    const Truth run = truth(flags, source);
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_TRUE(run.text.empty());
    const std::string start = "exactff: ";  // after a warning of the face without area
    const std::size_t at = run.error.find(start);
    return at == std::string::npos ? run.error : run.error.substr(at + start.size());
  }

  const TemporaryDirectory directory_;
  const std::string room_ = directory_.write("room.obj", kRoom).string();
};

TEST_F(ReceiverFlags, AGridIsDescribedAndItsCellsNamed) {
  const Truth run = truth({"--on", "floor", "--grid", "2x1"});
  EXPECT_EQ(run.comment("receivers"), "# receivers: floor, grid 2x1");
  EXPECT_EQ(run.ids(), (Words{"\"1,1\"", "\"2,1\""}));
}

TEST_F(ReceiverFlags, AGridOnSeveralFacesNamesThem) {
  const Truth run = truth({"--on", "lid", "--grid", "1x2"});
  EXPECT_EQ(run.ids(), (Words{"\"lid:1/1,1\"", "\"lid:2/1,1\"", "\"lid:2/1,2\""}));
}

TEST_F(ReceiverFlags, Vertices) {
  const Truth run = truth({"--on", "lid:2", "--vertices"});
  EXPECT_EQ(run.comment("receivers"), "# receivers: lid:2, vertices");
  EXPECT_EQ(run.ids(), (Words{"lid:2/1", "lid:2/2", "lid:2/3"}));
}

TEST_F(ReceiverFlags, Centres) {
  const Truth run = truth({"--on", "lid", "--on", "floor", "--centres"});
  EXPECT_EQ(run.comment("receivers"), "# receivers: lid,floor, centres");
  EXPECT_EQ(run.ids(), (Words{"lid:1", "lid:2", "floor:1"}));
}

TEST_F(ReceiverFlags, SamplesHaveASeedOfTheirOwn) {
  const Truth first = truth({"--on", "floor", "--samples", "3"});
  EXPECT_EQ(first.comment("receivers"), "# receivers: floor, 3 samples, seed 1");
  EXPECT_EQ(first.ids(), (Words{"1", "2", "3"}));
  EXPECT_EQ(first.text, truth({"--on", "floor", "--samples", "3", "--sample-seed", "1"}).text);
  const Truth other = truth({"--on", "floor", "--samples", "3", "--sample-seed", "18446744073709551615"});
  EXPECT_EQ(other.comment("receivers"), "# receivers: floor, 3 samples, seed 18446744073709551615");
  EXPECT_NE(first.text.substr(first.text.find("\n1,")), other.text.substr(other.text.find("\n1,")));
}

TEST_F(ReceiverFlags, AFileIsCalledByItsName) {
  const fs::path file = directory_.write("points.csv", "id,x,y,z,nx,ny,nz\nhere,1,1,0,0,0,1\n");
  const Truth run = truth({"--receivers", file.string()});
  EXPECT_EQ(run.comment("receivers"), "# receivers: points.csv");
  EXPECT_EQ(run.ids(), (Words{"here"}));
}

TEST_F(ReceiverFlags, SeveralPatchesMayCarryReceivers) {
  EXPECT_EQ(truth({"--on", "floor,lid:1", "--centres"}).ids(), (Words{"floor:1", "lid:1"}));
  EXPECT_EQ(truth({"--on", "a,b", "--centres"}).ids(), (Words{"\"a,b:1\""}));
}

TEST_F(ReceiverFlags, AllIsEveryPatchWithArea) {
  EXPECT_EQ(truth({"--on", "all", "--centres"}).ids(), (Words{"floor:1", "lid:1", "lid:2", "\"a,b:1\"", "lamp:1"}));
  EXPECT_EQ(truth({"--on", "floor", "--centres"}, "all").comment("sources"), "# sources: floor + lid + a,b + lamp");
}

TEST_F(ReceiverFlags, APatchNamedAllWins) {
  const std::string scene = directory_.write("all.obj", kRoom + "g all\nf 1 2 4\n").string();
  EXPECT_EQ(truth({"--on", "all", "--centres"}, "lamp", scene).ids(), (Words{"all:1"}));
  EXPECT_EQ(truth({"--on", "floor", "--centres"}, "all", scene).comment("sources"), "# sources: all");
}

TEST_F(ReceiverFlags, SourcesAreThoseThatEmitUnlessNamed) {
  EXPECT_EQ(truth({"--on", "floor", "--centres"}, "").comment("sources"), "# sources: lamp");
  EXPECT_EQ(truth({"--on", "floor", "--centres"}, "lid,a,b").exit_code, 2);
  EXPECT_EQ(truth({"--on", "floor", "--centres", "--source", "lid:2"}).comment("sources"), "# sources: lid:2 + lamp");
}

TEST_F(ReceiverFlags, WhatIsMissingIsTold) {
  EXPECT_EQ(refusal({}),
            "there are no receivers (values are computed at points); give --on NAME with --grid 32x32, --vertices, "
            "--centres or --samples 1000; or --receivers FILE.csv\n");
  EXPECT_EQ(refusal({"--on", "floor"}),
            "--on comes without --grid, --vertices, --centres or --samples (they say where on it the receivers are); "
            "give one of them, such as --grid 32x32\n");
  for (const Words& flags : {Words{"--grid", "2x2"}, {"--vertices"}, {"--centres"}, {"--samples", "9"}}) {
    EXPECT_EQ(refusal(flags),
              flags.front() + " comes without --on (it places receivers on a patch); name that with --on NAME\n");
  }
  EXPECT_EQ(refusal({"--on", "floor", "--centres", "--sample-seed", "2"}),
            "--sample-seed comes without --samples (nothing else is drawn at random); give --samples 1000, or leave it "
            "out\n");
}

TEST_F(ReceiverFlags, WhatContradictsIsTold) {
  EXPECT_EQ(
      refusal({"--on", "floor", "--vertices", "--samples", "9"}),
      "--vertices and --samples come together (each places the receivers in a way of its own); keep one of them\n");
  EXPECT_EQ(refusal({"--on", "floor", "--grid", "2x2", "--vertices", "--centres"}),
            "--grid, --vertices and --centres come together (each places the receivers in a way of its own); keep one "
            "of them\n");
  EXPECT_EQ(refusal({"--receivers", "points.csv", "--on", "floor", "--grid", "2x2"}),
            "--receivers comes with --on and --grid (the receivers are those of the file, or those on a patch); leave "
            "one of them out\n");
  EXPECT_EQ(refusal({"--receivers", "points.csv", "--centres"}),
            "--receivers comes with --centres (the receivers are those of the file, or those on a patch); leave one of "
            "them out\n");
}

TEST_F(ReceiverFlags, WrongNumbersAreTold) {
  for (const std::string grid : {"2", "2x", "x2", "2x2x2", "2.5x2", "2 x2"}) {
    EXPECT_EQ(
        refusal({"--on", "floor", "--grid", grid}),
        "--grid: '" + grid + "' is no grid (it is made of two whole numbers); write columns x rows: --grid 32x32\n");
  }
  EXPECT_EQ(refusal({"--on", "floor", "--grid", "0x2"}),
            "a grid of 0x2 cells (each count is at least 1); write it as 32x32\n");
  for (const std::string count : {"1e3", "many", "1.5", "99999999999999999999"}) {
    EXPECT_EQ(refusal({"--on", "floor", "--samples", count}),
              "--samples: '" + count +
                  "' is not a whole number in range (so many receivers are drawn); write it such "
                  "as --samples 1000\n");
  }
  EXPECT_EQ(refusal({"--on", "floor", "--samples", "0"}),
            "0 samples (there may be 1 to 4194304 receivers); ask for at least one\n");
  EXPECT_EQ(refusal({"--on", "floor", "--samples", "4194305"}),
            "4194305 samples (there may be 1 to 4194304 receivers); use fewer\n");
  EXPECT_EQ(refusal({"--on", "floor", "--samples", "9", "--sample-seed", "18446744073709551616"}),
            "--sample-seed: '18446744073709551616' is not a whole number in range (it numbers the random choices, from "
            "0 to 2^64 - 1); write it such as --sample-seed 7\n");
}

TEST_F(ReceiverFlags, WrongNamesAreTold) {
  EXPECT_EQ(refusal({"--on", "lid,lid:2", "--centres"}),
            "--on: 'lid:2' is named twice (it would have every receiver twice); name it once\n");
  EXPECT_EQ(refusal({"--on", "line", "--vertices"}),
            "--on: there is no face with area in 'line' (receivers lie on faces); name another patch\n");
  EXPECT_NE(refusal({"--on", "flor", "--vertices"}).find("there is no patch named 'flor'"), std::string::npos);
  const std::string twice = "--source: 'lamp' is named twice (its light would count twice); name it once\n";
  EXPECT_EQ(refusal({"--on", "floor", "--centres"}, "lamp,lamp"), twice);
  EXPECT_EQ(refusal({"--on", "floor", "--centres"}, "all,lamp"), twice);
}

TEST_F(ReceiverFlags, WhereNothingIsLeftItIsTold) {
  EXPECT_EQ(refusal({"--on", "lid:1", "--grid", "1x1"}),
            "there is no receiver in lid:1, grid 1x1 (no cell of the grid has its centre inside a face); use a finer "
            "grid, or another patch\n");
  const fs::path file = directory_.write("none.csv", "x,y,z,nx,ny,nz\n");
  EXPECT_EQ(refusal({"--receivers", file.string()}),
            "there is no receiver in none.csv (its rows are the receivers); add one below the header\n");
}

// Without gnuplot, so that nothing is drawn.
TEST_F(ReceiverFlags, CompareTakesThemAndRepeatsThemInItsReport) {
  const fs::path folder = directory_.path() / "out";
  const Words flags = {
      "compare",   room_,      "--on",      "floor",  "--on",    "lid",          "--samples", "2", "--sample-seed", "5",
      "--threads", "1",        "--rays",    "4",      "--eps-b", ".1",           "--eps-a",   "0", "--seeds",       "1",
      "--pattern", "jittered", "--variant", "mended", "-o",      folder.string()};
  const RunningProgram run(EXACTFF_PROGRAM, flags, directory_.path() / "stderr",
                           [] { ::setenv("PATH", "/nonexistent", 1); });
  EXPECT_EQ(run.wait(), 0);
  const std::string report = text_of(folder / "report.html");
  EXPECT_NE(report.find(" --on floor --on lid --samples 2 --sample-seed 5 --eps-b .1 "), std::string::npos);
  EXPECT_NE(report.find("the receivers are not a grid on a face"), std::string::npos);
  const std::string exact = text_of(folder / "exact.csv");
  EXPECT_NE(exact.find("# receivers: floor,lid, 2 samples, seed 5\n"), std::string::npos);
  const std::string expected = truth({"--on", "floor", "--on", "lid", "--samples", "2", "--sample-seed", "5"}).text;
  const std::string row = expected.substr(expected.find("\n1,"), 40);
  EXPECT_NE(exact.find(row), std::string::npos);
}

}  // namespace
}  // namespace exactff
