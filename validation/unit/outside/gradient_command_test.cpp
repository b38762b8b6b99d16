// The gradient as scripts use it: exactff point --gradient and exactff truth --gradient.
#include <nlohmann/json.hpp>

#include "support/test.h"

namespace exactff {
namespace {

// A light [-1,1]^2 at z = 1 facing down, a plate, a floor, and far away a sheet that is seen edge-on from y = 20.
const std::string kGradientScene =
    "v -1 1 1\nv 1 1 1\nv 1 -1 1\nv -1 -1 1\n"
    "v -.25 -.25 .5\nv .25 -.25 .5\nv .25 .25 .5\nv -.25 .25 .5\n"
    "v -9 -9 0\nv 9 -9 0\nv 9 9 0\nv -9 9 0\n"
    "v -1 .5 .25\nv -1 .5 .5\nv -2 .5 .5\nv -2 .5 .25\n"
    "g light\nf 1 2 3 4\ng plate\nf 5 6 7 8\ng floor\nf 9 10 11 12\ng sheet\nf 13 14 15 16\n";

struct GradientCommand : testing::Test {
  TemporaryDirectory directory;
  std::string scene = directory.write("a.obj", kGradientScene).string();

  ProgramRun point(const std::string& x, const std::string& y, Words flags) const {
    return run_exactff(joined(
        {"point", scene, "--at", x, y, "0", "--normal", "0", "0", "1", "--on", "floor", "--source", "light"}, flags));
  }
};

Words split_at(const std::string& line, char separator) {
  Words fields;
  std::istringstream in(line);
  for (std::string field; std::getline(in, field, separator);) fields.push_back(field);
  return fields;
}

TEST_F(GradientCommand, PlainPrintsValueAndDerivativesSeparatedByTabs) {
  const ProgramRun run = point("0.375", "0.25", {"--gradient", "--plain"});
  EXPECT_EQ(run.exit_code, 0);
  ASSERT_EQ(run.output.back(), '\n');
  const Words fields = split_at(run.output.substr(0, run.output.size() - 1), '\t');
  ASSERT_EQ(fields.size(), 4U);
  EXPECT_EQ(fields[0] + '\n', point("0.375", "0.25", {"--plain"}).output);
  const double ahead = std::stod(point("0.37501", "0.25", {"--plain"}).output);
  const double back = std::stod(point("0.37499", "0.25", {"--plain"}).output);
  EXPECT_NEAR(std::stod(fields[1]), (ahead - back) / 2e-5, 1e-7);
}

TEST_F(GradientCommand, PlainTellsProvedZerosFromKinks) {
  const ProgramRun middle = point("0", "0", {"--gradient", "--plain"});
  const Words fields = split_at(middle.output, '\t');
  ASSERT_EQ(fields.size(), 4U);
  EXPECT_EQ(fields[1], "0");
  EXPECT_EQ(fields[2], "0");
  const ProgramRun kink = point("-3", "0.5", {"--gradient", "--plain"});
  EXPECT_EQ(kink.exit_code, 0);
  EXPECT_EQ(kink.output, split_at(point("-3", "0.5", {"--plain"}).output, '\n').front() + "\tkink\n");
}

TEST_F(GradientCommand, JsonHasBallsAndArcs) {
  const auto json = nlohmann::json::parse(point("0.375", "0.25", {"--gradient", "--json", "--explain"}).output);
  const auto& gradient = json.at("sources").at(0).at("gradient");
  EXPECT_TRUE(gradient.at("kink").is_null());
  double sum = 0.0;
  for (const auto& arc : gradient.at("arcs")) sum += arc.at("part").at(0).get<double>();
  EXPECT_NEAR(sum, gradient.at("position").at(0).at("value").get<double>(), 1e-14);
  EXPECT_EQ(gradient.at("normal").at(2).at("status"), "certified");
  const auto kink = nlohmann::json::parse(point("-3", "0.5", {"--gradient", "--json"}).output).at("sources").at(0);
  EXPECT_TRUE(kink.at("gradient").at("position").at(0).at("value").is_null());
  EXPECT_EQ(kink.at("gradient").at("kink").at("faces").at(0), "sheet");
}

// With the receiver, all vertices that move the view move the other way.
TEST_F(GradientCommand, VerticesAddUpToTheGradient) {
  const auto json =
      nlohmann::json::parse(point("0.375", "0.25", {"--gradient", "--vertices", "--json"}).output).at("sources").at(0);
  const auto& gradient = json.at("gradient");
  EXPECT_EQ(gradient.at("vertices").size(), 8U);
  EXPECT_EQ(gradient.at("frames"), nlohmann::json({{0, 1, 2}}));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double sum = gradient.at("position").at(axis).at("value").get<double>();
    for (const auto& vertex : gradient.at("vertices")) {
      EXPECT_FALSE(vertex.at("kink").get<bool>());
      sum += vertex.at("position").at(axis).at("value").get<double>();
    }
    EXPECT_NEAR(sum, 0.0, 1e-14);
  }
  const ProgramRun text = point("0.375", "0.25", {"--gradient", "--vertices"});
  EXPECT_HOLDS(text.output, "  vertices that move the visible boundary: 8\n    (-1, 1, 1)  ");
  EXPECT_HOLDS(text.output, "  the source's plane follows (-1, 1, 1) (1, 1, 1) (1, -1, 1)\n");
}

TEST_F(GradientCommand, TruthHasColumnsThatAreEmptyAtKinks) {
  const auto receivers =
      directory.write("r.csv", "id,x,y,z,nx,ny,nz,on\na,0.375,0.25,0,0,0,1,floor\nb,-3,0.5,0,0,0,1,floor\n");
  const std::string file = (directory.path() / "truth.csv").string(), npy = (directory.path() / "truth.npy").string();
  const std::string vtk = (directory.path() / "truth.vtp").string();
  const ProgramRun run = run_exactff({"truth", scene, "--receivers", receivers.string(), "--source", "light",
                                      "--gradient", "-o", file, "--npy", npy, "--vtk", vtk});
  EXPECT_EQ(run.exit_code, 0);
  Words lines;
  for (const std::string& line : split_at(text_of(file), '\n')) {
    if (line.front() != '#') lines.push_back(line);
  }
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_HOLDS(lines[0], ",upper,dF_dx,dF_dy,dF_dz,dF_dx_status,dF_dy_status,dF_dz_status,");
  const Words plain = split_at(split_at(point("0.375", "0.25", {"--gradient", "--plain"}).output, '\n').front(), '\t');
  EXPECT_HOLDS(lines[1], ',' + plain[1] + ',' + plain[2] + ',' + plain[3] + ",certified,certified,certified,");
  EXPECT_HOLDS(lines[2], ",,,,kink,kink,kink,");
  EXPECT_HOLDS(text_of(npy), "(2, 4)");
  EXPECT_HOLDS(text_of(vtk), "Name=\"gradient\"");
}

// Whatever a program says at a kink, it is not wrong.
TEST_F(GradientCommand, CheckComparesAColumnWithoutTheKinks) {
  const auto receivers =
      directory.write("r.csv", "id,x,y,z,nx,ny,nz,on\na,0.375,0.25,0,0,0,1,floor\nb,-3,0.5,0,0,0,1,floor\n");
  const std::string file = (directory.path() / "truth.csv").string();
  ASSERT_EQ(
      run_exactff({"truth", scene, "--receivers", receivers.string(), "--source", "light", "--gradient", "-o", file})
          .exit_code,
      0);
  const std::string x = split_at(point("0.375", "0.25", {"--gradient", "--plain"}).output, '\t')[1];
  const auto check = [&](const std::string& value) {
    const auto mine = directory.write("mine.csv", "receiver,source,value\na,light," + value + "\nb,light,17\n");
    return run_exactff({"check", file, mine.string(), "--truth-column", "dF_dx", "--max-abs", "1e-6"}).exit_code;
  };
  EXPECT_EQ(check(x), 0);
  EXPECT_EQ(check(std::to_string(std::stod(x) + 1e-3)), 1);
}

}  // namespace
}  // namespace exactff
