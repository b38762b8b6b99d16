// Radiosities after all bounces: rooms and plates whose radiosities are known, the balance of light, the command.
#include <nlohmann/json.hpp>

#include "radiosity/narrowing.h"
#include "support/test.h"

namespace exactff::radiosity {
namespace {

constexpr double kOpposite = 0.199824895698387383041599251193;  // squares of side 1, 1 apart

PlainScene cube(const Rgb& kd, const Rgb& ke) {
  PlainScene scene;
  for (const auto& [side, corners] : sides_of({0, 0, 0}, {1, 1, 1})) add(scene, side, corners, kd, ke);
  return scene;
}

const Rgb kLowerKd{0.1, 0.25, 0.5}, kLowerKe{1, 2, 3}, kUpperKd{0.75, 0.125, 0.9}, kUpperKe{8, 0, 2};

// Squares of side 1 that look at each other.
PlainScene plates() {
  PlainScene scene;
  add(scene, "below", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, kLowerKd, kLowerKe);
  add(scene, "above", {{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}}, kUpperKd, kUpperKe);
  return scene;
}

Solution solution_of(const PlainScene& scene, double accuracy) {
  return solve(generate::build(scene), {.factors = {.accuracy = accuracy}});
}

void expect_holds(const BoundedValue& q, double truth, double width) {
  EXPECT_LE(q.lower, truth);
  EXPECT_GE(q.upper, truth);
  EXPECT_LE(q.lower, q.value);
  EXPECT_GE(q.upper, q.value);
  EXPECT_LE(q.upper - q.lower, width);
}

// In a closed room in which all patches are alike, B = E / (1 - rho), whatever the view factors.
TEST(Radiosity, OfAFurnaceIsEmissionOverAbsorption) {
  const Solution solution = solution_of(cube({0.5, 0.75, 0.0}, {1, 3, 0.1}), 1e-5);
  for (std::size_t i = 0; i < 6; ++i) {
    expect_holds(solution.channels[0].radiosity[i], 2.0, 2e-3);
    expect_holds(solution.channels[1].radiosity[i], 12.0, 2e-2);
    expect_holds(solution.channels[1].irradiance[i], 12.0, 2e-2);
    expect_holds(solution.channels[2].radiosity[i], 0.1, 0.0);
    expect_holds(solution.channels[2].irradiance[i], 0.1, 1e-4);
  }
  EXPECT_TRUE(solution.is_bounded());
  EXPECT_EQ(solution.claim, Claim::kEstimated);
  EXPECT_EQ(solution.reasons_against_balance, Words{});
  EXPECT_TRUE(is_balanced(solution));
  EXPECT_EQ(solution.channels[0].balance.back.upper, 0.0);
}

TEST(Radiosity, OfTwoPlatesIsTheClosedFormInEachChannel) {
  const Solution solution = solution_of(plates(), 1e-9);
  for (const auto& [c, colour] : {std::pair{0, &Rgb::r}, {1, &Rgb::g}, {2, &Rgb::b}}) {
    const double rho = kLowerKd.*colour, other_rho = kUpperKd.*colour, e = kLowerKe.*colour, other_e = kUpperKe.*colour;
    const double loss = 1.0 - rho * other_rho * kOpposite * kOpposite;
    const double below = (e + rho * kOpposite * other_e) / loss, above = (other_e + other_rho * kOpposite * e) / loss;
    const Channel& channel = solution.channels[static_cast<std::size_t>(c)];
    expect_holds(channel.radiosity[0], below, 1e-7);
    expect_holds(channel.radiosity[1], above, 1e-7);
    expect_holds(channel.irradiance[0], kOpposite * above, 1e-7);
    const Balance& balance = channel.balance;
    EXPECT_LE(balance.open.lower, (1.0 - kOpposite) * (below + above));
    EXPECT_GE(balance.open.upper, (1.0 - kOpposite) * (below + above));
    EXPECT_NEAR(balance.emitted.lower, e + other_e, 1e-12);
    EXPECT_NEAR(balance.absorbed.upper, kOpposite * ((1.0 - rho) * above + (1.0 - other_rho) * below), 1e-6);
  }
  EXPECT_TRUE(is_balanced(solution));
}

TEST(Radiosity, OfAClosedRoomOfReflectanceOneHasNoUpperBound) {
  PlainScene room = cube({1, 0.5, 1}, {1, 1, 0});
  const Solution solution = solution_of(room, 1e-4);
  EXPECT_FALSE(solution.channels[0].is_bounded());
  EXPECT_HOLDS(solution.channels[0].no_bound, "Kd is 1 or more on floor, left and 4 others");
  for (const BoundedValue& q : solution.channels[0].radiosity) {
    EXPECT_EQ(q.lower, 1.0);
    EXPECT_EQ(q.upper, std::numeric_limits<double>::infinity());
    EXPECT_TRUE(std::isnan(q.value)) << q.value << ": there is no such number";
  }
  EXPECT_EQ(claim_text(solution, solution.channels[0]), "no bound");
  EXPECT_TRUE(solution.channels[1].is_bounded());
  expect_holds(solution.channels[1].radiosity[0], 2.0, 1e-2);
  EXPECT_TRUE(solution.channels[2].is_bounded());  // nothing emits
  expect_holds(solution.channels[2].radiosity[0], 0.0, 0.0);
  EXPECT_FALSE(solution.is_bounded());
  EXPECT_TRUE(is_balanced(solution));  // as far as is known
}

TEST(Radiosity, RefusesPatchesOfSeveralMaterialsByName) {
  SceneBuilder builder("room.obj");
  for (const Vec3& v : {Vec3{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}}) builder.add_vertex(v);
  const MaterialId grey = builder.add_material({.name = "grey", .reflectance = {0.5, 0.5, 0.5}});
  const MaterialId light =
      builder.add_material({.name = "light", .reflectance = {0.5, 0.5, 0.5}, .radiosity = {1, 1, 1}});
  const MaterialId white = builder.add_material({.name = "white", .reflectance = {0.9, 0.5, 0.5}});
  builder.add_face(builder.patch("wall"), grey, {{0, 1, 2}}, 7);
  builder.add_face(builder.patch("wall"), light, {{3, 4, 5}}, 8);
  builder.add_face(builder.patch("sky"), grey, {{0, 1, 3}}, 9);
  builder.add_face(builder.patch("sky"), white, {{0, 1, 4}}, 10);
  const Scene scene = builder.build();
  const std::string said = complaint([&] { (void)solve(scene); });
  EXPECT_HOLDS(said, "room.obj:8: the faces of patch 'wall' differ in Ke");
  EXPECT_HOLDS(said, "room.obj:10: the faces of patch 'sky' differ in Kd");
}

// Nothing is open in a closed room, no back is seen on the inside of a convex one. Both follow without a factor.
TEST(Radiosity, TellsWhatIsLostWhereOneWayIsProvedToBeNone) {
  const Balance closed = solution_of(cube({0.5, 0.5, 0.5}, {1, 1, 1}), 1e-3).channels[0].balance;
  for (const matrix::Sum& part : {closed.lost, closed.back, closed.open}) EXPECT_EQ(part.upper, 0.0);
  const Balance open = solution_of(plates(), 1e-6).channels[0].balance;
  EXPECT_EQ(open.back.upper, 0.0);
  EXPECT_GT(open.open.lower, 1.0);
  EXPECT_LE(open.open.upper - open.open.lower, 1e-4);
  EXPECT_EQ(open.open.upper, open.lost.upper);
}

TEST(Radiosity, TheBalanceTestsThatNoRowIsAboveOne) {
  const Scene scene = generate::build(cube({}, {}));  // in the dark, no sum of light tells
  const std::vector<Selection> patches = patches_of(scene);
  matrix::Matrix matrix = matrix::compute(scene, patches, patches, {.factors = {.accuracy = 1e-3}});
  EXPECT_TRUE(is_balanced(solve(scene, matrix)));
  for (double ViewFactor::*number : {&ViewFactor::value, &ViewFactor::lower, &ViewFactor::upper}) {
    matrix.factors.entries[1].*number += 1e-2;
  }
  EXPECT_FALSE(is_balanced(solve(scene, matrix)));
}

// Radiosities far from 1, up to the limits of doubles.
TEST(Radiosity, OfAnySizeIsBounded) {
  for (const double scale : {1e-300, 1e-310, 1e150, 1e300}) {
    const Solution solution = solution_of(cube({0.5, 0.5, 0.5}, {scale, scale, scale}), 1e-4);
    ASSERT_TRUE(solution.is_bounded()) << scale;
    expect_holds(solution.channels[0].radiosity[0], 2.0 * scale, 1e-2 * scale);
  }
  const Solution solution = solution_of(cube({0.99, 0.99, 0.99}, {1e308, 1e308, 1e308}), 1e-4);
  EXPECT_FALSE(solution.is_bounded());
}

// The two plates, and one between them.
PlainScene three_plates() {
  PlainScene scene = plates();
  add(scene, "between", {{0.25, 0.25, 0.5}, {0.75, 0.25, 0.5}, {0.75, 0.75, 0.5}, {0.25, 0.75, 0.5}}, kUpperKd, {});
  add(scene, "wall", {{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}}, kLowerKd, {});
  return scene;
}

// Too coarse to prove that less light is reflected than arrives.
TEST(RadiosityWidth, IsReachedFromFactorsThatProveNoBound) {
  const Scene scene = generate::build(cube({0.95, 0.95, 0.95}, {1, 1, 1}));
  EXPECT_FALSE(solve(scene, {.factors = {.accuracy = 0.2}}).is_bounded());
  const Solution solution = solve(scene, {.factors = {.accuracy = 0.2}, .width = 0.05});
  EXPECT_LE(widest_bounds(solution).share, 0.05);
  expect_holds(solution.channels[0].radiosity[0], 20.0, 1.0);
}

TEST(RadiosityWidth, EntriesAreWhatViewFactorGivesWithTheirAccuracy) {
  const Scene scene = generate::build(three_plates());
  const std::vector<Selection> patches = patches_of(scene);
  const Options options{.factors = {.accuracy = 0.5}, .width = 1e-5};
  const TemporaryDirectory folder;
  jobs::Journal journal(folder.path() / "again.part", jobs::Existing::kRefuse);
  matrix::Matrix matrix = matrix::compute(scene, patches, patches, matrix_options(options));
  const Narrowed narrowed = narrow(scene, matrix, options, &journal, {});
  std::set<int> halvings;
  for (std::size_t e = 0; e < matrix.factors.entries.size(); ++e) {
    halvings.insert(narrowed.halvings[e]);
    const double accuracy = std::ldexp(0.5, -narrowed.halvings[e]);
    const ViewFactor &f = matrix.factors.entries[e],
                     g = view_factor(scene, patches[e / 4], patches[e % 4], {.accuracy = accuracy});
    EXPECT_EQ(f.value, g.value) << e;
    EXPECT_EQ(f.lower, g.lower) << e;
    EXPECT_EQ(f.upper, g.upper) << e;
    EXPECT_EQ(f.cells, g.cells) << e;
  }
  EXPECT_GT(halvings.size(), 2U);
  EXPECT_LE(widest_bounds(solve(scene, matrix)).share, 1e-5);
  EXPECT_GT(journal.size(), narrowed.entries / 2) << "some pairs are computed twice";
}

TEST(RadiosityWidth, DoesNotDependOnThreadsOrInterruptions) {
  const Scene scene = generate::build(three_plates());
  const std::vector<Selection> patches = patches_of(scene);
  Options options{.factors = {.accuracy = 0.1}, .width = 1e-4, .threads = 1};
  const auto text = [&](const Solution& solution) {
    return table::csv_text(table_of(scene, solution, options.factors));
  };
  const std::string one = text(solve(scene, options));
  options.threads = 3;
  EXPECT_EQ(text(solve(scene, options)), one);
  const TemporaryDirectory folder;
  const std::filesystem::path file = folder.path() / "again.part";
  const matrix::Matrix first = matrix::compute(scene, patches, patches, matrix_options(options));
  {
    jobs::Journal journal(file, jobs::Existing::kRefuse);
    matrix::Matrix matrix = first;
    EXPECT_THROW((void)solve_within(scene, matrix, options, &journal, {{}, [&] { return journal.size() >= 2; }}),
                 Cancelled);
  }
  std::uintmax_t size = 0;
  for (int again = 0; again < 2; ++again) {
    jobs::Journal journal(file, jobs::Existing::kResume);
    EXPECT_GE(journal.size(), 2U);
    matrix::Matrix matrix = first;
    EXPECT_EQ(text(solve_within(scene, matrix, options, &journal, {})), one);
    EXPECT_TRUE(again == 0 || std::filesystem::file_size(file) == size) << "nothing was left to compute";
    size = std::filesystem::file_size(file);
  }
}

TEST(RadiosityWidth, ThatTheBudgetDoesNotAllowIsNotClaimed) {
  const Scene scene = generate::build(three_plates());
  const Solution solution = solve(scene, {.factors = {.accuracy = 0.1, .budget = 4}, .width = 1e-6});
  EXPECT_TRUE(solution.is_bounded());
  EXPECT_GT(widest_bounds(solution).share, 1e-6);
  EXPECT_THROW((void)solve(scene, {.width = 0.0}), InputError);
}

class RadiosityCommand : public testing::Test {
 protected:
  [[nodiscard]] ProgramRun run(const std::string& scene, Words flags) const {
    if (std::ranges::find(flags, "--accuracy") == flags.end()) flags.insert(flags.begin(), {"--accuracy", "1e-3"});
    flags.insert(flags.begin(), {"radiosity", scene});
    return run_exactff(flags);
  }
  [[nodiscard]] std::string write(const PlainScene& scene) const {
    (void)folder_.write("scene.mtl", generate::to_mtl(scene));
    return folder_.write("scene.obj", generate::to_obj(scene, "scene.mtl")).string();
  }
  [[nodiscard]] std::string file(const char* name) const { return (folder_.path() / name).string(); }

  const TemporaryDirectory folder_;
};

TEST_F(RadiosityCommand, PrintsTheSameNumbersInEveryForm) {
  const std::string scene = write(plates());
  const Solution solution = solve(read_scene(scene), {.factors = {.accuracy = 1e-3}});
  const auto plain = run(scene, {"--plain", "-o", file("b.csv")});
  EXPECT_EQ(plain.exit_code, 0);
  std::istringstream lines(plain.output);
  std::string name, channel, value, lower, upper, claim;
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      lines >> name >> channel >> value >> lower >> upper >> claim;
      const BoundedValue& b = solution.channels[c].radiosity[i];
      EXPECT_EQ(name, i == 0 ? "below" : "above");
      EXPECT_EQ(channel, kChannelNames[c]);
      EXPECT_EQ(std::stod(value), b.value);
      EXPECT_EQ(std::stod(lower), b.lower);
      EXPECT_EQ(std::stod(upper), b.upper);
      EXPECT_EQ(claim, "estimated");
    }
  }
  const std::string csv = text_of(file("b.csv"));
  EXPECT_EQ(run(scene, {"--csv"}).output, csv);
  EXPECT_HOLDS(csv, "\nabove,green,");
  EXPECT_EQ(run(scene, {"-o", file("b.csv")}).exit_code, 2);
  const auto json = nlohmann::json::parse(run(scene, {"--json"}).output);
  EXPECT_EQ(json["patches"][1]["blue"]["radiosity"]["upper"], solution.channels[2].radiosity[1].upper);
  EXPECT_EQ(json["channels"]["red"]["balance"]["open"]["lower"], solution.channels[0].balance.open.lower);
  const std::string table = run(scene, {}).output;
  EXPECT_HOLDS(table, "What is lost is what the view factors of each patch leave of 1");
}

TEST_F(RadiosityCommand, WithoutABoundHasTheExitCodeThree) {
  const std::string scene = write(cube({1, 1, 1}, {1, 1, 1}));
  const auto plain = run(scene, {"--plain"});
  EXPECT_EQ(plain.exit_code, 3);
  EXPECT_HOLDS(plain.output, "\t1\tinf\tno bound\n");
  const auto csv = run(scene, {"--csv"});
  EXPECT_EQ(csv.exit_code, 3);
  EXPECT_HOLDS(csv.output, ",no bound,");
  EXPECT_EQ(csv.output.find("inf"), std::string::npos);
  const auto json = nlohmann::json::parse(run(scene, {"--json"}).output);
  EXPECT_FALSE(json["patches"][0]["red"]["radiosity"].contains("upper"));
  EXPECT_TRUE(json["channels"]["red"].contains("no_bound"));
}

TEST_F(RadiosityCommand, TakesAFinishedMatrixOfTheSameScene) {
  const std::string scene = write(plates());
  const auto matrix = [&](const std::string& to, const std::string& name) {
    return run_exactff({"matrix", scene, "--accuracy", "1e-3", "--backs", "--to", to, "-o", file(name.c_str())})
        .exit_code;
  };
  EXPECT_EQ(matrix("all,sky", "m.csv"), 0);
  EXPECT_EQ(matrix("all", "less.csv"), 0);
  const auto taken = run_exactff({"radiosity", scene, "--matrix", file("m.csv"), "--csv"});
  EXPECT_EQ(taken.exit_code, 0) << taken.output;
  EXPECT_EQ(taken.output, run(scene, {"--csv"}).output);
  EXPECT_EQ(run_exactff({"radiosity", scene, "--matrix", file("less.csv"), "--csv"}).output, taken.output);
  EXPECT_EQ(run_exactff({"radiosity", scene, "--matrix", file("m.csv"), "--divide", "0.5"}).exit_code, 2);
  EXPECT_EQ(run_exactff({"radiosity", scene, "--matrix", file("m.csv"), "--accuracy", "1e-3"}).exit_code, 2);
  EXPECT_EQ(run_exactff({"radiosity", scene, "--matrix", file("m.csv"), "--force", "-o", file("m.csv")}).exit_code, 2);
  EXPECT_EQ(run_exactff({"radiosity", scene, "--matrix", file("m.csv"), "--csv"}).output, taken.output);
}

TEST_F(RadiosityCommand, KeepsACompleteFileAndMakesWhatIsMissingBesideIt) {
  const std::string scene = write(three_plates());
  const Words wide = {"--budget", "1", "-o", file("s.csv")};
  const auto with = [&](const Words& more) { return run(scene, joined(wide, more)); };
  EXPECT_EQ(with({"--vtk", file("first.vtp")}).exit_code, 3) << "view factors are wider than 1e-3";
  const std::string first = text_of(file("s.csv"));
  EXPECT_HOLDS(first, "\"wide_entries\":8,");
  EXPECT_EQ(with({"--resume", "--vtk", file("again.vtp")}).exit_code, 3);
  EXPECT_EQ(text_of(file("again.vtp")), text_of(file("first.vtp")));
  EXPECT_EQ(with({"--resume", "--plain"}).output, run(scene, {"--budget", "1", "--plain"}).output);
  EXPECT_EQ(with({"--resume", "--csv"}).output, first);
  EXPECT_HOLDS(with({"--resume"}).output, "irradiance");
  for (const Words& other : {Words{"--resume", "--json"},
                             {"--resume", "--width", "1"},
                             {"--resume", "--certify"},
                             {"--resume", "--two-sided", "all"},
                             {"--resume", "--force"},
                             {}}) {
    EXPECT_EQ(with(other).exit_code, 2) << testing::PrintToString(other);
  }
  EXPECT_EQ(run(scene, {"--budget", "2", "-o", file("s.csv"), "--resume"}).exit_code, 2);
  EXPECT_EQ(text_of(file("s.csv")), first);
  EXPECT_EQ(with({"--force"}).exit_code, 3);
  EXPECT_EQ(text_of(file("s.csv")), first);
}

TEST_F(RadiosityCommand, MakesBoundsOfAWidthOrSaysHowWideTheyAre) {
  const std::string scene = write(three_plates());
  const auto command = [&](Words words) { return run_exactff(joined({"radiosity", scene}, words)); };
  const auto csv = command({"--width", "1e-3", "--csv"});
  EXPECT_EQ(csv.exit_code, 0);
  EXPECT_HOLDS(csv.output, "\"width\":0.001,\"entries_again\":4,");
  EXPECT_EQ(command({"--width", "1e-3", "-o", file("w.csv")}).exit_code, 0);
  EXPECT_EQ(text_of(file("w.csv")), csv.output);
  const auto wide = command({"--width", "1e-6", "--budget", "4"});
  EXPECT_EQ(wide.exit_code, 3);
  EXPECT_HOLDS(wide.error, "of the brightest radiosity wide, the widest of all, and not 1e-06");
  EXPECT_EQ(command({"--width", "0"}).exit_code, 2);
}

}  // namespace
}  // namespace exactff::radiosity
