// Temperatures and heats of gray surfaces: closed forms, a published cavity, files, the command.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "exactff/radiosity.h"
#include "exactff/scene_files.h"
#include "generate/plain_scene.h"
#include "support/program.h"

namespace exactff::radiosity {
namespace {

void add_box_to(generate::PlainScene& scene, const std::string& name, double h, double kd, bool inward) {
  const std::vector<Vec3> c{{-h, -h, -h}, {h, -h, -h}, {h, h, -h}, {-h, h, -h},
                            {-h, -h, h},  {h, -h, h},  {h, h, h},  {-h, h, h}};
  for (std::vector<std::size_t> side : std::vector<std::vector<std::size_t>>{
           {0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {3, 7, 6, 2}, {0, 4, 7, 3}, {1, 2, 6, 5}}) {
    if (inward) std::ranges::reverse(side);
    scene.add_ring(scene.patch(name), {c[side[0]], c[side[1]], c[side[2]], c[side[3]]});
  }
  scene.patch(name).material = "of " + name;
  scene.materials.push_back({.name = "of " + name, .reflectance = {kd, kd, kd}});
}

// A cube of area 24 in a room of area 216, each of one temperature.
Scene thing_in_a_room() {
  generate::PlainScene plain;
  add_box_to(plain, "thing", 1.0, 0.3, false);
  add_box_to(plain, "room", 3.0, 0.6, true);
  return generate::build(plain);
}
constexpr double kConductor = 24.0 / (1.0 / 0.7 + 24.0 / 216.0 * (1.0 / 0.4 - 1.0));

double power(double t) { return kStefanBoltzmann * t * t * t * t; }

Temperatures solved(const Scene& scene, const std::vector<Known>& known, double sky = 0.0) {
  const std::vector<Selection> patches = patches_of(scene);
  const matrix::Matrix matrix =
      matrix::compute(scene, patches, patches, {.factors = {.accuracy = 1e-7}, .backs = true, .open = true});
  return temperatures(scene, matrix, {.patches = known, .open = sky});
}

void expect_within(const BoundedValue& q, double truth, double width) {
  EXPECT_LE(q.lower, truth);
  EXPECT_GE(q.upper, truth);
  EXPECT_NEAR(q.value, truth, width);
  EXPECT_LE(q.upper - q.lower, width);
}

TEST(Temperatures, OfAThingInARoomAreTheClosedForm) {
  const Scene scene = thing_in_a_room();
  const double heat = kConductor * (power(400.0) - power(300.0));
  const Temperatures both = solved(scene, {{.temperature = 400.0}, {.temperature = 300.0}});
  expect_within(both.heats[0], heat, 0.1);
  expect_within(both.heats[1], -heat, 0.1);
  EXPECT_LE(both.unbalanced.lower, 0.0);
  EXPECT_GE(both.unbalanced.upper, 0.0);
  const Temperatures warmed = solved(scene, {{.heat = heat}, {.temperature = 300.0}});
  expect_within(warmed.temperatures[0], 400.0, 1e-2);
  const Temperatures cooled = solved(scene, {{.temperature = 400.0}, {.heat = -heat}});
  expect_within(cooled.temperatures[1], 300.0, 1e-2);
  EXPECT_EQ(cooled.claim, Claim::kEstimated);
}

// A plate that gives off heat to a black sky, and what only reflects between plates of known temperature.
TEST(Temperatures, OfAPlateUnderTheSkyAreTheClosedForm) {
  generate::PlainScene plain;
  plain.add_ring(plain.patch("plate"), {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  plain.patch("plate").material = "grey";
  plain.materials.push_back({.name = "grey", .reflectance = {0.2, 0.2, 0.2}});
  const Scene scene = generate::build(plain);
  const Temperatures found = solved(scene, {{.heat = 100.0}}, 250.0);
  const double truth = std::pow((power(250.0) + 100.0 / 0.8) / kStefanBoltzmann, 0.25);
  expect_within(found.temperatures[0], truth, 1e-3);
  expect_within(found.to_open, 100.0, 1e-3);
  EXPECT_EQ(found.to_back.upper, 0.0);
  const Temperatures idle = solved(scene, {{.heat = 0.0}}, 250.0);
  expect_within(idle.temperatures[0], 250.0, 1e-3);
}

TEST(Temperatures, TakesNoMoreHeatThanThereIs) {
  EXPECT_THROW((void)solved(thing_in_a_room(), {{.temperature = 300.0}, {.heat = -1e6}}), InputError);
}

class TemperaturesCommand : public testing::Test {
 protected:
  [[nodiscard]] std::string file(const std::string& name) const { return (folder_.path() / name).string(); }
  void expect_refused(const std::string& conditions, const std::string& what) const {
    const validation::ProgramRun run = validation::run_exactff(
        {"radiosity", scene_, "--temperatures", folder_.write("bad.csv", conditions).string(), "--accuracy", "1e-2"});
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_NE(run.error.find(what), std::string::npos) << run.error;
  }

  const std::string scene_ = EXACTFF_DATA_DIR "/scenes/triangular_cavity.obj";
  const validation::TemporaryDirectory folder_;
};

// A thread of CalculiX' forum on COMSOL's tutorial says about 641 K and 600 K. Without ends, the crossed strings give
// 640.683 K and 598.772 K; the cavity here is 1000 long, and its ends make a difference of 0.02 K.
TEST_F(TemperaturesCommand, ComputesTheTriangularCavity) {
  const validation::ProgramRun run =
      validation::run_exactff({"radiosity", scene_, "--temperatures", EXACTFF_DATA_DIR "/scenes/triangular_cavity.csv",
                               "--accuracy", "1e-5", "-o", file("t.csv")});
  EXPECT_EQ(run.exit_code, 0);
  const table::Table table = table::read(file("t.csv"));
  const std::vector<double>& t = table.numbers(table.column("temperature").value());
  const std::vector<double>& heat = table.numbers(table.column("heat").value());
  EXPECT_EQ(t[0], 300.0);
  EXPECT_NEAR(t[1], 640.683, 0.05);
  EXPECT_NEAR(t[2], 598.772, 0.05);
  EXPECT_NEAR(heat[0], -1.1e7, 1.0);
}

TEST_F(TemperaturesCommand, RefusesConditionsThatAreNone) {
  expect_refused("patch,T,Q\nbottom,300,\nside,,6\nslope,,5\n", "has no row for 'ends'");
  expect_refused("patch,T,Q\n*,300,5\n", "bad.csv:2: there are both T and Q");
  expect_refused("patch,T,Q\nbottom,,\n", "bad.csv:2: there is neither T nor Q");
  expect_refused("patch,T,Q\n*,-3,\n", "bad.csv:2: T is -3");
  expect_refused("patch,T,Q\n*,warm,\n", "bad.csv:2:");
  expect_refused("patch,T,Q\n*,300,\nends,300,\n", "bad.csv:3: 'ends' has two rows");
  expect_refused("patch,T,Q\nlid,300,\n", "bad.csv:2:");
  expect_refused("name,T,Q\nlid,300,\n", "bad.csv:1: the first line has not the columns");
  expect_refused("patch,T,Q\n*,300,\n(open),,5\n", "bad.csv:3: (open) has a Q");
  expect_refused("patch,T,Q\nbottom,1e200,\nside,300,\nslope,300,\nends,300,\n",
                 "'bottom' gives off more than 1e+300 W per unit of area (doubles end");
  expect_refused("patch,T,Q\n*,,0\n", "no patch has a temperature, and nothing is open");
}

}  // namespace
}  // namespace exactff::radiosity
