// Scenes as modelling programs export them, each with one slip: what the terminal prints leads to the right number.
#include "support/test.h"

namespace exactff {
namespace {

namespace fs = std::filesystem;

class ExportedScenes : public testing::Test {
 protected:
  ExportedScenes() {
    const std::string script = std::string(EXACTFF_DATA_DIR) + "/../validation/support/exported_scenes.py";
    EXPECT_EQ(RunningProgram("/usr/bin/env", {"python3", script, path(".")}, path("script.err")).wait(), 0);
    clean_ = value("clean");
  }

  [[nodiscard]] std::string path(const std::string& name) const { return (directory_.path() / name).string(); }
  [[nodiscard]] std::string scene(const std::string& name) const { return path(name + ".obj"); }

  // What the program prints on both streams.
  [[nodiscard]] std::string told(const Words& words) const {
    return run_program("/bin/sh", joined({"-c", "\"$0\" \"$@\" 2>&1", EXACTFF_PROGRAM}, words)).output;
  }
  [[nodiscard]] std::string info(const std::string& name, const Words& flags = {}) const {
    return told(joined({"info", scene(name)}, flags));
  }
  [[nodiscard]] Words question(const std::string& name, const Words& flags) const {
    return joined({"point", scene(name), "--at", "1", "1", "0", "--normal", "0", "0", "1", "--source", "lamp"}, flags);
  }
  [[nodiscard]] std::string point(const std::string& name, const Words& flags = {}) const {
    return told(question(name, flags));
  }
  [[nodiscard]] double value(const std::string& name, Words flags = {}) const {
    flags.emplace_back("--plain");
    return std::stod(run_exactff(question(name, flags)).output);
  }

  // The column of the exact values of a truth file, by rows; and what the run told.
  struct Truth {
    std::string told;
    std::vector<std::string> rows;
    std::vector<double> values;
  };
  [[nodiscard]] Truth truth(const std::string& name, const Words& flags) const {
    Truth result{
        told(joined({"truth", scene(name), "--source", "lamp", "--force", "-o", path("truth.csv")}, flags)), {}, {}};
    std::istringstream lines(text_of(path("truth.csv")));
    for (std::string line; std::getline(lines, line);) {
      if (line.starts_with('#') || line.starts_with("receiver,")) continue;
      Words fields;
      std::istringstream columns(line);
      for (std::string field; std::getline(columns, field, ',');) fields.push_back(field);
      result.rows.push_back(line);
      result.values.push_back(std::stod(fields.at(9)));
    }
    return result;
  }

  const TemporaryDirectory directory_;
  const Words kGrid = {"--on", "floor", "--grid", "6x5"};
  double clean_ = 0.0;
};

TEST_F(ExportedScenes, TheCleanOneIsNotDoubted) {
  EXPECT_GT(clean_, 0.06);
  EXPECT_FALSE(holds(info("clean"), "check:")) << info("clean");
  EXPECT_FALSE(holds(info("clean"), "warning")) << info("clean");
  EXPECT_FALSE(holds(point("clean", {"--on", "floor"}), "warning"));
  EXPECT_FALSE(holds(truth("clean", kGrid).told, "warning"));
}

// The room is rotated, and everything is printed with six decimals: the cells of the grid as well.
TEST_F(ExportedScenes, PointsPrintedWithSixDecimalsFindTheirFloor) {
  const Truth clean = truth("clean", kGrid), grid = truth("rotated", kGrid);
  ASSERT_EQ(grid.values.size(), clean.values.size());
  std::ofstream file(path("printed.csv"));
  file << "id,x,y,z,nx,ny,nz\n";
  for (const std::string& row : grid.rows) {
    std::istringstream fields(row);
    std::string id, field;
    std::getline(fields, id, ',');
    std::getline(fields, field, ',');
    file << id;
    for (int i = 0; i < 6 && std::getline(fields, field, ','); ++i) {
      char text[32];
      std::snprintf(text, sizeof text, ",%.6f", std::stod(field));
      file << text;
    }
    file << '\n';
  }
  file.close();
  const Truth free = truth("rotated", {"--receivers", path("printed.csv")});
  EXPECT_HOLDS(free.told, "30 of 30 receivers are given without a face, within ");
  EXPECT_HOLDS(free.told, "look through it from behind, so it hides everything; --on auto places them on their faces");
  EXPECT_HOLDS(free.told, " behind 'floor:");
  const Truth placed = truth("rotated", {"--receivers", path("printed.csv"), "--on", "auto"});
  EXPECT_FALSE(holds(placed.told, "warning")) << placed.told;
  for (std::size_t i = 0; i < clean.values.size(); ++i) {
    EXPECT_NEAR(placed.values[i], clean.values[i], 1e-5) << i;
    EXPECT_NEAR(grid.values[i], clean.values[i], 1e-5) << i;
  }
}

TEST_F(ExportedScenes, APointBehindItsFloorIsTold) {
  Words words = {"point", scene("clean"), "--at", "1", "1", "-3.1e-7", "--normal", "0", "0", "1", "--source", "lamp"};
  const std::string text = told(words);
  EXPECT_HOLDS(text,
               "x lies 3.1e-07 behind 'floor', which then hides everything beyond it. With --on floor the form "
               "factor of 'lamp' is 0.0678624");
  EXPECT_HOLDS(text, " instead of 0\n");
  words.insert(words.end(), {"--on", "auto", "--plain"});
  EXPECT_NEAR(std::stod(run_exactff(words).output), clean_, 1e-6);
}

}  // namespace
}  // namespace exactff
