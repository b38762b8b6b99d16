// exactff point as scripts use it: output contract, exit codes, files.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "support/program.h"

namespace exactff {
namespace {

using validation::ProgramRun;
using validation::run_program;
using validation::TemporaryDirectory;

// A light [-1,1]^2 at z = 1 facing down, a second one half as strong beside it, a plate between, a floor.
const std::string kScene =
    "mtllib a.mtl\n"
    "v -1 1 1\nv 1 1 1\nv 1 -1 1\nv -1 -1 1\n"
    "v 3 1 1\nv 3 -1 1\n"
    "v -.25 -.25 .5\nv .25 -.25 .5\nv .25 .25 .5\nv -.25 .25 .5\n"
    "v -9 -9 0\nv 9 -9 0\nv 9 9 0\nv -9 9 0\n"
    "usemtl lamp\ng light\nf 1 2 3 4\nusemtl dim\ng side\nf 2 5 6 3\n"
    "usemtl grey\ng plate\nf 7 8 9 10\ng floor\nf 11 12 13 14\n";
const std::string kLamps = "newmtl lamp\nKe 4 2 1\nnewmtl dim\nKe 2 1 .5\nnewmtl grey\nKd .5 .25 .125\n";

struct PointCommand : testing::Test {
  TemporaryDirectory directory;
  std::string scene;

  PointCommand() {
    (void)directory.write("a.mtl", kLamps);
    scene = directory.write("a.obj", kScene).string();
  }
  ProgramRun point(std::vector<std::string> flags) const {
    std::vector<std::string> arguments = {"point", scene};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    return run_program(EXACTFF_PROGRAM, arguments);
  }
  // At the origin, looking up.
  ProgramRun up(std::vector<std::string> flags) const {
    std::vector<std::string> arguments = {"--at", "0", "0", "0", "--normal", "0", "0", "1"};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    return point(arguments);
  }
};

TEST_F(PointCommand, PlainPrintsTheShortestDecimalAlone) {
  const ProgramRun run = up({"--source", "light", "--plain"});
  EXPECT_EQ(run.output, "0.31466995351879845\n");
  EXPECT_EQ(run.exit_code, 0);
}

TEST_F(PointCommand, PlainTellsAProvedZeroFromAnUnderflow) {
  EXPECT_EQ(point({"--at", "0", "0", "2", "--normal", "0", "0", "1", "--source", "light", "--plain"}).output, "0\n");
  scene =
      directory.write("tiny.obj", "v 0 1e-170 1\nv 1e-170 1e-170 1\nv 1e-170 0 1\nv 0 0 1\ng s\nf 1 2 3 4\n").string();
  EXPECT_EQ(up({"--source", "s", "--plain"}).output, "0.0\n");
}

TEST_F(PointCommand, DigitsAreCertifiedDecimals) {
  EXPECT_EQ(up({"--source", "plate", "--flip", "plate", "--plain", "--digits", "30"}).exit_code, 0);
  const ProgramRun run = up({"--source", "light", "--plain", "--digits", "30"});
  EXPECT_EQ(run.output, "0.314669953518798448298026682526\n");
}

TEST_F(PointCommand, FlipTurnsTheSource) {
  const std::vector<std::string> above = {"--at", "0",  "0",        "2",     "--normal", "0",
                                          "0",    "-1", "--source", "light", "--plain"};
  EXPECT_EQ(point(above).output, "0\n");
  std::vector<std::string> flipped = above;
  flipped.insert(flipped.end(), {"--flip", "light"});
  EXPECT_EQ(point(flipped).output, "0.554126423979572\n");
}

TEST_F(PointCommand, JsonHoldsBallSumAndRadiosityOfAllSources) {
  const ProgramRun run = up({"--on", "floor", "--json", "--explain", "--fraction"});
  ASSERT_EQ(run.exit_code, 0);
  const nlohmann::json json = nlohmann::json::parse(run.output);
  ASSERT_EQ(json["sources"].size(), 2U);
  EXPECT_EQ(json["sources"][0]["value"], 0.31466995351879845);
  EXPECT_EQ(json["sources"][0]["status"], "certified");
  EXPECT_EQ(json["sources"][0]["visible_fraction"], 0.75);
  EXPECT_EQ(json["sources"][0]["cutters"][0], "plate");
  const double both = json["sources"][0]["value"].get<double>() + json["sources"][1]["value"].get<double>();
  EXPECT_NEAR(json["sum"]["lower"].get<double>(), both, 1e-15);
  EXPECT_LE(json["sum"]["lower"], json["sum"]["upper"]);
  const double expected_red =
      0.5 * (4 * json["sources"][0]["value"].get<double>() + 2 * json["sources"][1]["value"].get<double>());
  EXPECT_NEAR(json["radiosity"][0].get<double>(), expected_red, 1e-15);
}

TEST_F(PointCommand, TheSvgAppearsWhole) {
  const std::filesystem::path file = directory.path() / "view.svg";
  EXPECT_EQ(up({"--source", "light", "--adaptive", "--svg", file.string()}).exit_code, 0);
  std::ifstream in(file);
  std::stringstream text;
  text << in.rdbuf();
  EXPECT_EQ(text.str().substr(0, 4), "<svg");
  EXPECT_NE(text.str().find("</svg>"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(file.string() + ".partial"));
}

TEST_F(PointCommand, ExitCodeThreeMeansNotCertified) {
  const ProgramRun run = up({"--source", "light", "--precision-cap", "40", "--plain"});
  EXPECT_EQ(run.exit_code, 3);
}

TEST_F(PointCommand, BadInputExitsWithTwoAndPrintsNoValue) {
  const std::vector<std::vector<std::string>> bad = {
      {"--at", "0", "nan", "0", "--normal", "0", "0", "1"},
      {"--at", "0", "1e999", "0", "--normal", "0", "0", "1"},
      {"--at", "0", "0", "--normal", "0", "0", "1"},
      {"--at", "0", "0", "0", "--normal", "0", "0", "0"},
      {"--at", "0", "0", "0", "--normal", "0", "0", "1", "--source", "nobody"},
      {"--at", "0", "0", "0", "--normal", "0", "0", "1", "--source", "light:2"},
      {"--at", "0", "0", "0", "--normal", "0", "0", "1", "--plain"},  // two sources
      {"--at", "0", "0", "0", "--normal", "0", "0", "1", "--svg", (directory.path() / "no" / "a.svg").string(),
       "--source", "light"},
      {"--at", "0", "0", "0", "--normal", "0", "0", "1", "--nonsense"},
  };
  for (const std::vector<std::string>& flags : bad) {
    const ProgramRun run = point(flags);
    EXPECT_EQ(run.exit_code, 2) << testing::PrintToString(flags);
    EXPECT_EQ(run.output, "") << testing::PrintToString(flags);
  }
  EXPECT_EQ(run_program(EXACTFF_PROGRAM, {}).exit_code, 2);
  EXPECT_EQ(run_program(EXACTFF_PROGRAM, {"frobnicate"}).exit_code, 2);
}

}  // namespace
}  // namespace exactff
