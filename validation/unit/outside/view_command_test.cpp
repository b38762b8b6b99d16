// exactff view as scripts use it.
#include <nlohmann/json.hpp>

#include "support/test.h"

namespace exactff {
namespace {

// A light [-1,1]^2 at z = 1 that looks down, a plate before it that looks up, and a wall below the horizon.
const std::string kTwins =
    "v -1 1 1\nv 1 1 1\nv 1 -1 1\nv -1 -1 1\n"
    "v -.25 -.25 .5\nv .25 -.25 .5\nv .25 .25 .5\nv -.25 .25 .5\n"
    "v -9 -9 -1\nv 9 -9 -1\nv 9 9 -1\nv -9 9 -1\n"
    "g light\nf 1 2 3 4\ng plate\nf 5 6 7 8\ng floor\nf 9 10 11 12\ng twin\nf 1 2 3 4\n";

struct ViewCommand : testing::Test {
  TemporaryDirectory directory;
  std::string scene = directory.write("a.obj", kTwins).string();

  [[nodiscard]] ProgramRun up(const Words& flags) const {
    return run_exactff(joined({"view", scene, "--at", "0", "0", "0", "--normal", "0", "0", "1"}, flags));
  }
};

double sum_of_plain(const std::string& output) {
  std::istringstream lines(output);
  double sum = 0.0;
  for (std::string line; std::getline(lines, line);) sum += std::stod(line.substr(line.find('\t') + 1));
  return sum;
}

TEST_F(ViewCommand, KnowsOtherMeasuresAndSpheres) {
  constexpr double kPi = 3.141592653589793;
  EXPECT_NEAR(sum_of_plain(up({"--plain", "--measure", "solid-angle"}).output), 2.0 * kPi, 1e-14);
  EXPECT_NEAR(sum_of_plain(up({"--plain", "--measure", "overcast"}).output), 1.0, 1e-15);
  const auto sphere = [&](const Words& more) {
    return run_exactff(joined({"view", scene, "--at", "0", "0", "0", "--sphere"}, more));
  };
  EXPECT_NEAR(sum_of_plain(sphere({"--plain"}).output), 1.0, 1e-15);
  EXPECT_NEAR(sum_of_plain(sphere({"--plain", "--measure", "solid-angle"}).output), 4.0 * kPi, 1e-14);
  EXPECT_TRUE(sphere({"--plain"}).output.starts_with("light\t0.1")) << sphere({"--plain"}).output;
  EXPECT_EQ(sphere({"--measure", "overcast"}).exit_code, 2);
  EXPECT_EQ(sphere({"--normal", "0", "0", "1"}).exit_code, 2);
  EXPECT_EQ(up({"--measure", "overcast", "--up", "0", "0", "0"}).exit_code, 2);
  EXPECT_EQ(up({"--measure", "overcast", "--engine", "both"}).exit_code, 0);
}

TEST_F(ViewCommand, PointAndRenderKnowOtherMeasures) {
  const auto point = [&](const Words& more) {
    return run_exactff(joined({"point", scene, "--at", "0", "0", "0", "--source", "light", "--plain"}, more));
  };
  const std::string sphere = point({"--sphere"}).output;
  EXPECT_EQ(point({"--normal", "0", "0", "1", "--measure", "solid-angle", "--engine", "both"}).exit_code, 0);
  EXPECT_NEAR(4.0 * std::stod(sphere) * 3.141592653589793,
              std::stod(point({"--sphere", "--measure", "solid-angle"}).output), 1e-14);
  EXPECT_EQ(point({}).exit_code, 2);
  EXPECT_EQ(point({"--sphere", "--gradient"}).exit_code, 2);
  const std::string picture = (directory.path() / "a.exr").string();
  const auto render = [&](const Words& more) {
    return run_exactff(joined({"render", scene, "--size", "8x8", "--eye", "3", "3", "3", "--look", "0", "0", "-1",
                               "--source", "light", "-o", picture, "--force"},
                              more))
        .exit_code;
  };
  EXPECT_EQ(render({"--measure", "overcast", "--up", "0", "0", "1"}), 0);
  EXPECT_EQ(render({"--sphere"}), 0);
  EXPECT_EQ(render({"--measure", "solid-angle", "--quantity", "radiance"}), 2);
}

// The twin is stacked: it is not seen.
TEST_F(ViewCommand, PlainPrintsNameTabShareThenBackAndOpen) {
  const ProgramRun run = up({"--plain"});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_TRUE(run.output.starts_with("light\t0.31466995351879845\n(back)\t")) << run.output;
  EXPECT_HOLDS(run.output, "\n(open)\t");
  EXPECT_EQ(std::ranges::count(run.output, '\n'), 3);
  EXPECT_NEAR(sum_of_plain(run.output), 1.0, 1e-15);
}

TEST_F(ViewCommand, AViewOfNothingGivesAnEmptyPictureAndMesh) {
  const std::filesystem::path picture = directory.path() / "empty.svg", mesh = directory.path() / "empty";
  for (const char* extension : {".obj", ".ply", ".stl", ".off", ".vs3", ".vtp", ".vtu"}) {
    const std::string file = mesh.string() + extension;
    const RunningProgram program(
        EXACTFF_PROGRAM,
        {"view", scene, "--at", "0", "0", "3", "--normal", "0", "0", "1", "--svg", picture, "--mesh", file},
        directory.path() / "errors");
    EXPECT_EQ(program.wait(), 0) << program.error();
    EXPECT_HOLDS(program.error(), "note: the receiver sees nothing of the scene; the mesh is empty\n");
    EXPECT_TRUE(std::filesystem::exists(file)) << file;
  }
  const std::string svg = text_of(picture);
  EXPECT_HOLDS(svg, "<title>(open)</title>");
  EXPECT_EQ(svg.find("class=\"front\""), std::string::npos) << svg;
  EXPECT_EQ(text_of(mesh.string() + ".off"), "OFF\n0 0 0\n");
}

TEST_F(ViewCommand, JsonHasEveryPatchSeenAndTheRest) {
  const nlohmann::json json = nlohmann::json::parse(up({"--json", "--digits", "30"}).output);
  ASSERT_EQ(json["patches"].size(), 2U);
  EXPECT_EQ(json["patches"][0]["patch"], "light");
  EXPECT_EQ(json["patches"][0]["decimals"], "0.314669953518798448298026682526");
  EXPECT_FALSE(json["patches"][0].contains("stacked"));
  EXPECT_EQ(json["patches"][1]["value"], 0.0);
  EXPECT_EQ(json["patches"][1]["stacked"], true);
  EXPECT_EQ(json["patches"][1]["form_factor"]["status"], "certified");
  EXPECT_EQ(json["back"]["status"], "certified");
  EXPECT_GT(json["open"]["value"], 0.0);
  EXPECT_GT(json["work"]["arcs"], 0);
}

TEST_F(ViewCommand, CsvHasSharesAndFormFactors) {
  const std::string text = up({"--csv"}).output;
  EXPECT_HOLDS(text, "name,share,lower,upper,status,form_factor,stacked\nlight,0.31466995351879845,");
  EXPECT_HOLDS(text, ",certified,0.31466995351879845,no\n");
  EXPECT_HOLDS(text, "\ntwin,0,0,0,zero,0.31466995351879845,yes\n");
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 6);
}

TEST_F(ViewCommand, DrawsAllThatItSees) {
  for (const char* projection : {"nusselt", "fisheye"}) {
    const std::string file = (directory.path() / (std::string(projection) + ".svg")).string();
    EXPECT_EQ(up({"--svg", file, "--projection", projection, "--up", "1", "1", "0"}).exit_code, 0);
    const std::string svg = text_of(file);
    for (const char* part : {"<g class=\"front\"><title>light</title>", "<g class=\"back\"><title>plate</title>",
                             "<g class=\"open\"><title>(open)</title>", "id=\"horizon\"", "A320 "}) {
      EXPECT_HOLDS(svg, part) << part;
    }
    EXPECT_EQ(svg.find("twin"), std::string::npos) << "it lies in the plane of the light, which comes first";
  }
  EXPECT_EQ(up({"--projection", "fisheye"}).exit_code, 2);
  EXPECT_EQ(up({"--svg", (directory.path() / "up.svg").string(), "--up", "0", "0", "0"}).exit_code, 2);
}

// The plate hides a square of side 1 of the light, whose side is 2.
TEST_F(ViewCommand, WritesTheVisibleRegionsAsAScene) {
  const std::string file = (directory.path() / "seen.obj").string();
  const nlohmann::json json = nlohmann::json::parse(up({"--mesh", file, "--json"}).output);
  EXPECT_EQ(json["regions"].dump(), R"([{"face":"light","fraction":"3/4","front":true},)"
                                    R"({"face":"plate","fraction":"1","front":false}])");
  const Scene seen = read_scene(file);
  ASSERT_EQ(seen.patches().size(), 2U);
  EXPECT_EQ(seen.patches()[0].name, "light");
  EXPECT_EQ(seen.patches()[1].name, "plate (back)");
  double area = 0.0;
  for (const FaceId face : seen.patches()[0].faces) area += seen.face(face).area;
  EXPECT_EQ(area, 3.0);
  const FormFactor light =
      exact_form_factor(seen, {.point = {}, .normal = {0, 0, 1}, .on = {}, .id = {}}, {seen, seen.select("light")});
  EXPECT_EQ(light.value, 0.31466995351879845);

  EXPECT_EQ(up({"--mesh", file}).exit_code, 2) << "it is there";
  EXPECT_EQ(up({"--mesh", file, "--force"}).exit_code, 0);
  const std::filesystem::path vtk = directory.path() / "seen.vtp";
  EXPECT_EQ(up({"--mesh", vtk.string()}).exit_code, 0);
  EXPECT_HOLDS(text_of(vtk), "type=\"PolyData\"");
  EXPECT_EQ(up({"--mesh", (directory.path() / "seen.png").string()}).exit_code, 2);
}

TEST_F(ViewCommand, IsNotCertifiedUnderALowCap) {
  const ProgramRun run = up({"--precision-cap", "32", "--plain"});
  EXPECT_EQ(run.exit_code, 3) << run.output;
}

}  // namespace
}  // namespace exactff
