// Files of matrices for other programs, each read back.
#include "matrix/other_programs.h"
#include "support/test.h"

namespace exactff::matrix {
namespace {

class ProgramFiles : public testing::Test {
 protected:
  void SetUp() override {
    const ProgramRun run = run_exactff({"matrix",          scene_,        "--balance",    "--accuracy",  "1e-3",
                                        "--openfoam",      file("F"),     "--calculix",   file("m.vwf"), "--moose",
                                        file("moose.txt"), "--nek",       file("nek"),    "--esatan",    file("e.gr"),
                                        "--view3d",        file("v.out"), "--energyplus", file("z.idf"), "--exchange",
                                        file("b.csv"),     "-o",          file("m.csv")});
    ASSERT_EQ(run.exit_code, 0) << run.error;
    EXPECT_HOLDS(run.output, "(without bounds and names; patches must be in the order of");
    const table::Table table = table::read(file("m.csv"));
    const std::vector<double>& balanced = table.numbers(table.column("balanced").value());
    for (std::size_t i = 0; i < kPatches; ++i) {
      for (std::size_t j = 0; j < kPatches; ++j) values_.push_back(balanced[i * (kPatches + 2) + j]);
    }
  }
  [[nodiscard]] std::string file(const std::string& name) const { return (folder_.path() / name).string(); }
  // As `exactff check` reads it.
  [[nodiscard]] std::vector<double> read(const std::string& name) const {
    Order order{{"from", "to"}, {}, {}, {}};
    for (std::size_t i = 0; i < kPatches; ++i) order.rows.push_back("srf-" + std::to_string(i + 1));
    order.columns = order.rows;
    const auto table = read_other(file(name), order);
    return table->numbers(2);
  }

  static constexpr std::size_t kPatches = 8;
  const std::string scene_ = EXACTFF_DATA_DIR "/scenes/formats/test4.vs3";
  const TemporaryDirectory folder_;
  std::vector<double> values_;  // of the balanced matrix
};

TEST_F(ProgramFiles, HoldTheBalancedMatrixToTheLastBit) {
  EXPECT_EQ(read("F"), values_);
  EXPECT_EQ(read("m.vwf"), values_);
  EXPECT_EQ(read("z.idf"), values_);
  const std::vector<double> six_decimals = read("v.out");
  for (std::size_t k = 0; k < values_.size(); ++k) EXPECT_NEAR(six_decimals[k], values_[k], 5.01e-7);

  std::istringstream moose(text_of(file("moose.txt")));
  std::string line;
  std::getline(moose, line);
  EXPECT_EQ(line, "subdomain_id,vf_to_1,vf_to_2,vf_to_3,vf_to_4,vf_to_5,vf_to_6,vf_to_7,vf_to_8");
  std::vector<double> found;
  for (std::size_t i = 0; i < kPatches && std::getline(moose, line); ++i) {
    std::istringstream fields(line);
    std::string field;
    std::getline(fields, field, ',');
    EXPECT_EQ(field, std::to_string(i + 1));
    while (std::getline(fields, field, ',')) found.push_back(std::stod(field));
  }
  EXPECT_EQ(found, values_);

  // As vf_read_view_factors reads it, with list-directed input.
  std::ifstream nek(file("nek"));
  std::size_t walls = 0, wall = 0, element = 0, face = 0, count = 0;
  nek >> walls;
  ASSERT_EQ(walls, kPatches);
  found.assign(kPatches * kPatches, 0.0);
  for (std::size_t i = 1; i <= walls; ++i) {
    nek >> wall >> element >> face >> count;
    EXPECT_EQ(std::pair(wall, element), std::pair(i, i));
    EXPECT_EQ(face, 1U);
    for (; count > 0; --count) {
      nek >> wall >> element >> face;
      nek >> found[(i - 1) * kPatches + wall - 1];
    }
  }
  EXPECT_TRUE(nek.good());
  EXPECT_EQ(found, values_);
}

// A patch of the mesh has one coarse face; by --patches faces, each of its faces is one.
TEST_F(ProgramFiles, HoldTheAgglomerationOfOpenFoam) {
  const auto lists_of = [&](const std::vector<std::string>& flags) {
    EXPECT_EQ(run_exactff(joined({"matrix", scene_, "--accuracy", "0.1", "--openfoam", file("F"), "--force"}, flags))
                  .exit_code,
              0);
    const std::string text = text_of(file("finalAgglom"));
    return text.substr(text.find("}\n\n") + 3);
  };
  EXPECT_EQ(lists_of({"--from", "srf-1,srf-7", "--to", "srf-1,srf-7"}), "2\n(\n1(0)\n3(0 0 0)\n)\n");
  EXPECT_EQ(lists_of({"--patches", "faces", "--from", "srf-1:1,srf-7:*", "--to", "srf-1:1,srf-7:*"}),
            "2\n(\n1(0)\n3(0 1 2)\n)\n");
  const std::string map = text_of(file("mapDist"));
  EXPECT_EQ(map.substr(map.find("}\n\n") + 3), "4\n1(4(0 1 2 3))\n1(4(0 1 2 3))\n0 0\n0()\n0()\n");
}

TEST_F(ProgramFiles, HoldTheConductors) {
  const table::Table table = table::read(file("b.csv"));
  const std::vector<double>& conductors = table.numbers(table.column("conductor").value());
  std::map<std::pair<std::size_t, std::size_t>, double> expected, found;
  for (std::size_t i = 0; i < kPatches; ++i) {
    for (std::size_t j = i + 1; j < kPatches + 2; ++j) {
      const double g = conductors[i * (kPatches + 2) + j];
      if (g > 0.0) expected[{i + 1, j + 1}] = g;
    }
  }
  std::istringstream lines(text_of(file("e.gr")));
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with('#')) continue;
    std::size_t i = 0, j = 0;
    double g = 0.0;
    ASSERT_EQ(std::sscanf(line.c_str(), "GR(%zu, %zu) = %lf;", &i, &j, &g), 3) << line;
    found[{i, j}] = g;
  }
  EXPECT_EQ(found, expected);
  EXPECT_HOLDS(text_of(file("e.gr")), "# node 8: 'srf-8'\n# node 9: '(back)'\n");
}

}  // namespace
}  // namespace exactff::matrix
