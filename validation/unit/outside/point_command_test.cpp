// exactff point as scripts use it: output contract, exit codes, files, and what it says.
#include <nlohmann/json.hpp>
#include <regex>

#include "support/test.h"

namespace exactff {
namespace {

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
  ProgramRun point(const Words& flags) const { return run_exactff(joined({"point", scene}, flags)); }
  // At the origin, looking up.
  ProgramRun up(const Words& flags) const {
    return point(joined({"--at", "0", "0", "0", "--normal", "0", "0", "1"}, flags));
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

TEST_F(PointCommand, ExitCodeThreeMeansNotCertified) {
  const ProgramRun run = up({"--source", "light", "--precision-cap", "40", "--plain"});
  EXPECT_EQ(run.exit_code, 3);
}

TEST_F(PointCommand, BadInputExitsWithTwoAndPrintsNoValue) {
  const std::vector<Words> bad = {
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
  for (const Words& flags : bad) {
    const ProgramRun run = point(flags);
    EXPECT_EQ(run.exit_code, 2) << testing::PrintToString(flags);
    EXPECT_EQ(run.output, "") << testing::PrintToString(flags);
  }
  EXPECT_EQ(run_exactff({}).exit_code, 2);
  EXPECT_EQ(run_exactff({"frobnicate"}).exit_code, 2);
}

// --- What exactff point says: sources without emission, all patches at once, outcomes, options without effect ---

// A light [-1,1]^2 at z = 1 facing down, a floor, and a plate past the corner of the view of the light: no side of the
// shaft from the origin rules it out, and it hides nothing.
const std::string kLidded =
    "mtllib a.mtl\n"
    "v -1 1 1\nv 1 1 1\nv 1 -1 1\nv -1 -1 1\n"
    "v 1.3 -.1 .5\nv 1.3 1.3 .5\nv -.1 1.3 .5\n"
    "v -9 -9 0\nv 9 -9 0\nv 9 9 0\nv -9 9 0\n"
    "v 2 1 2\nv 4 1 2\nv 4 -1 2\nv 2 -1 2\n"
    "usemtl lamp\ng light\nf 1 2 3 4\nusemtl grey\ng past\nf 5 6 7\ng floor\nf 8 9 10 11\ng lid\nf 12 13 14 15\n";
const std::string kLiddedMaterials = "newmtl lamp\nKe 4 2 1\nnewmtl grey\nKd .5 .25 .125\n";

// A cube about the origin whose six faces look inward.
const std::string kCube =
    "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n"
    "g bottom\nf 1 2 3 4\ng top\nf 8 7 6 5\ng front\nf 1 5 6 2\ng right\nf 2 6 7 3\ng back\nf 3 7 8 4\ng left\nf 4 8 5 "
    "1\n";

class PointWords : public testing::Test {
 protected:
  PointWords() {
    (void)directory_.write("a.mtl", kLiddedMaterials);
    scene_ = directory_.write("a.obj", kLidded).string();
  }

  using Said = ProgramRun;
  // At the origin, looking up.
  Said up(const Words& flags) const { return from(scene_, {"0", "0", "0"}, flags); }
  static Said from(const std::string& scene, const Words& at, const Words& flags) {
    return run_exactff(joined({"point", scene, "--at", at[0], at[1], at[2], "--normal", "0", "0", "1"}, flags));
  }
  nlohmann::json json(Words flags) const {
    flags.emplace_back("--json");
    return nlohmann::json::parse(up(flags).output);
  }
  const TemporaryDirectory directory_;
  std::string scene_;
};

TEST_F(PointWords, ASourceWithoutEmissionCountsWithARadiosityOfOne) {
  const Said said = up({"--source", "lid", "--on", "floor"});
  EXPECT_HOLDS(said.output, "  emits        nothing (Ke 0), so it counts with a radiosity of 1\n");
  EXPECT_HOLDS(said.output, "(reflectance x 1 x form factor, per channel, since nothing is emitted)\n");
  const nlohmann::json of_lid = json({"--source", "lid", "--on", "floor"});
  EXPECT_EQ(of_lid["sources"][0]["emits"], false);
  const double value = of_lid["sources"][0]["value"];
  EXPECT_EQ(of_lid["radiosity"], nlohmann::json::array({0.5 * value, 0.25 * value, 0.125 * value}));
  EXPECT_FALSE(of_lid.contains("sum_of_emitters"));
}

TEST_F(PointWords, ASourceWithoutEmissionIsNotInTheSumOverEmitters) {
  const nlohmann::json alone = json({"--source", "light"}), both = json({"--source", "light,lid"});
  EXPECT_EQ(both["radiosity"], alone["radiosity"]);
  EXPECT_EQ(both["sum_of_emitters"], alone["sum"]);
  EXPECT_GE(both["sum"]["lower"].get<double>(), alone["sum"]["upper"].get<double>());
  EXPECT_EQ(both["sources"][0]["emits"], true);
  EXPECT_EQ(both["sources"][1]["radiosity"][0], both["sources"][1]["value"]);
  const Said said = up({"--source", "light,lid"});
  EXPECT_HOLDS(said.output, "sum of 2 sources\n");
  EXPECT_HOLDS(said.output, "sum of the 1 that emits\n");
  EXPECT_HOLDS(said.output, "  (from the 1 that emits nothing, with a radiosity of 1)\n");
  EXPECT_HOLDS(said.output, "over the 1 source that emits)\n  not added         ");
}

TEST_F(PointWords, AllIsATableWithTheSumAndWhatIsMissing) {
  const Said said = up({"--source", "all", "--fraction", "--on", "floor"});
  EXPECT_EQ(said.exit_code, 0);
  const nlohmann::json all = json({"--source", "all", "--on", "floor"});
  ASSERT_EQ(all["sources"].size(), 4U);
  for (const char* row :
       {"\\npatch +form factor +status +visible +emits\\n", "\\nlight +0\\.[0-9]+ +certified +1 +yes\\n",
        "\\npast +0 +zero +0 +-\\n", "\\nfloor +0 +zero +0 +-\\n"}) {
    EXPECT_TRUE(std::regex_search(said.output, std::regex(row))) << row << '\n' << said.output;
  }
  EXPECT_HOLDS(said.output, "  (of 4 patches, added as balls)\n");
  EXPECT_HOLDS(said.output, "missing to 1  0.");
  EXPECT_TRUE(
      holds(said.output, "(the share that reaches no patch's front: it leaves the scene or meets the back of a face)"));
  EXPECT_HOLDS(said.output, "  (the sum over the 1 patch that emits)\n");
  EXPECT_FALSE(holds(said.output, "source light\n")) << "no block per source";
  EXPECT_NEAR(all["missing_to_1"]["lower"].get<double>() + all["sum"]["upper"].get<double>(), 1.0, 1e-15);
}

// The rounded values of the six sides add up to 1 only by luck; the balls enclose it.
TEST_F(PointWords, InAClosedRoomNothingIsMissingToOne) {
  const std::string cube = directory_.write("cube.obj", kCube).string();
  const Said said = from(cube, {".1", ".2", ".3"}, {"--source", "all"});
  EXPECT_HOLDS(said.output, "\nsum           1  (of 6 patches");
  EXPECT_HOLDS(said.output, "\nmissing to 1  0, to within ");
  EXPECT_FALSE(holds(said.output, "\nemitters ")) << said.output;
  const nlohmann::json json =
      nlohmann::json::parse(from(cube, {".1", ".2", ".3"}, {"--source", "all", "--json"}).output);
  EXPECT_LE(json["missing_to_1"]["lower"], 0.0);
  EXPECT_GE(json["missing_to_1"]["upper"], 0.0);
  EXPECT_LT(json["missing_to_1"]["upper"], 1e-25);
}

// What the sum lacks is then not what reaches no front.
TEST_F(PointWords, AllSaysWhereTheSumCountsSomeOfTheViewTwice) {
  const std::string twin = kLidded + "usemtl grey\ng twin\nf 12 13 14 15\n";
  const std::string back = kLidded + "usemtl grey\ng turned\nf 4 3 2 1\n";
  const auto missing = [&](const std::string& scene, const Words& flags) {
    const std::string said =
        from(directory_.write("more.obj", scene).string(), {"0", "0", "0"}, joined({"--source", "all"}, flags)).output;
    const std::size_t at = said.find("missing to 1");
    return said.substr(at, said.find('\n', at) - at);
  };
  EXPECT_TRUE(std::regex_match(
      missing(twin, {}), std::regex("missing to 1  0\\.[0-9]+  \\(patches lie in one plane over each other, and each "
                                    "counts fully; exactff view has the shares of what is seen\\)")))
      << missing(twin, {});
  for (const std::string& scene : {back, kLidded}) {
    EXPECT_HOLDS(missing(scene, {}), "  (the share that reaches no patch's front: it leaves the scene or");
  }
  EXPECT_HOLDS(missing(kLidded, {"--transparent", "past"}),
               "  (transparent patches count fully, and so does what is seen through them)");
}

TEST_F(PointWords, WhatPlainDoesNotPrintIsSaid) {
  const Said said = up({"--source", "light", "--plain", "--fraction", "--explain"});
  EXPECT_EQ(said.exit_code, 0);
  EXPECT_EQ(said.output, up({"--source", "light", "--plain"}).output);
  EXPECT_EQ(said.error,
            "exactff: warning: --fraction and --explain have no effect here (--plain prints the value alone; remove "
            "--plain, or use --json)\n");
  EXPECT_HOLDS(up({"--source", "light", "--plain", "--method", "adaptive"}).error, "--method has no effect here");
  const std::string file = (directory_.path() / "view.svg").string();
  EXPECT_EQ(up({"--source", "light", "--plain", "--method", "adaptive", "--svg", file}).error, "")
      << "the drawing shows leaves";
}

TEST_F(PointWords, ExplainTellsTheStagesAndTheOutcome) {
  for (const char* engine : {"edges", "boolean"}) {
    const Said said = up({"--source", "light", "--fraction", "--explain", "--method", "adaptive", "--engine", engine});
    for (const char* part : {"  visible      1  (all of it)\n", "plane of light: unoccluded\n",
                             "occluders that hide a part of it: 0\n", "\n  adaptive: 0.55"}) {
      EXPECT_HOLDS(said.output, part);
    }
    EXPECT_EQ(holds(said.output, "that 1 candidate leaves visible: all of it\n"), engine == std::string("edges"));
  }
}

}  // namespace
}  // namespace exactff
