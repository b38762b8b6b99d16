// Exchange factors over all bounces, and conductors.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "exactff/radiosity.h"
#include "exactff/scene_files.h"
#include "generate/plain_scene.h"
#include "support/program.h"

namespace exactff::radiosity {
namespace {

using generate::PlainScene;

void set_kd(PlainScene& scene, const std::string& name, double kd, double ke = 0.0) {
  scene.patch(name).material = "of " + name;
  scene.materials.push_back({.name = "of " + name, .reflectance = {kd, kd, kd}, .radiosity = {ke, ke, ke}});
}

void add_cube(PlainScene& scene, const std::string& name, double h, bool inward) {
  const std::vector<Vec3> c{{-h, -h, -h}, {h, -h, -h}, {h, h, -h}, {-h, h, -h},
                            {-h, -h, h},  {h, -h, h},  {h, h, h},  {-h, h, h}};
  for (std::vector<std::size_t> side : std::vector<std::vector<std::size_t>>{
           {0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {3, 7, 6, 2}, {0, 4, 7, 3}, {1, 2, 6, 5}}) {
    if (inward) std::ranges::reverse(side);
    scene.add_ring(scene.patch(name), {c[side[0]], c[side[1]], c[side[2]], c[side[3]]});
  }
}

matrix::Matrix whole_matrix(const Scene& scene, double accuracy) {
  const std::vector<Selection> patches = patches_of(scene);
  return matrix::compute(scene, patches, patches, {.factors = {.accuracy = accuracy}, .backs = true, .open = true});
}

void expect_value(const BoundedValue& q, double truth, double width) {
  EXPECT_LE(q.lower, truth * (1.0 + 1e-15));
  EXPECT_GE(q.upper, truth * (1.0 - 1e-15));
  EXPECT_LE(q.lower, q.value);
  EXPECT_GE(q.upper, q.value);
  EXPECT_LE(q.upper - q.lower, width);
}

// A cube in a room: GR = A_1 / (1 / eps_1 + A_1 / A_2 (1 / eps_2 - 1)), whatever their shapes.
TEST(Exchange, OfAThingInARoomIsTheClosedForm) {
  PlainScene plain;
  add_cube(plain, "thing", 1.0, false);
  add_cube(plain, "room", 3.0, true);
  set_kd(plain, "thing", 0.3);
  set_kd(plain, "room", 0.6);
  const Scene scene = generate::build(plain);
  const Exchange found = exchange(scene, whole_matrix(scene, 1e-6));
  ASSERT_EQ(found.channels.size(), 1U);
  const Exchange::Channel& grey = found.channels.front();
  const double area = 24.0, ratio = 24.0 / 216.0;
  expect_value(grey.conductors[1], area / (1.0 / 0.7 + ratio * (1.0 / 0.4 - 1.0)), 1e-3);
  EXPECT_EQ(grey.conductors[1].value, grey.conductors[2].value);
  expect_value(grey.factors[1], grey.conductors[1].value / (0.7 * area), 1e-4);
  EXPECT_EQ(grey.back[0].upper, 0.0);
  EXPECT_LE(grey.open[0].upper, 1e-6);
}

// Two plates in space: with F between them, B_12 = F eps_2 / (1 - F^2 rho_1 rho_2), and the rest leaves.
TEST(Exchange, OfTwoPlatesInSpaceIsTheClosedForm) {
  PlainScene plain;
  plain.add_ring(plain.patch("below"), {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  plain.add_ring(plain.patch("above"), {{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}});
  set_kd(plain, "below", 0.25);
  set_kd(plain, "above", 0.75);
  const Scene scene = generate::build(plain);
  const Exchange found = exchange(scene, whole_matrix(scene, 1e-7));
  const Exchange::Channel& grey = found.channels.front();
  const double f = 0.199824895698387383041599251193, bounces = 1.0 / (1.0 - f * f * 0.25 * 0.75);
  expect_value(grey.factors[1], f * 0.25 * bounces, 1e-6);
  expect_value(grey.factors[2], f * 0.75 * bounces, 1e-6);
  expect_value(grey.factors[0], f * f * 0.75 * 0.75 * bounces, 1e-6);
  expect_value(grey.open[0], (1.0 - f) * (1.0 + f * 0.75) * bounces, 1e-5);
  EXPECT_EQ(found.areas[0], 1.0);
}

// By radiosities: what i emits and j absorbs, over all i, is what j absorbs of its irradiance.
TEST(Exchange, AddsUpToWhatRadiositiesAbsorb) {
  const Scene scene = read_scene(EXACTFF_DATA_DIR "/scenes/cornell_box.obj");
  const matrix::Matrix matrix = whole_matrix(scene, 1e-3);
  const matrix::Balanced balanced = matrix::balanced(scene, matrix);
  const matrix::Matrix values = with_values(matrix, balanced);
  const Exchange found = exchange(scene, values, 1);
  const Exchange again = exchange(scene, values, 2);
  const Solution solution = solve(scene, values);
  const std::size_t n = found.patches.size();
  ASSERT_EQ(found.channels.size(), 3U);
  for (std::size_t c = 0; c < 3; ++c) {
    const Exchange::Channel& channel = found.channels[c];
    EXPECT_TRUE(channel.is_bounded());
    for (std::size_t j = 0; j < n; ++j) {
      const Material& material = scene.material(scene.face(scene.faces_of(found.patches[j]).front()).material);
      const double rho = c == 0 ? material.reflectance.r : c == 1 ? material.reflectance.g : material.reflectance.b;
      double absorbed = 0.0, row = channel.back[j].value + channel.open[j].value;
      for (std::size_t i = 0; i < n; ++i) {
        const double emitted = [&] {
          const Rgb ke = scene.material(scene.face(scene.faces_of(found.patches[i]).front()).material).radiosity;
          return c == 0 ? ke.r : c == 1 ? ke.g : ke.b;
        }();
        absorbed += emitted * found.areas[i] * channel.factors[i * n + j].value;
        row += channel.factors[j * n + i].value;
        EXPECT_EQ(channel.factors[i * n + j].value, again.channels[c].factors[i * n + j].value);
        EXPECT_LE(channel.factors[i * n + j].lower, channel.factors[i * n + j].value);
        EXPECT_EQ(channel.conductors[i * n + j].value, channel.conductors[j * n + i].value);
      }
      EXPECT_NEAR(row, 1.0, 1e-13);
      const double expected = (1.0 - rho) * solution.channels[c].irradiance[j].value * found.areas[j];
      EXPECT_NEAR(absorbed, expected, 1e-11 * (1.0 + expected));
    }
  }
}

TEST(Exchange, WithoutABoundSaysWhy) {
  PlainScene plain;
  add_cube(plain, "room", 3.0, true);
  set_kd(plain, "room", 1.0);
  const Scene scene = generate::build(plain);
  const Exchange found = exchange(scene, whole_matrix(scene, 1e-3));
  EXPECT_NE(found.channels.front().no_bound.find("Kd is 1 or more on room"), std::string::npos);
}

TEST(ExchangeCommand, WritesATableThatIsReadAgain) {
  const validation::TemporaryDirectory folder;
  const std::string file = (folder.path() / "b.csv").string();
  const validation::ProgramRun run = validation::run_exactff(
      {"matrix", EXACTFF_DATA_DIR "/scenes/formats/test4.vs3", "--accuracy", "1e-3", "--balance", "--exchange", file});
  EXPECT_EQ(run.exit_code, 0);
  const table::Table table = table::read(file);
  EXPECT_EQ(table.kind(), "exchange");
  const std::vector<double>& values = table.numbers(table.column("exchange").value());
  ASSERT_EQ(values.size(), 80U);
  for (std::size_t row = 0; row < 8; ++row) {
    double sum = 0.0;
    for (std::size_t j = 0; j < 10; ++j) sum += values[10 * row + j];
    EXPECT_NEAR(sum, 1.0, 1e-13);
  }
}

// Before any pair is computed.
TEST(ExchangeCommand, RefusesWhatTheSceneTells) {
  const validation::TemporaryDirectory folder;
  const std::string scene = EXACTFF_DATA_DIR "/scenes/cornell_box.obj";
  const std::filesystem::path conductors = folder.path() / "e.gr", values = folder.path() / "m.csv";
  const validation::ProgramRun run = validation::run_exactff(
      {"matrix", scene, "--accuracy", "1e-9", "--certify", "--esatan", conductors.string(), "-o", values.string()});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_NE(run.error.find("Kd differs between red, green and blue"), std::string::npos) << run.error;
  const validation::ProgramRun unknown =
      validation::run_exactff({"matrix", scene, "--exchange", (folder.path() / "e.xyz").string()});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_NE(unknown.error.find("name a file .csv, .npz or .jsonl"), std::string::npos) << unknown.error;
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  PlainScene bright;
  add_cube(bright, "room", 1.0, true);
  set_kd(bright, "room", 1.25);
  EXPECT_THROW(require_exchangeable(generate::build(bright)), InputError);
}

}  // namespace
}  // namespace exactff::radiosity
