// What exactff point says: sources without emission, all patches at once, outcomes, options without effect.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>
#include <string>
#include <vector>

#include "support/holds.h"
#include "support/program.h"

namespace exactff {
namespace {

using validation::holds;
using validation::TemporaryDirectory;
using Words = std::vector<std::string>;

// A light [-1,1]^2 at z = 1 facing down, a floor, and a plate past the corner of the view of the light: no side of the
// shaft from the origin rules it out, and it hides nothing.
const std::string kScene =
    "mtllib a.mtl\n"
    "v -1 1 1\nv 1 1 1\nv 1 -1 1\nv -1 -1 1\n"
    "v 1.3 -.1 .5\nv 1.3 1.3 .5\nv -.1 1.3 .5\n"
    "v -9 -9 0\nv 9 -9 0\nv 9 9 0\nv -9 9 0\n"
    "v 2 1 2\nv 4 1 2\nv 4 -1 2\nv 2 -1 2\n"
    "usemtl lamp\ng light\nf 1 2 3 4\nusemtl grey\ng past\nf 5 6 7\ng floor\nf 8 9 10 11\ng lid\nf 12 13 14 15\n";
const std::string kMaterials = "newmtl lamp\nKe 4 2 1\nnewmtl grey\nKd .5 .25 .125\n";

// A cube about the origin whose six faces look inward.
const std::string kCube =
    "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n"
    "g bottom\nf 1 2 3 4\ng top\nf 8 7 6 5\ng front\nf 1 5 6 2\ng right\nf 2 6 7 3\ng back\nf 3 7 8 4\ng left\nf 4 8 5 "
    "1\n";

class PointWords : public testing::Test {
 protected:
  PointWords() {
    (void)directory_.write("a.mtl", kMaterials);
    scene_ = directory_.write("a.obj", kScene).string();
  }

  using Said = validation::ProgramRun;
  // At the origin, looking up.
  Said up(const Words& flags) const { return from(scene_, {"0", "0", "0"}, flags); }
  static Said from(const std::string& scene, const Words& at, const Words& flags) {
    Words words = {"point", scene, "--at", at[0], at[1], at[2], "--normal", "0", "0", "1"};
    words.insert(words.end(), flags.begin(), flags.end());
    return validation::run_exactff(words);
  }
  nlohmann::json json(Words flags) const {
    flags.emplace_back("--json");
    return nlohmann::json::parse(up(flags).output);
  }
  const TemporaryDirectory directory_;
  std::string scene_;
};

// --- sources without emission --------------------------------------------------------------------------------

TEST_F(PointWords, ASourceWithoutEmissionCountsWithARadiosityOfOne) {
  const Said said = up({"--source", "lid", "--on", "floor"});
  EXPECT_TRUE(holds(said.output, "  emits        nothing (Ke 0), so it counts with a radiosity of 1\n")) << said.output;
  EXPECT_TRUE(holds(said.output, "(reflectance x 1 x form factor, per channel, since nothing is emitted)\n"));
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
  EXPECT_TRUE(holds(said.output, "sum of 2 sources\n")) << said.output;
  EXPECT_TRUE(holds(said.output, "sum of the 1 that emits\n")) << said.output;
  EXPECT_TRUE(holds(said.output, "  (from the 1 that emits nothing, with a radiosity of 1)\n")) << said.output;
  EXPECT_TRUE(holds(said.output, "over the 1 source that emits)\n  not added         ")) << said.output;
}

// --- every patch ---------------------------------------------------------------------------------------------

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
  EXPECT_TRUE(holds(said.output, "  (of 4 patches, added as balls)\n")) << said.output;
  EXPECT_TRUE(holds(said.output, "missing to 1  0.")) << said.output;
  EXPECT_TRUE(
      holds(said.output, "(the share that reaches no patch's front: it leaves the scene or meets the back of a face)"));
  EXPECT_TRUE(holds(said.output, "  (the sum over the 1 patch that emits)\n")) << said.output;
  EXPECT_FALSE(holds(said.output, "source light\n")) << "no block per source";
  EXPECT_NEAR(all["missing_to_1"]["lower"].get<double>() + all["sum"]["upper"].get<double>(), 1.0, 1e-15);
}

// The rounded values of the six sides add up to 1 only by luck; the balls enclose it.
TEST_F(PointWords, InAClosedRoomNothingIsMissingToOne) {
  const std::string cube = directory_.write("cube.obj", kCube).string();
  const Said said = from(cube, {".1", ".2", ".3"}, {"--source", "all"});
  EXPECT_TRUE(holds(said.output, "\nsum           1  (of 6 patches")) << said.output;
  EXPECT_TRUE(holds(said.output, "\nmissing to 1  0, to within ")) << said.output;
  EXPECT_FALSE(holds(said.output, "\nemitters ")) << said.output;
  const nlohmann::json json =
      nlohmann::json::parse(from(cube, {".1", ".2", ".3"}, {"--source", "all", "--json"}).output);
  EXPECT_LE(json["missing_to_1"]["lower"], 0.0);
  EXPECT_GE(json["missing_to_1"]["upper"], 0.0);
  EXPECT_LT(json["missing_to_1"]["upper"], 1e-25);
}

// What the sum lacks is then not what reaches no front.
TEST_F(PointWords, AllSaysWhereTheSumCountsSomeOfTheViewTwice) {
  const std::string twin = kScene + "usemtl grey\ng twin\nf 12 13 14 15\n";
  const std::string back = kScene + "usemtl grey\ng turned\nf 4 3 2 1\n";
  const auto missing = [&](const std::string& scene, const Words& flags) {
    Words all = {"--source", "all"};
    all.insert(all.end(), flags.begin(), flags.end());
    const std::string said = from(directory_.write("more.obj", scene).string(), {"0", "0", "0"}, all).output;
    const std::size_t at = said.find("missing to 1");
    return said.substr(at, said.find('\n', at) - at);
  };
  EXPECT_TRUE(std::regex_match(
      missing(twin, {}), std::regex("missing to 1  0\\.[0-9]+  \\(patches lie in one plane over each other, and each "
                                    "counts fully; exactff view has the shares of what is seen\\)")))
      << missing(twin, {});
  for (const std::string& scene : {back, kScene}) {
    EXPECT_TRUE(holds(missing(scene, {}), "  (the share that reaches no patch's front: it leaves the scene or"));
  }
  EXPECT_TRUE(holds(missing(kScene, {"--transparent", "past"}),
                    "  (transparent patches count fully, and so does what is seen through them)"));
}

// --- outcomes ------------------------------------------------------------------------------------------------

TEST_F(PointWords, AnOutcomeAgreesWithTheExactVisiblePart) {
  for (const char* engine : {"edges", "boolean"}) {
    const Said said = up({"--source", "light", "--fraction", "--explain", "--engine", engine});
    EXPECT_TRUE(holds(said.output, "  visible      1  (all of it)\n")) << said.output;
    EXPECT_TRUE(holds(said.output, "plane of light: unoccluded\n")) << said.output;
    EXPECT_EQ(holds(said.output, "that 1 candidate leaves visible: all of it\n"), engine == std::string("edges"));
    EXPECT_TRUE(holds(said.output, "occluders that hide a part of it: 0\n")) << said.output;
    EXPECT_FALSE(holds(said.output, "partly hidden")) << said.output;
  }
  EXPECT_EQ(json({"--source", "light", "--fraction"})["sources"][0]["planes"][0]["outcome"], "unoccluded");
}

// --- options without effect ----------------------------------------------------------------------------------

TEST_F(PointWords, SettingsOfTheAdaptiveAlgorithmNeedIt) {
  const Said one = up({"--source", "light", "--rays", "4"});
  EXPECT_EQ(one.exit_code, 2);
  EXPECT_EQ(one.output, "");
  EXPECT_EQ(one.error,
            "exactff: --rays is given without --adaptive (it is a setting of the ray-sampled adaptive algorithm, which "
            "does not run); add --adaptive, or remove it\n");
  const Said several = up({"--source", "light", "--seed", "4", "--eps-a", "1", "--eps-b", "1"});
  EXPECT_EQ(several.exit_code, 2);
  EXPECT_TRUE(holds(several.error, "--eps-b, --eps-a and --seed are given without --adaptive (they are settings"))
      << several.error;
  EXPECT_EQ(up({"--source", "light", "--rays", "4", "--adaptive"}).error, "");
}

TEST_F(PointWords, WhatPlainDoesNotPrintIsSaid) {
  const Said said = up({"--source", "light", "--plain", "--fraction", "--explain"});
  EXPECT_EQ(said.exit_code, 0);
  EXPECT_EQ(said.output, up({"--source", "light", "--plain"}).output);
  EXPECT_EQ(said.error,
            "exactff: warning: --fraction and --explain have no effect here (--plain prints the value alone; remove "
            "--plain, or use --json)\n");
  EXPECT_TRUE(holds(up({"--source", "light", "--plain", "--adaptive"}).error, "--adaptive has no effect here"));
  const std::string file = (directory_.path() / "view.svg").string();
  EXPECT_EQ(up({"--source", "light", "--plain", "--adaptive", "--svg", file}).error, "") << "the drawing shows leaves";
}

// --- pipes ---------------------------------------------------------------------------------------------------

}  // namespace
}  // namespace exactff
