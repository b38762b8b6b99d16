// Scenes as modelling programs export them, each with one slip: what the terminal prints leads to the right number.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "support/holds.h"
#include "support/program.h"

namespace exactff {
namespace {

namespace fs = std::filesystem;
using validation::holds;
using validation::run_program;
using validation::RunningProgram;
using validation::TemporaryDirectory;
using validation::text_of;

using Words = std::vector<std::string>;

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
  [[nodiscard]] std::string told(Words words) const {
    words.insert(words.begin(), {"-c", "\"$0\" \"$@\" 2>&1", EXACTFF_PROGRAM});
    return run_program("/bin/sh", words).output;
  }
  [[nodiscard]] std::string info(const std::string& name, const Words& flags = {}) const {
    Words words = {"info", scene(name)};
    words.insert(words.end(), flags.begin(), flags.end());
    return told(words);
  }
  [[nodiscard]] Words question(const std::string& name, const Words& flags) const {
    Words words = {"point", scene(name), "--at", "1", "1", "0", "--normal", "0", "0", "1", "--source", "lamp"};
    words.insert(words.end(), flags.begin(), flags.end());
    return words;
  }
  [[nodiscard]] std::string point(const std::string& name, const Words& flags = {}) const {
    return told(question(name, flags));
  }
  [[nodiscard]] double value(const std::string& name, Words flags = {}) const {
    flags.emplace_back("--plain");
    return std::stod(run_program(EXACTFF_PROGRAM, question(name, flags)).output);
  }

  // The column of the exact values of a truth file, by rows; and what the run told.
  struct Truth {
    std::string told;
    std::vector<std::string> rows;
    std::vector<double> values;
  };
  [[nodiscard]] Truth truth(const std::string& name, const Words& flags) const {
    Words words = {"truth", scene(name), "--source", "lamp", "--force", "-o", path("truth.csv")};
    words.insert(words.end(), flags.begin(), flags.end());
    Truth result{told(words), {}, {}};
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

#define EXPECT_TOLD(text, part) EXPECT_TRUE(holds(text, part)) << text

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
  EXPECT_TOLD(free.told, "30 of 30 receivers are given without a face, within ");
  EXPECT_TOLD(free.told, "look through it from behind, so it hides everything; --on auto places them on their faces");
  EXPECT_TOLD(free.told, " behind 'floor:");
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
  EXPECT_TOLD(text,
              "x lies 3.1e-07 behind 'floor', which then hides everything beyond it. With --on floor the form "
              "factor of 'lamp' is 0.0678624");
  EXPECT_TOLD(text, " instead of 0\n");
  words.insert(words.end(), {"--on", "auto", "--plain"});
  EXPECT_NEAR(std::stod(run_program(EXACTFF_PROGRAM, words).output), clean_, 1e-6);
}

TEST_F(ExportedScenes, AFlippedLampIsTold) {
  EXPECT_TOLD(info("flipped"), "emitter 'lamp' looks away from everything");
  EXPECT_TOLD(info("flipped"), "turn it round with --flip lamp");
  EXPECT_TOLD(point("flipped"), "the receiver is behind every face of 'lamp'");
  EXPECT_TOLD(point("flipped"), "turn it round with --flip lamp");
  EXPECT_TOLD(truth("flipped", kGrid).told, "--flip lamp");
  EXPECT_EQ(value("flipped", {"--flip", "lamp"}), clean_);
  EXPECT_FALSE(holds(point("flipped", {"--flip", "lamp"}), "--flip"));
  EXPECT_FALSE(holds(info("flipped", {"--flip", "lamp"}), "check:"));
}

TEST_F(ExportedScenes, GlassIsTold) {
  const std::string text = point("glass");
  EXPECT_TOLD(text, "material 'glass' lets light through (d 0.1), but 'pane' occludes");
  EXPECT_TOLD(text, "give --transparent pane");
  EXPECT_EQ(value("glass"), 0.0);
  EXPECT_EQ(value("glass", {"--transparent", "pane"}), clean_);
  EXPECT_FALSE(holds(point("glass", {"--transparent", "pane"}), "warning"));
}

TEST_F(ExportedScenes, ATableTurnedInsideOutIsTold) {
  EXPECT_TOLD(info("inverted"), "1 closed surface looks inward and encloses no other face: 'table'");
  EXPECT_TOLD(info("inverted"), "turn it round with --flip table");
  EXPECT_FALSE(holds(info("inverted", {"--flip", "table"}), "check:"));
  const Words table = {"--on", "table", "--samples", "50"};
  Words mended = table;
  mended.insert(mended.end(), {"--flip", "table"});
  const Truth inward = truth("inverted", table), outward = truth("inverted", mended);
  EXPECT_TOLD(inward.told, "--flip");
  double sum = 0.0;
  for (const double f : outward.values) sum += f;
  EXPECT_GT(sum, 1.0);
}

TEST_F(ExportedScenes, NormalsAgainstTheWindingAreTold) {
  EXPECT_TOLD(info("normals"), "the normals in the file (vn) contradict the winding");
  EXPECT_TOLD(info("normals"), "turn it round with --flip lamp");
  EXPECT_EQ(value("normals", {"--flip", "lamp"}), clean_);
}

}  // namespace
}  // namespace exactff
